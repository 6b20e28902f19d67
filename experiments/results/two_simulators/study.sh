#!/usr/bin/env bash
# The Table 1 animal in two simulators: holds the core against MuJoCo, then slides the knot of a run
# in MuJoCo, with its own contacts and limits, by its mean f_thigmo alone. Leaves tables and HDF5.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/../common.sh"

failed=0
"$hagfish" compare table1 --set time.step=0.002 --out "$out/compare.h5" --force | tee "$out/compare.txt" || failed=$?
echo
"$hagfish" run table1 --qp ipopt --set time.step=0.002 --out "$out/table1.h5" --force
"$hagfish" playback "$out/table1.h5" --out "$out/playback.h5" --force | tee "$out/playback.txt"
draw two_simulators.py "$out/compare.h5" "$out/playback.h5" "$out"
exit "$failed"
