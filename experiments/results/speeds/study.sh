#!/usr/bin/env bash
# How fast a knot can slide: 0.1 to 50 cm/s commanded, against the speed, force, slack and penetration that come of it. Leaves
# speeds.png and a table.
# Stopped, it goes on where it was.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/../common.sh"

"$hagfish" sweep "$grids/speeds.toml" --out "$out"
draw speeds.py "$out"
