"""The animal that ties itself: torques, noisy starts, other animals, the paper's claims, and sweeps of stiffness, drag and haste.

Usage: living.py FOLDER, of the sweeps of study.sh.
"""

from collections import Counter
from dataclasses import dataclass
from pathlib import Path

import numpy as np

import claim_row
import claims
import plots
import tables
from script import run_script
from slides import failure_of, slide_of
from sweep_columns import Cell, read_cells

SWEEPS = {"stiffness": "flexural rigidity, dyn cm²", "drag": "drag, times that of the scenes", "haste": "speed of the program"}
CAPACITY = 2.7e5  # dyn cm, a guess: data/living_overhand.toml
HAGFISH = (3e4, 1.2e6)  # dyn cm^2, made of moduli, Long et al. 2002: data/specimens/pacific_hagfish.toml
PHASES = ("form", "tighten", "slide", "release")


@dataclass
class Run:
    """What one run shows; cm, dyn cm, erg."""

    knot: str
    off: bool  # the knot was tied, held, came to the head and was let go
    slid: bool  # it did, and slid by both ends
    travel: float  # of the knot's head end
    share: float  # of a slide by both ends, %
    met: float  # share of sliding steps that meet Eq. 6
    force: float  # median of the sum of the multipliers of Eq. 6 / h while sliding, dyn
    penetration: float
    torque: dict[str, float]  # largest of the muscles at a hinge, by phase


def run_of(cell: Cell) -> Run:
    log, slide = cell.log, slide_of(cell, "slide")
    torque = np.abs(np.nan_to_num(log["/forces/active"])).max(axis=1)  # no step begins at the end
    frames = {phase: log.in_phase(phase) for phase in PHASES}
    off = not failure_of(log, cell.unmet)
    return Run(plots.knot_of(cell.axes["scene"]), off, off and cell.both_ends, slide.travel, cell.figures["both_ends_percent"],
               slide.met, slide.force, float(log["/steps/penetration"].max()),
               {phase: float(torque[rows].max()) if rows.size else np.nan for phase, rows in frames.items()})


def runs_of(sweep: Path) -> list[list[Run]]:
    """By knot."""
    runs = [run_of(cell) for cell in read_cells(sweep)]
    return [[run for run in runs if run.knot == knot] for knot in plots.SCENES.values()]


def claims_table(folder: Path) -> None:
    """Verdicts and measures of claim_row.py over starts with a degree of noise."""
    rows = []
    every = [(plots.knot_of(cell.axes["scene"]), claim_row.judged(cell.log)) for cell in read_cells(folder / "claims")]
    for knot in plots.SCENES.values():
        judged = [row for of, row in every if of == knot]
        own = [row for row in judged if row["outcome"] == "slid"]
        others = Counter(row["outcome"] for row in judged if row["outcome"] != "slid")
        verdicts = [claims.over_runs([row[name] for row in own]) for name in claims.NAMES]
        spread = lambda what: "{1:.3g} ({0:.3g} to {2:.3g})".format(*np.percentile([row[what] for row in own], [0, 50, 100])) if own else ""
        rows.append([knot, f"{len(own)} of {len(judged)}", *verdicts, *map(spread, claim_row.MEASURES[1:]),
                     ", ".join(f"{what}: {count}" for what, count in others.items())])
    tables.write_table(folder, "living_claims", ["knot", "let go at the head", *claims.NAMES, "beyond, dyn cm",
                                              "near over far", "roughness along the body", "in time",
                                              "Fourier modes for 95 %", "what else became of it"], rows)


def draw(sweeps: dict[str, dict[str, list[tuple[float, Run]]]], out: Path) -> None:
    figure, axes = plots.panels(1, 3, (plots.WIDTH, 3.2), [f"by {what}" for what in SWEEPS], sharey=True)
    for panel, (what, label) in zip(axes, SWEEPS.items(), strict=True):
        for knot, runs in sweeps[what].items():
            look = plots.KNOTS[knot]
            for fill, line, own in ((None, "-", runs), ("white", "", [each for each in runs if not each[1].slid])):
                panel.plot([value for value, _ in own], [run.torque["form"] / 1e3 for _, run in own], **look.style, mfc=fill, ls=line)
        panel.axhline(CAPACITY / 1e3, color=plots.GREY, ls="--", lw=0.8)
        panel.set(xscale="log", yscale="log", xlabel=label, ylim=(14, 350))
        plots.plain_ticks(panel.xaxis, [value for value, _ in runs])
    axes[0].axvspan(*HAGFISH, color=plots.GRID, lw=0)
    axes[0].text(HAGFISH[0], 15, " by moduli", fontsize=8, va="bottom")
    axes[0].set(ylabel="largest torque of the muscles at a\nhinge while the knot forms, 1000 dyn cm", xlim=(250, 2e6))
    plots.plain_ticks(axes[0].xaxis, [1e3, 1e4, 1e5, 1e6])
    axes[0].set_xticklabels(["10³", "10⁴", "10⁵", "10⁶"])
    plots.plain_ticks(axes[0].yaxis, [20, 50, 100, 200])
    handles = plots.knot_handles(axes[0])
    handles += axes[0].plot([], [], color=plots.INK, marker="o", mfc="white", ls="", label="not slid off by both ends")
    handles += axes[0].plot([], [], color=plots.GREY, ls="--", lw=0.8, label="a guess at the capacity")
    plots.legend_above(figure, handles, 3, 0.13)
    plots.save(figure, out)


