#!/usr/bin/env bash
# A knot's figures of other pages beside what is known of animals (rows/). Leaves tables, and runs nothing.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/../common.sh"

draw knot_in_numbers.py "$out"
