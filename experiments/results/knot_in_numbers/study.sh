#!/usr/bin/env bash
# A knot's figures of other pages beside what is known of animals (rows/), and how fast animals of three sizes could tie. Leaves tables.
# Stopped, it goes on where it was.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/../common.sh"

for length in 25 42 60; do
  for knot in 3_1 4_1 5_1 5_2; do
    "$hagfish" specimen --length $length --knot $knot --out "$out/$length.toml" --scene-out "$out/${knot}_$length.toml" --force >/dev/null
  done
done
draw haste.py grid "$out"
"$hagfish" sweep "$out/haste.toml" --out "$out/haste"
draw haste.py table "$out"
draw knot_in_numbers.py "$out"
