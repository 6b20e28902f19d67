#!/usr/bin/env bash
# The reverse slide: each knot slid to the head and back until it comes undone at the tail, at several speeds, beside the way
# to the head at the same speed. Leaves reverse.png, reverse.csv and reverse.md.
#   bash experiments/studies/reverse.sh [OUTPUT_FOLDER]     default: out/reverse
# Stopped, it goes on where it was.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/study.sh"

runs_of_all() {
  local scene v turn back="" row
  turn="--set controller.leave_by=tail --set controller.free_from=free --set controller.untied_for=0.2"
  for scene in overhand_reverse figure_eight double_overhand three_twist; do
    for v in 0.5 1 2 5 10 20; do
      back=" --set controller.acceleration=$(awk "BEGIN { print 200 * $v }")"  # the speed within 5 ms
      for row in head.a head.b tail.a tail.b; do back+=" --set controller.reverse_$row=$v"; done
      printf 'timed_run\t%s\t1\t%s\n' "reverse_${scene}_$v" \
        "$scene --qp active-set $turn$back --set time.duration=90 --set expect.types=[]"
    done
  done
}
runs_of_all | work "$cores" "Reverse slides"

echo "Drawing"
draw reverse.py "$runs" "$out/reverse.csv" "$out/reverse.png" "$out/reverse.md"
finish "$out/reverse.md"
