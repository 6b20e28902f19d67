"""The core against MuJoCo, from `hagfish compare`: differences in random states, along rollouts by the same rule, and
errors over the time step.

Usage: agreement.py COMPARE.h5 OUT.png (writes a PDF beside, and tables/two_simulators.csv).
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

import plots
from hagfish_log import Results
from script import run_script
from tables import write_table

HEADS = {"free": (plots.BLUE, "free head"), "clamped": (plots.ORANGE, "clamped head")}
QUANTITIES = {"position": "positions", "orientation": "orientations", "mass": "M", "bias": "bias",
              "acceleration": r"$\ddot q$"}
REQUIRED = {"color": plots.INK, "lw": 1, "label": "required"}


def draw_states(axes: Any, results: Results) -> None:
    for row, name in enumerate(QUANTITIES):
        for shift, (head, (colour, label)) in zip((-0.15, 0.15), HEADS.items()):
            values = results[f"/states/{head}/{name}"]
            low, middle, high = np.quantile(values, [0.01, 0.5, 1])
            axes.plot([low, high], [row + shift] * 2, color=colour, lw=2, label=label if row == 0 else None)
            axes.plot(middle, row + shift, "o", color=colour)
        bound = results[f"/states/free/{name}_bound"][0]
        axes.plot([bound] * 2, [row - 0.35, row + 0.35], **(REQUIRED | ({} if row == 0 else {"label": None})))
    axes.set(xscale="log", xlabel="difference over scale: median, 1 % to largest")
    axes.set_yticks(range(len(QUANTITIES)), QUANTITIES.values())
    axes.invert_yaxis()
    axes.legend(loc="lower left")


def draw_rollouts(axes: Any, results: Results) -> None:
    for head, (colour, label) in HEADS.items():
        axes.semilogy(results[f"/rollout/{head}/time"], results[f"/rollout/{head}/velocity"], color=colour, lw=1, label=label)
    axes.axhline(results["/rollout/free/velocity_bound"][0], **REQUIRED)
    axes.set(xlabel="time, s", ylabel=r"largest difference in $\dot q$ over largest $\dot q$")
    axes.legend(loc="center left", bbox_to_anchor=(0, 0.65))


def draw_errors(axes: Any, results: Results) -> None:
    h = results["/error/clamped/h"] * 1e3
    for name, look in plots.INTEGRATORS.items():
        if name == "core_midpoint":  # compared are rules that both simulators have, and RK4
            continue
        # MuJoCo's Euler lies on the core.
        core = {"ms": 9, "fillstyle": "none"} if name == "core" else {}
        axes.loglog(h, results[f"/error/clamped/{name}"], label=look.label, **look.style, **core)
    core = results["/error/clamped/core"]
    axes.loglog(h, 0.4 * core[-1] * h / h[-1], color=plots.GREY, lw=0.8, ls="--", label="first order")
    plots.plain_ticks(axes.xaxis, h)
    axes.set(xlabel="time step, ms", ylabel="largest error of a body centre, cm")
    axes.legend(loc="lower right")


def rows_of(results: Results) -> list[list[str]]:
    """The largest difference in each quantity, over its scale, and what is required."""
    rows = []
    for name, words in (QUANTITIES | {"acceleration": "q̈"}).items():
        rows.append([words, f"{results[f'/states/free/{name}_bound'][0]:.0e}", *(f"{results[f'/states/{head}/{name}'].max():.0e}" for head in HEADS)])
    return [*rows, ["q̇ along a run by the same rule", f"{results['/rollout/free/velocity_bound'][0]:.0e}",
                    *(f"{results[f'/rollout/{head}/velocity'].max():.0e}" for head in HEADS)]]


def main(compare: Path, out: Path) -> None:
    results = Results(compare)
    figure, (states, rollouts, errors) = plots.panels(
        1, 3, (13, 4.2), [f"{len(results['/states/free/mass'])} random states", "the same rule, step by step",
                          "error against the step, clamped head"])
    write_table(out.parent, "two_simulators", ["largest difference, of its scale", "required", "free head", "clamped head"], rows_of(results))
    draw_states(states, results)
    draw_rollouts(rollouts, results)
    draw_errors(errors, results)
    plots.save(figure, out)


if __name__ == "__main__":
    run_script(__doc__, ["COMPARE.h5", "OUT.png"], main)
