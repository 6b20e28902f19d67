#!/usr/bin/env bash
# What slides the knot of a stiff animal: Eq. 6 at two contacts or at all, tightened first or not, at the skin, or the reflex; by knots,
# meshes, steps, speeds and starts. Leaves thigmotaxis.png and three tables.
# Stopped, it goes on where it was.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/../common.sh"

for grid in laws tightened reflex meshes steps speeds starts; do
  "$hagfish" sweep "$grids/$grid.toml" --out "$out/$grid"
done
draw thigmotaxis.py "$out"
