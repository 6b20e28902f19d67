#!/usr/bin/env bash
# Builds and runs the tests; closes on CTest's summary. Further arguments go to ctest:
#   bash tests/run.sh                  all tests
#   bash tests/run.sh --quick          those for each edit: no whole runs, no hostile input
#   bash tests/run.sh -L validation    what has a label
#   PRESET=sanitize bash tests/run.sh  with AddressSanitizer and UndefinedBehaviorSanitizer
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
targets=() chosen=()
if [[ ${1-} == --quick ]]; then
  shift
  targets=(--target unit_tests)
  chosen=(-L quick)
fi
bash experiments/setup.sh "${targets[@]}"
source experiments/cores.sh
jobs=$(cores)
# Serial BLAS, so that runs repeat and tests do not fight for the cores.
export OPENBLAS_NUM_THREADS=1 OMP_NUM_THREADS=1
ctest --preset "${PRESET:-release}" --parallel "$jobs" "${chosen[@]}" "$@"
