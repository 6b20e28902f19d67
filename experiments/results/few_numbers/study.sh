#!/usr/bin/env bash
# How few numbers slide a knot, in which frame, how often found (grids/numbers.toml), twenty starts of each
# (grids/starts.toml), a free head (grids/free.toml), ten other animals (grids/animals.toml and
# animals.py), what they take against f_thigmo, and, for each knot, numbers played by its place and shapes learned from f_thigmo, at
# other steps and bodies and mirrored too. Leaves tables and few_numbers.png.
# Stopped, it goes on where it was; logs that are there already are not made again.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/../common.sh"

for grid in numbers starts free; do "$hagfish" sweep "$grids/$grid.toml" --out "$out/$grid"; done
swept_animals

# NAME of a run and the arguments of `hagfish run`, to the end of the slide. A knot that is lost is a result: exit code 3.
runs=$out/runs
mkdir -p "$runs"
run_of() {
  [[ -e $runs/$1.h5 ]] || "$hagfish" run "${@:2}" --until slide --out "$runs/$1.h5" --quiet || [[ $? == 3 ]]
}
# The same in other circumstances: an animal of fewer bodies, shorter steps, the mirror image, another start.
transfers_of() {
  run_of "$1" "${@:2}"
  run_of "$1_bodies" "${@:2}" --set model.bodies=60
  run_of "$1_step" "${@:2}" --set time.step=0.002
  run_of "$1_mirror" "${@:2}" --set mirror=true
  run_of "$1_start" "${@:2}" --set start.noise_deg=3 --set start.seed=2
}
numbers=(--set controller.law=reduced_basis --set expect.speed_share=0)
for setting in frame=knot margin=2 smooth=0.1 period=0.1 softness=0.03 most=1e5; do numbers+=(--set "controller.reduced_basis.$setting"); done
declare -A enough=([overhand]=3 [figure_eight]=3 [double_overhand]=6 [three_twist]=3) # cosines
declare -A modes=([overhand]=2 [figure_eight]=6 [double_overhand]=6 [three_twist]=6) # learned
for knot in overhand figure_eight double_overhand three_twist; do
  run_of "paper_$knot" "living_$knot"
  for cosines in 1 2 3 4 6; do
    run_of "numbers_${knot}_$((3 * cosines))" "living_$knot" "${numbers[@]}" --set "controller.reduced_basis.cosines=$cosines"
  done
  draw played_numbers.py "$runs/numbers_${knot}_$((3 * ${enough[$knot]})).h5" "$runs/played_$knot.toml" 8 "living_$knot"
  transfers_of "played_$knot" "$runs/played_$knot.toml" "${numbers[@]}" --set "controller.reduced_basis.cosines=${enough[$knot]}"
  draw sliding_shapes.py "$runs/paper_$knot.h5" "$runs/shapes_$knot.csv" "${modes[$knot]}"
  transfers_of "learned_$knot" "living_$knot" "${numbers[@]}" --set "controller.reduced_basis.file=$runs/shapes_$knot.csv"
done
draw few_numbers.py "$out"
