"""Where sliding works and what it costs, over bending stiffness and commanded speed: the grid of study.sh.

Usage: sliding_map.py SWEEP.
"""

from __future__ import annotations

from collections import Counter
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


@dataclass
class Place:
    """All starts at one stiffness (dyn cm^2) and speed (cm/s); figures are of those that came to the head."""

    stiffness: float
    speed: float
    starts: int
    tied: int
    arrived: int
    passed: int
    force: np.ndarray  # quartiles, dyn
    work: np.ndarray  # of f_thigmo for each cm of slide, erg/cm
    measured: np.ndarray  # speed, cm/s
    unmet: str  # bounds that those at the head most often missed, and how many did


def quartiles(values: np.ndarray) -> np.ndarray:
    known = values[np.isfinite(values)]
    return np.percentile(known, [25, 50, 75]) if known.size else np.full(3, np.nan)


def most_unmet(unmet: list[str], chosen: np.ndarray) -> str:
    counts = Counter(name for text, own in zip(unmet, chosen) if own and text for name in text.split("; "))
    return ", ".join(f"{name}: {count}" for name, count in counts.most_common(2))


def places_of(table: SweepTable) -> list[Place]:
    stiffness, speed = (np.array([float(value) for value in table.axes[key]]) for key in (STIFFNESS, SPEED))
    figures = table.figures
    found = []
    for k, v in sorted({(k, v) for k, v in zip(stiffness, speed)}):
        here = (stiffness == k) & (speed == v)
        arrived = here & np.isfinite(figures[ARRIVED])
        found.append(Place(k, v, int(here.sum()), int((here & np.isfinite(figures["tighten_from_s"])).sum()), int(arrived.sum()),
                           int((here & table.passed).sum()), quartiles(figures["sliding_force_dyn"][arrived]),
                           quartiles((figures["work_thigmotaxis_erg"] / figures["slide_distance_cm"])[arrived]),
                           quartiles(figures["slide_speed_cm_per_s"][arrived]), most_unmet(table.texts["unmet"], arrived)))
    return found


def draw_quartiles(axes: Any, own: list[Place], measure: str, look: plots.Look, label: str) -> None:
    x, y = np.array([p.stiffness for p in own]), np.array([getattr(p, measure) for p in own])
    axes.fill_between(x, y[:, 0], y[:, 2], color=look.colour, alpha=0.25, lw=0)
    axes.plot(x, y[:, 1], **(look.style | {"ms": 3}))
    last = np.flatnonzero(np.isfinite(y[:, 1]))[-1]
    axes.annotate(label, (x[last], y[last, 1]), xytext=(6, 0), textcoords="offset points", va="center", fontsize=8, color=look.colour)


def draw(places: list[Place], out: Path) -> None:
    figure, (works, force, work) = plots.panels(1, 3, (11.0, 3.9), ["where it works", "force", "work"], sharex=True)
    for look, v in zip(LOOKS, sorted({p.speed for p in places})):
        own = [p for p in places if p.speed == v]
        x = [p.stiffness for p in own]
        works.plot(x, [100 * p.arrived / p.starts for p in own], ls=":", color=look.colour)
        works.plot(x, [100 * p.passed / p.starts for p in own], **(look.style | {"ms": 3}))
        draw_quartiles(force, own, "force", look, f"{v:g} cm/s")
        draw_quartiles(work, own, "work", look, f"{v:g} cm/s")
    works.plot([], [], ls=":", color=plots.INK, label="knot at the head")
    works.plot([], [], ls="-", color=plots.INK, label="and every bound met")
    works.set(xscale="log", ylabel="starts, %", ylim=(-4, 104))
    works.legend(loc="lower left", bbox_to_anchor=(0.0, 0.06), fontsize=7)
    force.set(yscale="log", ylabel="sum of $\\lambda/h$ of Eq. 6 while sliding, dyn\n(median and quartiles of starts)")
    work.set(yscale="log", ylabel="work of $f_{thigmo}$, erg for each cm of slide")
    for axes in (works, force, work):
        axes.set_xlabel("bending stiffness, dyn cm$^2$")
    plots.save(figure, out)


def by_speed(places: list[Place]) -> list[list[str]]:
    """A row a speed, and one of all: how many starts tie, come to the head and meet every bound; from which stiffness on all do; what the
    stiffest body that is tied takes, over the softest."""
    def counts(own: list[Place]) -> list[str]:
        total = lambda what: sum(getattr(p, what) for p in own)
        return [f"{total('tied')} of {total('starts')}", f"{total('arrived')} of {total('tied')}",
                f"{100 * total('passed') / total('tied'):.0f} %"]

    rows = []
    for speed in sorted({p.speed for p in places}):
        own = sorted((p for p in places if p.speed == speed), key=lambda p: p.stiffness)
        known = [p for p in own if p.tied]
        good = next((f"{p.stiffness:.2g}" for k, p in enumerate(known) if all(q.passed == q.tied for q in known[k:])), "none")
        over = lambda what: f"{getattr(known[-1], what)[1] / getattr(known[0], what)[1]:.1f}"
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
    tables.write_table(out, "sliding", ["commanded speed, cm/s", "tied", "of these came to the head", "and met every bound",
                                        "all do from this stiffness on, dyn cm²", "force, stiffest over softest body",
                                        "work, the same"], by_speed(places))
    tables.write_table(out, "sliding_stiffness", ["bending stiffness, dyn cm²", "starts that tie"], by_stiffness(places))


def main(folder: Path) -> None:
    places = places_of(read_sweep(folder / "table.csv"))
    draw(places, folder / "sliding.png")
    write_tables(places, folder)


if __name__ == "__main__":
    run_script(__doc__, ["SWEEP"], main)
