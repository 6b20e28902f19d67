#!/usr/bin/env bash
# How sure the figures of the Table 1 scene and of living scenes are: their spread over chance, steps, bodies, starts, girth, limits and stiffness.
# Leaves a folder of `hagfish sure` a scene, sure.png (of living_overhand) and two tables.
# Stopped, it goes on where it was.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/../common.sh"

for scene in table1 {living,reflex}_{overhand,figure_eight,double_overhand,three_twist}; do
  "$hagfish" sure "$scene" --out "$out/$scene" --quiet
done
cp "$out/living_overhand/sure.png" "$out/sure.png"
draw sure_page.py "$out"
