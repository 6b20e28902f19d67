#!/usr/bin/env bash
# The animal ties itself: the living scenes, 20 starts with noise on every hinge, and what the body's stiffness, the water and
# the haste of the program do. Leaves living.png, living.csv and living.md.
#   bash experiments/studies/living.sh [OUTPUT_FOLDER]     default: out/living
# Stopped, it goes on where it was.
set -euo pipefail
inputs=("$(dirname "${BASH_SOURCE[0]}")"/../../data/programs/*.csv)
source "$(dirname "${BASH_SOURCE[0]}")/study.sh"

declare -A noise=([overhand]=5 [figure_eight]=3 [double_overhand]=3 [three_twist]=3) # degrees
declare -A end=([overhand]=11.8 [figure_eight]=13.5 [double_overhand]=17 [three_twist]=17) # of the program, s

# The water's drag, times $1.
drag() { awk -v d="$1" 'BEGIN { printf "--set drag.normal=%g --set drag.tangential=%g", 9.434 * d, 2.358 * d }'; }
# The program of $1 at $2 times its speed.
program() {
  mkdir -p "$out/programs"
  awk -F, -v OFS=, -v v="$2" 'NR > 1 { $1 /= v } 1' "$root/data/programs/$1.csv" >"$out/programs/$1_$2.csv"
  awk -v e="${end[$1]}" -v v="$2" -v f="$out/programs/$1_$2.csv" \
    'BEGIN { printf "--set script.program=%s --set controller.tighten_from=%g", f, e / v }'
}

runs_of_all() {
  local knot seed value sweep="--qp active-set --set expect.types=[] --set time.duration=60"
  for knot in overhand figure_eight double_overhand three_twist; do
    printf 'timed_run\t%s\t1\t%s\n' "held_$knot" "living_$knot --qp active-set"
    printf 'timed_run\t%s\t1\t%s\n' "free_$knot" "living_${knot}_free --qp active-set"
    printf 'timed_run\t%s\t1\t%s\n' "ipopt_$knot" "living_$knot --qp ipopt"
    printf 'timed_run\t%s\t1\t%s\n' "fine_$knot" "living_$knot --qp active-set --set time.step=0.002"
    for seed in {1..20}; do
      value="--qp active-set --set start.noise_deg=${noise[$knot]} --set start.seed=$seed"
      printf 'timed_run\t%s\t1\t%s\n' "heldstart_${knot}_$seed" "living_$knot $value"
      printf 'timed_run\t%s\t1\t%s\n' "freestart_${knot}_$seed" "living_${knot}_free $value"
    done
    for value in 4e2 4e3 3e4 2e5 1.2e6; do
      printf 'timed_run\t%s\t1\t%s\n' "stiffness_${knot}_$value" "living_$knot $sweep $(stiffness $value)"
    done
    for value in 0.25 0.5 1 2 4; do
      printf 'timed_run\t%s\t1\t%s\n' "drag_${knot}_$value" "living_$knot $sweep $(drag $value)"
      printf 'timed_run\t%s\t1\t%s\n' "haste_${knot}_$value" "living_$knot $sweep $(program $knot $value)"
    done
  done
}
runs_of_all | work "$cores" "Living animals"

echo "Drawing"
draw living.py "$runs" "$out/living.csv" "$out/living.png" "$out/living.md"
finish "$out/living.md"
