#!/usr/bin/env bash
# A world to knot in: the head pulled out of a hole by knots and by waves without a knot, the skin that knots sweep,
# and a snake robot on a floor. Leaves tables/world.csv, world_waves.csv, world_map.csv, world_chance.csv, world_skin.csv,
# world_pole.csv, world_robot.csv, world.png, world_map.png and world_skin.png.
# Stopped, it goes on where it was. It takes less than 0.5 GB.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/../common.sh"

# A part has at most eight runs.
swept "$grids/holes.toml" "$out/holes" 6 world_logs.hole
swept "$grids/hole_map.toml" "$out/hole_map" 12 world_logs.pull
swept "$grids/hole_chance.toml" "$out/hole_chance" 6 world_logs.pull
swept "$grids/skin.toml" "$out/skin" 4 world_logs.skin
swept "$grids/robot.toml" "$out/robot" 2 world_logs.robot

# Holes of other widths, since an array of tables is no axis of a grid; and waves without a knot, from eight phases.
draw world_scenes.py "$out" "$grids"
swept "$out/widths/grid.toml" "$out/hole_widths" 14 world_logs.pull
swept "$out/waves/grid.toml" "$out/wave_runs" 8 world_logs.wave

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
