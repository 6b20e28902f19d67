#!/usr/bin/env bash
# What accuracy costs: smooth motions, QPs, whole runs of the Table 1 scene and the choices of its
# model, each measured over step, size and method. Leaves CSV, figures and conclusions.md.
#   bash experiments/studies/speed_accuracy.sh [OUTPUT_FOLDER]     default: out/speed_accuracy
# Stopped, it goes on where it was. Times are CPU times; jobs share the machine.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/study.sh"

integrate() {
  [[ -e $runs/$1.h5 ]] || "$hagfish" integrate --motion "$1" --out "$runs/$1.h5" --force >"$runs/$1.txt"
}
# QPs of every tenth step of a run, solved by each back end down to each tolerance.
back_ends() {
  local set=$runs/$1.h5 tolerance
  local -a tolerances=()
  for tolerance in 1e-2 1e-4 1e-6 1e-8 1e-10; do tolerances+=(--tolerance "$tolerance"); done
  [[ -e $runs/$1.csv ]] && return
  "$hagfish" record-qp table1 --qp active-set --set time.step=0.002 --every 10 --out "$set" --force --quiet >"$runs/$1.txt"
  # A tolerance that a back end cannot reach fails, which the table counts.
  "$hagfish" qp "$set" "${tolerances[@]}" --csv "$runs/$1.csv.new" --force >>"$runs/$1.txt" 2>&1 || (($? == 1))
  mv "$runs/$1.csv.new" "$runs/$1.csv"
}
export -f integrate back_ends

# Frames every 50 ms, a multiple of every step here.
frames="--set time.frame_interval=0.05"
whole_runs() {
  local bodies h activation
  for bodies in 100 50 200 70 35 140 25; do
    for h in 0.0005 0.001 0.002 0.005 0.01 0.025 0.05; do
      # The midpoint rule, which needs no watch.
      printf 'timed_run\t%s\t1\t%s\n' "whole_${bodies}_${h}_midpoint_active-set" "table1 --qp active-set $frames \
--set model.bodies=$bodies --set time.step=$h --set time.rule=midpoint"
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

# The reference of the whole runs and the default, each from starts that differ by rounding.
chance() {
  local h seed
  for h in 0.0005 0.002; do
    for seed in {1..8}; do
      printf 'timed_run\t%s\t1\t%s\n' "chance_${h}_$seed" \
        "table1 --qp active-set $frames --set time.step=$h $rounding --set start.seed=$seed"
    done
  done
}

# One choice of the scene changed at a time; `as_is` is none.
needs() {
  local name sets key
  while read -r name sets; do
    local line="table1 --qp active-set $frames"
    for key in $sets; do line+=" --set $key"; done
    printf 'timed_run\t%s\t3\t%s\n' "need_$name" "$line"
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
baumgarte_0.2 constraints.baumgarte=0.2
baumgarte_1 constraints.baumgarte=1
no_corrections constraints.corrections=0
cap_1000 controller.cap=1000
no_cap controller.cap=1e9
votes_5 knot.votes=5
votes_45 knot.votes=45
no_wall wall.present=false
LIST
}

whole_runs | work "$cores" "Whole runs"
chance | work "$cores" "Chance"
needs | work "$cores" "Choices of the model"
{ printf 'back_ends\tqps\n'; printf 'integrate\t%s\n' coil hanging whip; } | work "$cores" "QPs and smooth motions"

echo "Drawing"
draw integration.py "$runs" "$out/integration.csv" "$out/integration.png"
draw back_ends.py "$runs" "$out/back_ends.csv" "$out/back_ends.png"
draw whole_runs.py "$runs" "$out/tables/speed_accuracy_runs.csv" "$out/speed_accuracy.png"
draw needs.py "$runs" "$out/needs.csv" "$out/needs.png"
draw conclusions.py "$runs" "$out/conclusions.md"
finish "$out/conclusions.md"
