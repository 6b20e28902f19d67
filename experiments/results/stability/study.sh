#!/usr/bin/env bash
# The failure map: stress scenes (experiments/results/stability/scenes/*.toml, and the Table 1 run) over time steps, methods and
# levels of stress. Leaves stability.csv, a heat map per scene, and stability.png: the largest step that
# each method survives; and how far the reflex goes.
# Stopped, it goes on where it was. `hagfish stress` judges a cell (experiments/mujoco/stress_judge.hpp).
set -euo pipefail
scenes=$(cd "$(dirname "${BASH_SOURCE[0]}")/scenes" && pwd)
export scenes
inputs=("$scenes"/*.toml)
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
    --step "$(awk "BEGIN { print $h / 1000 }")" --out "$file.new" "${arguments[@]}" 2>"$file.err" || code=$?
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

steps="0.2 0.5 1 2 5 10 20 50" # ms
coarse="1 2 5 10 20 50"        # where a step is slow
few="1 5 20"                   # of level sweeps
mujoco="mujoco_euler mujoco_hard mujoco_implicit mujoco_rk4"
rows="default no_watch midpoint violated baumgarte_0.2 baumgarte_1"

# line SCENE LEVEL STEPS METHODS [SETTINGS]
line() {
  local h method
  for h in $3; do
    for method in $4; do printf 'cell\t%s\t%s\t%s\t%s\t%s\n' "$1" "$2" "$method" "$h" "${5:-}"; done
  done
}
pull() { echo "script.knots=[[0,$1,0,0],[1,$1,0,0]]"; }
whip() {
  local twist sideways
  twist=$(awk "BEGIN { print 0.2 * $1 }") sideways=$(awk "BEGIN { print 0.5 * $1 }")
  echo "start.bend_rate=[[0,$twist,$1,$sideways],[0.2,$twist,$1,$sideways],[0.2001,0,0,0]]"
}
close_in() { echo "start.bend_rate=[[0.54,0,0,0],[0.5401,0,$1,0],[0.62,0,$1,0],[0.6201,0,0,0]]"; }

list() {
  local scene level
  # Whole grids.
  for scene in whip spinning stiff_joints stiff_tip mass_ratio; do
    line $scene "as is" "$steps" "default no_watch midpoint $mujoco"
  done
  for scene in coil tight_limits redundant pulled_knot closing overlap tight_bend; do
    line $scene "as is" "$steps" "$rows $mujoco"
    line $scene "as is" "$coarse" ipopt
  done
  line short_bodies "as is" "$steps" "$rows"
  line short_bodies "as is" "$coarse" "ipopt mujoco_euler mujoco_hard mujoco_implicit"
  line contradictory "as is" "$steps" "$rows"
  line contradictory "as is" "$coarse" ipopt
  line knot_into_head "as is" "$steps" "$rows hard_thigmotaxis"
  line knot_into_head "as is" "$coarse" ipopt
  line parallel "as is" "$steps" "$rows hard_thigmotaxis"
  line parallel "as is" "$coarse" ipopt
  line table1 "as is" "$steps" "$rows hard_thigmotaxis"
  line table1 "as is" "$coarse" ipopt
  # Levels of stress, that of the scene itself among them.
  for level in 0.03 0.1 0.3 1; do line whip "$level rad/(cm s)" "0.2 $few" "default mujoco_euler mujoco_rk4" "$(whip "$level")"; done
  for level in 1 3 10; do line spinning "$level rad/s" "0.2 $few" "default mujoco_euler mujoco_rk4" "start.spin=[$level,0,0]"; done
  for level in 1e-4 1e-2 1 1e2 1e3 1e4; do line mass_ratio "$level" "$few" "default mujoco_euler" "model.mass_ratio=$level"; done
  for level in 1e2 1e3 1e4 1e5 1e6; do
    line stiff_joints "$level dyn cm/rad" "$few" "default mujoco_euler" \
      "model.bending_stiffness=$(awk "BEGIN { print 1.696 * $level }") model.twist_stiffness=$(awk "BEGIN { print 1.696 * $level }")"
  done
  for level in 3e3 3e4 3e5 3e6 3e7; do line stiff_tip "$level dyn/cm" "$few" "default mujoco_euler" "script.spring=$level"; done
  for level in 500 1000 5000 10000 20000 50000 100000; do
    line pulled_knot "$level dyn" "$few" "default violated mujoco_euler" "$(pull $level)"
  done
  for level in 0.3 0.6 1; do line tight_limits "scale $level" "$few" "default mujoco_euler" "model.limit_scale=$level"; done
  for level in 0.3 0.5 0.7 0.85 1; do line table1 "limit scale $level" "$few" default "model.limit_scale=$level"; done
  line closing "10 cm/s" "$few" "default mujoco_euler" "$(close_in 1.475)"
  line closing "100 cm/s" "$few" "default mujoco_euler" "$(close_in 14.75)"
  line closing "1000 cm/s" "$few" "default mujoco_euler" "$(close_in 147.5)"
  line closing "10000 cm/s" "$few" "default mujoco_euler" "$(close_in 1475)"
  line short_bodies "100 bodies" "$few" "default mujoco_euler" model.bodies=100
  line short_bodies "200 bodies" "$few" "default mujoco_euler"
  line short_bodies "400 bodies" "$steps" default model.bodies=400
  # Perturbed starts of the whole run.
  for level in {1..20}; do
    line table1 "seed $level" "1 2 5 10 20" default "start.noise_deg=0.3 start.seed=$level"
  done
}

# Large steps first: they are quick and show the most.
list | sort -t$'\t' -k5,5gr | work "$cores" cells

{
  head -qn 1 "$runs"/whip_as-is_default_1.csv
  tail -qn 1 "$runs"/*.csv
} >"$out/stability.csv"
draw stability.py "$out/stability.csv" "$out"
draw reflex_limits.py "$hagfish" "$out"
