#!/usr/bin/env bash
# What a knot is for: the pull at the food of every knot, in the Table 1 body and in the living one, against what the rows of
# Eq. 6 may give, speed, stiffness, girth, muscles, time step and number of bodies. Leaves tables, leverage.png and
# leverage_why.png.
# Stopped, it goes on where it was.
set -euo pipefail
inputs=("$(dirname "${BASH_SOURCE[0]}")"/../../../data/pull_*.toml)
source "$(dirname "${BASH_SOURCE[0]}")/../jobs.sh"

# $1 times the largest force of a row that the scene $2 has, dyn.
cap() {
  awk -v c="$1" '/^cap = / { match($0, /from = [0-9.]+/); b = substr($0, RSTART + 7, RLENGTH - 7)
    printf "--set food.cap.from=%g --set food.cap.to=%g", c * b, c * b }' "$root/data/$2.toml"
}
# Commanded speed $1 of all rows while sliding and pulling, cm/s.
speed() {
  local end row
  for end in head tail; do for row in a b; do printf -- '--set controller.slide_%s.%s=%s ' "$end" "$row" "$1"; done; done
}
# $1 times the girth, at the same density.
girth() {
  awk -v c="$1" 'BEGIN {
    printf "--set specimen.mass=%g --set specimen.circumference=[%g,%g,%g,%g]", 80 * c * c, 5.6 * c, 5.5 * c, 5.6 * c, 4.3 * c
  }'
}

# sweep KIND VALUE STARTS BODIES SETTING...: of every knot in each of the bodies, named KIND-BODY-KNOT-VALUE-START. A start of
# the Table 1 body is off by rounding; a living animal forgets its start, so that of its starts more is asked. Start 0 is exact.
sweep() {
  local kind=$1 value=$2 starts=$3 bodies=$4 body knot scene noise seed start
  for body in $bodies; do
    for knot in overhand figure_eight double_overhand three_twist; do
      scene=pull_$knot noise=1e-6
      if [[ $body == living ]]; then scene=pull_living_$knot noise=1; fi
      for seed in $starts; do
        start="--set start.noise_deg=$noise --set start.seed=$seed"
        if [[ $seed == 0 ]]; then start=""; fi
        if [[ $kind == cap ]]; then start+=" $(cap "$value" "$scene")"; fi
        printf 'timed_run\t%s\t1\t%s\n' "$kind-$body-$knot-$value-$seed" \
          "$scene --qp active-set --set expect.types=[] --set time.duration=80 --set time.step=0.005 \
--set time.frame_interval=0.1 $start ${*:5}"
      done
    done
  done
}
runs_of_all() {
  local value
  sweep start 0 "1 2 3 4 5 6 7 8" "table1 living"
  sweep plain 0 0 "table1 living" --set time.frame_interval=0.02
  sweep mirror 0 0 "table1 living" --set time.frame_interval=0.02 --set mirror=true
  for value in 0.25 0.5 2 4 10; do sweep cap $value 1 "table1 living"; done
  for value in 3e4 4e5; do sweep stiffness $value 1 living "$(stiffness $value)"; done
  for value in 0.8 1.2; do sweep girth $value 1 "table1 living" "$(girth $value)"; done
  for value in 0.002 0.01; do sweep step $value 1 "table1 living" --set time.step=$value; done
  for value in 0.5 2; do sweep speed $value 1 "table1 living" "$(speed $value)"; done
  for value in 60 150; do sweep bodies $value 1 "table1 living" --set model.bodies=$value; done
  for value in 1.35e5 5.4e5; do sweep capacity $value 1 living --set active.capacity=$value; done
}
runs_of_all | work "$cores" "Leverage"

echo "Drawing"
draw leverage.py "$runs" "$out"
draw leverage_why.py "$runs" "$out/leverage_why.png"
