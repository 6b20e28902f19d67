# shellcheck shell=bash
# Sourced by the studies that sweep, not run: what common.sh does, and runs jobs side by side, which go on where they were
# stopped. Comes after inputs=(...), files that results depend on besides the program, if any. Leaves runs (a folder), cores
# and rounding (settings) besides.

source "$(dirname "${BASH_SOURCE[0]}")/common.sh"
# shellcheck disable=SC2034 # for the studies
cores=$(env -u OMP_NUM_THREADS nproc) # which it would take for their number
export runs=$out/runs

# Offsets of every hinge at the start, drawn anew with each start.seed, that put the tail off by some 1e-6 cm: what such
# runs differ by is chance.
# shellcheck disable=SC2034
rounding="--set start.noise_deg=1e-6"

# Results of another program or of other inputs do not mix with this one's.
version=$("$hagfish" --version; [[ -z ${inputs-} ]] || cat "${inputs[@]}" | cksum)
if [[ -d $runs && $(cat "$runs/version" 2>/dev/null) != "$version" ]]; then
  echo "$runs was made by another version: starting anew"
  rm -r "$runs"
fi
mkdir -p "$runs"
echo "$version" >"$runs/version"

# One job a line, fields by tabs: NAME REPEATS and the arguments of `hagfish run`. A job that is done has a NAME.cpu: user
# and system time of each repeat, s. A run may fail, or tie another knot: that is a result.
timed() {
  local name=$1 repeats=$2
  local -a arguments
  read -ra arguments <<<"$3"
  local i code
  TIMEFORMAT='%U %S'
  rm -f "$runs/$name.times"
  for ((i = 0; i < repeats; ++i)); do
    code=0
    { time "$hagfish" run "${arguments[@]}" --out "$runs/$name.h5" --force --quiet 2>"$runs/$name.err"; } 2>>"$runs/$name.times" ||
      code=$?
    if ((code == 2)) || grep -q 'failed: interrupted' "$runs/$name.err"; then
      cat "$runs/$name.err" >&2
      return 2
    fi
  done
}
timed_run() {
  local name=$1 code=0
  [[ -e $runs/$name.cpu ]] && return
  timed "$@" || return
  # A log that fails its audit is a result, too.
  "$hagfish" check "$runs/$name.h5" --csv "$runs/$name.check.csv" --force >/dev/null 2>"$runs/$name.err" || code=$?
  if ((code > 1)); then
    cat "$runs/$name.err" >&2
    return "$code"
  fi
  mv "$runs/$name.times" "$runs/$name.cpu"
}
unchecked_run() {
  [[ -e $runs/$1.cpu ]] && return
  timed "$@" && mv "$runs/$1.times" "$runs/$1.cpu"
}
# One job, which says that it is done where no bar does.
job() {
  local -a fields
  IFS=$'\t' read -ra fields <<<"$1"
  "${fields[@]}" || return # parallel ends the study
  [[ -t 2 ]] || echo "$PARALLEL_SEQ of $jobs: ${fields[1]}"
}
export -f timed timed_run unchecked_run job

# work AT_ONCE TITLE: the jobs of standard input, `function TAB arguments`, so many at once.
work() {
  local list show=()
  list=$(cat)
  jobs=$(wc -l <<<"$list")
  export jobs
  echo "$2: $jobs jobs, $1 at once"
  if [[ -t 2 ]]; then show=(--bar); fi
  parallel --will-cite --halt soon,fail=1 -j "$1" "${show[@]}" job {} <<<"$list"
}
