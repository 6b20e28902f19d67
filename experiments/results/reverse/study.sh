#!/usr/bin/env bash
# The reverse slide: each knot slid to the head and back until it comes undone at the tail, at several
# speeds. Leaves a table.
# Stopped, it goes on where it was.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/../common.sh"

"$hagfish" sweep "$grids/reverse.toml" --out "$out"
draw reverse.py "$out"
