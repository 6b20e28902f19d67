#!/usr/bin/env bash
# The Table 1 experiment from nothing to figures.
#   bash experiments/table1.sh [OUTPUT_FOLDER]     default: out/table1
exec bash "$(dirname "${BASH_SOURCE[0]}")/results/table1/study.sh" "$@"
