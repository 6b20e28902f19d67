"""How sure the figures of a scene are: what each is at other meshes, steps, starts and animals. `hagfish sure` calls this.

Usage: sure.py FOLDER. FOLDER has table.csv of the runs and causes.csv. Prints a table; leaves sure.csv, sure.png and a PDF beside.
"""

from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.ticker import MaxNLocator

import plots
from hagfish_log import LogError
from script import run_script
from sweep_columns import FIGURES, SweepTable, read_sweep
from tables import read_csv, write_csv

AS_IS, ALL = "as it is", "all"
NUMERICS = ("chance", "step", "bodies")  # the rest is the animal's
# Of the run's quality, which are bounds and no figures of the animal.
QUALITY = {"penetration_cm", "limit_violation_rad", "head_drift_cm", "kkt", "eq6_percent", "energy_ledger", "energy_gain", "energy_loss",
           "momentum_ledger"}
COLUMNS = 3
MESH, ANIMAL = ("o", plots.BLUE), ("D", plots.ORANGE)
HEADING = ["figure", "unit", "as_it_is", "cause", "least", "most", "furthest_percent", "runs", "runs_of"]


@dataclass
class Spread:
    """A figure over the runs of a cause that count; nan where none has it."""

    cause: str
    least: float
    most: float
    furthest: float  # from the scene as it is, %
    runs: int
    of: int


@dataclass
class Sure:
    """The runs of a scene, a cell each; the first is the scene as it is."""

    table: SweepTable
    causes: list[str]

    @property
    def kinds(self) -> list[str]:
        return [cause for cause in dict.fromkeys(self.causes) if cause != AS_IS]

    @property
    def counted(self) -> np.ndarray:
        """Runs that came to their end with the scene's knot, and slid it by both ends if the scene as it is does."""
        texts, slides = self.table.texts, self.table.both_ends
        same = [outcome == "ok" and knot == texts["knot"][0] for outcome, knot in zip(texts["outcome"], texts["knot"])]
        return np.array(same) & (slides | ~slides[0])

    def figures(self) -> Iterator[tuple[str, np.ndarray]]:
        """Those that the scene as it is has."""
        return ((name, values) for name, values in self.table.figures.items() if np.isfinite(values[0]))

    def of_the_animal(self) -> list[tuple[str, np.ndarray]]:
        return [(name, values) for name, values in self.figures() if name not in QUALITY and name != "duration_s" and values[0]]

    def spread(self, values: np.ndarray, cause: str, kinds: tuple[str, ...]) -> Spread:
        own = np.array([each in kinds for each in self.causes])
        found = values[own & self.counted & np.isfinite(values)]
        if not found.size:
            return Spread(cause, np.nan, np.nan, np.nan, 0, int(own.sum()))
        with_own = np.append(found, values[0])
        off = np.abs(found - values[0]).max()
        return Spread(cause, with_own.min(), with_own.max(), 100 * off / abs(values[0]) if values[0] else (np.inf if off else 0.0),
                      found.size, int(own.sum()))

    def spreads(self, values: np.ndarray) -> list[Spread]:
        """Of each cause by itself, of the numerical ones, and of all."""
        return [*(self.spread(values, kind, (kind,)) for kind in self.kinds), self.spread(values, "numerics", NUMERICS),
                self.spread(values, ALL, tuple(self.kinds))]

    def lost(self) -> list[str]:
        """What became of runs that do not count, and of how many of each cause."""
        texts = self.table.texts
        ended = lambda knot, slide: (slide or "does not slide") if knot == texts["knot"][0] else f"tied {knot or 'no knot'}"
        why = Counter((cause, ended(knot, slide) if outcome == "ok" else outcome) for cause, outcome, knot, slide, counts
                      in zip(self.causes, texts["outcome"], texts["knot"], texts["slide"], self.counted) if not counts)
        return [f"{cause}: {count} of {self.causes.count(cause)}: {words}" for (cause, words), count in why.items()]


def read(folder: Path) -> Sure:
    table = read_sweep(folder / "table.csv")
    causes = [row["cause"] for row in read_csv(folder / "causes.csv", ["cell", "cause"])]
    if len(causes) != len(table.texts["outcome"]):
        raise LogError(f"{folder}: causes.csv has {len(causes)} cells, table.csv {len(table.texts['outcome'])}")
    if table.texts["outcome"][0] != "ok":
        raise LogError(f"{folder}: the unchanged scene fails: {table.texts['message'][0]}")
    return Sure(table, causes)


