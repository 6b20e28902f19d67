#!/usr/bin/env bash
# What each departure from the paper changes: table1 with one thing as the paper has it, or may have it, and table1_as_printed with one
# thing as table1 has it. Leaves two tables.
# Stopped, it goes on where it was.
set -euo pipefail
targets=(hagfish_python)
source "$(dirname "${BASH_SOURCE[0]}")/../common.sh"

draw departures.py scenes "$out"
"$hagfish" sweep "$out/grid.toml" --out "$out/sweep"

# What no setting does: alone WAY SCENE COMMAND... makes a log.
alone() {
  local folder=$out/$1 scene=$2
  [[ -e $folder/$scene/summary.csv ]] && return
  mkdir -p "$folder"
  { time "${@:3}" 2>"$folder/$scene.err"; } 2>"$folder/$scene.cpu"
  "$hagfish" export "$folder/$scene.h5" --out "$folder/$scene" --force
}
TIMEFORMAT="%U %S"
for scene in table1 table1_as_printed; do
  alone ipopt "$scene" "$hagfish" run "$scene" --qp ipopt --out "$out/ipopt/$scene.h5" --force --quiet
  alone explicit "$scene" draw explicit_springs.py "$scene" "$out/explicit/$scene.h5"
done
draw departures.py tables "$out"
