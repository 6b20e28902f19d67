#!/usr/bin/env bash
# The reflex (core/run/reflex.hpp): the four knots at two meshes and steps beside the paper's law, what it needs, its law of speed, where
# it fails, pulls at food, and the same in MuJoCo. Leaves experiments/results/reflex.csv, reflex.md, made of it, and
# experiments/figures/reflex.png.
#   bash experiments/studies/reflex.sh [OUTPUT_FOLDER]     default: out/reflex
# Stopped, it goes on where it was; logs of MuJoCo and the table of laws in Python that are there already are not made again.
set -euo pipefail
targets=(hagfish_python)
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

for grid in knots paper knockouts speed delay noise bodies step drag muscle damping stiffness starts pull pull_shift; do
  "$hagfish" sweep "$grids/reflex_$grid.toml" --out "$out/$grid"
done
{
  cat "$grids/reflex_animals.toml"
  /usr/bin/python3 "$root/experiments/studies/animals.py" 10 axis
} >"$out/animals.toml"
"$hagfish" sweep "$out/animals.toml" --out "$out/animals"

if [[ ! -e $out/laws.csv ]]; then
  PYTHONPATH=$root/build/release/experiments/python /usr/bin/python3 "$root/experiments/studies/reflex_laws.py" "$out/laws.csv.part"
  mv "$out/laws.csv.part" "$out/laws.csv"
fi
mkdir -p "$out/mujoco"
for scene in reflex_overhand reflex_figure_eight reflex_double_overhand reflex_three_twist; do
  [[ -e $out/mujoco/$scene.h5 ]] || "$hagfish" mujoco-run "$scene" --step 0.002 --out "$out/mujoco/$scene.h5"
done
draw reflex.py "$out" "$root/experiments/results/reflex.csv" "$root/experiments/results/reflex.md" "$root/experiments/figures/reflex.png"
finish "$root/experiments/results/reflex.md"
