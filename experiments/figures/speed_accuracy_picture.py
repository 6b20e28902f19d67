"""Whole runs of the Table 1 scene: errors, overlap and cost over the time step, and over the number of bodies.

Usage: speed_accuracy_picture.py speed_accuracy_runs.csv OUT.png (writes a PDF beside).
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

import plots
from script import run_script
from tables import read_csv

HEAD = ["run", "scene", "bodies", "h_ms", "rule", "activation", "back_end", "cpu_s", "outcome", "position_error_rms_cm", "position_error_largest_cm",
        "tail_end_error_rms_cm", "slide_start_s", "slide_cm", "force_median_dyn", "force_error_percent", "force_mean_dyn", "penetration_cm", "audit_fails", "on_front"]
SLID, REFERENCE = "knot slid to the head", "reference"
USUAL = 100  # bodies
METHODS = {("euler", "speculative", "active-set"): plots.Look("Euler", plots.BLUE, "o"),
           ("midpoint", "speculative", "active-set"): plots.Look("midpoint", plots.VERMILION, "v"),
           ("euler", "violated", "active-set"): plots.Look("Euler, violated rows only", plots.ORANGE, "s"),
           ("euler", "speculative", "ipopt"): plots.Look("Euler, by Ipopt", plots.PURPLE, "D")}
FINE = 5  # ms: steps whose errors are shown by number of bodies
LEAST = {"position_error_rms_cm": 0.01, "force_error_percent": 0.3}  # what is less is drawn here

Runs = list[dict[str, str]]


def of(runs: Runs, method: tuple[str, str, str], **wanted: object) -> Runs:
    return [run for run in runs if (run["rule"], run["activation"], run["back_end"]) == method and run["outcome"] in (SLID, REFERENCE)
            and all(float(run[key]) == value for key, value in wanted.items())]


def column(runs: Runs, name: str) -> np.ndarray:
    return np.maximum([float(run[name]) for run in runs], LEAST.get(name, 0))


def draw_over(axes: plots.plt.Axes, runs: Runs, across: str, name: str, joined: bool) -> None:
    """A measure by method, at the usual number of bodies over the step or by Euler's rule over the number of bodies."""
    for method, look in METHODS.items():
        own = of(runs, method, bodies=USUAL) if across == "h_ms" else [run for run in of(runs, method) if float(run["h_ms"]) == FINE]
        own = sorted((run for run in own if name not in LEAST or run["outcome"] != REFERENCE), key=lambda run: float(run[across]))
        if own:
            axes.plot(column(own, across), column(own, name), ls="-" if joined else "", lw=1, ms=5, label=look.label, **look.style)


def shade_chance(axes: plots.plt.Axes, chance: dict[str, str], name: str, side: str) -> None:
    axes.axhspan(LEAST[name] / 2, float(chance[name]), color="#eeeeee", zorder=-1)
    axes.text(0.98 if side == "right" else 0.02, 0.03, "chance: starts\nthat differ by rounding", transform=axes.transAxes, ha=side, fontsize=7, color=plots.GREY)
    axes.set_ylim(bottom=0.8 * LEAST[name])


def fail_to_tie(axes: plots.plt.Axes, runs: Runs) -> None:
    """How many runs of each number of bodies did not slide to the head."""
    sizes = sorted({int(float(run["bodies"])) for run in runs})
    count = [sum(run["outcome"] not in (SLID, REFERENCE) for run in runs if float(run["bodies"]) == size) for size in sizes]
    every = [sum(float(run["bodies"]) == size for run in runs) for size in sizes]
    axes.bar(range(len(sizes)), [100 * a / b for a, b in zip(count, every)], color=plots.GREY, width=0.6)
    for k, (a, b) in enumerate(zip(count, every)):
        axes.text(k, 100 * a / b + 1, f"{a} of {b}", ha="center", va="bottom", fontsize=7)
    axes.set_xticks(range(len(sizes)), [str(size) for size in sizes])
    axes.set(xlabel="number of bodies", ylabel="runs, %", ylim=(0, 115))


def draw(runs: Runs, out: Path) -> None:
    chance = next(run for run in runs if run["run"].startswith("chance"))
    whole = [run for run in runs if run["run"].startswith("whole") and run["scene"] == "table1"]
    figure, panels = plots.panels(2, 3, (11, 7.2), [
        "where the knot is", "how hard it is pushed", "how deep skins overlap", "what a run costs", f"where the knot is, steps of {FINE} ms", "runs that fail, all methods"])
    position, force, depth, cost, bodies, failures = panels
    for axes, name, label, side in ((position, "position_error_rms_cm", "knot's head end off, rms, cm", "right"), (force, "force_error_percent", "sliding force off, %", "left")):
        draw_over(axes, whole, "h_ms", name, joined=False)
        shade_chance(axes, chance, name, side)
        axes.set_ylabel(label)
    draw_over(depth, whole, "h_ms", "penetration_cm", joined=True)
    depth.set_ylabel("deepest of any step, cm")
    draw_over(cost, whole, "h_ms", "cpu_s", joined=True)
    cost.set_ylabel("CPU time, s")
    steps = sorted({float(run["h_ms"]) for run in whole})
    for axes in (position, force, depth, cost):
        axes.set(xscale="log", yscale="log", xlabel="time step, ms")
        plots.plain_ticks(axes.xaxis, steps)
    draw_over(bodies, whole, "bodies", "position_error_rms_cm", joined=False)
    shade_chance(bodies, chance, "position_error_rms_cm", "left")
    bodies.set(xscale="log", yscale="log", xlabel="number of bodies", ylabel="knot's head end off, rms, cm")
    plots.plain_ticks(bodies.xaxis, sorted({float(run["bodies"]) for run in whole}))
    fail_to_tie(failures, whole)
    handles = cost.get_legend_handles_labels()[0]
    plots.legend_above(figure, handles, len(handles), 0.045)
    plots.save(figure, out)


if __name__ == "__main__":
    run_script(__doc__, ["speed_accuracy_runs.csv", "OUT.png"], lambda table, out: draw(read_csv(table, HEAD), out))
