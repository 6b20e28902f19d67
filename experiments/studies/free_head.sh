#!/usr/bin/env bash
# Free head: each knot tied with the head held, then tightened and slid off by an animal that nothing holds (no clamp, no
# plate), beside the held one, at several speeds. Leaves free_head.png, free_head.csv and free_head.md.
#   bash experiments/studies/free_head.sh [OUTPUT_FOLDER]     default: out/free_head
# Stopped, it goes on where it was.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

for head in held free forming; do "$hagfish" sweep "$grids/free_head_$head.toml" --out "$out/$head"; done
draw free_head.py "$out" "$out/free_head.csv" "$out/free_head.png" "$out/free_head.md"
finish "$out/free_head.md"
