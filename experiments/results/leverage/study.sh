#!/usr/bin/env bash
# What a knot is for: the pull at the food of every knot, in the Table 1 body and in the living one, against what the rows of
# Eq. 6 may give, speed, stiffness, girth, muscles, time step and number of bodies. Leaves tables, leverage.png and
# leverage_why.png.
# Stopped, it goes on where it was.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/../common.sh"

for grid in "$grids"/*.toml; do "$hagfish" sweep "$grid" --out "$out/sweeps/$(basename "$grid" .toml)"; done
draw leverage.py "$out/sweeps" "$out"
draw leverage_why.py "$out/sweeps/plain" "$out/leverage_why.png"
