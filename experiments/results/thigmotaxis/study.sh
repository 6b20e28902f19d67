#!/usr/bin/env bash
# What slides the knot of a stiff animal: Eq. 6 at two contacts, at the skin, at all contacts, or the reflex; by knots, meshes, steps,
# speeds and starts. Leaves thigmotaxis.png and two tables.
# Stopped, it goes on where it was.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/../common.sh"

for grid in laws reflex meshes steps speeds starts; do
  "$hagfish" sweep "$grids/$grid.toml" --out "$out/$grid"
done
draw thigmotaxis.py "$out"
