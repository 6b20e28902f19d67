"""The core against MuJoCo, from `hagfish compare`: differences in random states, along rollouts by the same rule, and
errors over the time step.

Usage: agreement.py COMPARE.h5 OUT.png (writes a PDF beside).
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
HEADS = {"free": ("#4477aa", "free head"), "clamped": ("#cc6677", "clamped head")}
QUANTITIES = {"position": "positions", "orientation": "orientations", "mass": "M", "bias": "bias",
              "acceleration": r"$\ddot q$"}
RULES = {"core": ("core (semi-implicit)", "#000000", "o", 9), "mujoco_euler": ("MuJoCo Euler", "#4477aa", "s", 4),
         "mujoco_implicit": ("MuJoCo implicit", "#ccaa33", "^", 5), "mujoco_rk4": ("MuJoCo RK4", "#228833", "D", 5)}


def draw_states(axes: Any, results: Results) -> None:
    for row, (name, text) in enumerate(QUANTITIES.items()):
        for shift, (head, (colour, label)) in zip((-0.15, 0.15), HEADS.items()):
            values = results[f"/states/{head}/{name}"]
            low, middle, high = np.quantile(values, [0.01, 0.5, 1])
            axes.plot([low, high], [row + shift] * 2, color=colour, lw=2, label=label if row == 0 else None)
            axes.plot(middle, row + shift, "o", color=colour, ms=5)
        bound = results[f"/states/free/{name}_bound"][0]
        axes.plot([bound] * 2, [row - 0.35, row + 0.35], color="black", lw=1, label="required" if row == 0 else None)
    axes.set_xscale("log")
    axes.set_yticks(range(len(QUANTITIES)), QUANTITIES.values())
    axes.invert_yaxis()
    axes.set_xlabel("difference over scale: median, 1 % to largest")
    axes.set_title(f"(a) {len(results['/states/free/mass'])} random states", loc="left")
    axes.legend(fontsize=8, loc="upper right")


def draw_rollouts(axes: Any, results: Results) -> None:
    for head, (colour, label) in HEADS.items():
        axes.semilogy(results[f"/rollout/{head}/time"], results[f"/rollout/{head}/velocity"], color=colour, label=label)
    axes.axhline(results["/rollout/free/velocity_bound"][0], color="black", lw=1, label="required")
    axes.set_xlabel("time, s")
    axes.set_ylabel(r"largest difference in $\dot q$ over largest $\dot q$")
    axes.set_title("(b) the same rule, step by step", loc="left")
    axes.legend(fontsize=8)


def draw_errors(axes: Any, results: Results) -> None:
    h = results["/error/clamped/h"] * 1e3
    for name, (label, colour, marker, size) in RULES.items():
        axes.loglog(h, results[f"/error/clamped/{name}"], marker=marker, color=colour, label=label, ms=size,
                    fillstyle="none" if name == "core" else "full")  # MuJoCo's Euler lies on it
    core = results["/error/clamped/core"]
    axes.loglog(h, 0.4 * core[-1] * h / h[-1], color="grey", lw=0.8, ls="--", label="first order")
    axes.set_xticks(h, [f"{step:g}" for step in h])
    axes.minorticks_off()
    axes.set_xlabel("time step, ms")
    axes.set_ylabel("largest error of a body centre, cm")
    axes.set_title("(c) error against the step, clamped head", loc="left")
    axes.legend(fontsize=8)


def main(results: Results, out: Path) -> None:
    figure, axes = plt.subplots(1, 3, figsize=(13, 4.2), layout="constrained")
    draw_states(axes[0], results)
    draw_rollouts(axes[1], results)
    draw_errors(axes[2], results)
    save_figure(figure, out, DPI)


if __name__ == "__main__":
    run_script(__doc__, ["OUT.png"], main, Results)
