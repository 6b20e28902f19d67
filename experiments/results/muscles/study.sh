#!/usr/bin/env bash
# Muscles: what the living scenes take of them while tying, sliding and pulling, in softer and stiffer bodies too, and the knots tied
# and slid by activations alone, also from noisy starts and with quicker and slower muscles. Leaves tables, muscles_stiffness.png
# and, of the overhand knot, muscles.png.
# Stopped, it goes on where it was.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/../common.sh"

for grid in ties forward start lag stiffness; do "$hagfish" sweep "$grids/$grid.toml" --out "$out/$grid"; done
draw muscle_study.py "$out"
draw muscles.py "$out/ties/logs/0.h5" "$out/muscles.png"
