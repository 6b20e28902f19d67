#!/usr/bin/env bash
# Muscles: what the living scenes take of them while tying, sliding and pulling, in softer and stiffer bodies too, and the knots tied
# and slid by activations alone, also from noisy starts and with quicker and slower muscles. Leaves muscles.md, muscles_stiffness.png
# and, of the overhand knot, muscles.png.
# Logs that are there already are not made again.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/../common.sh"

# NAME of a run and the arguments of `hagfish run`. Runs that do not tie are a result: exit code 3.
run_of() {
  [[ -e $out/$1.h5 ]] || "$hagfish" run "${@:2}" --out "$out/$1.h5" --quiet || [[ $? == 3 ]]
  [[ $1 == ei_* ]] || "$hagfish" check "$out/$1.h5" --csv "$out/$1.check.csv" --force >/dev/null || [[ $? == 1 ]]
}
# A body of the rigidity EI = $1 and muscles without a bound. They follow their program as those of the living scenes do, so they are stiffer in a
# body that is stiffer than these, and no softer in a softer one.
rigid() { awk -v b="$1" 'BEGIN { printf "--set active.stiffness=%g --set active.capacity=1e9 ", (b > 2e5 ? 2.5 * b : 5e5) }' && stiffness "$1"; }

with="--set muscle.present=true"
moved="$with --set controller.law=muscles --set muscle.activation_time=0.1 --set expect.speed_share=0"
# shellcheck disable=SC2046,SC2086 # lists of options
{
  for knot in overhand figure_eight double_overhand three_twist; do
    run_of "tie_$knot" "living_$knot" $with
    run_of "pull_$knot" "pull_living_$knot" $with
    run_of "forward_$knot" "living_$knot" $moved
    for value in 4e4 1e5 3e5 4e5 6e5 8e5; do
      run_of "ei_${knot}_$value" "living_$knot" $with --set 'expect.types=[]' --log frames $(rigid $value)
    done
  done
  for seed in {1..8}; do
    run_of "start_$seed" muscles_forward --set start.noise_deg=3 --set "start.seed=$seed"
  done
  for time in 0.01 0.03 0.2 0.3; do run_of "lag_$time" muscles_forward --set "muscle.activation_time=$time"; done
}
draw muscle_study.py "$out"
draw muscles.py "$out/tie_overhand.h5" "$out/muscles.png"
