#!/usr/bin/env bash
# Hostile, damaged and extreme input through every subcommand, with AddressSanitizer and
# UndefinedBehaviorSanitizer: no signal, no internal error, nothing over 10 s, no control characters.
#   bash tests/fuzz.sh                          the named cases, 20,000 flips, 1,000 changes, 1,000 scenes (--cases 23000)
#   bash tests/fuzz.sh --seed 7 --minutes 10    other ones, as many as the time allows
# Inputs that find a fault are kept in out/fuzz. CHANGELOG.md says what was found.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
preset=${PRESET:-sanitize}
PRESET=$preset bash experiments/setup.sh --target fork_server
/usr/bin/python3 -B tests/fuzz/fuzz.py "build/$preset/tests/fork_server" "$@"
