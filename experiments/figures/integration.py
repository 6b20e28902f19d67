"""Smooth motions: error at the end against CPU time per simulated time, for the core and MuJoCo.

Usage: integration.py RUNS OUT.csv OUT.png (writes a PDF beside), with RUNS/coil.h5, ... of `hagfish integrate`.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

from hagfish_log import Results, save_figure
from study import GREY, run_study, write_csv

DPI = 200
MOTIONS = ("coil", "hanging", "whip")
METHODS = {"core": ("core, semi-implicit", "#000000", "o"), "mujoco_euler": ("MuJoCo Euler, to 0.25 ms", "#4477aa", "s"),
           "mujoco_implicit": ("MuJoCo implicit, to 0.25 ms", "#cc6677", "^"), "mujoco_rk4": ("MuJoCo RK4", "#228833", "D")}


def steps(results: Results, method: str) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """h (ms), CPU time per simulated time, and error (cm, infinite where it blew up)."""
    return results[f"/{method}/h"] * 1e3, results[f"/{method}/cost"], results[f"/{method}/error"]


def draw(axes: Any, results: Results, letter: str) -> None:
    for method, (label, colour, marker) in METHODS.items():
        h, cost, error = steps(results, method)
        known = np.isfinite(error)
        axes.loglog(cost[known], error[known], marker=marker, ms=4.5, color=colour, label=label)
        note = lambda k, shift, ha, va: axes.annotate(f"{h[k]:g} ms", (cost[k], error[k]), shift, fontsize=7, ha=ha,
                                                      textcoords="offset points", color=colour, va=va)
        first, last = np.flatnonzero(known)[[0, -1]]
        if method in ("mujoco_euler", "mujoco_implicit"):
            note(first, (4, 4), "left", "bottom")
        else:
            note(first, (-4, -5), "right", "top")
            note(last, (6, -1), "left", "center")
    agreement = float(results["/reference/agreement"][0])
    axes.axhline(agreement, color=GREY, lw=0.8, ls="--")
    axes.text(0.98, agreement * 1.4, "two references differ", transform=axes.get_yaxis_transform(), ha="right",
              fontsize=7, color=GREY)
    axes.set_title(f"({letter}) {results.root('motion')}", loc="left")
    axes.set_xlabel("CPU time per simulated time")
    axes.grid(which="major", color="#e5e5e5", lw=0.6)


def main(folder: Path, csv: Path, png: Path) -> None:
    figure, all_axes = plt.subplots(1, 3, figsize=(11, 4.4), layout="constrained", sharex=True, sharey=True)
    rows = []
    for axes, motion, letter in zip(all_axes, MOTIONS, "abc"):
        results = Results(folder / f"{motion}.h5")
        draw(axes, results, letter)
        for method in METHODS:
            rows += [[motion, method, float(h), float(cost), float(error)] for h, cost, error in
                     zip(*steps(results, method))]
    all_axes[0].set_ylabel("largest error of a body centre at 0.5 s, cm")
    all_axes[0].legend(fontsize=8, loc="lower left", bbox_to_anchor=(0, 0.12))
    all_axes[0].set_xlim(7e-4, 40)
    all_axes[0].set_ylim(1e-10, 30)
    save_figure(figure, png, DPI)
    write_csv(csv, ["motion", "method", "h_ms", "cpu_per_simulated_time", "error_cm"], rows)


if __name__ == "__main__":
    run_study(__doc__, ["OUT.csv", "OUT.png"], main)