def plain_name(figure: str) -> str:
    """Without its unit, where it has one."""
    if FIGURES[figure][0] == "1":
        return figure.replace("_", " ")
    unit = next(unit for unit in ("_cm_per_s", "_dyn_cm", "_" + figure.rsplit("_", 1)[-1]) if figure.endswith(unit))
    return figure.removesuffix(unit).replace("_", " ")


def percent(value: float) -> str:
    return "-" if np.isnan(value) else "inf" if np.isinf(value) else f"{value:.2g}" if value < 100 else f"{value:.0f}"


def words(sure: Sure) -> list[str]:
    """The table as text: furthest from the scene as it is by each cause, in percent, and the interval of all."""
    head = ["figure", AS_IS, *(f"{kind}, %" for kind in sure.kinds), "numerics: from", "to", "all: from", "to"]
    rows = [head]
    for name, values in sure.of_the_animal():
        found = sure.spreads(values)
        ends = [f"{end:.4g}" for spread in found[-2:] for end in (spread.least, spread.most)]
        rows.append([name, f"{values[0]:.4g}", *(percent(spread.furthest) for spread in found[:-2]), *ends])
    width = [max(len(row[k]) for row in rows) for k in range(len(head))]
    lines = ["  ".join(cell.ljust(w) if k == 0 else cell.rjust(w) for k, (cell, w) in enumerate(zip(row, width))) for row in rows]
    counted = int(sure.counted.sum())
    return [*lines, "", "Columns in % say how far from the scene as it is a cause takes a figure. Numerics are chance, step and bodies.",
            "Each change is a single run, so an end of an interval may be its chance.",
            f"{counted} of {len(sure.causes)} runs count: they end with the scene's knot, slid by both ends if the scene's is."
            + ("" if counted == len(sure.causes) else " Others: " + "; ".join(sure.lost()) + ".")]


def strip(panel: Any, sure: Sure, name: str, values: np.ndarray) -> None:
    """A row a cause, a mark a run; the line is the scene as it is."""
    panel.axvline(values[0], color=plots.INK, lw=0.9)
    for row, kind in enumerate(sure.kinds):
        own = values[np.array([each == kind for each in sure.causes]) & sure.counted]
        mark, colour = MESH if kind in NUMERICS else ANIMAL
        panel.plot(own, np.full(own.size, row), mark, color=colour, mfc="none", ms=4)
    panel.xaxis.set_major_locator(MaxNLocator(5))
    panel.ticklabel_format(axis="x", style="sci", scilimits=(-2, 4))
    panel.set_xlabel(FIGURES[name][0])
    panel.grid(axis="y", visible=False)


def draw(sure: Sure, png: Path) -> None:
    shown = sure.of_the_animal()
    rows = -(-len(shown) // COLUMNS)
    figure, panels = plots.panels(rows, COLUMNS, (10, 0.6 + 1.75 * rows), [""] * rows * COLUMNS, sharey=True)
    plots.name_panels(panels[:len(shown)], [plain_name(name) for name, _ in shown])
    for panel, (name, values) in zip(panels, shown):
        strip(panel, sure, name, values)
    for panel in panels[len(shown):]:
        panel.set_visible(False)
    panels[0].set_yticks(range(len(sure.kinds)), sure.kinds)
    panels[0].set_ylim(len(sure.kinds) - 0.5, -0.5)
    figure.supxlabel("circles: chance, step and bodies;  diamonds: the animal and its start;  line: the scene as it is", fontsize=9)
    plots.save(figure, png)


def main(folder: Path) -> None:
    sure = read(folder)
    write_csv(folder / "sure.csv", HEADING, [[name, FIGURES[name][0], float(values[0]), s.cause, float(s.least), float(s.most),
                                              float(s.furthest), s.runs, s.of]
                                             for name, values in sure.figures() for s in sure.spreads(values)])
    draw(sure, folder / "sure.png")
    print("\n".join(words(sure)))


if __name__ == "__main__":
    run_script(__doc__, ["FOLDER"], main)
