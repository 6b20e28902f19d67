#!/usr/bin/env bash
# Rods whose forces are known, by the tests that hold the program to them, and loose and tight knots. Leaves the tables of
# experiments/results/mechanics.md.
#   bash experiments/studies/mechanics.sh [OUTPUT_FOLDER]     default: out/mechanics
set -euo pipefail
targets=(--target validation_tests --target mechanics)
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

mkdir -p "$out/tables"
"$root/build/release/tests/validation_tests" --gtest_filter='*TwistedRod*' --gtest_output="json:$out/tests.json"
for knots in loose tight; do
  "$root/build/release/experiments/mechanics" $knots >"$out/$knots.csv"
done
python3 "$root/experiments/studies/mechanics.py" "$out"
list_output
