#!/usr/bin/env bash
# Every knot the animal ties: overhand (3_1), figure-eight (4_1), double overhand (5_1) and three-twist (5_2), their mirror
# images, from noisy starts, with coarse and fine steps and from starts that differ by rounding. Leaves pictures and
# tables.
# Stopped, it goes on where it was.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/../common.sh"

for grid in plain step chance noise; do "$hagfish" sweep "$grids/$grid.toml" --out "$out/$grid"; done
draw knots.py "$out"
