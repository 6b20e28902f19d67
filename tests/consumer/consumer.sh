#!/usr/bin/env bash
# Builds the project of this folder on hagfish, installed and as a part of its own build.
#   bash tests/consumer/consumer.sh BUILD_FOLDER SCRATCH_FOLDER CXX
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
build=$1 scratch=$2 cxx=$3
rm -rf "$scratch"
configure() { cmake -S "$root/tests/consumer" -G Ninja -DCMAKE_CXX_COMPILER="$cxx" "$@"; }

echo "== Installed"
cmake --install "$build" --prefix "$scratch/prefix" >/dev/null
configure -B "$scratch/installed" -DCMAKE_PREFIX_PATH="$scratch/prefix"
cmake --build "$scratch/installed"
"$scratch/installed/example" | tee "$scratch/told.txt"
grep -q '^3_1 tied' "$scratch/told.txt"

# Compiling the libraries once more would take longer than all unit tests: that their sources and
# headers are found shows that the paths are right.
echo "== As a part of the build"
configure -B "$scratch/part" -DHAGFISH_SOURCE="$root"
cmake --build "$scratch/part" -- -n >/dev/null
cmake --build "$scratch/part" -- -v "$root/experiments/example.cpp^" | tee "$scratch/compiled.txt"
if grep -qE -- '-Werror|-march' "$scratch/compiled.txt"; then
  echo "consumer: warnings or the processor of hagfish's own build reach code that links it" >&2
  exit 1
fi
