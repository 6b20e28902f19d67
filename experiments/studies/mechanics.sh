#!/usr/bin/env bash
# Rods and knots whose forces are known. Leaves the tables of experiments/results/mechanics.md.
#   bash experiments/studies/mechanics.sh [OUTPUT_FOLDER]     default: out/mechanics
set -euo pipefail
targets=(--target mechanics)
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

for table in twisted hooked loose mujoco ply tight time; do
  "$root/build/release/experiments/mechanics" $table >"$out/$table.csv"
done
/usr/bin/python3 "$root/experiments/studies/mechanics.py" "$out"
list_output
