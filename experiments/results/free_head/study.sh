#!/usr/bin/env bash
# Free head: each knot tied with the head held, then tightened and slid off by an animal that nothing holds (no clamp, no
# plate), beside the held one, at several speeds. Leaves a table.
# Stopped, it goes on where it was.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/../common.sh"

for head in held free forming; do "$hagfish" sweep "$grids/$head.toml" --out "$out/$head"; done
draw free_head.py "$out"
