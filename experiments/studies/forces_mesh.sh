#!/usr/bin/env bash
# Where the mesh's share of the forces of Eq. 6 comes from: slides of 92 to 400 bodies, and of one curve carried over to several
# counts. Leaves experiments/results/forces_mesh.csv and forces_mesh.md, made of it.
#   bash experiments/studies/forces_mesh.sh [OUTPUT_FOLDER]     default: out/forces_mesh
# Stopped, it goes on where it was.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

"$hagfish" sweep "$grids/forces_counts.toml" --out "$out/counts"
draw carried_curve.py "$out/counts" "$out/carried"
for scene in "$out"/carried/*.toml; do
  log=${scene%.toml}.h5
  [[ -e $log ]] || "$hagfish" run "$scene" --out "$log" --quiet
done
draw forces_mesh.py "$out" "$root/experiments/results/forces_mesh.csv" "$root/experiments/results/forces_mesh.md"
finish "$root/experiments/results/forces_mesh.md"
