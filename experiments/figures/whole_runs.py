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

import speed_accuracy_picture as picture
from hagfish_log import LogError
from script import run_script
from study import Run, pareto, path_error, read_runs
from tables import read_csv, write_csv

REFERENCE = "whole_100_0.0005_midpoint_active-set"
CHANCE_STEPS = (0.0005, 0.002)  # s, of the starts that differ by rounding: the reference's and the default
MEASURES = ("position", "force", "penetration")


def errors(run: Run, reference: Run) -> dict[str, float]:
    """MEASURES of a run."""
    return {"position": path_error(run, reference)[0], "force": 100 * abs(run.force / reference.force - 1),
            "penetration": run.penetration}


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
        """In one of MEASURES; 0 where runs are not compared with another."""
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


def rows_of(runs: list[Run], reference: Run, floor: Chance) -> list[list[Any]]:
    """A row a run, and what chance makes of its errors."""
    fronts = {what: {run.name for run in front_of(runs, reference, what, floor.of(what))} for what in MEASURES}
    rows: list[list[Any]] = [[
        run.name, run.scene, run.bodies, 1e3 * run.step, run.rule, run.activation, run.qp, run.cpu,
        run.failure or (picture.REFERENCE if run is reference else picture.SLID),
        *path_error(run, reference), path_error(run, reference, "tail_end")[0], run.slide_at, run.slide, run.force,
        errors(run, reference)["force"], run.force_mean, run.penetration, "; ".join(run.unmet),
        " ".join(what for what in MEASURES if run.name in fronts[what])] for run in runs]
    chance = dict.fromkeys(picture.HEAD, "") | {"run": f"chance, {floor.starts} starts", "position_error_rms_cm": floor.position,
                                                "position_error_largest_cm": floor.pointwise, "force_error_percent": floor.force}
    return [*rows, list(chance.values())]


def main(folder: Path, csv: Path, png: Path) -> None:
    runs = read_runs(folder, "whole")
    reference = reference_of(runs)
    csv.parent.mkdir(parents=True, exist_ok=True)
    write_csv(csv, picture.HEAD, rows_of(runs, reference, chance(folder, reference.step)))
    picture.draw(read_csv(csv, picture.HEAD), png)


if __name__ == "__main__":
    run_script(__doc__, ["RUNS", "OUT.csv", "OUT.png"], main)
