"""Whole runs of the Table 1 scene: where the knot is, how hard it is pushed and how deep skins overlap, against CPU
time, over step, body count, rule, back end and activation. The reference is 100 bodies at 0.5 ms by the midpoint rule.

Usage: whole_runs.py RUNS OUT.csv OUT.png (writes a PDF beside).
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.lines import Line2D

import plots
from hagfish_log import LogError
from plots import GREY, INK
from script import run_script
from study import FORCE_WINDOW, Run, pareto, path_error, read_runs
from tables import write_csv

REFERENCE = "whole_100_0.0005_midpoint_active-set"
# Body counts, told apart by marker too; Paul Tol's muted colours for those that tie.
LOOKS = {25: ("#999999", "x"), 35: ("#ddcc77", "v"), 50: ("#44aa99", "s"), 70: ("#88ccee", "^"), 100: ("#332288", "o"),
         140: ("#cc6677", "D"), 200: ("#882255", "P")}
# Columns, and which runs each shows.
METHODS = {"Euler": lambda run: run.qp == "active-set" and run.activation == "speculative" and run.rule == "euler",
           "midpoint": lambda run: run.rule == "midpoint",
           "violated rows": lambda run: run.qp == "active-set" and run.activation == "violated",
           "Ipopt": lambda run: run.qp == "ipopt"}
LABELS_APART = 1.2  # ratio of times
FAILURE_TICKS = (0.05, 0.1, 0.2, 0.5)  # s
TIMES_BEYOND = (0.5, 1.5)  # of the shortest and longest time: room for the step beside it
CHANCE_STEPS = (0.0005, 0.002)  # s, of the starts that differ by rounding: the reference's and the default
BELOW_CHANCE = 5  # a panel ends at this part of chance
AT_EDGE = 1.2  # times the end of a panel, where a preset is drawn that is below


def errors(run: Run, reference: Run) -> dict[str, float]:
    """The three measures of the figure."""
    return {"position": path_error(run, reference)[0], "force": 100 * abs(run.force / reference.force - 1),
            "penetration": run.penetration}


# Title and axis label of each.
PANELS = {"position": ("position of the knot", "error of the knot's head end, rms, cm"),
          "force": ("sliding force", "sliding force off the reference, %"),
          "penetration": ("penetration", "deepest penetration of any step, cm")}


def reference_of(runs: list[Run]) -> Run:
    for run in runs:
        if run.name == REFERENCE and not run.failure:
            return run
    raise LogError(f"{REFERENCE}: the reference is missing or failed")


@dataclass
class Chance:
    """What starts that differ by rounding alone come to: the largest difference between any two. None smaller means
    anything."""

    starts: int
    position: float  # of the knot's head end, rms over the slide, cm
    pointwise: float  # at any frame, cm
    force: float  # %
    force_spread: float  # standard deviation, %

    def of(self, what: str) -> float:
        """In one of PANELS; 0 where runs are not compared with another."""
        return {"position": self.position, "force": self.force}.get(what, 0.0)


def chance(folder: Path, step: float) -> Chance:
    runs = [run for run in read_runs(folder, f"chance_{step:g}") if not run.failure]
    if len(runs) < 2:
        raise LogError(f"{folder}: of the runs chance_{step:g}_*, {len(runs)} slid")
    away = np.array([path_error(*pair) for pair in combinations(runs, 2)])
    force = np.array([run.force for run in runs])
    return Chance(len(runs), *map(float, away.max(axis=0)), float(100 * np.ptp(force) / force.mean()),
                  float(100 * force.std(ddof=1) / force.mean()))


def front_of(runs: list[Run], reference: Run, what: str, floor: float) -> list[Run]:
    """The Pareto front in CPU time and one measure, by rising time; within chance, `floor`, the cheapest is as good as any.
    The reference has no error to compare."""
    able = [run for run in runs if not run.failure and (run is not reference or what == "penetration")]
    front = pareto(np.array([run.cpu for run in able]),
                   np.array([max(floor, errors(run, reference)[what]) for run in able]))
    return [able[k] for k in front]


def series(runs: list[Run]) -> list[list[Run]]:
    """Runs that differ by their step alone, by rising step."""
    groups: dict[Any, list[Run]] = {}
    for run in runs:
        groups.setdefault((run.bodies, run.qp, run.activation, run.rule, run.scene), []).append(run)
    return [sorted(group, key=lambda run: run.step) for group in groups.values()]


def draw(axes: Any, runs: list[Run], reference: Run, what: str) -> None:
    """A line for each body count, over its steps."""
    for group in series([run for run in runs if not run.failure]):
        group = [run for run in group if run is not reference or what == "penetration"]
        if not group:
            continue
        colour, marker = LOOKS[group[0].bodies]
        filled = group[0].activation == "speculative"
        axes.loglog([run.cpu for run in group], [errors(run, reference)[what] for run in group], marker=marker,
                    ls="-" if filled else ":", color=colour, ms=4.5, lw=0.9, mfc=colour if filled else "white")


def draw_front(axes: Any, front: list[Run], own: list[Run], reference: Run, what: str) -> None:
    """Of all runs; steps stand at those that the panel shows."""
    points = [(run.cpu, errors(run, reference)[what]) for run in front]
    axes.step(*zip(*points), where="post", color=INK, lw=2.2, alpha=0.25, zorder=0)
    last, shown = 0.0, {run.name for run in own}
    for run, point in zip(front, points):
        if run.name in shown and point[0] > LABELS_APART * last:
            axes.annotate(f"{1e3 * run.step:g}", point, (-3, -3), textcoords="offset points", fontsize=7, ha="right",
                          va="top", color=LOOKS[run.bodies][0], fontweight="bold")
            last = point[0]


def draw_presets(axes: Any, presets: list[Run], reference: Run, what: str, floor: float) -> None:
    """Stars with their names, that of the quickest on its left, as the next one is near."""
    quickest = min(run.cpu for run in presets)
    for run in presets:
        point = (run.cpu, max(errors(run, reference)[what], AT_EDGE * floor / BELOW_CHANCE))
        axes.plot(*point, "*", ms=11, mfc=plots.YELLOW, mec=INK, zorder=5)
        left = run.cpu == quickest
        axes.annotate(run.name.removeprefix("preset_"), point, (-5 if left else 5, 6), textcoords="offset points",
                      fontsize=8, ha="right" if left else "left",
                      bbox={"fc": "white", "ec": "none", "pad": 0.5, "alpha": 0.8}, zorder=6)


def draw_row(row: Any, runs: list[Run], presets: list[Run], reference: Run, what: str, floor: Chance) -> None:
    """One measure: a panel for each of METHODS, the front of all runs behind."""
    chance, front = floor.of(what), front_of(runs, reference, what, floor.of(what))
    times = [run.cpu for run in runs if not run.failure]
    for axes, (words, belongs) in zip(row, METHODS.items()):
        own = [run for run in runs if belongs(run)]
        draw(axes, own, reference, what)
        draw_front(axes, front, own, reference, what)
        axes.set_xlim(TIMES_BEYOND[0] * min(times), TIMES_BEYOND[1] * max(times))
        if axes is row[0]:
            draw_presets(axes, presets, reference, what, chance)
        if chance:
            axes.set_ylim(bottom=chance / BELOW_CHANCE)
            axes.axhspan(axes.get_ylim()[0], chance, color="#eeeeee", zorder=-1)
            axes.text(0.98, 0.02, f"chance, {floor.starts} starts", transform=axes.transAxes, ha="right", va="bottom",
                      fontsize=7.5, color=GREY, bbox={"fc": "#eeeeee", "ec": "none", "pad": 0.5}, zorder=3)
    row[0].set_ylabel(PANELS[what][1])


def draw_failures(axes: Any, runs: list[Run]) -> None:
    """A row for every cause: one cross a run, at what it cost until then."""
    causes = sorted({run.failure for run in runs if run.failure})
    for row, words in enumerate(causes):
        own = [run for run in runs if run.failure == words]
        axes.scatter([run.cpu for run in own], [row] * len(own), marker="x", s=22,
                     c=[LOOKS[run.bodies][0] for run in own])
        sizes = ", ".join(str(n) for n in sorted({run.bodies for run in own}))
        count = f"{len(own)} runs" if len(own) > 1 else "one run"
        axes.text(0.02, row + 0.18, f"{words}: {count}, {sizes} bodies", fontsize=8,
                  transform=axes.get_yaxis_transform())
    axes.set_yticks([])
    axes.set_ylim(-0.5, len(causes) - 0.3)
    axes.set_xscale("log")
    plots.plain_ticks(axes.xaxis, FAILURE_TICKS)
    axes.set_xlabel("CPU time until then, s")


def legend(figure: Any) -> None:
    lines = [Line2D([], [], color=colour, marker=marker, lw=0.9, ms=5, label=f"{bodies} bodies") for bodies, (colour, marker) in LOOKS.items()]
    lines += [Line2D([], [], color=GREY, ls=":", marker="o", mfc="white", lw=0.9, ms=5, label="violated rows only"),
              Line2D([], [], color=INK, lw=2.2, alpha=0.25, label="Pareto front of all, h in ms"),
              Line2D([], [], color=INK, marker="*", ls="", mfc=plots.YELLOW, ms=10, label="preset, timed alone (lower edge: less)")]
    figure.legend(handles=lines, loc="upper center", ncols=5, fontsize=8, frameon=False)


def rows_of(runs: list[Run], reference: Run, floor: Chance) -> tuple[list[str], list[list[Any]]]:
    heading = ["scene", "bodies", "h_ms", "rule", "activation", "back_end", "cpu_s", "outcome", "position_error_rms_cm",
               "position_error_largest_cm", "tail_end_error_rms_cm", "slide_start_s", "slide_cm",
               f"force_median_of_{1000 * FORCE_WINDOW:g}_ms_means_dyn", "force_mean_dyn", "penetration_cm", "audit_fails", "on_front"]
    fronts = {what: {run.name for run in front_of(runs, reference, what, floor.of(what))} for what in PANELS}
    rows = [[run.scene, run.bodies, 1e3 * run.step, run.rule, run.activation, run.qp, run.cpu,
             run.failure or ("reference" if run is reference else "knot slid to the head"),
             *path_error(run, reference), path_error(run, reference, "tail_end")[0], run.slide_at, run.slide, run.force,
             run.force_mean, run.penetration, "; ".join(run.unmet),
             " ".join(what for what in PANELS if run.name in fronts[what])] for run in runs]
    return heading, rows


def main(folder: Path, csv: Path, png: Path) -> None:
    runs = read_runs(folder, "whole")
    reference = reference_of(runs)
    floor = chance(folder, reference.step)
    write_csv(csv, *rows_of(runs, reference, floor))
    figure = plots.plt.figure(figsize=(12, 11.5), layout="constrained")
    figure.get_layout_engine().set(rect=(0, 0, 1, 0.955))
    grid = figure.add_gridspec(len(PANELS) + 1, len(METHODS), height_ratios=[1] * len(PANELS) + [0.75])
    presets, first, lettered = read_runs(folder, "preset"), None, []
    for place, what in enumerate(PANELS):
        row: list[Any] = []
        for column in range(len(METHODS)):
            row.append(figure.add_subplot(grid[place, column], sharex=first, sharey=row[0] if row else None))
            first = first or row[0]
            row[-1].tick_params(labelleft=column == 0)
            row[-1].set_xlabel("CPU time of the run, s" if place == len(PANELS) - 1 else "")
        draw_row(row, runs, presets, reference, what, floor)
        lettered += [(axes, f"{PANELS[what][0]}, {words}") for axes, words in zip(row, METHODS)]
    failed = figure.add_subplot(grid[-1, :])
    draw_failures(failed, runs)
    plots.name_panels(*zip(*lettered, (failed, "runs that failed")))
    legend(figure)
    plots.save(figure, png)


if __name__ == "__main__":
    run_script(__doc__, ["RUNS", "OUT.csv", "OUT.png"], main)
