#!/usr/bin/env bash
# The Table 1 experiment from nothing to figures: sets up, builds, runs the scene with Ipopt, audits
# the log and draws. Leaves table1.h5, figure7, figure8, claims and summary.md in one folder.
#   bash experiments/table1.sh [OUTPUT_FOLDER]     default: out/table1
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
out=${1:-$root/out/table1}
source "$root/experiments/studies/elapsed.sh"
mkdir -p "$out"
out=$(cd "$out" && pwd)

bash "$root/experiments/setup.sh" --target hagfish
# Serial BLAS, so that the run repeats to the last bit.
export OPENBLAS_NUM_THREADS=1 OMP_NUM_THREADS=1

hagfish=$root/build/release/experiments/hagfish
# Exit codes 1 and 3 are runs that stopped: their log is audited and drawn as far as it goes. Either failure
# fails the script, at the end.
failed=0
"$hagfish" run table1 --qp ipopt --out "$out/table1.h5" --force || failed=$?
if ((failed == 2)); then exit "$failed"; fi
"$hagfish" check "$out/table1.h5" --csv "$out/check.csv" | tee "$out/check.txt" || failed=$?

# Debian's python3 is the one that has h5py and matplotlib.
draw() { /usr/bin/python3 "$root/experiments/figures/$1" "${@:2}"; }
echo "Drawing Figure 7"
draw figure7.py "$out/table1.h5" "$hagfish" "$out/figure7.png"
echo "Drawing Figure 8"
draw figure8.py "$out/table1.h5" "$out/figure8.png" "$out/claims.png" >"$out/claims.txt"
draw summary.py "$out/table1.h5" "$out/check.csv" "$out/summary.md"
echo
cat "$out/claims.txt"
echo
echo "In $out:"
ls "$out"
exit "$failed"
