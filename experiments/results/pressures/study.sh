#!/usr/bin/env bash
# What contacts of a knot press with: four living knots, hard and with flesh. Leaves tables/pressures.csv and pressures.png.
# Stopped, it goes on where it was.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/../common.sh"

mkdir -p "$out/runs"
for knot in overhand figure_eight double_overhand three_twist; do
  for stiffness in 0 6e4 1e5 3e5; do
    run=$out/runs/${knot}_$stiffness
    [[ -e $run.done ]] && continue
    flesh=()
    [[ $stiffness == 0 ]] || flesh=(--set "flesh.stiffness=$stiffness" --set flesh.relaxation=0.015 --set flesh.spacing=0.424)
    "$hagfish" run "living_$knot" --out "$run.h5" --qp active-set --force --quiet "${flesh[@]}" || (($? == 1)) # a result, too
    touch "$run.done"
  done
done
draw pressures.py "$out"
