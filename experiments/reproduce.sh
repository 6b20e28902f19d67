#!/usr/bin/env bash
# Makes pages of results again, from nothing: runs the study of each, takes its tables and figures into the page's folder
# (experiments/results/NAME), and says what differs from those that were there by more than chance.
#   bash experiments/reproduce.sh [NAME...]     default: all pages
#   bash experiments/reproduce.sh --list        their names, questions, and how long each took
#   bash experiments/reproduce.sh --mark        notes on each page whether the simulator has changed since it was made
#   bash experiments/reproduce.sh --digest      notes how this code moves each scene, to the last bit: code that moves all alike ages no page
# Stopped, it goes on where it was: studies keep what they have in out/reproduce, and a page that is done by the same program
# is not made again. Exits 1 if anything differs.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
results() { /usr/bin/python3 -B "$root/experiments/results/results.py" "$@"; }
case ${1-} in
  --list) results list; exit ;;
  --mark) results mark; exit ;;
  --digest)
    PRESET=portable bash "$root/experiments/setup.sh" --target live_digest
    results digest "$root/build/portable/experiments/live_digest"
    results mark
    exit ;;
esac
names=("$@")
if ((${#names[@]} == 0)); then mapfile -t names < <(results names); fi
for name in "${names[@]}"; do results page "$name"; done # unknown names end it before any work

bash "$root/experiments/setup.sh" --target hagfish
version=$("$root/build/release/experiments/hagfish" --version)
differs=()
for name in "${names[@]}"; do
  out=$root/out/reproduce/$name
  if [[ $(cat "$out/done" 2>/dev/null) == "$version" ]]; then
    echo "$name: done before, by this program"
    continue
  fi
  mkdir -p "$out"
  start=$SECONDS
  echo "$name: running"
  bash "$root/experiments/results/$name/study.sh" "$out" >"$out/study.txt" 2>&1 || {
    tail -n 20 "$out/study.txt" >&2
    echo "reproduce: $name: its study failed; all that it said is in $out/study.txt" >&2
    exit 1
  }
  took=$((SECONDS - start))
  results adopt "$name" "$out" "$version" "$took" || differs+=("$name")
  echo "$version" >"$out/done"
  echo "$name: took $((took / 60)) min $((took % 60)) s"
done
results mark
if ((${#differs[@]})); then
  echo "These pages differ from what they were by more than chance: ${differs[*]}"
  exit 1
fi
