#!/usr/bin/env bash
# Rods and knots whose forces are known. Leaves the tables of the page.
set -euo pipefail
targets=(--target mechanics)
source "$(dirname "${BASH_SOURCE[0]}")/../common.sh"

for table in twisted hooked loose mujoco ply tight time; do
  "$root/build/release/experiments/mechanics" $table >"$out/$table.csv"
done
draw mechanics.py "$out"
