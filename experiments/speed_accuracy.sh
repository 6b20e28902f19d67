#!/usr/bin/env bash
# What accuracy costs: smooth motions, QPs, whole runs of the Table 1 scene and the choices of its
# model, each measured over step, size and method. Leaves CSV, figures and conclusions.md.
#   bash experiments/speed_accuracy.sh [OUTPUT_FOLDER]     default: out/speed_accuracy; some 13 minutes
# Stopped, it goes on where it was. Times are CPU times; jobs share the machine, presets do not.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
out=${1:-$root/out/speed_accuracy}
mkdir -p "$out"
out=$(cd "$out" && pwd)

bash "$root/experiments/setup.sh" --target hagfish
cores=$(nproc)
# Serial BLAS, so that runs repeat to the last bit.
export OPENBLAS_NUM_THREADS=1 OMP_NUM_THREADS=1
export hagfish=$root/build/release/experiments/hagfish runs=$out/runs

# Results of another program do not mix with this one's.
if [[ -d $runs && $(cat "$runs/version" 2>/dev/null) != "$("$hagfish" --version)" ]]; then
  echo "$runs was made by another version: starting anew"
  rm -r "$runs"
fi
mkdir -p "$runs"
"$hagfish" --version >"$runs/version"

# One job a line, fields by tabs: NAME REPEATS and the arguments of `hagfish run`. A job that is done
# has a NAME.cpu: user and system time of each repeat, s. A run may fail, or tie another
# knot: that is a result.
timed_run() {
  local name=$1 repeats=$2
  local -a arguments
  read -ra arguments <<<"$3"
  local log=$runs/$name.h5 i code
  [[ -e $runs/$name.cpu ]] && return
  TIMEFORMAT='%U %S'
  rm -f "$runs/$name.times"
  for ((i = 0; i < repeats; ++i)); do
    code=0
    { time "$hagfish" run "${arguments[@]}" --out "$log" --force --quiet 2>"$runs/$name.err"; } 2>>"$runs/$name.times" ||
      code=$?
    if ((code == 2)) || grep -q 'failed: interrupted' "$runs/$name.err"; then
      cat "$runs/$name.err" >&2
      return "$code"
    fi
  done
  "$hagfish" check "$log" >"$runs/$name.check" 2>&1 || (($? == 1))
  mv "$runs/$name.times" "$runs/$name.cpu"
}
integrate() {
  [[ -e $runs/$1.h5 ]] || "$hagfish" integrate --motion "$1" --out "$runs/$1.h5" >"$runs/$1.txt"
}
# One job, which says that it is done where no bar does.
job() {
  local -a fields
  IFS=$'\t' read -ra fields <<<"$1"
  "${fields[@]}"
  [[ -t 2 ]] || echo "$PARALLEL_SEQ of $jobs: ${fields[1]}"
}
# QPs of every tenth step of a run, solved by each back end down to each tolerance.
back_ends() {
  local set=$runs/$1.h5 tolerance
  local -a tolerances=()
  for tolerance in 1e-2 1e-4 1e-6 1e-8 1e-10; do tolerances+=(--tolerance "$tolerance"); done
  [[ -e $runs/$1.csv ]] && return
  "$hagfish" record-qp table1 --qp active-set --every 10 --out "$set" --force --quiet >"$runs/$1.txt"
  # A tolerance that a back end cannot reach fails, which the table counts.
  "$hagfish" qp "$set" "${tolerances[@]}" --csv "$runs/$1.csv.new" >>"$runs/$1.txt" 2>&1 || (($? == 1))
  mv "$runs/$1.csv.new" "$runs/$1.csv"
}
export -f timed_run integrate back_ends job

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

# Frames every 50 ms, a multiple of every step here.
frames="--set time.frame_interval=0.05"
whole_runs() {
  local bodies h activation
  for bodies in 100 50 200 70 35 140 25; do
    for h in 0.0005 0.001 0.002 0.005 0.01 0.025 0.05; do
      for activation in speculative violated; do
        local sets="$frames --set model.bodies=$bodies --set time.step=$h --set constraints.activation=$activation"
        printf 'timed_run\t%s\t1\t%s\n' "whole_${bodies}_${h}_${activation}_active-set" "table1 --qp active-set $sets"
        # Ipopt gives the same answers: two sizes show what it costs.
        if [[ $bodies == 50 || $bodies == 100 ]] && [[ $h != 0.0005 || $activation == speculative ]]; then
          printf 'timed_run\t%s\t1\t%s\n' "whole_${bodies}_${h}_${activation}_ipopt" "table1 --qp ipopt $sets"
        fi
        # The force script, fitted to 100 bodies, does not tie so few: waypoints do.
        if [[ $bodies == 25 ]]; then
          printf 'timed_run\t%s\t1\t%s\n' "whole_waypoints_${bodies}_${h}_${activation}_active-set" \
            "overhand_waypoints --qp active-set $sets"
        fi
      done
    done
  done
}

# One choice of the scene changed at a time; `as_is` is none.
needs() {
  local name sets key
  while read -r name sets; do
    local arguments="table1 $frames"
    for key in $sets; do arguments+=" --set $key"; done
    printf 'timed_run\t%s\t3\t%s\n' "need_$name" "$arguments"
  done <<'LIST'
as_is
bodies_25 model.bodies=25
bodies_50 model.bodies=50
bodies_200 model.bodies=200
violated constraints.activation=violated
margin_0.06 contact.margin=0.06
margin_0.3 contact.margin=0.3
least_arc_4.24 contact.least_arc=4.24
least_arc_2.12 contact.least_arc=2.12
no_stiffness model.bending_stiffness=0 model.twist_stiffness=0
no_drag drag.normal=0 drag.tangential=0
push_out_0.2 constraints.push_out=0.2
push_out_1 constraints.push_out=1
cap_1000 controller.cap=1000
no_cap controller.cap=1e9
no_hysteresis controller.hysteresis=0
votes_5 knot.votes=5
votes_45 knot.votes=45
no_wall wall.present=false
LIST
}

presets() {
  local preset
  for preset in quick default figure; do
    printf 'timed_run\t%s\t3\t%s\n' "preset_$preset" "table1 --preset $preset"
  done
}

whole_runs | work "$cores" "Whole runs"
needs | work "$cores" "Choices of the model"
{ printf 'back_ends\tqps\n'; printf 'integrate\t%s\n' coil hanging whip; } | work "$cores" "QPs and smooth motions"
presets | work 1 "Presets, alone on the machine"

# Debian's python3 is the one that has h5py and matplotlib.
draw() { /usr/bin/python3 "$root/experiments/figures/$1" "${@:2}"; }
echo "Drawing"
draw integration.py "$runs" "$out/integration.csv" "$out/integration.png"
draw back_ends.py "$runs" "$out/back_ends.csv" "$out/back_ends.png"
draw whole_runs.py "$runs" "$out/whole_runs.csv" "$out/whole_runs.png"
draw needs.py "$runs" "$out/needs.csv" "$out/needs.png"
draw conclusions.py "$runs" "$out/conclusions.md"
echo
cat "$out/conclusions.md"
echo
echo "In $out:"
ls "$out"
