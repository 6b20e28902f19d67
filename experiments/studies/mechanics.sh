#!/usr/bin/env bash
# Rods whose forces are known, by the tests that hold the program to them. Leaves the table of experiments/results/mechanics.md.
#   bash experiments/studies/mechanics.sh [OUTPUT_FOLDER]     default: out/mechanics
set -euo pipefail
targets=(--target validation_tests)
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

mkdir -p "$out/tables"
"$root/build/release/tests/validation_tests" --gtest_filter='*TwistedRod*' --gtest_output="json:$out/tests.json"
python3 - "$out/tests.json" >"$out/tables/mechanics.csv" <<'END'
import json
import sys

print('problem,bending over twist rigidity,bodies,"closed form, dyn cm","error, %","CPU time, s"')
for suite in json.load(open(sys.argv[1]))["testsuites"]:
    for test in suite["testsuite"]:
        for name, row in sorted(test.items()):
            if name.startswith("row_"):
                print(row)
END
list_output
