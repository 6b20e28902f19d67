"""Activations over body and time, which muscles work, and what antagonists do: of a scene with muscles.

Usage: muscles.py LOG.h5 OUT.png (writes a PDF beside).
"""

from __future__ import annotations

from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import plots
from figure8 import edges
from hagfish_log import HagfishLog
from muscle_log import Muscles
from script import run_script


def phases(log: HagfishLog) -> list[tuple[str, float]]:
    names, time = log.labels("/trajectory/phase"), log["/trajectory/time"]
    starts = np.flatnonzero(np.r_[True, names[1:] != names[:-1]])
    return [(names[k], time[k]) for k in starts]


def draw_map(axes: plt.Axes, muscles: Muscles, bends: bool) -> None:
    log = muscles.log
    arc, activation = muscles.map(bends)
    axes.grid(visible=False)
    image = axes.pcolormesh(edges(muscles.time), edges(arc), activation.T, cmap="viridis", vmin=0, vmax=1, rasterized=True)
    axes.plot(muscles.time, log["/knot/head_end"], color="white", lw=0.9, label="knot, head end")
    axes.plot(muscles.time, log["/knot/tail_end"], color="white", lw=0.9, ls="--", label="knot, tail end")
    axes.set(ylabel="arc length from the head, cm", xlabel="time, s", ylim=(arc[0], arc[-1]))
    legend = axes.legend(loc="lower left", fontsize=7, framealpha=0.35, facecolor="black")
    for text in legend.get_texts():
        text.set_color("white")
    axes.figure.colorbar(image, ax=axes, pad=0.02, fraction=0.05, label="largest activation of a joint's muscles")


def main(path: Path, out: Path) -> None:
    log = HagfishLog(path)
    muscles = Muscles(log)
    figure, panels = plots.panels(3, 1, (8.0, 9.0), ["lines along the body: joints that bend", "oblique families: joints that twist",
                                                     "all muscles"], sharex=True)
    draw_map(panels[0], muscles, bends=True)
    draw_map(panels[1], muscles, bends=False)
    below = panels[2]
    below.plot(muscles.time, muscles.activation.max(axis=1), color=plots.VERMILION, lw=0.8, label="largest activation")
    below.plot(muscles.time, muscles.activation.mean(axis=1), color=plots.BLUE, label="mean activation")
    every = np.array([muscles.antagonists(np.array([f])) for f in range(log.frames)])
    below.plot(muscles.time, every, color=plots.INK, lw=0.8, ls=":", label="antagonists' share of the force")
    below.set(xlabel="time, s", ylabel="share", ylim=(0, 1.3))
    below.legend(loc="center left")
    for axes in panels:
        for _, start in phases(log)[1:]:
            axes.axvline(start, color=plots.GREY if axes is below else "white", lw=0.6, ls="-.")
    least = 0.03 * (muscles.time[-1] - muscles.time[0])
    marks = phases(log) + [("", muscles.time[-1])]
    for (name, start), (_, end) in zip(marks, marks[1:]):
        if end - start > least:
            below.text((start + end) / 2, 1.17, name, ha="center", fontsize=7.5, color=plots.GREY)
    plots.save(figure, out)


if __name__ == "__main__":
    run_script(__doc__, ["LOG.h5", "OUT.png"], main)
