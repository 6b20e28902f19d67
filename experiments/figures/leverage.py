"""The pull of every knot: tables, a CSV of all runs (tables/leverage_runs.csv), and a figure of what it depends on.

Usage: leverage.py RUNS OUT.png OUT.md (writes a PDF beside).
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

import audits
import leverage_picture as picture
import plots
import tables
from hagfish_log import HagfishLog, LogError
from leverage_picture import BASE, HEAD, SWEEPS
from pulls import NEWTON, Pull, read_pull, read_strand, settled
from script import run_script

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


def outcome_of(log: HagfishLog, unmet: list[str]) -> str:
    status = str(log.attribute("status"))
    if status != "complete":
        return status.removeprefix("failed: ").split(" at step")[0].split(":")[0].split(",")[0]
    if "knot held" in unmet:
        return "knot lost"
    return "pulled" if log.in_phase("pull").size else "never at the head"


def read_run(path: Path) -> Run:
    name = path.name.removesuffix(".check.csv")
    kind, body, knot, value, seed = name.split("-")
    log = HagfishLog(path.parent / f"{name}.h5")
    unmet = audits.unmet(audits.read_findings(path))
    outcome = outcome_of(log, unmet)
    pull = read_pull(log) if outcome == "pulled" else None
    if pull is not None and not pull.force.size:
        outcome, pull = "too short", None
    deepest = float(log["/steps/penetration"].max())
    return Run(kind, body, plots.SCENES[knot], value, int(seed), outcome, pull, deepest, "penetration" in unmet)


def chosen(runs: Iterable[Run], body: str, knot: str, *kinds: str, value: str | None = None) -> list[Run]:
    return [run for run in runs if run.body == body and run.knot == knot and run.kind in kinds and value in (None, run.value)]


def spread(values: list[float], digits: int = 2) -> str:
    """Mean ± standard deviation."""
    if not values:
        return "none"
    return f"{np.mean(values):.{digits}f}" + (f" ± {np.std(values, ddof=1):.{digits}f}" if len(values) > 1 else "")


def starts_table(runs: list[Run], out: Path) -> list[str]:
    rows = []
    for body, label in BODIES.items():
        for knot in plots.SCENES.values():
            all_starts = chosen(runs, body, knot, "start")
            pulls = [run.pull for run in all_starts if run.pull]
            mirrored, plain = ([(run.outcome, run.pull and run.pull.mean) for run in chosen(runs, body, knot, kind)]
                               for kind in ("mirror", "plain"))
            same = "yes" if plain and mirrored == plain else "no"
            of_each = lambda figure, digits=2: spread([float(figure(pull)) for pull in pulls], digits)
            deepest = max((run.overlap for run in all_starts), default=np.nan)
            rows.append([label, knot, f"{len(pulls)} of {len(all_starts)}", of_each(lambda p: p.mean, 3),
                         of_each(lambda p: p.force.std(), 3), of_each(lambda p: p.mean / p.sum),
                         of_each(lambda p: p.mean / p.rows.mean(axis=0).max()), of_each(lambda p: p.torque.mean()),
                         of_each(lambda p: p.mean / p.torque.mean()), of_each(lambda p: p.mean / p.estimate),
                         of_each(lambda p: np.linalg.norm(np.nanmean(p.bearing, axis=0)), 1), f"{deepest:.4f}", same])
    return tables.of_page(out, "leverage", ["body", "knot", "pulled", "pull, N", "it swings by, N", "over the sum of the rows",
                            "over the largest row", "largest torque, N cm", "pull over it, 1/cm", "over the rope estimate",
                            "plate's force off the head by, cm", "deepest overlap, cm", "mirror image the same"], rows)


def work_table(folder: Path, out: Path) -> list[str]:
    """What a slip of the whole body along itself would cost and yield, were the knot to keep its shape."""
    rows = []
    for body, label in BODIES.items():
        for scene, knot in plots.SCENES.items():
            path = folder / f"plain-{body}-{scene}-0-1.h5"
            if not path.is_file() or not settled(log := HagfishLog(path)).size:
                continue
            pull, work = read_pull(log).mean, read_strand(log).work
            rows.append([label, knot, f"{pull:.3f}", *(f"{work[key]:.3f}" for key in ("rows", "contacts", "plate")),
                         f"{pull - sum(work.values()):.3f}"])
    head = ["body", "knot", "pull", "rows of Eq. 6", "contacts", "head plate", "left to bending, limits, muscles"]
    return tables.of_page(out, "leverage_work", head, rows)


def points(runs: list[Run], body: str, knot: str, kind: str) -> list[tuple[float, float]]:
    """Value and pull, N, of the runs that pulled, and the mean of the starts."""
    found = [(float(run.value), run.pull.mean) for run in chosen(runs, body, knot, kind) if run.pull]
    starts = [run.pull.mean for run in chosen(runs, body, knot, "start") if run.pull]
    return sorted(found + [(BASE[kind][body], float(np.mean(starts)))] * bool(starts))


def sweep_table(runs: list[Run], kind: str, out: Path) -> list[str]:
    values = sorted({float(run.value) for run in runs if run.kind == kind} | set(BASE[kind].values()))
    rows = []
    for body in BASE[kind]:
        for knot in plots.SCENES.values():
            there = chosen(runs, body, knot, kind)
            pulls = dict(points(runs, body, knot, kind))
            deep = {float(run.value) for run in there if run.deep}
            failed = {float(run.value): run.outcome for run in there if not run.pull}
            cells = [f"{pulls[v]:.3f}" + "*" * (v in deep) if v in pulls else failed.get(v, "") for v in values]
            rows.append([BODIES[body], knot, *cells])
    return tables.of_page(out, f"leverage_{kind}", ["body", "knot", *(f"{v:g}" for v in values)], rows)


def summary_table(runs: list[Run], out: Path) -> list[str]:
    """What each change makes of the pull, over that of the starts: the least and the largest of the knots that pulled."""
    rows = []
    for kind, label in SWEEPS.items():
        for body in BASE[kind]:
            for value in sorted({float(run.value) for run in runs if run.kind == kind and run.body == body}):
                ratios = []
                for knot in plots.SCENES.values():
                    starts = [run.pull.mean for run in chosen(runs, body, knot, "start") if run.pull]
                    ratios += [run.pull.mean / np.mean(starts) for run in chosen(runs, body, knot, kind) if run.pull and starts and float(run.value) == value]
                rows.append([f"{label}: {value:g}", BODIES[body], f"{len(ratios)} of {len(plots.SCENES)}",
                             f"{min(ratios):.2f} to {max(ratios):.2f}" if ratios else ""])
    return tables.of_page(out, "leverage_changes", ["what is changed", "body", "pulled", "pull, over that of the starts"], rows)


def csv_row(run: Run) -> list[str | float]:
    deep = "yes" if run.deep else "no"
    if not run.pull:
        return [run.kind, run.body, run.knot, run.value, run.seed, run.outcome, *[""] * (len(HEAD) - 8), run.overlap, deep]
    p = run.pull
    torque = float(p.torque.mean())
    return [run.kind, run.body, run.knot, run.value, run.seed, run.outcome, p.mean, float(p.force.std()),
            float(p.plate.mean()), p.sum, float(p.rows.mean(axis=0).max()), torque, float(p.torque.max()), p.mean / p.sum,
            p.mean / torque, p.estimate, *map(float, p.turn.mean(axis=0)), run.overlap, deep]


def main(folder: Path, out: Path, page: Path) -> None:
    runs = [read_run(path) for path in sorted(folder.glob("*-*-*-*-*.check.csv"))]
    if not any(run.pull for run in runs):
        raise LogError(f"{folder}: holds no run that pulled")
    (page.parent / "tables").mkdir(parents=True, exist_ok=True)
    table = page.parent / "tables/leverage_runs.csv"
    tables.write_csv(table, HEAD, [csv_row(run) for run in runs])
    picture.draw(tables.read_csv(table, HEAD), out)
    note = "Pulls in N, means over the settled pull; ± is the standard deviation over starts; * overlaps too deep for its scene."
    lines = ["# Leverage", "", note, "", *starts_table(runs, page.parent)]
    lines += ["## Work, N cm for each cm that the head is drawn in", "", *work_table(folder, page.parent)]
    lines += ["## Each change", "", *summary_table(runs, page.parent)]
    for kind, label in SWEEPS.items():
        lines += [f"## By {label}", "", *sweep_table(runs, kind, page.parent)]
    tables.write_page(page, lines)


if __name__ == "__main__":
    run_script(__doc__, ["RUNS", "OUT.png", "OUT.md"], main)
