#!/usr/bin/env bash
# The Table 1 animal in two simulators: holds the core against MuJoCo, then slides the knot of a run
# in MuJoCo, with its own contacts and limits, by its mean f_thigmo alone. Leaves tables, HDF5 and figures.
#   bash experiments/studies/mujoco.sh [OUTPUT_FOLDER]     default: out/mujoco
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
out=${1:-$root/out/mujoco}
source "$root/experiments/studies/elapsed.sh"
mkdir -p "$out"
out=$(cd "$out" && pwd)

bash "$root/experiments/setup.sh" --target hagfish
# Serial BLAS, so that runs repeat to the last bit.
export OPENBLAS_NUM_THREADS=1 OMP_NUM_THREADS=1

hagfish=$root/build/release/experiments/hagfish
# Debian's python3 is the one that has h5py and matplotlib.
draw() { /usr/bin/python3 "$root/experiments/figures/$1" "${@:2}"; }

failed=0
"$hagfish" compare table1 --out "$out/compare.h5" | tee "$out/compare.txt" || failed=$?
draw agreement.py "$out/compare.h5" "$out/agreement.png"
echo
"$hagfish" run table1 --qp ipopt --out "$out/table1.h5" --force
"$hagfish" playback "$out/table1.h5" --out "$out/playback.h5" | tee "$out/playback.txt"
draw playback.py "$out/playback.h5" "$out/playback.png"
echo
echo "In $out:"
ls "$out"
exit "$failed"
