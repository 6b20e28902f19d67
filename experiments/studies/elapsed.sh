# Sourced, not run: when the script ends, in whatever way, it says how long it took; building counts, and what an earlier run
# of it left does not.
elapsed() {
  echo
  echo "$(basename "$0") took $((SECONDS / 60)) min $((SECONDS % 60)) s on $(env -u OMP_NUM_THREADS nproc) cores"
}
trap elapsed EXIT
