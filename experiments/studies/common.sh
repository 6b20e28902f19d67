# shellcheck shell=bash
# Sourced by table1.sh and the studies, not run: sets up and builds, and makes the output folder, the script's argument or
# out/ with the script's name. Comes after targets=(...), what to build besides the program, if anything. Leaves root, grids,
# out, hagfish (the program) and stiffness (settings). When the script ends, in whatever way, it says how long it took; building
# counts, and what an earlier run of it left does not. Grids of `hagfish sweep` are in $grids.
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
# shellcheck disable=SC2034 # for the studies
grids=$root/experiments/studies/grids
out=${1:-$root/out/$(basename "$0" .sh)}
elapsed() {
  echo
  echo "$(basename "$0") took $((SECONDS / 60)) min $((SECONDS % 60)) s on $(env -u OMP_NUM_THREADS nproc) cores"
}
trap elapsed EXIT
mkdir -p "$out"
out=$(cd "$out" && pwd)
# shellcheck disable=SC2154 # targets may be unset
bash "$root/experiments/setup.sh" --target hagfish "${targets[@]}"
# Serial BLAS, so that runs repeat to the last bit.
export OPENBLAS_NUM_THREADS=1 OMP_NUM_THREADS=1
export hagfish=$root/build/release/experiments/hagfish

# Flexural rigidity $1 (dyn cm^2), and with it what the specimen file has in proportion to it.
stiffness() {
  awk -v b="$1" 'BEGIN {
    split("bending_stiffness 1 bending_damping 0.015 twist_stiffness 0.65 twist_damping 0.01", f, " ")
    for (i = 1; i < 8; i += 2)
      printf "--set specimen.passive.%s=[%g,%g,%g,%g] ", f[i], b * f[i + 1], b * f[i + 1], b * f[i + 1], b * f[i + 1]
  }'
}

# draw SCRIPT.py ARGUMENT...: Debian's python3 is the one that has h5py and matplotlib.
draw() { /usr/bin/python3 "$root/experiments/figures/$1" "${@:2}"; }

# Closes a script: what lies in the output folder, for `finish PAGE` after a page of results.
list_output() {
  echo
  echo "In $out:"
  ls "$out"
}
finish() {
  echo
  cat "$1"
  list_output
}
