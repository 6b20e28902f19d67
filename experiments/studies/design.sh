#!/usr/bin/env bash
# `hagfish design` from nothing for the Table 1 animal, by three seeds, and 4_1 for ten random animals: how long each knot takes on two
# cores, how sure the found programs are, the audit of their runs at steps of 1, 2 and 5 ms, and which of ten animals that the search
# never saw they serve. Leaves experiments/results/design.csv and design.md, made of it.
#   bash experiments/studies/design.sh [OUTPUT_FOLDER]     default: out/design
# KNOTS, SEEDS, ANIMALS (numbers of random ones) and ROBUST (knots whose programs must serve other animals, by seed 1) in the environment
# are others. Stopped, it goes on where it was.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

# search FOLDER ARGUMENT...: `hagfish design`, and runs of what it found at three steps.
search() {
  local folder=$out/$1 resume=() step log
  if [[ ! -e $folder/result.csv ]]; then
    [[ -e $folder/search.toml ]] && resume=(--resume)
    "$hagfish" design "${@:2}" --out "$folder" --budget 15m --threads 2 "${resume[@]}" || (($? == 3))
  fi
  [[ -e $folder/scene.toml ]] || return 0
  for step in 0.001 0.002 0.005; do
    log=$folder/step_$step.h5
    [[ -e $log ]] || "$hagfish" run "$folder/scene.toml" --quiet --set time.step=$step --out "$log" || true
    [[ ! -e $log ]] || "$hagfish" check "$log" --csv "$folder/step_$step.csv" --force >/dev/null || true
  done
}

# unseen FOLDER: what was found there, in ten animals that no search saw.
unseen() {
  local folder=$out/$1 law
  [[ -e $folder/scene.toml ]] || return 0
  for law in paper reflex; do
    {
      echo 'scene = "scene.toml"'
      [[ $law == paper ]] ||
        echo 'set = ["controller.law=reflex", "controller.tighten_time=0.04", "controller.reflex.shift=2.5e-4 L", "expect.speed_share=0.0"]'
      /usr/bin/python3 "$root/experiments/studies/animals.py" 10 axis
    } >"$folder/unseen_$law.toml"
    "$hagfish" sweep "$folder/unseen_$law.toml" --out "$folder/unseen_$law" --quiet
  done
}

for knot in ${KNOTS-3_1 4_1 5_1 5_2}; do
  for seed in ${SEEDS-1 2 3}; do
    search "$knot-$seed" "$knot" --seed "$seed"
    unseen "$knot-$seed"
  done
done
for knot in ${ROBUST-3_1 4_1 5_1 5_2}; do
  search "$knot-1-animals" "$knot" --animals
  unseen "$knot-1-animals"
done
for animal in ${ANIMALS-1 2 3 4 5 6 7 8 9 10}; do
  /usr/bin/python3 "$root/experiments/studies/animals.py" specimen "$animal" >"$out/animal_$animal.toml"
  search "4_1-animal-$animal" 4_1 --specimen "$out/animal_$animal.toml"
done
draw design.py "$out" "$root/experiments/results/design.csv" "$root/experiments/results/design.md"
finish "$root/experiments/results/design.md"
