"""Where sliding works and what it costs, over bending stiffness and commanded speed: the grid of study.sh.

Usage: sliding_map.py SWEEP.
"""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

import plots
import tables
from script import run_script
from sweep_columns import SweepTable, read_sweep

STIFFNESS, SPEED = "model.bending_stiffness", "controller.slide_head.a"
LOOKS = [plots.Look("", plots.BLUE, "o"), plots.Look("", plots.ORANGE, "s"), plots.Look("", plots.PURPLE, "D")]
ARRIVED = "release_from_s"
TABLE_1 = 424.0  # dyn cm^2: data/table1.toml
HAGFISH = (3e4, 1.2e6)  # dyn cm^2, made of Long et al. 2002: data/specimens/pacific_hagfish.toml
POINTS = ["stiffness_dyn_cm2", "speed_cm_per_s", "starts", "tied", "at_head_by_both_ends", "passed",
          *(f"{what}_{part}" for what in ("force_dyn", "work_erg_per_cm") for part in ("lower", "median", "upper"))]


@dataclass
class Place:
    """All starts at one stiffness (dyn cm^2) and speed (cm/s); figures are of those that slid to the head by both ends."""

    stiffness: float
    speed: float
    starts: int
    tied: int
    arrived: int
    passed: int
    force: np.ndarray  # quartiles, dyn
    work: np.ndarray  # of f_thigmo for each cm of slide, erg/cm


def quartiles(values: np.ndarray) -> np.ndarray:
    known = values[np.isfinite(values)]
    return np.percentile(known, [25, 50, 75]) if known.size else np.full(3, np.nan)


def places_of(table: SweepTable) -> list[Place]:
    stiffness, speed = (np.array([float(value) for value in table.axes[key]]) for key in (STIFFNESS, SPEED))
    figures = table.figures
    found = []
    for k, v in sorted({(k, v) for k, v in zip(stiffness, speed)}):
        here = (stiffness == k) & (speed == v)
        arrived = here & np.isfinite(figures[ARRIVED]) & table.both_ends
        found.append(Place(k, v, int(here.sum()), int((here & np.isfinite(figures["tighten_from_s"])).sum()), int(arrived.sum()),
                           int((here & table.passed).sum()), quartiles(figures["sliding_force_dyn"][arrived]),
                           quartiles((figures["work_thigmotaxis_erg"] / figures["slide_distance_cm"])[arrived])))
    return found


def draw_quartiles(axes: Any, own: list[dict[str, str]], what: str, look: plots.Look) -> None:
    x, *y = (np.array([float(row[key]) for row in own if row[f"{what}_median"]])
             for key in (POINTS[0], *(f"{what}_{part}" for part in ("lower", "median", "upper"))))
    axes.fill_between(x, y[0], y[2], color=look.colour, alpha=0.25, lw=0)
    axes.plot(x, y[1], **(look.style | {"ms": 3}))


