"""Shares of a slide by both ends, by how few numbers: medians of the knots, and the least.

Usage: few_numbers_picture.py few_numbers_points.csv OUT.png (writes a PDF beside).
"""

from pathlib import Path

import numpy as np

import plots
from script import run_script
from tables import read_csv

HEAD = ["knot", "frame", "found each, s", "numbers", "share"]
FRAMES = {"knot": "in the knot's window", "body": "along the body"}
ENOUGH = 0.7  # of a slide by both ends: both_ends_share in core/run/slide.hpp
COLOURS = [plots.GREY, plots.BLUE, plots.ORANGE]
STYLES = {"knot": {"ls": "-", "marker": "o"}, "body": {"ls": "--", "marker": "s"}}
BESIDE = 0.06  # of the room between two numbers: lines beside each other


def draw(points: list[dict[str, str]], out: Path) -> None:
    counts = sorted({int(p["numbers"]) for p in points})
    periods = sorted({p["found each, s"] for p in points}, key=float)
    figure, (axes,) = plots.panels(1, 1, (6, 3.6), [""])
    for f, (frame, words) in enumerate(FRAMES.items()):
        for k, (period, colour) in enumerate(zip(periods, COLOURS)):
            of = lambda count: np.clip([float(p["share"]) for p in points if p["frame"] == frame and p["found each, s"] == period
                                        and int(p["numbers"]) == count], 0, None)
            ways = [of(count) for count in counts if of(count).size]
            at = np.array([n for n, count in enumerate(counts) if of(count).size]) + BESIDE * (k - 1 + 3 * (f - 0.5))
            middle = np.array([np.median(way) for way in ways])
            axes.errorbar(at, middle, [middle - [way.min() for way in ways], 0 * middle], color=colour, lw=1.2, ms=4, elinewidth=0.7,
                          label=f"{1000 * float(period):g} ms, {words}", **STYLES[frame])
    axes.axhline(ENOUGH, color=plots.GREY, lw=0.8, ls=":", zorder=0)
    axes.set(xlabel="numbers", ylabel="share of a slide by both ends:\nmedian of the knots, and the least", ylim=(-0.05, None))
    axes.set_xticks(range(len(counts)), [str(count) for count in counts])
    axes.legend(title="numbers found every; shapes", loc="upper left")
    plots.save(figure, out)


if __name__ == "__main__":
    run_script(__doc__, ["few_numbers_points.csv", "OUT.png"], lambda table, out: draw(read_csv(table, HEAD), out))
