#!/usr/bin/env bash
# The simulator in WebAssembly: how fast Table 1 runs in node, and what a step costs beside one of today's MuJoCo in the same engine.
# Builds the page, and gets MuJoCo from npm, which this study alone needs.
#   bash experiments/studies/live.sh [OUTPUT_FOLDER]     default: out/live
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

HAGFISH_WEB=1 bash "$root/experiments/setup.sh"
wasm=$root/build/web/hagfish.wasm
command -v npm >/dev/null || { echo "live.sh: npm is not here: install Debian's package npm" >&2; exit 2; }
npm install --silent --no-audit --no-fund --prefix "$out" @mujoco/mujoco@3.14.0
mkdir -p "$out/tables"
"$hagfish" mjcf table1 --out "$out/mjcf" --force
node "$root/experiments/studies/live_speed.mjs" "$wasm" >"$out/tables/live_speed.csv"
node "$root/experiments/studies/live_mujoco.mjs" "$wasm" "$out/node_modules/@mujoco/mujoco/mujoco.js" "$out/mjcf" >"$out/tables/live.csv"
list_output
