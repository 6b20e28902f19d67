#!/usr/bin/env bash
# How few numbers slide a knot, in which frame, how often found (grids/numbers.toml), twenty starts of each (grids/starts.toml), other
# meshes and steps (grids/meshes.toml), a free head (grids/free.toml), ten other animals (grids/animals.toml), what they take against
# f_thigmo (grids/effort.toml), and, for each knot, numbers played by its place and shapes learned from f_thigmo.
# Leaves tables and few_numbers.png.
# Stopped, it goes on where it was; logs that are there already are not made again.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/../common.sh"

for grid in numbers starts meshes free effort; do "$hagfish" sweep "$grids/$grid.toml" --out "$out/$grid"; done
swept_animals

# numbers_of KNOT FRAME COSINES: its scene, a run of it, its numbers played by the knot's place, and shapes that f_thigmo has.
numbers_of() {
  cat >"$out/numbers_$1.toml" <<END
base = "living_$1"

[controller]
law = "reduced_basis"
reduced_basis = { frame = "$2", margin = 1.0, smooth = 0.1, cosines = $3, period = 0.1, softness = 0.01, most = 1e5 }

[expect]
speed_share = 0.0
END
  once "numbers_$1" "$out/numbers_$1.toml" --until slide
  draw played_numbers.py "$out/runs/numbers_$1.h5" "$out/played_$1.toml" 8 "numbers_$1.toml"
  once "eq6_$1" "living_$1" --until slide
  draw sliding_shapes.py "$out/runs/eq6_$1.h5" "$out/shapes_$1.csv" 6
  cat >"$out/learned_$1.toml" <<END
base = "numbers_$1.toml"

[controller.reduced_basis]
cosines = 0
frame = "knot"
margin = 2.0
file = "shapes_$1.csv"
END
}
numbers_of overhand knot 3
for knot in figure_eight double_overhand three_twist; do numbers_of "$knot" body 12; done
cat >"$out/transfers.toml" <<'END'
set = ["time.until=slide", "expect.types=[]"]

[[axis]]
scene = ["played_overhand.toml", "played_figure_eight.toml", "played_double_overhand.toml", "played_three_twist.toml",
  "learned_overhand.toml", "learned_figure_eight.toml", "learned_double_overhand.toml", "learned_three_twist.toml"]

# As found, and in other circumstances.
[[axis]]
"start.noise_deg" = [0.0, 3.0, 0.0, 0.0, 0.0]
"time.step" = [0.005, 0.005, 0.002, 0.005, 0.005]
"model.bodies" = [100, 100, 100, 60, 100]
mirror = [false, false, false, false, true]
END
"$hagfish" sweep "$out/transfers.toml" --out "$out/transfers"
draw few_numbers.py "$out"
