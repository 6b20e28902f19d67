#!/usr/bin/env bash
# `hagfish design` from nothing: small knots for the Table 1 animal, by three seeds; larger ones for one that is 1.5 times as slender;
# 4_1 for ten random animals. How long each takes on two cores, how sure the found programs are, the audit of their runs at steps of 1, 2
# and 5 ms, and which of ten animals that the search never saw they serve. Leaves tables and design.png.
# In the environment KNOTS, SEEDS, LARGE, LARGE_SEEDS, ANIMALS (numbers of random ones), ROBUST and ROBUST_LARGE (knots whose programs must serve
# other animals) are others, and BEYOND are large knots that the Table 1 animal tries. Stopped, it goes on where it was.
set -euo pipefail
keeps=yes # each search names its own program
source "$(dirname "${BASH_SOURCE[0]}")/../common.sh"
animals=$root/experiments/results/animals.py

# search FOLDER ARGUMENT...: `hagfish design` for a quarter of an hour at most, and runs of what it found at three steps.
search() {
  local folder=$out/$1 resume=() step log
  if [[ ! -e $folder/ended ]]; then
    [[ -e $folder/search.toml ]] && resume=(--resume)
    "$hagfish" design "${@:2}" --out "$folder" --budget 15m --threads 2 "${resume[@]}" || (($? == 3))
    touch "$folder/ended"
  fi
  [[ -e $folder/scene.toml ]] || return 0
  for step in 0.001 0.002 0.005; do
    log=$folder/step_$step.h5
    [[ -e $log ]] || "$hagfish" run "$folder/scene.toml" --quiet --set time.step=$step --out "$log" || true
    [[ ! -e $log ]] || "$hagfish" check "$log" --csv "$folder/step_$step.csv" --force >/dev/null || true
  done
}

# unseen FOLDER [slender]: what was found there, in ten animals that no search saw.
unseen() {
  local folder=$out/$1 law
  [[ -e $folder/scene.toml ]] || return 0
  for law in eq6 reflex; do
    {
      echo 'scene = "scene.toml"'
      [[ $law == eq6 ]] ||
        echo 'set = ["controller.law=reflex", "controller.reflex.shift=2.5e-4 L"]'
      /usr/bin/python3 "$animals" 10 "${@:2}"
    } >"$folder/unseen_$law.toml"
    "$hagfish" sweep "$folder/unseen_$law.toml" --out "$folder/unseen_$law" --quiet
  done
}

slender=$out/slender.toml
/usr/bin/python3 "$animals" specimen slender >"$slender"
for knot in ${KNOTS-3_1 4_1 5_1 5_2}; do
  for seed in ${SEEDS-1 2 3}; do
    search "$knot-$seed" "$knot" --seed "$seed"
    unseen "$knot-$seed"
  done
done
for knot in ${LARGE-6_1 6_2 6_3 7_1 3_1#3_1 3_1#-3_1}; do
  for seed in ${LARGE_SEEDS-1 2}; do
    search "$knot-$seed-slender" "$knot" --specimen "$slender" --seed "$seed"
    unseen "$knot-$seed-slender" slender
  done
done
for knot in ${ROBUST-3_1 4_1 5_1 5_2}; do
  search "$knot-1-animals" "$knot" --seed 1 --animals
  unseen "$knot-1-animals"
done
for knot in ${ROBUST_LARGE-6_1 3_1#3_1 3_1#-3_1}; do
  search "$knot-1-slender-animals" "$knot" --specimen "$slender" --seed 1 --animals
  unseen "$knot-1-slender-animals" slender
done
for knot in ${BEYOND-6_1}; do search "$knot-1-beyond" "$knot"; done
for animal in ${ANIMALS-1 2 3 4 5 6 7 8 9 10}; do
  /usr/bin/python3 "$animals" specimen "$animal" >"$out/animal_$animal.toml"
  search "4_1-animal-$animal" 4_1 --specimen "$out/animal_$animal.toml"
done
draw design.py "$out" "$page/design.csv"
