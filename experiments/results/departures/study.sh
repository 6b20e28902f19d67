#!/usr/bin/env bash
# What each departure from the paper changes: table1 with one thing as the paper has it, or may have it, and table1_as_printed with one
# thing as table1 has it. Leaves two tables.
# Stopped, it goes on where it was.
set -euo pipefail
targets=(hagfish_python)
source "$(dirname "${BASH_SOURCE[0]}")/../common.sh"

rm -rf "$out/scenes"
mkdir -p "$out/scenes"
# change SCENE WORDS LINE...: one more scene file, with these lines besides.
number=100
change() {
  number=$((number + 1))
  printf '%s\n' "base = \"$1\"" "title = \"$2\"" "${@:3}" >"$out/scenes/$number.toml"
}
# both WORDS LINE...
both() {
  change table1 "$@"
  change table1_as_printed "$@"
}
waypoints=$(sed -n '/^\[script\]/,/^\]/p' "$root/data/overhand_waypoints.toml")
near=("contact.margin = 0.1" "controller.contact_gap = 0.05")

both "nothing changed"
for seed in {1..8}; do both "0.1° of noise at the start, eight times" "start.noise_deg = 0.1" "start.seed = $seed"; done
change table1 "rows that act once violated" 'constraints.activation = "violated"'
change table1_as_printed "rows that act before a gap is closed" 'constraints.activation = "speculative"' "contact.margin = 0.1"
change table1 "steps that are not solved again" "constraints.corrections = 0"
change table1_as_printed "rows that act before, and steps that are solved again" 'constraints.activation = "speculative"' "contact.margin = 0.1" \
  "constraints.corrections = 8"
both "violations that are not taken back" "constraints.baumgarte = 0"
change table1 "Eq. 6 at a point" "controller.contact_patch = 0"
change table1_as_printed "Eq. 6 over a patch" "controller.contact_patch = 0.2" "${near[@]}"
change table1 "touching from no gap on, and Eq. 6 at a point" "controller.contact_gap = 0" "controller.contact_patch = 0"
change table1_as_printed "touching from 0.05 cm on" "${near[@]}"
change table1 "no cap" "controller.cap = 1e9"
change table1_as_printed "a cap of 5000 dyn" "controller.cap = 5000"
change table1 "momentum as the rule makes it" 'time.momentum = "rule"'
change table1_as_printed "momentum kept" 'time.momentum = "kept"'
change table1 "an energy guard that warns" 'guard.energy_action = "warn"'
change table1_as_printed "an energy guard that acts" 'guard.energy_action = "hold"'
change table1 "no twist stiffness" "model.twist_stiffness = 0"
change table1_as_printed "twist stiffness" "model.twist_stiffness = 424"
both "no stiffness" "model.bending_stiffness = 0" "model.twist_stiffness = 0"
both "no drag" "drag.normal = 0" "drag.tangential = 0"
both "equal drag along and across" "drag.normal = 4" "drag.tangential = 4"
change table1 "tightening once the tail is through" "controller.tighten_from = 0"
change table1_as_printed "tightening from 9.5 s on" "controller.tighten_from = 9.5"
both "tightening once the knot is there" "controller.tighten_from = 0" "controller.tail_through = 0"
both "sliding at once where it is tight" "controller.tight_hold = 0"
both "waypoints for the tail" "$waypoints"
both "waypoints for the tail, no drag" "drag.normal = 0" "drag.tangential = 0" "$waypoints"
both "waypoints for the tail, no drag, a step of 2 ms" "time.step = 0.002" "drag.normal = 0" "drag.tangential = 0" "$waypoints"
change living_overhand "an animal that ties itself (living_overhand), no drag" "drag.normal = 0" "drag.tangential = 0"
both "a bending limit on the total angle of a joint" 'model.bending_limit = "cone"'
both "limits on the sum over a fifth of the body" "model.limit_scale = 0.1"
both "Eq. 6 for the slip of a knot that keeps its shape" 'controller.eq6_slip = "shape"'
both "Eq. 6 at the skin" 'controller.eq6_at = "skin"'
both "Eq. 6 at all contacts" 'controller.law = "all_contacts"'
both "a step of 2 ms" "time.step = 0.002"
both "a step of 1 ms" "time.step = 0.001"

{
  printf '[[axis]]\nscene = [\n'
  for scene in "$out"/scenes/*; do printf '  "scenes/%s",\n' "$(basename "$scene")"; done
  echo "]"
} >"$out/grid.toml"
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
  alone explicit "$scene" /usr/bin/python3 "$page/explicit_springs.py" \
    "$scene" "$out/explicit/$scene.h5"
done
draw departures.py "$out"
