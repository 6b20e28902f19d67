#!/usr/bin/env bash
# How well `hagfish midlines` gives back what was filmed: closed forms, ten runs as films with a tracker's faults, 300 damaged films;
# what the tutorial takes; 18 animals that are let go. Leaves tables.
# Stopped, it goes on where it was.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/../jobs.sh"

draw films.py "$runs" "$out"
