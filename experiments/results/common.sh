# shellcheck shell=bash
# Sourced by a page's study.sh, not run: sets up and builds, and makes the output folder, the script's argument or out/NAME:
#   bash experiments/results/NAME/study.sh [OUTPUT_FOLDER]
# Comes after targets=(...), what to build besides the program, inputs=(...), files that results depend on besides it, and
# keeps=yes where what another program left is not to go, if any of these. Leaves root, page (its folder), grids (of `hagfish
# sweep`), out, hagfish (the program), draw and swept. When the script ends, in whatever way, it says what is in out
# and how long it took; building counts, and what an earlier run of it left does not.
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
source "$root/experiments/cores.sh"
page=$(cd "$(dirname "$0")" && pwd)
# shellcheck disable=SC2034 # for the studies
grids=$page/grids
out=${1:-$root/out/$(basename "$page")}
elapsed() {
  printf '\nIn %s:\n' "$out"
  ls "$out"
  echo "$(basename "$page") took $((SECONDS / 60)) min $((SECONDS % 60)) s on $(cores) cores"
}
mkdir -p "$out"
out=$(cd "$out" && pwd)
trap elapsed EXIT
# shellcheck disable=SC2154 # targets may be unset
bash "$root/experiments/setup.sh" --target hagfish "${targets[@]}"
# What another program or other inputs left does not mix with this one's.
made_by=$("$root/build/release/experiments/hagfish" --version; [[ -z ${inputs-} ]] || cat "${inputs[@]}" | cksum)
if [[ -z ${keeps-} && -e $out/made_by && $(<"$out/made_by") != "$made_by" ]]; then
  echo "$out was made by another version: starting anew"
  find "$out" -mindepth 1 -maxdepth 1 ! -name study.txt -exec rm -r {} +
fi
echo "$made_by" >"$out/made_by"
# Serial BLAS, so that runs repeat to the last bit.
export OPENBLAS_NUM_THREADS=1 OMP_NUM_THREADS=1
export hagfish=$root/build/release/experiments/hagfish HAGFISH_PROGRAM=$root/build/release/experiments/hagfish # for shell, for Python

# draw SCRIPT.py ARGUMENT...: the page's own, or one that pages share. Debian's python3 is the one that has h5py and matplotlib.
export PYTHONPATH=$page:$root/experiments/drawing:$root/experiments/results:$root/build/release/experiments/python
draw() { /usr/bin/python3 -BPm "${1%.py}" "${@:2}"; }

# swept GRID.toml FOLDER PARTS MODULE.FUNCTION: a part of the grid after the other, and of each log what the function makes of it
# (taken.py), so that only the logs of a part are there at once.
swept() {
  for ((part = 1; part <= $3; ++part)); do
    "$hagfish" sweep "$1" --out "$2" --part "$part/$3"
    draw taken.py "$4" "$2/logs"
  done
}

# once NAME ARGUMENT...: a run whose log is kept in out/runs, made once. One that fails is a result, too.
once() {
  [[ -e $out/runs/$1.done ]] && return
  mkdir -p "$out/runs"
  "$hagfish" run "${@:2}" --out "$out/runs/$1.h5" --force --quiet || (($? == 1))
  touch "$out/runs/$1.done"
}

# swept_animals: the page's grid animals.toml with ten animals drawn at random, into out/animals.
swept_animals() {
  { cat "$grids/animals.toml" && /usr/bin/python3 "$root/experiments/results/animals.py" 10; } >"$out/animals.toml"
  "$hagfish" sweep "$out/animals.toml" --out "$out/animals"
}
