#!/usr/bin/env bash
# The QPs of a Table 1 run at h = 5 ms, solved by each back end, from zero and from warm starts. Leaves q.h5, qps.csv and a table.
# The QPs are not recorded again where they are there already.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/../common.sh"

if [[ ! -e $out/q.h5 ]]; then
  "$hagfish" record-qp table1 --qp active-set --set time.step=0.005 --out "$out/q.new.h5" --force --quiet
  mv "$out/q.new.h5" "$out/q.h5"
fi
"$hagfish" qp "$out/q.h5" --csv "$out/qps.csv" --force || (($? == 1)) # a back end that fails is a result
draw qp_table.py "$out/qps.csv" "$out"
