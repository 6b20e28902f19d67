"""A knot slid in MuJoCo by f_thigmo alone, its mean from frame to frame of a log, from `hagfish playback`: where its
head end goes, how much of the slide it keeps, how far the body drifts from the log, and how deep the soft contacts
overlap. The control has no f_thigmo.

Usage: playback.py PLAYBACK.h5 OUT.png (writes a PDF beside).
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

from hagfish_log import Results, run_script, save_figure

DPI = 200
INTERVALS = ["0.04", "0.1", "0.2", "0.5", "1"]
FORCES = {"thigmotaxis": ("#cc6677", r"driven by mean $f_\mathrm{thigmo}$"), "none": ("#888888", "no force (control)")}
SHOWN = {"0.1": "#ddaa33", "0.5": "#4477aa", "1": "#aa3377"}


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
    axes.set_xlabel("time, s")
    axes.set_ylabel("head end of the knot, cm from the head")
    interval = 1000 * np.median(np.diff(time))
    axes.set_title(rf"(a) driven by $f_\mathrm{{thigmo}}$ alone, means over {interval:.0f} ms", loc="left")
    axes.legend(fontsize=8)


def draw_share(axes: Any, results: Results) -> None:
    logged = results["/head_end"]
    for force, (colour, label) in FORCES.items():
        share = []
        for interval in INTERVALS:
            path = results[f"/{force}_{interval}s/head_end"]
            ends = [(logged[p.start], path[p.stop - 1], logged[p.stop])
                    for p in stretches(results, interval)]
            share.append(sum(a - b for a, b, _ in ends) / sum(a - c for a, _, c in ends))
        axes.plot([float(i) for i in INTERVALS], 100 * np.array(share), "o-", color=colour, label=label)
    axes.axhline(100, color="black", lw=0.8)
    axes.set_xscale("log")
    axes.set_xticks([float(i) for i in INTERVALS], INTERVALS)
    axes.minorticks_off()
    axes.set_ylim(0, 110)
    axes.set_xlabel("time between restarts, s")
    axes.set_ylabel("headward slide, % of the log's")
    axes.set_title("(b) how much of the slide", loc="left")
    axes.legend(fontsize=8)


def draw_drift(axes: Any, results: Results) -> None:
    for force, (colour, label) in FORCES.items():
        middle, high = [], []
        for interval in INTERVALS:
            drift = results[f"/{force}_{interval}s/drift"]
            ends = [drift[p.stop - 1] for p in stretches(results, interval)]
            middle.append(np.nanmedian(ends))
            high.append(np.nanmax(drift))
        x = [float(i) for i in INTERVALS]
        axes.plot(x, middle, "o-", color=colour, label=f"{label}, median at the end")
        axes.plot(x, high, ":", color=colour, label="largest")
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_xticks(x, INTERVALS)
    axes.minorticks_off()
    axes.set_xlabel("time between restarts, s")
    axes.set_ylabel("farthest body centre from the log, cm")
    axes.set_title("(c) drift", loc="left")
    axes.legend(fontsize=8)


def draw_overlap(axes: Any, results: Results) -> None:
    x = np.arange(len(INTERVALS))
    kinds = {"capsule_penetration": ("#4477aa", "capsules (MuJoCo)"), "penetration": ("#ddaa33", "skin along the spline")}
    for shift, (kind, (colour, label)) in zip((-0.18, 0.18), kinds.items()):
        sets = [results[f"/thigmotaxis_{i}s/{kind}"] for i in INTERVALS]
        axes.bar(x + shift, [np.nanmax(s) for s in sets], 0.34, color=colour, alpha=0.45, label=f"{label}, largest")
        middle = [np.nanmedian(s) for s in sets]
        # A logarithmic axis has no 0.
        axes.bar(x + shift, middle, 0.34, color=colour, label="median" if any(middle) else "median: 0")
    axes.set_yscale("log")
    axes.set_xticks(x, INTERVALS)
    axes.set_xlabel("time between restarts, s")
    axes.set_ylabel("overlap, cm")
    axes.set_title("(d) overlap of the soft contacts", loc="left")
    axes.set_ylim(top=2)  # room for the legend
    axes.legend(fontsize=8, ncols=2)


def main(results: Results, out: Path) -> None:
    figure, axes = plt.subplots(2, 2, figsize=(11, 8), layout="constrained")
    draw_paths(axes[0, 0], results)
    draw_share(axes[0, 1], results)
    draw_drift(axes[1, 0], results)
    draw_overlap(axes[1, 1], results)
    save_figure(figure, out, DPI)


if __name__ == "__main__":
    run_script(__doc__, ["OUT.png"], main, Results)
