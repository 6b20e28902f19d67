"""Smooth motions: error at the end against CPU time per simulated time, for the simulator and MuJoCo.

Usage: integration.py RUNS OUT_FOLDER, with RUNS/coil.h5, ... of `hagfish integrate`.
"""

from pathlib import Path
from typing import Any

import numpy as np

import plots
import tables
from hagfish_log import Results
from script import run_script

MOTIONS = ("coil", "hanging", "whip")
STEPS = (10.0, 2.0, 0.5)  # ms, of the table
FAR = 20.0  # cm, about half of the body: what is farther off is not drawn
WANTED = 0.01  # cm, an error whose price the table has


def steps(results: Results, method: str) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """h (ms), CPU time per simulated time, and error (cm, infinite where it blew up)."""
    return results[f"/{method}/h"] * 1e3, results[f"/{method}/cost"], results[f"/{method}/error"]


def reached(cost: np.ndarray, error: np.ndarray) -> float:
    """Least CPU time at which the error is WANTED or less, between the steps tried; nan where none comes so near."""
    known = np.isfinite(error)
    cost, error = cost[known], error[known]
    if not error.size or error.min() > WANTED:
        return np.nan
    order = np.argsort(error)
    between = np.exp(np.interp(np.log(WANTED), np.log(error[order]), np.log(cost[order])))
    return float(min(between, cost[error <= WANTED].min()))


def row(results: Results, method: str) -> list[str]:
    """Of the table: a motion by a method. Order is by the last two of STEPS."""
    h, cost, error = steps(results, method)
    at = {step: float(error[np.isclose(h, step)][0]) for step in STEPS}
    coarse, fine = STEPS[-2:]
    order = np.log(at[coarse] / at[fine]) / np.log(coarse / fine)
    price = reached(cost, error)
    return [results.attribute("motion"), plots.INTEGRATORS[method].label,
            *(f"{value:.1e}" if np.isfinite(value) else "blew up" for value in at.values()),
            f"{order:.1f}" if np.isfinite(order) else "", f"{price:.2g}" if np.isfinite(price) else ""]


def draw(axes: Any, results: Results) -> None:
    """Steps with an error below FAR."""
    for method, look in plots.INTEGRATORS.items():
        h, cost, error = steps(results, method)
        known = error < FAR
        first, last = np.flatnonzero(known)[[0, -1]]
        between = method in ("mujoco_euler", "mujoco_implicit")  # where labels of both ends would cover other curves
        axes.loglog(cost[known], error[known], **look.style, label=look.label + (f", to {h[last]:g} ms" if between else ""))
        note = lambda k, shift, ha, va: axes.annotate(f"{h[k]:g} ms", (cost[k], error[k]), shift, fontsize=7, ha=ha,
                                                      textcoords="offset points", va=va)
        below, beside = ((-4, -5), "right", "top"), ((6, 1), "left", "bottom")
        note(first, *(((-3, 5), "right", "bottom") if between else ((0, -7), "center", "top") if method == "mujoco_rk4" else below))
        if not between:
            note(last, *(below if method == "core_midpoint" else beside))
    agreement = float(results["/reference/agreement"][0])
    axes.axhline(agreement, color=plots.GREY, lw=0.8, ls="--")
    axes.text(0.98, agreement * 1.4, "two references differ", transform=axes.get_yaxis_transform(), ha="right", fontsize=7, color=plots.GREY)
    axes.set_xlabel("CPU time per simulated time")


def main(folder: Path, out: Path) -> None:
    motions = {motion: Results(folder / f"{motion}.h5") for motion in MOTIONS}
    figure, panels = plots.panels(1, 3, (11, 4.4), [results.attribute("motion") for results in motions.values()], sharex=True, sharey=True)
    for axes, results in zip(panels, motions.values()):
        draw(axes, results)
    panels[0].set(ylabel="largest error of a body centre at 0.5 s, cm", xlim=(1e-4, 40), ylim=(1e-10, 90))
    plots.legend_above(figure, panels[0].get_legend_handles_labels()[0], 5, 0.07)
    plots.save(figure, out / "integration.png")
    tables.write_table(out, "speed_accuracy_motions", ["motion", "method", *(f"error at {h:g} ms, cm" for h in STEPS), "order",
                                                       "CPU time per simulated time for 0.01 cm"],
                       [row(results, method) for results in motions.values() for method in plots.INTEGRATORS])


if __name__ == "__main__":
    run_script(__doc__, ["RUNS", "OUT_FOLDER"], main)
