#!/usr/bin/env bash
# What accuracy costs where a motion forgets its start: a living overhand knot that slides by reflex, here and in MuJoCo, and by
# Eq. 6, over steps, rules and bodies. Leaves contracting.png and tables.
# Stopped, it goes on where it was. One run at a time, since CPU times are measured.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/../jobs.sh"

run() { timed "$1" 1 "${@:2}" --set time.frame_interval=0.1 --set 'expect.types=[]'; }

# Up to 0.1 s after the last frame that counts (contracting.py). MuJoCo's model has no head plate.
declare -A scene=([reflex]="reflex_overhand --set wall.present=false --set time.duration=16.9" [paper]="living_overhand --set time.duration=15.9")
here() { # LAW RULE BODIES STEP
  local -a of
  read -ra of <<<"${scene[$1]}"
  run "$1_here_$2_$3_$4" run "${of[@]}" --set time.rule="$2" --set model.bodies="$3" --set time.step="$4"
}
mujoco() { # RULE BODIES STEP [CONTACT_TIME]
  local -a of
  read -ra of <<<"${scene[reflex]}"
  run "reflex_mujoco-${4:-0.005}_$1_$2_$3" mujoco-run "${of[@]}" --integrator "$1" --contact-time "${4:-0.005}" --set model.bodies="$2" --step "$3"
}

for law in reflex paper; do
  for bodies in 50 100 200 400; do
    [[ "$law $bodies" == "paper 50" ]] && continue # too coarse for Eq. 6: its slide differs from step to step
    for step in 0.02 0.01 0.005 0.002 0.001; do
      here $law euler $bodies $step
      here $law midpoint $bodies $step
    done
    here $law euler $bodies 0.0005
  done
  here $law midpoint 100 0.0005
  here $law euler 100 0.00025
done
for step in 0.01 0.005 0.002 0.001; do mujoco euler 100 $step; done
for step in 0.01 0.005; do mujoco implicit 100 $step; done
for step in 0.01 0.005 0.002; do mujoco euler 50 $step; done
mujoco euler 200 0.005
mujoco euler 100 0.001 0.002

# The slide alone, without water, from one tied knot: here, in MuJoCo, and in today's MuJoCo where npm is here.
[[ -e $out/tied.toml ]] || /usr/bin/python3 "$root/experiments/results/tied_knot.py" "$hagfish" "$out/tied.toml"
dry=("$out/tied.toml" --set drag.normal=0 --set drag.tangential=0 --set time.duration=3.8)
for step in 0.005 0.002 0.001; do
  run dry_here_euler_100_$step run "${dry[@]}" --set time.step=$step
  run dry_here_midpoint_100_$step run "${dry[@]}" --set time.rule=midpoint --set time.step=$step
  run dry_mujoco-0.005_euler_100_$step mujoco-run "${dry[@]}" --step $step
done
if command -v npm >/dev/null; then
  library=$out/node_modules/@mujoco/mujoco/mujoco.js
  [[ -e $library ]] || npm install --silent --no-audit --no-fund --prefix "$out" @mujoco/mujoco@3.14.0
  [[ -d $out/mjcf ]] || "$hagfish" mjcf "$out/tied.toml" --clamp --out "$out/mjcf"
  for rule in Euler implicitfast discrete; do
    for step in 0.005 0.002 0.001; do
      [[ -e $runs/dry_today_${rule}_100_$step.json ]] ||
        node "$page/contracting_mujoco.mjs" "$library" "$out/mjcf" "$out/tied.toml" $rule $step "$runs/dry_today_${rule}_100_$step.json"
    done
  done
fi

echo "Drawing"
draw contracting.py "$runs" "$out"
