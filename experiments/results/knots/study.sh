#!/usr/bin/env bash
# Every knot the animal ties: overhand (3_1), figure-eight (4_1), double overhand (5_1) and three-twist (5_2), their mirror
# images, from noisy starts, with coarse and fine steps and from starts that differ by rounding. Leaves pictures and
# tables.
# Stopped, it goes on where it was.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/../jobs.sh"

scenes=(overhand_waypoints figure_eight double_overhand three_twist)
runs_of_all() {
  local scene seed noise h
  for scene in "${scenes[@]}"; do
    printf 'timed_run\t%s\t1\t%s\n' "plain_$scene" "$scene --qp active-set"
    printf 'timed_run\t%s\t1\t%s\n' "mirror_$scene" "$scene --qp active-set --set mirror=true"
    for h in 0.0005 0.001 0.005 0.01 0.02; do
      printf 'timed_run\t%s\t1\t%s\n' "step_${scene}_$h" "$scene --qp active-set --set time.step=$h"
    done
    for h in 0.002 0.001; do
      for seed in {1..8}; do
        printf 'timed_run\t%s\t1\t%s\n' "chance_${scene}_${h}_$seed" \
          "$scene --qp active-set --set time.step=$h $rounding --set start.seed=$seed"
      done
    done
    for noise in 0.2 0.5 1; do
      for seed in {1..10}; do
        printf 'timed_run\t%s\t1\t%s\n' "noise_${scene}_${noise}_$seed" \
          "$scene --qp active-set --set script.noise=$noise --set script.noise_seed=$seed"
      done
    done
  done
}
runs_of_all | work "$cores" "Four knots"

echo "Drawing"
draw knots.py "$runs" "$hagfish" "$out"