def draw(rows: list[dict[str, str]], out: Path) -> None:
    figure, (works, force, work) = plots.panels(1, 3, (plots.WIDTH, 3.1), ["every bound met", "force", "work"])
    for look, v in zip(LOOKS, dict.fromkeys(row[POINTS[1]] for row in rows)):
        own = [row for row in rows if row[POINTS[1]] == v]
        share = lambda what: [100 * float(row[what]) / float(row["starts"]) for row in own]
        works.plot([float(row[POINTS[0]]) for row in own], share("passed"), **(look.style | {"ms": 3}), label=f"{v} cm/s")
        for axes, what in ((force, "force_dyn"), (work, "work_erg_per_cm")):
            draw_quartiles(axes, own, what, look)
    works.plot([float(row[POINTS[0]]) for row in own], share("tied"), color=plots.INK, lw=0.8, ls=":", label="knot tied")
    works.axvspan(*HAGFISH, color=plots.GRID, lw=0)
    works.text(np.sqrt(np.prod(HAGFISH)), 50, "a hagfish's own", fontsize=8, rotation=90, ha="center", va="center")
    for axes in (works, force, work):
        axes.axvline(TABLE_1, color=plots.GREY, lw=0.8, ls="--", zorder=0, label="Table 1's body")
        axes.set(xscale="log", xlabel="bending stiffness EI,\ndyn cm²")
    works.set(ylabel="starts, %", ylim=(-4, 104))
    plots.plain_ticks(works.xaxis, [10, 100, 1e3, 1e4, 1e5, 1e6])
    works.set_xticklabels(["10", "100", "10³", "10⁴", "10⁵", "10⁶"])
    for axes, label in ((force, "sum of $\\lambda/h$ while sliding, dyn"), (work, "work of f_thigmo, erg/cm")):
        axes.set(yscale="log", ylabel=label)
        plots.plain_ticks(axes.xaxis, [10, 30, 100, 300, 1000])
        plots.plain_ticks(axes.yaxis, [100, 200, 500, 1000, 2000, 5000, 10000])
    plots.legend_above(figure, works.get_legend_handles_labels()[0], 5, 0.08, columnspacing=1.2)
    plots.save(figure, out)


def by_speed(places: list[Place]) -> list[list[str]]:
    """A row a speed, and one of all: how many starts tie, slide to the head by both ends and meet every bound; from which stiffness on all do;
    what the stiffest body that slides takes, over the softest."""
    def counts(own: list[Place]) -> list[str]:
        total = lambda what: sum(getattr(p, what) for p in own)
        return [f"{total('tied')} of {total('starts')}", f"{total('arrived')} of {total('tied')}",
                f"{100 * total('passed') / total('tied'):.0f} %"]

    rows = []
    for speed in sorted({p.speed for p in places}):
        own = sorted((p for p in places if p.speed == speed), key=lambda p: p.stiffness)
        known = [p for p in own if p.tied]
        good = next((f"{p.stiffness:.2g}" for k, p in enumerate(known) if all(q.passed == q.tied for q in known[k:])), "none")
        both = [p for p in known if p.arrived]
        over = lambda what: f"{getattr(both[-1], what)[1] / getattr(both[0], what)[1]:.1f}"
        rows.append([f"{speed:g}", *counts(own), good, over("force"), over("work")])
    return [*rows, ["all", *counts(places), "", "", ""]]


def by_stiffness(places: list[Place]) -> list[list[str]]:
    """A row a stiffness from the first on that does not always tie."""
    rows = []
    for stiffness in sorted({p.stiffness for p in places}):
        own = [p for p in places if p.stiffness == stiffness]
        tied, starts = sum(p.tied for p in own), sum(p.starts for p in own)
        if tied < starts or rows:
            rows.append([f"{stiffness:.3g}", f"{tied} of {starts}"])
    return rows


def write_tables(places: list[Place], out: Path) -> None:
    tables.write_table(out, "sliding", ["commanded speed, cm/s", "tied", "of these slid to the head by both ends", "and met every bound",
                                        "all do from this stiffness on, dyn cm²", "force, stiffest over softest body",
                                        "work, the same"], by_speed(places))
    tables.write_table(out, "sliding_stiffness", ["bending stiffness, dyn cm²", "starts that tie"], by_stiffness(places))


def write_points(places: list[Place], out: Path) -> None:
    """What the figure is drawn from."""
    tables.write_table(out, "sliding_points", POINTS, [
        [p.stiffness, f"{p.speed:g}", p.starts, p.tied, p.arrived, p.passed,
         *("" if np.isnan(value) else float(value) for value in (*p.force, *p.work))] for p in places])


def main(folder: Path) -> None:
    places = places_of(read_sweep(folder / "table.csv"))
    write_tables(places, folder)
    write_points(places, folder)
    draw(tables.read_csv(folder / "tables/sliding_points.csv", POINTS), folder / "sliding.png")


if __name__ == "__main__":
    run_script(__doc__, ["SWEEP"], main)
