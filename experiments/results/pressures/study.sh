#!/usr/bin/env bash
# What contacts of a knot press with: four living knots, hard and with flesh. Leaves tables/pressures.csv and pressures.png.
# Stopped, it goes on where it was.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/../common.sh"

for knot in overhand figure_eight double_overhand three_twist; do
  for stiffness in 0 6e4 1e5 3e5; do
    flesh=()
    [[ $stiffness == 0 ]] || flesh=(--set "flesh.stiffness=$stiffness" --set flesh.relaxation=0.015 --set flesh.spacing=0.424)
    once "${knot}_$stiffness" "living_$knot" --qp active-set "${flesh[@]}"
  done
done
draw pressures.py "$out"
