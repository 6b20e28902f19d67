#!/usr/bin/env bash
# Where does sliding work and what does it cost? 900 runs, of bending stiffness x commanded speed x starts (grids/sliding.toml).
# Leaves table.csv, a row a run, page.html, sliding.png and tables.
# Stopped, it goes on where it was.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/../common.sh"

"$hagfish" sweep "$grids/sliding.toml" --out "$out"
draw sweep_page.py "$out/table.csv" "$out/page.html"
draw sliding_map.py "$out"
