# shellcheck shell=bash
# Sourced by the studies of what is no grid of `hagfish sweep`, not run: what common.sh does, and jobs side by side, which go on where they
# were stopped. Leaves runs (a folder) and cores besides.

source "$(dirname "${BASH_SOURCE[0]}")/common.sh"
cores=$(cores)
export runs=$out/runs
mkdir -p "$runs"

# timed NAME REPEATS ARGUMENT...: a command of hagfish that makes the log NAME.h5, and NAME.cpu: user and system time of each repeat, s. A
# run may fail, or tie another knot: that is a result.
timed() {
  local name=$1 repeats=$2 i code
  [[ -e $runs/$name.cpu ]] && return
  rm -f "$runs/$name.times"
  TIMEFORMAT='%U %S'
  for ((i = 0; i < repeats; ++i)); do
    code=0
    { time "$hagfish" "${@:3}" --out "$runs/$name.h5" --force --quiet 2>"$runs/$name.err"; } 2>>"$runs/$name.times" || code=$?
    if ((code == 2)) || grep -q 'failed: interrupted' "$runs/$name.err"; then
      cat "$runs/$name.err" >&2
      return 2
    fi
  done
  mv "$runs/$name.times" "$runs/$name.cpu"
  echo "$name"
}
export -f timed

# job WORD...: a command, quoted, as a line of what `work` runs.
job() { printf '%q ' "$@" && echo; }
# work TITLE: the jobs of standard input on all cores. One that fails ends the study.
work() {
  local list
  list=$(cat)
  echo "$1: $(wc -l <<<"$list") jobs, $cores at once"
  xargs -P "$cores" -d '\n' -I{} bash -c '{} || exit 255' <<<"$list"
}
