#!/usr/bin/env bash
# How fast a knot can slide: 0.1 to 50 cm/s commanded, against the speed, force, slack and penetration that come of it. Leaves
# speeds.png, speeds.csv and speeds.md.
#   bash experiments/studies/speeds.sh [OUTPUT_FOLDER]     default: out/speeds
# Stopped, it goes on where it was.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/study.sh"

runs_of_all() {
  local scene v row sets frames
  for scene in overhand_waypoints figure_eight double_overhand three_twist; do
    for v in 0.1 0.2 0.5 1 2 5 10 15 20 30 50; do
      # A fast slide is over in a few frames of the usual kind.
      frames=$([[ ${v%.*} -gt 5 ]] && echo 0.002 || echo 0.02)
      sets="--set time.duration=130 --set time.frame_interval=$frames --set expect.types=[] --set guard.penetration=2"
      sets+=" --set controller.acceleration=$(awk "BEGIN { print 200 * $v }")"  # the speed within 5 ms
      for row in head.a head.b tail.a tail.b; do sets+=" --set controller.slide_$row=$v"; done
      printf 'timed_run\t%s\t1\t%s\n' "speed_${scene}_$v" "$scene --qp active-set $sets"
    done
  done
}
runs_of_all | work "$cores" "Speeds"

echo "Drawing"
draw speeds.py "$runs" "$out/speeds.csv" "$out/speeds.png" "$out/speeds.md"
finish "$out/speeds.md"