def sweep_rows(sweeps: dict[str, dict[str, list[tuple[float, Run]]]]) -> list[list[str]]:
    """A row a value of each sweep: how many knots slide off by both ends, the least share of that of those that come off, %, and the
    span of the largest torques of those that slide so while they form, dyn cm."""
    rows = []
    for what, label in SWEEPS.items():
        for value in sorted({value for runs in sweeps[what].values() for value, _ in runs}):
            own = [run for runs in sweeps[what].values() for each, run in runs if each == value]
            torques, shares = [run.torque["form"] for run in own if run.slid], [run.share for run in own if run.off]
            rows.append([f"{label}: {value:g}", f"{len(torques)} of {len(own)}", f"{min(shares):.0f}" if shares else "",
                         f"{min(torques):.2g} to {max(torques):.2g}" if torques else ""])
    return rows


def off(runs: list[Run]) -> list[Run]:
    return [run for run in runs if run.off]


def came_off(runs: list[Run]) -> str:
    """How many knots come off, how many of these by both ends, and the least share of that, %."""
    return f"{len(off(runs))}; {sum(run.slid for run in runs)}; {min(run.share for run in off(runs)):.0f}"


def main_table(folder: Path) -> None:
    held, free = ([run for run, in runs_of(folder / name)] for name in ("held", "free"))
    animals = list(map(off, runs_of(folder / "animals")))
    programs = [cell.log.scene()["script"]["curvature"] for cell in read_cells(folder / "held")]
    large = lambda value: tables.short(value, ".1e")
    slid = lambda run: f"{run.travel:.1f}; {run.share:.0f}; {100 * run.met:.0f}"
    met = [[100 * run.met for run in runs if np.isfinite(run.met)] for runs in animals]
    tables.write_table(folder, "living", ["h = 5 ms, `active-set`", *plots.SCENES.values()], [
        ["clamped: way of the knot's head end, cm; share of a slide by both ends, %; steps that meet Eq. 6, %", *map(slid, held)],
        ["free, no plate: the same", *map(slid, free)],
        ["deepest penetration at any step, release included, cm", *(f"{max(a.penetration, b.penetration):.4f}" for a, b in zip(held, free))],
        ["sum of λ/h of all rows while sliding, clamped, median, dyn", *(large(run.force) for run in held)],
        ["largest torque of the muscles at a hinge, forming; sliding, dyn cm", *(f"{large(run.torque['form'])}; {large(run.torque['slide'])}" for run in held)],
        ["values of the program: stations x times", *(f"{len(each['stations'])} x {len(each['times'])}" for each in programs)],
        ["of 20 starts with 3 degrees (3_1: 5) of noise on every hinge, clamped: tied, kept and off; of these by both ends; least share, %",
         *map(came_off, runs_of(folder / "heldstart"))],
        ["free: the same", *map(came_off, runs_of(folder / "freestart"))],
        ["of 10 other animals, clamped: the same", *map(came_off, animals)],
        ["of those off: sliding steps that meet Eq. 6, %: median, least", *(f"{np.median(each):.0f}, {min(each):.0f}" for each in met)]])


def main(folder: Path) -> None:
    sweeps: dict[str, dict[str, list[tuple[float, Run]]]] = {}
    for what in SWEEPS:
        found = [(float(cell.axes["title"]), run_of(cell)) for cell in read_cells(folder / what)]
        sweeps[what] = {knot: [each for each in found if each[1].knot == knot] for knot in plots.SCENES.values()}
    draw(sweeps, folder / "living.png")
    main_table(folder)
    claims_table(folder)
    tables.write_table(folder, "living_sweeps", ["what is changed", "knots tied and slid off by both ends",
                                                 "least share of a slide by both ends, %", "largest torque of the muscles at a hinge while forming, dyn cm"],
                       sweep_rows(sweeps))


if __name__ == "__main__":
    run_script(__doc__, ["FOLDER"], main)
