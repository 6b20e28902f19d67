#!/usr/bin/env bash
# The reflex (core/control/reflex.hpp): the four knots at two meshes and steps beside the paper's law, what it needs, its law of speed, where
# it fails, pulls at food, and the same in MuJoCo. Leaves tables, reflex.png and reflex_strip.png.
# Stopped, it goes on where it was; logs of MuJoCo and tables of laws in Python that are there already are not made again. Rows of the table
# whose part of the study the output folder has not stay as they are.
set -euo pipefail
targets=(hagfish_python)
source "$(dirname "${BASH_SOURCE[0]}")/../common.sh"

for grid in knots meshes paper knockouts speed delay noise bodies step drag muscle damping stiffness paper_soft starts free free_programs pull \
  pull_shift beside; do
  "$hagfish" sweep "$grids/$grid.toml" --out "$out/$grid"
done
swept_animals

for made in laws.csv rate.csv curves loose.csv; do
  [[ -e $out/$made ]] || { draw reflex_laws.py "${made%.csv}" "$out/$made.part" && mv "$out/$made.part" "$out/$made"; }
done

# in_mujoco NAME ARGUMENT...
mkdir -p "$out/mujoco"
in_mujoco() {
  [[ -e $out/mujoco/$1.h5 ]] || "$hagfish" mujoco-run "${@:2}" --step 0.002 --set time.until=slide --set 'expect.types=[]' --out "$out/mujoco/$1.h5"
}
cell=0 # of the sweep "beside": each scene with drag, then without
for scene in reflex_{overhand,figure_eight,double_overhand,three_twist}{,_free}; do
  in_mujoco "$scene" "$scene"
done
for scene in reflex_{overhand,figure_eight,double_overhand,three_twist} reflex_{overhand,figure_eight,double_overhand,three_twist}_free; do
  in_mujoco "$scene-from_the_slide" --from "$out/beside/logs/$cell.h5"
  in_mujoco "$scene-no_drag" --from "$out/beside/logs/$((cell + 1)).h5"
  cell=$((cell + 2))
done
fine=no_drag,_200_bodies
for scene in reflex_double_overhand{,_free}; do
  log=$out/beside/$scene-$fine.h5
  [[ -e $log ]] || "$hagfish" run "$scene" --set model.bodies=200 --set time.step=0.002 --set wall.present=false --set drag.normal=0 \
    --set drag.tangential=0 --set time.until=slide --set 'expect.types=[]' --out "$log"
  in_mujoco "$scene-$fine" --from "$log"
done
draw reflex.py "$out" "$page/reflex.csv"
