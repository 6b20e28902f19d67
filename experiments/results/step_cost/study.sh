#!/usr/bin/env bash
# What a step costs at 25 to 400 bodies, with MuJoCo's beside it in one process.
# Leaves benchmarks.json, which has processor, flags and library versions, and three tables.
set -euo pipefail
targets=(hagfish_benchmarks hagfish_overlap)
source "$(dirname "${BASH_SOURCE[0]}")/../common.sh"

# The knotted states come from runs of the animal with as many bodies. At 25 the force script ends untied;
# the waypoints tie, with less of the tail through.
run() { "$hagfish" run "${@:2}" --qp active-set --out "$out/$1.h5" --force --quiet; }
run 25 overhand_waypoints --set model.bodies=25 --set controller.tail_through=3 --set controller.tighten_from=10
for bodies in 50 100 200 400; do
  run "$bodies" table1 --set model.bodies="$bodies" --set time.step=0.002
done

# measure PRESET NAME ARGUMENT...: on one core, parts in random order, so that a busy spell of the machine falls on all alike.
measure() {
  taskset --cpu-list 0 "$root/build/$1/experiments/benchmarks/hagfish_benchmarks" \
    --benchmark_min_time=0.1 --benchmark_repetitions=5 --benchmark_enable_random_interleaving=true \
    --benchmark_out="$out/$2.json" --benchmark_out_format=json "${@:3}" >"$out/$2.log" 2>&1 || { cat "$out/$2.log" >&2; exit 2; }
}
measure release benchmarks "$out"/{25,50,100,200,400}.h5
PRESET=generic bash "$root/experiments/setup.sh" --target hagfish_benchmarks
measure generic any_processor --benchmark_filter='/step_(knotted|free).*:10/' "$out"/{100,400}.h5
# What it costs to keep strands apart: a knot pulled as hard in both simulators.
taskset --cpu-list 0 "$root/build/release/experiments/benchmarks/hagfish_overlap" \
  "$root/experiments/results/stability/scenes/pulled_knot.toml" "$out"/{50,100}.h5 >"$out/overlap.csv"
draw benchmarks.py "$out"/{benchmarks,any_processor}.json "$root/experiments/results/live/live.csv" "$out"
draw overlap.py "$out/overlap.csv" "$out"
