#!/usr/bin/env bash
# How few numbers slide a knot, in which frame, how often found (grids/few_numbers.toml), and twenty starts of each
# (grids/few_numbers_starts.toml). Leaves tables, few_numbers.png and few_numbers.md.
#   bash experiments/studies/few_numbers.sh [OUTPUT_FOLDER]     default: out/few_numbers
# Stopped, it goes on where it was.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

"$hagfish" sweep "$grids/few_numbers.toml" --out "$out/numbers"
"$hagfish" sweep "$grids/few_numbers_starts.toml" --out "$out/starts"
draw few_numbers.py "$out/numbers/table.csv" "$out/few_numbers.png" "$out/few_numbers.md"
finish "$out/few_numbers.md"
