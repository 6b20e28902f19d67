"""The core and MuJoCo, of `hagfish compare` and `hagfish playback`: differences in random states and along a run by the same rule;
and how a knot slides in MuJoCo by f_thigmo alone, its mean from frame to frame of a log, or without it.

Usage: two_simulators.py COMPARE.h5 PLAYBACK.h5 OUT_FOLDER.
"""

from pathlib import Path

import numpy as np

from hagfish_log import Results
from script import run_script
from tables import write_table

HEADS = ("free", "clamped")
QUANTITIES = {"position": "positions", "orientation": "orientations", "mass": "M", "bias": "bias", "acceleration": "q̈"}
INTERVALS = ["0.04", "0.1", "0.2", "0.5", "1"]  # s, between restarts


def compared(results: Results) -> list[list[str]]:
    """The largest difference in each quantity, over its scale, and what is required."""
    rows = []
    for name, words in QUANTITIES.items():
        largest = [results[f"/states/{head}/{name}"].max() for head in HEADS]
        rows.append([words, *(f"{value:.0e}" for value in (results[f"/states/free/{name}_bound"][0], *largest))])
    largest = [results[f"/rollout/{head}/velocity"].max() for head in HEADS]
    bound = results["/rollout/free/velocity_bound"][0]
    return [*rows, ["q̇ along a run by the same rule", *(f"{value:.0e}" for value in (bound, *largest))]]


def shares(results: Results, end: str, force: str) -> list[str]:
    """Of the way of an end of the knot in the log, by interval between restarts, %. Row k of a run is frame k + 1 of the log, so that each
    stretch starts from the log's frame."""
    time, logged, found = results["/time"], results[f"/{end}_end"], []
    for interval in INTERVALS:
        count, rows = round(float(interval) / (time[1] - time[0])), len(time) - 1
        path = results[f"/{force}_{interval}s/{end}_end"]
        ends = [(logged[k], path[min(k + count, rows) - 1], logged[min(k + count, rows)]) for k in range(0, rows, count)]
        found.append(100 * sum(a - b for a, b, _ in ends) / sum(a - c for a, _, c in ends))
    return [f"{share:.0f}" for share in found]


def played_back(results: Results) -> list[list[str]]:
    largest = lambda what: [f"{np.nanmax(results[f'/thigmotaxis_{interval}s/{what}']):.2g}" for interval in INTERVALS]
    return [["way of the knot's head end, of the log's, %", *shares(results, "head", "thigmotaxis")],
            ["of its tail end, %", *shares(results, "tail", "thigmotaxis")],
            ["head end without f_thigmo, %", *shares(results, "head", "none")],
            ["tail end without f_thigmo, %", *shares(results, "tail", "none")],
            ["farthest body centre from the log, cm", *largest("drift")],
            ["deepest overlap of the capsules, cm", *largest("capsule_penetration")]]


def main(compare: Path, playback: Path, out: Path) -> None:
    write_table(out, "two_simulators", ["largest difference, of its scale", "required", "free head", "clamped head"], compared(Results(compare)))
    write_table(out, "two_simulators_playback", ["restarted every, s", *INTERVALS], played_back(Results(playback)))


if __name__ == "__main__":
    run_script(__doc__, ["COMPARE.h5", "PLAYBACK.h5", "OUT_FOLDER"], main)
