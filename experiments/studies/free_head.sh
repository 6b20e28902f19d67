#!/usr/bin/env bash
# Free head: each knot tied with the head held, then tightened and slid off by an animal that nothing holds (no clamp, no
# plate), beside the held one, at several speeds. Leaves free_head.png, free_head.csv and free_head.md.
#   bash experiments/studies/free_head.sh [OUTPUT_FOLDER]     default: out/free_head
# Stopped, it goes on where it was.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/study.sh"

runs_of_all() {
  local scene v row sets free="--set controller.free_from=tighten --set wall.present=false"
  for scene in overhand_waypoints figure_eight double_overhand three_twist; do
    for v in 0.5 1 2 5 10; do
      sets="--set time.duration=60 --set expect.types=[]"
      sets+=" --set controller.acceleration=$(awk "BEGIN { print 200 * $v }")"  # the speed within 5 ms
      for row in head.a head.b tail.a tail.b; do sets+=" --set controller.slide_$row=$v"; done
      printf 'timed_run\t%s\t1\t%s\n' "held_${scene}_$v" "$scene --qp active-set $sets"
      printf 'timed_run\t%s\t1\t%s\n' "free_${scene}_$v" "$scene --qp active-set $free $sets"
    done
    printf 'timed_run\t%s\t1\t%s\n' "forming_${scene}_2" "$scene --qp active-set --set clamp_head=false --set wall.present=false"
  done
}
runs_of_all | work "$cores" "Free heads"

echo "Drawing"
draw free_head.py "$runs" "$out/free_head.csv" "$out/free_head.png" "$out/free_head.md"
finish "$out/free_head.md"
