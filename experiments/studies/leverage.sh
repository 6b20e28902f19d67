#!/usr/bin/env bash
# What a knot is for: the pull at the food of every knot, in the Table 1 body and in the living one, against what the rows of
# Eq. 6 may give, speed, stiffness, girth, muscles, time step and number of bodies. Leaves leverage.png, leverage_why.png,
# leverage.csv and leverage.md.
#   bash experiments/studies/leverage.sh [OUTPUT_FOLDER]     default: out/leverage
# Stopped, it goes on where it was.
set -euo pipefail
inputs=("$(dirname "${BASH_SOURCE[0]}")"/../../data/pull_*.toml)
source "$(dirname "${BASH_SOURCE[0]}")/study.sh"

# Largest force $1 of a row, dyn.
cap() { printf -- '--set food.cap.from=%s --set food.cap.to=%s' "$1" "$1"; }
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

# Name KIND-BODY-KNOT-VALUE-SEED and what differs.
runs_of_all() {
  local body knot scene seed value noise start
  for body in table1 living; do
    for knot in overhand figure_eight double_overhand three_twist; do
      scene=pull_$knot noise=1e-6
      if [[ $body == living ]]; then scene=pull_living_$knot noise=1; fi
      run() {
        local kind=$1 value=$2 seeds=$3
        for ((seed = 1; seed <= seeds; ++seed)); do
          start="--set start.noise_deg=$noise --set start.seed=$seed"
          printf 'timed_run\t%s\t1\t%s\n' "$kind-$body-$knot-$value-$seed" \
            "$scene --qp active-set --set expect.types=[] --set time.duration=80 --set time.step=0.005 $start ${*:4}"
        done
      }
      run start 0 8
      printf 'timed_run\t%s\t1\t%s\n' "mirror-$body-$knot-0-1" "$scene --qp active-set --set time.step=0.005 --set mirror=true"
      printf 'timed_run\t%s\t1\t%s\n' "plain-$body-$knot-0-1" "$scene --qp active-set --set time.step=0.005"
      for value in 1e3 2e3 5e3 1e4 2e4 3e4 5e4 1e5 1e9; do run cap $value 2 "$(cap $value)"; done
      for value in 0.5 1 2 4; do run speed $value 2 "$(speed $value)"; done
      for value in 0.8 0.9 1.1 1.2; do run girth $value 2 "$(girth $value)"; done
      for value in 0.001 0.002 0.01; do run step $value 2 --set time.step=$value; done
      for value in 60 150 200; do run bodies $value 2 --set model.bodies=$value; done
      if [[ $body == living ]]; then
        for value in 4e2 4e3 3e4 2e5 4e5 1.2e6; do run stiffness $value 2 "$(stiffness $value)"; done
        for value in 6.75e4 1.35e5 2.7e5 5.4e5 1.08e6; do run capacity $value 2 --set active.capacity=$value; done
      fi
    done
  done
}
runs_of_all | work "$cores" "Leverage"

echo "Drawing"
draw leverage.py "$runs" "$out/leverage.csv" "$out/leverage.png" "$out/leverage.md"
draw leverage_why.py "$runs" "$out/leverage_why.png"
finish "$out/leverage.md"
