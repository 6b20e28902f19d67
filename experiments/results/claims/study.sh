#!/usr/bin/env bash
# Where are the paper's three claims about the sliding force true? The overhand knot by both readings of the bending limit,
# over its scale, where the knot is let go, stiffness and drag, each from eight perturbed starts and at two steps. The
# force script of Table 1 is open loop and ties at its own stiffness and drag alone: for others waypoints lead the tail.
# Leaves claims.png and a table.
# Stopped, it goes on where it was.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/../jobs.sh"

# claim NAME SETTINGS: a row in a file of its own; the log is not kept. A run that fails, or ties no knot, is a row too.
claim() {
  local name=$1 log=$runs/$1.h5 code=0
  [[ -e $runs/$name.csv ]] && return
  local -a arguments
  read -ra arguments <<<"$2"
  "$hagfish" run "${arguments[@]}" --qp active-set --until slide --out "$log" --force --quiet 2>"$runs/$name.err" ||
    code=$?
  if ((code == 2)) || grep -q 'failed: interrupted' "$runs/$name.err"; then
    cat "$runs/$name.err" >&2
    return 2
  fi
  draw claim_row.py "$log" "$runs/$name.new.csv"
  rm -f "$log" "$runs/$name.err"
  mv "$runs/$name.new.csv" "$runs/$name.csv"
}
export -f claim

# What is changed, and how: SCENE NAME, then settings.
changes() {
  local scale at factor
  echo "table1 as-it-is"
  for scale in 0.7 0.75 0.8 0.85 0.9 1.2 1.4; do echo "table1 scale-$scale model.limit_scale=$scale"; done
  for at in 0.8 3.2; do echo "table1 release-$at controller.release_at=$at"; done
  echo "overhand_waypoints waypoints"
  for factor in 0.25 2; do
    echo "overhand_waypoints stiffness-$factor $(times "$factor" model.bending_stiffness 424 model.twist_stiffness 424)"
  done
  for factor in 0.75 2; do
    echo "overhand_waypoints drag-$factor $(times "$factor" drag.normal 9.434 drag.tangential 2.358)"
  done
}
# times FACTOR KEY VALUE ...: the settings KEY=FACTOR*VALUE.
times() {
  local factor=$1
  for ((shift = 2; shift < $#; shift += 2)); do
    local key=${!shift} next=$((shift + 1))
    printf '%s=%s ' "$key" "$(awk "BEGIN { print $factor * ${!next} }")"
  done
}
list() {
  local reading scene name sets key h seed
  for reading in box cone; do
    while read -r scene name sets; do
      for h in 0.005 0.002; do
        for seed in {1..8}; do
          local line="$scene --set model.bending_limit=$reading --set time.step=$h"
          line+=" --set start.noise_deg=0.1 --set start.seed=$seed"
          for key in $sets; do line+=" --set $key"; done
          printf 'claim\t%s\t%s\n' "${reading}_${name}_${h}_$seed" "$line"
        done
      done
    done < <(changes)
  done
}
list | work "$cores" "Claims"

draw claim_map.py "$runs" "$out"
