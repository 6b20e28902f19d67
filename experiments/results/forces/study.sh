#!/usr/bin/env bash
# What f_thigmo is worth: its sums and how it is spread, by step, mesh, girth and start. Leaves three tables.
# Stopped, it goes on where it was.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/../common.sh"

"$hagfish" sweep "$grids/forces.toml" --out "$out/slides"
draw forces.py "$out"
