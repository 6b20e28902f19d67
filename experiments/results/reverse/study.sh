#!/usr/bin/env bash
# The reverse slide: each knot slid to the head and back until it comes undone at the tail, at several speeds, beside the way
# to the head at the same speed. Leaves reverse.png and a table.
#   bash experiments/results/reverse/study.sh [OUTPUT_FOLDER]     default: out/reverse
# Stopped, it goes on where it was.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/../common.sh"

"$hagfish" sweep "$grids/reverse.toml" --out "$out"
draw reverse.py "$out"
list_output
