"""The pull of every knot: tables, one of all runs (tables/leverage_runs.csv) among them, and a figure of what it depends on.

Usage: leverage.py SWEEPS OUT_FOLDER, with SWEEPS of study.sh (writes leverage.png and a PDF beside).
"""

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

import leverage_picture as picture
import plots
import tables
from hagfish_log import HagfishLog, LogError
from leverage_picture import HEAD, MESH, SWEEPS, TIME_HEAD
from pulls import Pull, read_pull, read_strand
from script import run_script
from sweep_columns import Cell, read_cells

BODIES = {"table1": "Table 1", "living": "living"}


@dataclass
class Run:
    kind: str
    body: str
    knot: str
    value: str
    seed: int
    outcome: str  # "pulled", or why not
    pull: Pull | None  # of a run that pulled
    overlap: float  # deepest at any step, cm
    deep: bool  # deeper than the scene allows
    path: Path = Path()  # of its log


def outcome_of(log: HagfishLog, unmet: list[str]) -> str:
    status = str(log.attribute("status"))
    if status != "complete":
        return status.removeprefix("failed: ").split(" at step")[0].split(":")[0].split(",")[0]
    if "knot held" in unmet:
        return "knot lost"
    return "pulled" if log.in_phase("pull").size else "never at the head"


def run_of(sweep: str, cell: Cell) -> Run:
    """A value is the title in the grid; a start of 0 is exact."""
    axes = cell.axes
    scene, outcome = axes["scene"].removeprefix("pull_"), outcome_of(cell.log, cell.unmet)
    kind = "mirror" if axes.get("mirror") == "true" else sweep.partition("_")[0]
    seed = 0 if "mirror" in axes else int(axes.get("start.seed", 1))
    pull = read_pull(cell.log) if outcome == "pulled" else None
    if pull is not None and not pull.force.size:
        outcome, pull = "too short", None
    return Run(kind, "living" if scene.startswith("living_") else "table1", plots.knot_of(scene), axes.get("title", "0"), seed, outcome, pull,
               float(cell.log["/steps/penetration"].max()), "penetration" in cell.unmet, cell.path)


def chosen(runs: Iterable[Run], body: str, knot: str, kind: str) -> list[Run]:
    return [run for run in runs if (run.body, run.knot, run.kind) == (body, knot, kind)]


def pulls_of(runs: Iterable[Run]) -> list[Pull]:
    """Of those whose strands are not too deep in each other: what a crushed knot pulls is no pull."""
    return [run.pull for run in runs if run.pull and not run.deep]


def knots_table(runs: list[Run], out: Path) -> None:
    """Of each knot: its pull over time, and how far chance and meshes move the mean."""
    rows = []
    for body, label in BODIES.items():
        for knot in plots.SCENES.values():
            pulls = pulls_of(starts := chosen(runs, body, knot, "start"))
            plain, mirrored = (chosen(runs, body, knot, kind) for kind in ("plain", "mirror"))
            same = [(run.outcome, run.pull and run.pull.mean) for run in plain] == [(run.outcome, run.pull and run.pull.mean)
                                                                                    for run in mirrored]
            seconds = [force for pull in pulls_of(plain) for force in pull.over(1)[1]]
            third = ", ".join(f"{part.mean():.2f}" for part in np.array_split(seconds, 3)) if len(seconds) > 2 else ""
            mean = lambda figure: f"{np.mean([figure(pull) for pull in pulls]):.2g}" if pulls else ""
            rows.append([label, knot, mean(lambda p: p.cap), f"{len(pulls)} of {len(starts)}", third, tables.span(seconds, ".2f"),
                         tables.span((pull.mean for pull in pulls), ".2f"),
                         *(tables.span((pull.mean for pull in pulls_of([*chosen(runs, body, knot, kind), *plain])), ".2f") for kind in MESH),
                         mean(lambda p: p.mean / p.rows.mean()), mean(lambda p: p.mean / p.torque.mean()),
                         "yes" if plain and same else "no"])
    tables.write_table(out, "leverage", ["body", "knot", "cap of a row, N", "pulled", "pull in the thirds of its time, N",
                                         "of its seconds, N", "means of starts, N",
                                         "of steps, N", "of numbers of bodies, N", "over the sum of the rows", "over the largest torque, 1/cm",
                                         "mirror image the same"], rows)


