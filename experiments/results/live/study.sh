#!/usr/bin/env bash
# The simulator in WebAssembly: how fast Table 1 runs in node, and what a step costs beside one of today's MuJoCo in the same engine; whether
# both have the same model.
# Builds the page, and gets MuJoCo from npm, which this study alone needs.
set -euo pipefail
targets=(--target mechanics)
source "$(dirname "${BASH_SOURCE[0]}")/../common.sh"

HAGFISH_WEB=1 bash "$root/experiments/setup.sh"
wasm=$root/build/web/hagfish.wasm
command -v npm >/dev/null || { echo "live: npm is not here: install Debian's package npm" >&2; exit 2; }
npm install --silent --no-audit --no-fund --prefix "$out" @mujoco/mujoco@3.14.0
mkdir -p "$out/tables"
"$hagfish" mjcf table1 --out "$out/mjcf" --force
node "$page/live_speed.mjs" "$wasm" >"$out/tables/live_speed.csv"
mujoco=$out/node_modules/@mujoco/mujoco/mujoco.js
node "$page/live_mujoco.mjs" "$wasm" "$mujoco" "$out/mjcf" >"$out/tables/live.csv"
"$root/build/release/experiments/mechanics" states >"$out/states.json"
node "$page/live_mirror.mjs" "$out/states.json" "$mujoco" "$out/mjcf" >"$out/tables/live_mirror.csv"
