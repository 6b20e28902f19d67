# shellcheck shell=bash
# Sourced, not run: cores prints how many cores this shell may use: those of its affinity, and no more than the CPU quota of its container.
cores() {
  local all quota period
  all=$(env -u OMP_NUM_THREADS nproc) # which would take that for their number
  if read -r quota period 2>/dev/null <"${1:-/sys/fs/cgroup/cpu.max}" && [[ $quota != max ]]; then
    quota=$(((quota + period - 1) / period))
    ((quota < all)) && all=$quota
  fi
  echo "$all"
}
