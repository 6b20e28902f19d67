"""Slides of the studies of knots: what was commanded and what came of it."""

import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from hagfish_log import HagfishLog
from means import WINDOW, read_means
from summary import step_phases
from sweep_columns import Cell, read_cells

LEAST_FRAMES = 5  # of a slide with a speed
AT_CAP = 0.999  # of the cap, a multiplier that is at it
MEAN = f"{1000 * WINDOW:g} ms mean"  # what forces are, for headings


@dataclass
class Slide:
    """One phase of one run in which the knot slides; cm, s, dyn. Forces are means over WINDOW."""

    knot: str  # expected type
    commanded: float  # speed, cm/s
    speed: float  # of the knot's leading end, a line through its places; nan where it never slid
    travel: float  # of that end
    follows: float  # travel of the other end: of a knot that only grows it stays
    force: float  # sum of the multipliers of Eq. 6 / h, median of the means
    peak: float  # largest of them
    capped: float  # share of rows at controller.cap, of all steps
    slack: float  # largest shortfall of the four rows of Eq. 6, median of the means, cm/s
    met: float  # share of steps without slack
    penetration: float  # deepest of any step in the phase
    allowed: float  # deepest that the scene expects
    failure: str  # why the run did not go on to its end; empty where it did
    seconds: float
    kind: str  # what the slide is by both ends, as `hagfish sweep` names it; empty where there is none


def cause(status: str) -> str:
    """Why a run stopped, without its numbers."""
    text = re.split(r",(?![^(]*\))", status.removeprefix("failed: ").split(" at step ")[0])[0]  # at a comma that no bracket holds
    return re.sub(r" is [\d.]+ \w+ past", " went past", re.sub(r"^body \d+", "a body", text))


def tied(log: HagfishLog) -> bool:
    """Whether the controller took the knot as tied: it then tightens it, or slides it at once."""
    return bool(log.in_phase("tighten").size or log.in_phase("slide").size)


def failure_of(log: HagfishLog, unmet: list[str]) -> str:
    status = str(log.attribute("status"))
    if status != "complete":
        return cause(status)
    if not tied(log):
        return "the knot was never ready to tighten"
    if not log.in_phase("slide").size:
        return "the knot never slid"
    for name, words in (("knot held", "the knot was lost early"), ("unknot at end", "the knot stayed on")):
        if name in unmet:
            return words
    return ""


def slide_of(cell: Cell, phase: str) -> Slide:
    log = cell.log
    scene = log.scene()
    end, other = ("head", "tail") if phase == "slide" else ("tail", "head")
    frames = log.in_phase(phase)
    frames = frames[np.isfinite(log["/knot/head_end"][frames])]
    time, place, behind = log["/trajectory/time"][frames], *(log[f"/knot/{which}_end"][frames] for which in (end, other))
    moved = frames.size >= LEAST_FRAMES
    slope = float(np.polyfit(time, place, 1)[0]) if moved else np.nan
    travel, follows = (float(of[-1] - of[0]) if moved else np.nan for of in (place, behind))
    sign = -1.0 if phase == "slide" else 1.0
    means = read_means(log, phase)
    some = moved and means.end.size > 0
    steps = step_phases(log) == phase
    at_cap = log["/steps/thigmotaxis_lambda"][steps] >= AT_CAP * scene["controller"]["cap"]
    ended = str(log.attribute("status")) == "complete" and "unknot at end" not in cell.unmet
    commanded = float(scene["controller"][f"{phase}_head"]["a"])
    return Slide(scene["expect"]["knot"], commanded, sign * slope, sign * travel, sign * follows,
                 float(np.median(means.total)) if some else np.nan, float(means.total.max()) if some else np.nan,
                 float(at_cap.mean()) if steps.any() else np.nan,
                 float(np.nanmedian(np.fmax.reduce(means.slack, axis=1))) if some else np.nan,
                 float((log["/steps/eq6"][steps] == 1).mean()) if steps.any() else np.nan,
                 float(log["/steps/penetration"][steps].max()) if steps.any() else np.nan, float(scene["expect"]["penetration"]),
                 "" if ended else failure_of(log, cell.unmet), float(time[-1] - time[0]) if moved else np.nan, cell.texts["slide"])


def read_slides(folder: Path, phase: str = "slide") -> list[Slide]:
    """All runs of a sweep that kept its logs, by knot and speed."""
    slides = [slide_of(cell, phase) for cell in read_cells(folder)]
    return sorted(slides, key=lambda s: (s.knot, s.commanded))
