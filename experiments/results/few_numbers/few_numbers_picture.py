"""Shares of the way by how few numbers, and what they take: each start a point by itself.

Usage: few_numbers_picture.py few_numbers_points.csv OUT.png (writes a PDF beside).
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

import plots
from script import run_script
from tables import read_csv

HEAD = ["figure", "knot", "frame", "found each, s", "numbers", "start", "value"]
FRAMES = {"knot": "in the knot's window", "body": "along the body"}
ENOUGH = 0.9  # of the way by the paper's law
LOOKS = [(plots.GREY, "o"), (plots.BLUE, "s"), (plots.ORANGE, "D"), (plots.VERMILION, "^")]
BESIDE = 0.2  # of the room between two numbers: points found at other rates
LARGEST = 1.3  # share shown

Point = dict[str, str]


def draw(points: list[Point], out: Path) -> None:
    of = lambda **wanted: [p for p in points if all(p[key] == value for key, value in wanted.items())]
    counts = sorted({int(p["numbers"]) for p in points})
    periods = sorted({p["found each, s"] for p in of(figure="share")}, key=float)
    x_of = lambda found, beside=0.0: [counts.index(int(p["numbers"])) + beside for p in found]
    y_of = lambda found: [float(p["value"]) for p in found]
    figure, panels = plots.panels(3, 4, (11, 7.2), [look.label for look in plots.KNOTS.values()] + [""] * 8, sharex=True, sharey="row")
    panels = panels.reshape(3, 4)
    for column, knot in enumerate(plots.KNOTS):
        for row, frame in enumerate(FRAMES):
            axes = panels[row, column]
            for k, (period, (colour, marker)) in enumerate(zip(periods, LOOKS)):
                beside = BESIDE * (k - (len(periods) - 1) / 2)
                found = of(figure="share", knot=knot, frame=frame, **{"found each, s": period})
                axes.plot(x_of(found, beside), np.clip(y_of(found), 0, None), marker, color=colour, ms=4.5,
                          label=f"{1000 * float(period):g} ms")
                many = of(figure="starts", knot=knot, frame=frame, **{"found each, s": period})
                for count in sorted({p["numbers"] for p in many}, key=int):
                    ways = np.clip(y_of([p for p in many if p["numbers"] == count]), 0, None)
                    axes.plot([counts.index(int(count)) + beside] * 2, [ways.min(), ways.max()], "_-", color=colour, ms=11, lw=1.4, mew=1.4,
                              label=f"least and largest of {ways.size}")
            axes.axhline(ENOUGH, color=plots.GREY, lw=0.8, ls="--", zorder=0)
            axes.set(ylim=(-0.05, LARGEST))
        axes = panels[2, column]
        found = of(figure="effort", knot=knot)
        axes.plot(x_of(found), y_of(found), LOOKS[1][1], color=LOOKS[1][0], ms=4.5)
        axes.axhline(1, color=plots.GREY, lw=0.8, ls="--", zorder=0)
        axes.set(xlabel="numbers", ylim=(0, 1.1 * max([1.0, *y_of(of(figure="effort"))])), xlim=(-0.5, len(counts) - 0.5))
        axes.set_xticks(range(len(counts)), [str(count) for count in counts])
    for row, words in enumerate(FRAMES.values()):
        panels[row, 0].set_ylabel(f"share of the full way,\nshapes {words}")
    panels[2, 0].set_ylabel("effort for each cm,\nover that of $f_{thigmo}$")
    handles = {label: handle for handle, label in zip(*panels[0, 0].get_legend_handles_labels())}
    plots.legend_above(figure, list(handles.values()), len(handles), 0.07, title="a point is one start; numbers found each")
    panels[0, 0].text(0.97, ENOUGH - 0.02, f"all the way: {ENOUGH:g}", transform=panels[0, 0].get_yaxis_transform(), ha="right", va="top",
                      fontsize=7, color=plots.GREY)
    panels[2, 3].text(0.97, 0.96, "none where they do not\nslide all the way", transform=panels[2, 3].transAxes, ha="right", va="top",
                      fontsize=7, color=plots.GREY)
    plots.save(figure, out)


if __name__ == "__main__":
    run_script(__doc__, ["few_numbers_points.csv", "OUT.png"], lambda table, out: draw(read_csv(table, HEAD), out))
