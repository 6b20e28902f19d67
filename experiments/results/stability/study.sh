#!/usr/bin/env bash
# The failure map: stress scenes (scenes/*.toml, and the Table 1 run) over time steps, methods and levels of stress
# (cells.toml). Leaves stability.csv, a heat map per scene, and stability.png: the largest step that each method
# survives; and how far the reflex goes.
# Stopped, it goes on where it was. `hagfish stress` judges a cell (experiments/mujoco/stress_judge.hpp).
set -euo pipefail
scenes=$(cd "$(dirname "${BASH_SOURCE[0]}")/scenes" && pwd)
export scenes
inputs=("$scenes"/*.toml "$scenes/../cells.toml")
source "$(dirname "${BASH_SOURCE[0]}")/../jobs.sh"
export cpu_limit=60 wall_limit=300 # s, of a cell

# cell SCENE LEVEL METHOD H_MS SETTINGS: one row in a file of its own. SETTINGS are KEY=VALUE, by blanks. A cell that
# hangs or crashes is a row, too.
cell() {
  local scene=$1 level=$2 method=$3 h=$4
  local file=$runs/${scene}_${level//[^a-z0-9.]/-}_${method}_$h.csv
  [[ -e $file ]] && return
  local -a settings=() arguments=()
  read -ra settings <<<"${5:-}"
  local setting code=0
  for setting in "${settings[@]}"; do arguments+=(--set "$setting"); done
  local name=$scene
  [[ -e $scenes/$scene.toml ]] && name=$scenes/$scene.toml
  timeout -k 5 "$wall_limit" "$hagfish" stress "$name" --method "$method" --level "$level" --cpu-limit "$cpu_limit" \
    --step "$(awk "BEGIN { print $h / 1000 }")" --out "$file.new" --force "${arguments[@]}" 2>"$file.err" || code=$?
  if ((code == 2)); then
    cat "$file.err" >&2
    return 2
  elif ((code == 124 || code == 137)); then
    printf 'scene\n%s,%s,%s,%s,capped,,,,,,,,no answer in %s s\n' "$scene" "$level" "$method" "$h" "$wall_limit" >"$file.new"
  elif ((code)); then
    printf 'scene\n%s,%s,%s,%s,crashed,,,,,,,,exit code %s\n' "$scene" "$level" "$method" "$h" "$code" >"$file.new"
  fi
  rm -f "$file.err"
  mv "$file.new" "$file"
}
export -f cell

draw stability.py jobs | work Cells

{
  head -qn 1 "$runs"/whip_as-is_default_1.csv
  tail -qn 1 "$runs"/*.csv
} >"$out/stability.csv"
draw stability.py page "$out/stability.csv" "$out"
draw reflex_limits.py "$hagfish" "$out"
