#!/usr/bin/env bash
# Through a slit narrower than the body: pulled, by a knot behind it, and by a wave; the wave in open water. Leaves tables/slit.csv,
# slit_meshes.csv, slit_knot.csv, slit_wave.csv, slit_swim.csv and slit.png. Stopped, it goes on where it was.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/../common.sh"

mkdir -p "$out/scenes"
for share in 0.9 0.8 0.7 0.6 0.5; do
  draw slit_scene.py "$share" slit "$out/scenes/pulled_$share.toml"
  draw slit_scene.py "$share" hole_overhand "$out/scenes/knot_$share.toml"
  for stiffness in 6e4 1e5 3e5; do
    once "pulled_${stiffness}_$share" "$out/scenes/pulled_$share.toml" --qp active-set --set "flesh.stiffness=$stiffness"
  done
  once "knot_1e5_$share" "$out/scenes/knot_$share.toml" --qp active-set
done
draw slit_scene.py 1.2 hole_overhand "$out/scenes/knot_1.2.toml"
once knot_1e5_1.2 "$out/scenes/knot_1.2.toml" --qp active-set
for share in 0.9 0.7 0.5; do
  once "bodies_200_$share" "$out/scenes/pulled_$share.toml" --qp active-set --set model.bodies=200
  once "step_5_$share" "$out/scenes/pulled_$share.toml" --qp active-set --set time.step=0.005
done
for wave in "0.5 1 1" "0.7 0.6 0.5"; do
  for share in 1.2 0.9 0.8 0.7; do
    name=wave_${wave// /_}_$share
    # shellcheck disable=SC2086 # three numbers
    draw slit_wave.py $wave "$share" "$out/scenes/$name.csv" "$out/scenes/$name.toml"
    once "$name" "$out/scenes/$name.toml" --qp active-set
  done
done
"$hagfish" specimen --length 31.5 --out "$out/scenes/small.toml" --scene-out "$out/scenes/swimmer.toml" --force
for wave in "0.7 0.6 0.5" "0.7 0.6 0.333"; do
  name=swim_${wave// /_}
  # shellcheck disable=SC2086 # three numbers
  draw slit_wave.py $wave "$out/scenes/swimmer.toml" "$out/scenes/$name.csv" "$out/scenes/$name.toml"
  once "$name" "$out/scenes/$name.toml" --qp active-set
done
draw slit.py "$out"
