"""What the columns of a table of `hagfish sweep` are, and the table itself, read by columns."""

import csv
from array import array
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np

from hagfish_log import HagfishLog, LogError

TEXTS = {"outcome": "ok where the run came to its end, else why it stopped", "unmet": "criteria of [expect] that it does not meet",
         "message": "why it stopped", "knot": "type as tightening or the slide begins, or at the end where it comes to neither",
         "slide": "what the slide is by name: by both ends, or the knot only grows"}
BOTH_ENDS = "slides by both ends"  # the only name of a slide that is one
FIGURES = {  # unit, meaning
    "duration_s": ("s", "simulated"),
    "tighten_from_s": ("s", "start of tightening"),
    "slide_from_s": ("s", "start of the slide"),
    "release_from_s": ("s", "when the head was let go"),
    "free_from_s": ("s", "when the knot was gone"),
    "slide_distance_cm": ("cm", "way of the knot's head end while it slides, to the head"),
    "slide_speed_cm_per_s": ("cm/s", "that way over its time"),
    "tail_distance_cm": ("cm", "way of the knot's tail end meanwhile"),
    "taper_asks_cm": ("cm", "way that the tail end of a knot as tight would come by"),
    "curvature_travel_cm": ("cm", "way of the body's curvature meanwhile"),
    "curvature_correlation": ("1", "of curvature before and after, the least of four quarters"),
    "both_ends_percent": ("%", "share by which this is a slide of both ends"),
    "sliding_force_dyn": ("dyn", "sum of the multipliers of all rows of Eq. 6: median over the slide of means from frame to frame"),
    "largest_thigmotaxis_dyn_cm": ("dyn cm", "f_thigmo of any hinge, mean from frame to frame"),
    "largest_active_dyn_cm": ("dyn cm", "torque of the muscles at any hinge, likewise"),
    "largest_torque_dyn_cm": ("dyn cm", "own torque and f_thigmo together, of any hinge while the knot slides or pulls, likewise"),
    "pull_N": ("N", "mean pull at food, once settled"),
    "penetration_cm": ("cm", "deepest overlap of skins at any step"),
    "skin_fold": ("1", "largest radius of the skin over radius of curvature while the knot is held, across one diameter: above 1 the skin folds into itself"),
    "limit_violation_rad": ("rad", "furthest past a joint limit at any step"),
    "head_drift_cm": ("cm", "largest way of the clamped head at any step"),
    "kkt": ("1", "largest scaled KKT residual of any step"),
    "eq6_percent": ("%", "sliding steps that meet Eq. 6 without slack"),
    "energy_ledger": ("1", "imbalance of the energy ledger, of the energy that passed"),
    "energy_gain": ("1", "mechanical energy above what there was and was put in, share of that"),
    "energy_loss": ("1", "energy that the integrator takes, without impacts, of the energy that passed"),
    "momentum_ledger": ("1", "imbalance of the momentum ledger, of the momentum that passed"),
    "work_tip_erg": ("erg", "of the scripted force on the tail, in all"),
    "work_active_erg": ("erg", "of the muscles, in all"),
    "work_thigmotaxis_erg": ("erg", "of f_thigmo, in all"),
    "dissipated_erg": ("erg", "lost to water drag and damping of joints and flesh, in all"),
}


@dataclass
class SweepTable:
    """Columns, a value a cell; nan where a run has no such figure."""

    axes: dict[str, list[str]]  # settings, as the grid has them
    texts: dict[str, list[str]]
    figures: dict[str, np.ndarray]

    @property
    def passed(self) -> np.ndarray:
        """Runs that came to their end and met all that their scene expects."""
        return np.array([outcome == "ok" and not unmet for outcome, unmet in zip(self.texts["outcome"], self.texts["unmet"])])

    @property
    def both_ends(self) -> np.ndarray:
        """Runs whose knot slides by both ends."""
        return np.array([slide == BOTH_ENDS for slide in self.texts["slide"]])


def read_sweep(path: Path) -> SweepTable:
    with path.open(newline="", encoding="utf-8") as file:
        rows = csv.reader(file)
        heading = next(rows, [])
        if heading[:1] != ["cell"] or heading[-len(FIGURES) - len(TEXTS):] != [*TEXTS, *FIGURES]:
            raise LogError(f"{path}: not a table of this version of hagfish sweep")
        first = len(heading) - len(FIGURES)
        words: list[list[str]] = [[] for _ in heading[:first]]
        numbers = [array("d") for _ in FIGURES]
        known: dict[str, str] = {}  # each text is kept once
        for row in rows:
            for column, text in zip(words, row):
                column.append(known.setdefault(text, text))
            for numbers_of, text in zip(numbers, row[first:]):
                numbers_of.append(float(text) if text else np.nan)
    if not words[0]:
        raise LogError(f"{path}: holds no rows")
    named = dict(zip(heading, words))
    return SweepTable({key: named[key] for key in heading[1:first - len(TEXTS)]}, {key: named[key] for key in TEXTS},
                      {key: np.frombuffer(values) for key, values in zip(FIGURES, numbers)})


@dataclass
class Cell:
    """One run of a sweep that kept its logs; figures are nan where it has none."""

    axes: dict[str, str]
    texts: dict[str, str]
    figures: dict[str, float]
    path: Path

    @property
    def outcome(self) -> str:
        return self.texts["outcome"]

    @property
    def unmet(self) -> list[str]:
        """Criteria of [expect]."""
        return self.texts["unmet"].split("; ")

    @property
    def both_ends(self) -> bool:
        """The knot slides by both ends."""
        return self.texts["slide"] == BOTH_ENDS

    @property
    def slid(self) -> bool:
        """The knot was kept, and slid by both ends as far as its scene asks."""
        return self.outcome == "ok" and not {"slide", "slide of both ends"} & set(self.unmet) and self.figures["slide_distance_cm"] > 0

    @cached_property
    def log(self) -> HagfishLog:
        return HagfishLog(self.path)


def read_cells(folder: Path) -> Iterator[Cell]:
    table = read_sweep(folder / "table.csv")
    of = lambda columns, k: {key: values[k] for key, values in columns.items()}
    for k in range(len(table.passed)):
        figures = {key: float(value) for key, value in of(table.figures, k).items()}
        yield Cell(of(table.axes, k), of(table.texts, k), figures, folder / "logs" / f"{k}.h5")
