#!/usr/bin/env bash
# `hagfish design` from nothing for the Table 1 animal, by three seeds: how long each knot takes on two cores, how sure the found programs
# are, and the audit of their runs at steps of 1, 2 and 5 ms. Leaves experiments/results/design.csv and design.md, made of it.
#   bash experiments/studies/design.sh [OUTPUT_FOLDER]     default: out/design
# KNOTS and SEEDS in the environment are others. Stopped, it goes on where it was.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

for knot in ${KNOTS:-3_1 4_1 5_1 5_2}; do
  for seed in ${SEEDS:-1 2 3}; do
    folder=$out/$knot-$seed
    if [[ ! -e $folder/result.csv ]]; then
      resume=()
      [[ -e $folder/search.toml ]] && resume=(--resume)
      "$hagfish" design "$knot" --seed "$seed" --out "$folder" --budget 15m --threads 2 "${resume[@]}" || (($? == 3))
    fi
    [[ -e $folder/scene.toml ]] || continue
    for step in 0.001 0.002 0.005; do
      log=$folder/step_$step.h5
      [[ -e $log ]] || "$hagfish" run "$folder/scene.toml" --quiet --set time.step=$step --out "$log" || true
      [[ ! -e $log ]] || "$hagfish" check "$log" --csv "$folder/step_$step.csv" --force >/dev/null || true
    done
  done
done
draw design.py "$out" "$root/experiments/results/design.csv" "$root/experiments/results/design.md"
finish "$root/experiments/results/design.md"
