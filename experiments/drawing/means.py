"""Forces of a slide as means over time, from /mean of the log: impulse over elapsed time, from frame to frame.

A single step's force is an impulse over h, and rows switch on and off many times a second: a few steps carry most of the
squares and little of the impulse.
"""

from dataclasses import dataclass

import numpy as np

from hagfish_log import HagfishLog, LogError

WINDOW = 0.020  # s, over which a study takes means where its table does not say otherwise
ROUNDING = 1e-9  # of a time, as a share of the window


@dataclass
class Means:
    """Means over windows that follow one another within a phase; rows are windows."""

    window: float  # s
    start: np.ndarray  # frame at which each begins
    end: np.ndarray  # and ends
    force: np.ndarray  # moment of f_thigmo about the axis of each hinge's kind, windows x hinges, dyn cm
    total: np.ndarray  # sum of the multipliers of all rows of Eq. 6 over h, dyn
    slack: np.ndarray  # shortfall of the four rows of Eq. 6, cm/s; nan where no row
    span: float  # share of the body's length that each hinge stands for


def read_means(log: HagfishLog, phase: str = "slide", window: float = WINDOW) -> Means:
    """Means of one phase. Windows that are no whole number of the log's frame intervals are an error; what is left of the phase
    after the last whole window is left out."""
    frames = log.intervals_in(phase)
    _, joints, _ = log.hinges()
    span = 2 / (joints.max() + 1)  # bend and twist take turns from body to body
    if not frames.size:
        return Means(window, frames, frames, np.empty((0, joints.size)), np.empty(0), np.empty((0, 4)), span)
    time = log["/trajectory/time"]
    interval = float(np.median(time[frames] - time[frames - 1]))
    count = max(1, round(window / interval))
    if abs(count * interval - window) > ROUNDING * window:
        raise LogError(f"{log.path}: frames every {interval:g} s do not make windows of {window:g} s")
    frames = frames[: frames.size // count * count].reshape(-1, count)
    rows = lambda path: log[path][frames]
    slack = np.ma.masked_invalid(rows("/mean/thigmotaxis/slack")).mean(axis=1).filled(np.nan)
    return Means(window, frames[:, 0] - 1, frames[:, -1], log.at_hinges(rows("/mean/moments/thigmotaxis").mean(axis=1)),
                 rows("/mean/thigmotaxis/sum").mean(axis=1), slack, span)


def effort(means: Means) -> np.ndarray:
    """Of each window: the mean over the body's length of |f_thigmo|, its three axes added, times the window, dyn cm s. Weighted
    with the length of body that a hinge stands for, it does not depend on the number of bodies."""
    return means.span * np.abs(means.force).sum(axis=1) * means.window


def effort_per_cm(log: HagfishLog, means: Means, end: str = "head") -> float:
    """Effort of a slide over the way of the knot's end, (1/L) integral |f_thigmo| ds dt / cm, dyn s; nan without a way."""
    place = log[f"/knot/{end}_end"]
    known = np.isfinite(place[means.start]) & np.isfinite(place[means.end])
    way = float(np.abs((place[means.end] - place[means.start])[known].sum()))
    return float(effort(means)[known].sum()) / way if way else np.nan
