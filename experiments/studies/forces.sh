#!/usr/bin/env bash
# How far the forces of Eq. 6 depend on the step, the mesh and chance, with intervals: slides of the four knots, pulled by the tail and living, pulls at food, and bodies
# of nearly the same stiffness. Leaves experiments/results/forces.csv and forces.md, made of it.
#   bash experiments/studies/forces.sh [OUTPUT_FOLDER]     default: out/forces
# Stopped, it goes on where it was.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

for grid in meshes midpoint starts pulls stiffness; do
  "$hagfish" sweep "$grids/forces_$grid.toml" --out "$out/$grid"
done
for scene in overhand_waypoints figure_eight double_overhand three_twist living_{overhand,figure_eight,double_overhand,three_twist}; do
  "$hagfish" sure "$scene" --set time.until=slide --set "expect.types=[]" --out "$out/sure/$scene" --quiet
done
draw forces.py "$out" "$root/experiments/results/forces.csv" "$root/experiments/results/forces.md"
finish "$root/experiments/results/forces.md"
