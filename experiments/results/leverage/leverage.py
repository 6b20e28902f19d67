"""The pull of every knot: tables, one of all runs (tables/leverage_runs.csv) among them, of which the others are made, and a figure of what
it depends on.

Usage: leverage.py SWEEPS OUT_FOLDER, with SWEEPS of study.sh (writes leverage.png and a PDF beside).
"""

from pathlib import Path

import numpy as np

import leverage_picture as picture
import plots
import tables
from hagfish_log import HagfishLog, LogError
from leverage_picture import HEAD, MESH, SWEEPS, TIME_HEAD, Runs, chosen, pulls
from pulls import Pull, read_pull, read_strand
from script import run_script
from sweep_columns import Cell, read_cells

BODIES = {"table1": "Table 1", "living": "living"}


def outcome_of(log: HagfishLog, unmet: list[str]) -> str:
    status = str(log.attribute("status"))
    if status != "complete":
        return status.removeprefix("failed: ").split(" at step")[0].split(":")[0].split(",")[0]
    if "knot held" in unmet:
        return "knot lost"
    return "pulled" if log.in_phase("pull").size else "never at the head"


def row_of(sweep: str, cell: Cell) -> tuple[list[str | float], Pull | None]:
    """Of HEAD, and the pull of a run that pulled. A value is the title in the grid; a start of 0 is exact."""
    axes = cell.axes
    scene, outcome = axes["scene"].removeprefix("pull_"), outcome_of(cell.log, cell.unmet)
    kind = "mirror" if axes.get("mirror") == "true" else sweep.partition("_")[0]
    seed = 0 if "mirror" in axes else int(axes.get("start.seed", 1))
    p = read_pull(cell.log) if outcome == "pulled" else None
    if p is not None and not p.force.size:
        outcome, p = "too short", None
    forces = [p.cap, p.mean, *(float(of) for of in (p.plate.mean(), p.rows.mean(), p.torque.mean(), p.torque.max(), p.estimate.mean()))] if p \
        else [""] * 7
    body = "living" if scene.startswith("living_") else "table1"
    return [kind, body, plots.knot_of(scene), axes.get("title", "0"), seed, outcome, *forces, float(cell.log["/steps/penetration"].max()),
            "yes" if "penetration" in cell.unmet else "no"], p


def all_of(runs: Runs, body: str, knot: str, kind: str) -> Runs:
    return [run for run in runs if (run["body"], run["knot"], run["kind"]) == (body, knot, kind)]


def knots_table(runs: Runs, seconds: Runs, out: Path) -> None:
    """Of each knot: its pull over time, and how far chance and meshes move the mean."""
    rows = []
    figures = lambda run: list(run.values())[HEAD.index("outcome"):]
    for body, label in BODIES.items():
        for knot in plots.SCENES.values():
            starts, plain = chosen(runs, body, knot, "start"), chosen(runs, body, knot, "plain")
            exact, mirrored = (list(map(figures, all_of(runs, body, knot, kind))) for kind in ("plain", "mirror"))
            own = [float(row["pull_N"]) for row in seconds if plain and (row["body"], row["knot"]) == (body, knot)]
            third = ", ".join(f"{part.mean():.2f}" for part in np.array_split(own, 3)) if len(own) > 2 else ""
            mean = lambda top, under="", of=starts: f"{np.mean([float(run[top]) / (float(run[under]) if under else 1) for run in of]):.2g}" if of \
                else ""
            rows.append([label, knot, mean("cap_N"), f"{len(starts)} of {len(all_of(runs, body, knot, 'start'))}", third,
                         tables.span(own, ".2f"), tables.span(pulls(starts), ".2f"),
                         *(tables.span(pulls([*chosen(runs, body, knot, kind), *plain]), ".2f") for kind in MESH),
                         mean("pull_N", "rows_N"), mean("pull_N", "torque_mean_N_cm"), "yes" if exact and exact == mirrored else "no"])
    tables.write_table(out, "leverage", ["body", "knot", "cap of a row, N", "pulled", "pull in the thirds of its time, N",
                                         "of its seconds, N", "means of starts, N",
                                         "of steps, N", "of numbers of bodies, N", "over the sum of the rows", "over the largest torque, 1/cm",
                                         "mirror image the same"], rows)


def work_table(plain: Path, out: Path) -> None:
    """What a slip of the whole body along itself would cost and yield, were the knot to keep its shape."""
    rows = []
    for cell in read_cells(plain):
        row, p = row_of("plain", cell)
        if p and row[0] == "plain" and row[-1] == "no":
            work = read_strand(cell.log).work
            forces = (p.mean, work["rows"], work["contacts"] + work["plate"], p.mean - sum(work.values()))
            rows.append([BODIES[row[1]], row[2], *(f"{force:.3f}" for force in forces)])
    tables.write_table(out, "leverage_work", ["body", "knot", "pull", "rows of Eq. 6", "contacts and head plate",
                                              "left to bending, limits, muscles"], rows)


def changes_table(runs: Runs, out: Path) -> None:
    """What each change makes of the pull, over that of the starts: the least and the largest of the knots that pulled."""
    rows = []
    for kind, label in SWEEPS.items():
        for value in sorted({float(run["value"]) for run in runs if run["kind"] == kind}):
            cells = []
            for body in BODIES:
                there = [run for run in runs if (run["kind"], run["body"], float(run["value"])) == (kind, body, value)]
                starts = {run["knot"]: pulls(chosen(runs, body, run["knot"], "start")) for run in there}
                ratios = [float(run["pull_N"]) / starts[run["knot"]].mean() for run in there
                          if run["pull_N"] and run["too_deep"] != "yes" and starts[run["knot"]].size]
                cells += [f"{len(ratios)} of {len(there)}" if there else "", tables.span(ratios, ".2f")]
            rows.append([f"{label}: {value:g}", *cells])
    tables.write_table(out, "leverage_changes", ["what is changed",
                                                 *(f"{label}: {what}" for label in BODIES.values()
                                                   for what in ("pulled", "pull, over that of the starts"))], rows)


def page(out: Path) -> None:
    """Of the tables of all runs and of the seconds of exact ones."""
    runs, seconds = tables.read_csv(out / "tables/leverage_runs.csv", HEAD), tables.read_csv(out / "tables/leverage_time.csv", TIME_HEAD)
    knots_table(runs, seconds, out)
    changes_table(runs, out)
    picture.draw(runs, seconds, out / "leverage.png")


def main(folder: Path, out: Path) -> None:
    names = {knot: name for name, knot in plots.SCENES.items()}
    found = sorted((row_of(sweep.name, cell) for sweep in folder.iterdir() for cell in read_cells(sweep)),
                   key=lambda run: (*run[0][:2], names[run[0][2]], *run[0][3:5]))
    if not any(p for _, p in found):
        raise LogError(f"{folder}: holds no run that pulled")
    tables.write_table(out, "leverage_runs", HEAD, [row for row, _ in found])
    tables.write_table(out, "leverage_time", TIME_HEAD, [[*row[1:3], float(second), float(force)] for row, p in found if p and row[0] == "plain"
                                                         for second, force in zip(*p.over(1))])
    page(out)
    work_table(folder / "plain", out)


if __name__ == "__main__":
    run_script(__doc__, ["SWEEPS", "OUT_FOLDER"], main)
