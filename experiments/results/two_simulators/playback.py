"""A knot slid in MuJoCo by f_thigmo alone, its mean from frame to frame of a log, from `hagfish playback`: where its
head end goes, how much of the slide it keeps, how far the body drifts from the log, and how deep the soft contacts
overlap. The control has no f_thigmo.

Usage: playback.py PLAYBACK.h5 OUT.png (writes a PDF beside, and tables/two_simulators_playback.csv).
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

import plots
from hagfish_log import Results
from script import run_script
from tables import write_table

INTERVALS = ["0.04", "0.1", "0.2", "0.5", "1"]
SECONDS = [float(interval) for interval in INTERVALS]
FORCES = {"thigmotaxis": (plots.ORANGE, r"driven by mean $f_\mathrm{thigmo}$"), "none": (plots.GREY, "no force (control)")}
SHOWN = {"0.1": plots.ORANGE, "0.5": plots.BLUE, "1": plots.PURPLE}


def stretches(results: Results, interval: str) -> list[slice]:
    """The frames that MuJoCo comes to between two restarts, one slice each of its rows: row k is frame k + 1 of the
    log, so that each stretch starts from the log's frame `start`."""
    time = results["/time"]
    count, rows = round(float(interval) / (time[1] - time[0])), len(time) - 1
    return [slice(k, min(k + count, rows)) for k in range(0, rows, count)]


def draw_paths(axes: Any, results: Results) -> None:
    time, logged = results["/time"], results["/head_end"]
    axes.plot(time, logged, color="black", lw=2, label="log")
    for interval, colour in SHOWN.items():
        path = results[f"/thigmotaxis_{interval}s/head_end"]
        for part in stretches(results, interval):
            axes.plot(time[part.start:part.stop + 1], np.r_[logged[part.start], path[part]], color=colour, lw=1.2,
                      label=f"MuJoCo, restarted every {interval} s" if part.start == 0 else None)
    axes.set(xlabel="time, s", ylabel="head end of the knot, cm from the head")
    axes.legend(loc="upper right")


def shares(results: Results, force: str) -> np.ndarray:
    """Of the log's headward slide, by interval between restarts, %."""
    logged, found = results["/head_end"], []
    for interval in INTERVALS:
        path = results[f"/{force}_{interval}s/head_end"]
        ends = [(logged[p.start], path[p.stop - 1], logged[p.stop])
                for p in stretches(results, interval)]
        found.append(100 * sum(a - b for a, b, _ in ends) / sum(a - c for a, _, c in ends))
    return np.array(found)


def rows_of(results: Results) -> list[list[str]]:
    largest = lambda what: [f"{np.nanmax(results[f'/thigmotaxis_{interval}s/{what}']):.2g}" for interval in INTERVALS]
    return [["headward slide, of the log's, %", *(f"{share:.0f}" for share in shares(results, "thigmotaxis"))],
            ["the same without f_thigmo, %", *(f"{share:.0f}" for share in shares(results, "none"))],
            ["farthest body centre from the log, cm", *largest("drift")],
            ["deepest overlap of the capsules, cm", *largest("capsule_penetration")]]


def draw_share(axes: Any, results: Results) -> None:
    for force, (colour, label) in FORCES.items():
        axes.plot(SECONDS, shares(results, force), "o-", color=colour, label=label)
    axes.axhline(100, color=plots.INK, lw=0.8)
    axes.set(xscale="log", ylim=(0, 110), xlabel="time between restarts, s", ylabel="headward slide, % of the log's")
    plots.plain_ticks(axes.xaxis, SECONDS)
    axes.legend(loc="lower left")


def draw_drift(axes: Any, results: Results) -> None:
    for force, (colour, label) in FORCES.items():
        middle, high = [], []
        for interval in INTERVALS:
            drift = results[f"/{force}_{interval}s/drift"]
            ends = [drift[p.stop - 1] for p in stretches(results, interval)]
            middle.append(np.nanmedian(ends))
            high.append(np.nanmax(drift))
        axes.loglog(SECONDS, middle, "o-", color=colour, label=f"{label}, median at the end")
        axes.plot(SECONDS, high, ":", color=colour, label=f"{label.split(' (')[0]}, largest")
    plots.plain_ticks(axes.xaxis, SECONDS)
    axes.set(xlabel="time between restarts, s", ylabel="farthest body centre from the log, cm")
    axes.legend(loc="upper left")


def draw_overlap(axes: Any, results: Results) -> None:
    x = np.arange(len(INTERVALS))
    kinds = {"capsule_penetration": (plots.BLUE, "capsules (MuJoCo)"), "penetration": (plots.ORANGE, "skin along the spline")}
    for shift, (kind, (colour, label)) in zip((-0.18, 0.18), kinds.items()):
        sets = [results[f"/thigmotaxis_{i}s/{kind}"] for i in INTERVALS]
        axes.bar(x + shift, [np.nanmax(s) for s in sets], 0.34, color=colour, alpha=0.45, label=f"{label}, largest")
        middle = [np.nanmedian(s) for s in sets]
        # A logarithmic axis has no 0.
        axes.bar(x + shift, middle, 0.34, color=colour, label="median" if any(middle) else "median: 0")
    axes.set_xticks(x, INTERVALS)
    axes.set(yscale="log", xlabel="time between restarts, s", ylabel="overlap, cm")
    axes.set_ylim(top=2)  # room for the legend
    axes.grid(axis="x", visible=False)
    axes.legend(ncols=2, loc="upper right")


def main(playback: Path, out: Path) -> None:
    results = Results(playback)
    interval = 1000 * np.median(np.diff(results["/time"]))
    figure, (paths, share, drift, overlap) = plots.panels(
        2, 2, (11, 8), [rf"driven by $f_\mathrm{{thigmo}}$ alone, means over {interval:.0f} ms", "how much of the slide",
                        "drift", "overlap of the soft contacts"])
    write_table(out.parent, "two_simulators_playback", ["restarted every, s", *INTERVALS], rows_of(results))
    draw_paths(paths, results)
    draw_share(share, results)
    draw_drift(drift, results)
    draw_overlap(overlap, results)
    plots.save(figure, out)


if __name__ == "__main__":
    run_script(__doc__, ["PLAYBACK.h5", "OUT.png"], main)
