#!/usr/bin/env bash
# The animal ties itself: the living scenes, 20 starts with noise on every hinge, ten other animals, what the body's stiffness,
# the water and the haste of the program do, and whether the paper's claims hold. Leaves living.png and tables.
# Stopped, it goes on where it was.
set -euo pipefail
inputs=("$(dirname "${BASH_SOURCE[0]}")"/{../../../data/programs/*.csv,../../../data/living_*.toml,../animals.py})
source "$(dirname "${BASH_SOURCE[0]}")/../jobs.sh"

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

# NAME of a run and the arguments of `hagfish run` but for the back end, which is active-set.
run_of() { printf 'timed_run\t%s\t1\t%s\n' "$1" "${*:2} --qp active-set"; }
runs_of_all() {
  local knot seed value animal line start
  for knot in overhand figure_eight double_overhand three_twist; do
    run_of "held_$knot" "living_$knot"
    run_of "free_$knot" "living_${knot}_free"
    for seed in {1..20}; do
      start="--set start.noise_deg=${noise[$knot]} --set start.seed=$seed"
      run_of "heldstart_${knot}_$seed" "living_$knot" "$start"
      run_of "freestart_${knot}_$seed" "living_${knot}_free" "$start"
    done
  done
  for knot in overhand figure_eight double_overhand three_twist; do
    animal=0
    while read -r line; do
      animal=$((animal + 1))
      run_of "animal_${knot}_$animal" "living_$knot" "$line"
    done <<<"$animals"
    for seed in {1..8}; do
      run_of "claims_${knot}_$seed" "living_$knot --set start.noise_deg=1 --set start.seed=$seed"
    done
  done
  local sweep="--set expect.types=[] --set time.duration=100"
  for knot in overhand figure_eight double_overhand three_twist; do
    for value in 4e2 4e3 3e4 2e5 4e5 1.2e6; do
      run_of "stiffness_${knot}_$value" "living_$knot $sweep" "$(stiffness $value)"
    done
    for value in 0.25 0.5 1 2 4; do
      run_of "drag_${knot}_$value" "living_$knot $sweep" "$(drag $value)"
      run_of "haste_${knot}_$value" "living_$knot $sweep" "$(program $knot $value)"
    done
  done
}
animals=$(/usr/bin/python3 "$root/experiments/results/animals.py" 10)
runs_of_all | work "$cores" "Living animals"

echo "Drawing"
draw living.py "$runs" "$out"
