#!/usr/bin/env bash
# Where are the paper's three claims about the sliding force true? The overhand knot by both readings of the bending limit,
# over its scale, where the knot is let go, stiffness and drag, each from eight perturbed starts and at two steps. Leaves claims.png and
# a table.
# Stopped, it goes on where it was.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/../common.sh"

swept "$grids/claims.toml" "$out/runs" 12 claim_map.claim_of
draw claim_map.py "$out/runs" "$out"
