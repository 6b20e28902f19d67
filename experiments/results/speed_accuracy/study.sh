#!/usr/bin/env bash
# What accuracy costs while an animal ties itself, by rule, step, bodies and back end; in smooth motions, beside MuJoCo; and what each
# choice of the Table 1 scene costs and buys. Slides are in contracting/. Leaves tables and two figures.
# Stopped, it goes on where it was. Times are CPU times; jobs share the machine.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/../jobs.sh"

integrate() {
  [[ -e $runs/$1.h5 ]] || "$hagfish" integrate --motion "$1" --out "$runs/$1.h5" --force >"$runs/$1.txt"
}
export -f integrate

# Two living animals, to the end of their programs: tying.py compares them from 5 s on. The smallest step is for
# the limit alone.
ties() {
  local knot bodies step rule
  local -A until=([overhand]=11.5 [figure_eight]=13)
  tie() { job timed "tie_$1_$2_$3_$4_$5" 3 run "living_$1" --qp "$2" --log frames --set "time.rule=$3" --set "model.bodies=$4" \
    --set "time.step=$5" --set "time.duration=${until[$1]}" --set time.frame_interval=0.1 --set 'expect.types=[]'; }
  for knot in overhand figure_eight; do
    for bodies in 400 200 100 50 25; do
      for step in 0.02 0.01 0.005 0.0025 0.00125; do
        for rule in euler midpoint; do tie $knot active-set $rule $bodies $step; done
      done
      tie $knot active-set euler $bodies 0.000625
      tie $knot ipopt euler $bodies 0.01
    done
  done
}

# One choice of the scene changed at a time; `as_is` is none.
choices() {
  local name sets
  draw choices.py list | while read -r name sets; do
    # shellcheck disable=SC2086 # words
    job timed "choice_$name" 7 run table1 --qp active-set --set time.frame_interval=0.05 ${sets:+--set ${sets// / --set }}
  done
}

ties | work "Knots that are tied"
choices | work "Choices of the scene"
for motion in coil hanging whip; do job integrate $motion; done | work "Smooth motions"

echo "Drawing"
draw tying.py "$runs" "$out"
draw integration.py "$runs" "$out"
draw choices.py table "$runs" "$out"
