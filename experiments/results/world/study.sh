#!/usr/bin/env bash
# A world to knot in: the head pulled out of a hole by knots and by waves without a knot, the skin that knots sweep,
# and a snake robot on a floor. Leaves tables/world.csv, world_waves.csv, world_map.csv, world_chance.csv, world_skin.csv,
# world_pole.csv, world_robot.csv, world.png, world_map.png and world_skin.png.
# Stopped, it goes on where it was. What it needs of a log is taken at once, and the log removed: it takes less than 0.5 GB.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/../common.sh"

# A part has at most eight runs.
swept "$grids/holes.toml" "$out/holes" 6 world_logs.hole
swept "$grids/hole_map.toml" "$out/hole_map" 12 world_logs.pull
swept "$grids/hole_chance.toml" "$out/hole_chance" 6 world_logs.pull
swept "$grids/skin.toml" "$out/skin" 4 world_logs.skin
swept "$grids/robot.toml" "$out/robot" 2 world_logs.robot

# Holes of other widths, cm: an array of tables is no axis of a grid.
scenes=()
for width in 2 3 4 5 6 7; do
  for knot in overhand figure_eight three_twist; do
    draw world_plate.py "$width" "$root/data/hole_$knot.toml" "$out/hole_${knot}_$width.toml"
    sed "s/^base = .*/base = \"hole_${knot}_$width.toml\"/" "$root/data/reflex_hole_$knot.toml" >"$out/reflex_hole_${knot}_$width.toml"
    scenes+=("\"hole_${knot}_$width.toml\"" "\"reflex_hole_${knot}_$width.toml\"")
  done
done
{
  grep "^keep\|^set" "$grids/hole_map.toml"
  echo "[[axis]]"
  echo "\"start.seed\" = [1, 2, 3]"
  echo "[[axis]]"
  echo "scene = [$(IFS=,; echo "${scenes[*]}")]"
} >"$out/hole_widths.toml"
swept "$out/hole_widths.toml" "$out/hole_widths" 14 world_logs.pull

# Without a knot: a wave of `angle` (rad) and `length` (body lengths) runs to the head once in `period` (s), from eight phases.
mkdir -p "$out/waves"
for wave in "0.5 1 2" "0.5 1 1" "0.5 1 0.5" "1 1 2" "1 1 1" "0.5 0.6 1" "0.5 0.6 0.5" "0.5 0.6 0.25"; do
  for eighth in 0 0.125 0.25 0.375 0.5 0.625 0.75 0.875; do
    name=$out/waves/${wave// /_}_$eighth
    [[ -e $name.json ]] && continue
    # shellcheck disable=SC2086 # three numbers
    draw world_wave.py $wave $eighth "$name.csv" "$name.toml"
    "$hagfish" run "$name.toml" --out "$name.h5" --force --quiet
    draw taken.py world_logs.wave "$out/waves"
  done
done

draw world.py "$out"
draw world_map.py "$out/tables/world_map.csv" "$out/world_map.png"
draw world_skin.py "$out/skin/logs" "$out/world_skin.png"

# Round a pole: the slide goes on from a frame of the run, with weights along the pole and across it.
mkdir -p "$out/pole" "$out/strip"
"$hagfish" run reflex_pole --out "$out/pole/run.h5" --force --quiet
draw world_pole.py "$out"
for scene in reflex_hole_overhand hole_overhand reflex_burrow robot_overhand; do
  "$hagfish" run "$scene" --out "$out/strip/$scene.h5" --force --quiet
done
draw world_strip.py "$out"/strip/{reflex_hole_overhand,hole_overhand,reflex_burrow}.h5 "$out/pole/run.h5" "$out/strip/robot_overhand.h5" "$out/world.png"
