#!/usr/bin/env bash
# The animal ties itself: the living scenes, 20 starts with noise on every hinge, ten other animals, what the body's stiffness,
# the water and the haste of the program do, and whether the paper's claims hold. Leaves living.png and tables.
# Stopped, it goes on where it was.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/../common.sh"

# Programs at other times their speed, and when each ends, s.
mkdir -p "$out/programs"
declare -A end=([overhand]=11.8 [figure_eight]=13.5 [double_overhand]=17 [three_twist]=17)
scenes=() hastes=() programs=() ends=()
for knot in overhand figure_eight double_overhand three_twist; do
  for haste in 0.25 0.5 1 2 4; do
    program=$out/programs/${knot}_$haste.csv
    awk -F, -v OFS=, -v v=$haste 'NR > 1 { $1 /= v } 1' "$root/data/programs/$knot.csv" >"$program"
    scenes+=("\"living_$knot\"") hastes+=("\"$haste\"") programs+=("\"$program\"") ends+=("$(awk "BEGIN { print ${end[$knot]} / $haste }")")
  done
done
joined() { (IFS=, && echo "[$*]"); }
cat >"$out/haste.toml" <<TOML
keep = "all"
set = ["expect.types=[]", "time.duration=100"]
[[axis]]
scene = $(joined "${scenes[@]}")
title = $(joined "${hastes[@]}")
"script.program" = $(joined "${programs[@]}")
"controller.tighten_from" = $(joined "${ends[@]}")
TOML

for grid in "$grids"/{held,free,heldstart,freestart,claims,stiffness,drag}.toml "$out/haste.toml"; do
  "$hagfish" sweep "$grid" --out "$out/$(basename "$grid" .toml)"
done
swept_animals
draw living.py "$out"
