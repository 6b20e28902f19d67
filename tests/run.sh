#!/usr/bin/env bash
# Builds and runs every test; closes on CTest's summary. Arguments go to ctest:
#   bash tests/run.sh -L unit          only the unit tests
#   PRESET=sanitize bash tests/run.sh  with AddressSanitizer and UndefinedBehaviorSanitizer
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
bash experiments/setup.sh
jobs=$(nproc) # which would heed OMP_NUM_THREADS
# Serial BLAS, so that runs repeat and tests do not fight for the cores.
export OPENBLAS_NUM_THREADS=1 OMP_NUM_THREADS=1
ctest --preset "${PRESET:-release}" --parallel "$jobs" "$@"