def time_table(runs: list[Run], out: Path) -> None:
    rows = [[run.body, run.knot, float(second), float(force)] for run in runs if run.kind == "plain" and run.pull for second,
            force in zip(*run.pull.over(1))]
    tables.write_table(out, "leverage_time", TIME_HEAD, rows)


def work_table(runs: list[Run], out: Path) -> None:
    """What a slip of the whole body along itself would cost and yield, were the knot to keep its shape."""
    rows = []
    for body, label in BODIES.items():
        for knot in plots.SCENES.values():
            for run in chosen(runs, body, knot, "plain"):
                if not pulls_of([run]):
                    continue
                pull, work = run.pull.mean, read_strand(HagfishLog(run.path)).work
                rows.append([label, knot, *(f"{force:.3f}" for force in (pull, work["rows"], work["contacts"] + work["plate"],
                                                                         pull - sum(work.values())))])
    tables.write_table(out, "leverage_work", ["body", "knot", "pull", "rows of Eq. 6", "contacts and head plate",
                                              "left to bending, limits, muscles"], rows)


def changes_table(runs: list[Run], out: Path) -> None:
    """What each change makes of the pull, over that of the starts: the least and the largest of the knots that pulled."""
    rows = []
    for kind, label in SWEEPS.items():
        for value in sorted({float(run.value) for run in runs if run.kind == kind}):
            cells = []
            for body in BODIES:
                there = [run for run in runs if (run.kind, run.body, float(run.value)) == (kind, body, value)]
                ratios = [pull.mean / np.mean([start.mean for start in starts]) for run in there for pull in pulls_of([run])
                          if (starts := pulls_of(chosen(runs, body, run.knot, "start")))]
                cells += [f"{len(ratios)} of {len(there)}" if there else "", tables.span(ratios, ".2f")]
            rows.append([f"{label}: {value:g}", *cells])
    tables.write_table(out, "leverage_changes", ["what is changed",
                                                 *(f"{label}: {what}" for label in BODIES.values()
                                                   for what in ("pulled", "pull, over that of the starts"))], rows)


def csv_row(run: Run) -> list[str | float]:
    deep = "yes" if run.deep else "no"
    if not run.pull:
        return [run.kind, run.body, run.knot, run.value, run.seed, run.outcome, *[""] * (len(HEAD) - 8), run.overlap, deep]
    p = run.pull
    return [run.kind, run.body, run.knot, run.value, run.seed, run.outcome, p.cap, p.mean, float(p.plate.mean()), float(p.rows.mean()),
            float(p.torque.mean()), float(p.torque.max()), float(p.estimate.mean()), run.overlap, deep]


def main(folder: Path, out: Path) -> None:
    runs = [run_of(sweep.name, cell) for sweep in sorted(folder.iterdir()) for cell in read_cells(sweep)]
    names = {knot: name for name, knot in plots.SCENES.items()}
    runs.sort(key=lambda run: (run.kind, run.body, names[run.knot], run.value, run.seed))
    if not any(run.pull for run in runs):
        raise LogError(f"{folder}: holds no run that pulled")
    knots_table(runs, out)
    time_table(runs, out)
    work_table(runs, out)
    changes_table(runs, out)
    table = out / "tables/leverage_runs.csv"
    tables.write_csv(table, HEAD, [csv_row(run) for run in runs])
    picture.draw(tables.read_csv(table, HEAD), tables.read_csv(out / "tables/leverage_time.csv", TIME_HEAD), out / "leverage.png")


if __name__ == "__main__":
    run_script(__doc__, ["SWEEPS", "OUT_FOLDER"], main)
