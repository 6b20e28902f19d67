"""Runs of `experiments/studies/speed_accuracy.sh`: what each cost, what became of it, and how far it is from a reference.

A run is NAME.h5 (its log), NAME.cpu (user and system time of each repeat, s) and NAME.check.csv (its audit).
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np

import audits
from hagfish_log import HagfishLog, LogError
from means import read_means

SHIFTS = 21  # tried within a frame to either side
FORCE_WINDOW = 0.1  # s, of the means of forces: a multiple of every interval between frames in the study


@dataclass
class Run:
    """One run; cm, s, dyn. Arrays are of its sliding frames, times from the first of them."""

    name: str
    cpu: float  # the least of the repeats
    step: float
    bodies: int
    qp: str
    activation: str
    rule: str  # "euler" or "midpoint"
    scene: str  # built-in scene's name
    failure: str  # why the knot did not slide to the head; empty where it did
    unmet: list[str]  # what the audit names, the penetration aside
    penetration: float  # deepest of every step
    slide: float  # headward travel of the knot's head end, cm
    tighten_at: float  # s; nan where it never came to that
    slide_at: float
    force: float  # sum of the four multipliers / h while sliding: median of means over FORCE_WINDOW
    force_mean: float  # and mean over the slide
    time: np.ndarray
    head_end: np.ndarray
    tail_end: np.ndarray


def cause(status: str) -> str:
    """Why a run stopped, without its numbers."""
    text = status.removeprefix("failed: ").split(" at step ")[0].split(",")[0]
    return re.sub(r" is [\d.]+ \w+ past", " went past", re.sub(r"^body \d+", "a body", text))


def failure_of(log: HagfishLog, unmet: list[str]) -> str:
    status = str(log.attribute("status"))
    if status != "complete":
        return cause(status)
    if not log.in_phase("tighten").size:
        return "the knot was never ready to tighten"
    if not log.in_phase("slide").size:
        return "the knot never slid"
    for name, words in (("knot held", "the knot was lost early"), ("unknot at end", "the knot stayed on")):
        if name in unmet:
            return words
    return ""


def read_run(folder: Path, name: str) -> Run:
    log = HagfishLog(folder / f"{name}.h5")
    try:
        cpu = [sum(map(float, line.split())) for line in (folder / f"{name}.cpu").read_text().splitlines()]
    except OSError as error:
        raise LogError(f"{error.filename}: cannot be read ({error.strerror})") from None
    unmet = audits.unmet(audits.read_findings(folder / f"{name}.check.csv"))
    scene = log.scene()
    slides = log.in_phase("slide")
    known = slides[np.isfinite(log["/knot/head_end"][slides])]
    start = lambda phase: float(log["/trajectory/time"][log.in_phase(phase)[0]]) if log.in_phase(phase).size else np.nan
    force = read_means(log, "slide", FORCE_WINDOW).total
    head_end = log["/knot/head_end"][known]
    return Run(name, min(cpu), scene["time"]["step"], scene["model"]["bodies"], str(log.attribute("qp")),
               scene["constraints"]["activation"], scene["time"]["rule"], str(log.attribute("command")).split(" run ")[1].split()[0],
               failure_of(log, unmet), [what for what in unmet if what != "penetration"],
               float(log["/steps/penetration"].max()), float(head_end[0] - head_end[-1]) if known.size else np.nan,
               start("tighten"), start("slide"), float(np.median(force)) if force.size else np.nan,
               float(force.mean()) if force.size else np.nan,
               log["/trajectory/time"][known] - start("slide"), head_end, log["/knot/tail_end"][known])


def read_runs(folder: Path, prefix: str) -> list[Run]:
    """All runs called PREFIX_..., by name."""
    names = sorted(path.stem for path in folder.glob(f"{prefix}_*.cpu"))
    if not names:
        raise LogError(f"{folder}: holds no run {prefix}_*")
    return [read_run(folder, name) for name in names]


def path_error(run: Run, reference: Run, end: str = "head_end") -> tuple[float, float]:
    """Distance along the body between the knot's ends in two runs, cm: rms over the slide and largest at any frame; nan where
    one has none. Times count from the beginning of the slide, which is known to a frame: the shift within that with the
    least rms is taken."""
    if not run.time.size or not reference.time.size:
        return np.nan, np.nan
    frame = max(float(np.median(np.diff(each.time))) for each in (run, reference))
    inside = (reference.time >= frame) & (reference.time <= run.time[-1] - frame)
    time, path = reference.time[inside], getattr(reference, end)[inside]
    if not time.size:
        return np.nan, np.nan
    away = [np.abs(np.interp(time + shift, run.time, getattr(run, end)) - path) for shift in np.linspace(-frame, frame, SHIFTS)]
    return min((float(np.sqrt(np.mean(each**2))), float(each.max())) for each in away)


def pareto(cost: np.ndarray, error: np.ndarray) -> np.ndarray:
    """Indices, by rising cost, of what nothing else beats in both."""
    order = np.lexsort((error, cost))
    best, front = np.inf, []
    for i in order:
        if error[i] < best:
            best = error[i]
            front.append(i)
    return np.array(front, dtype=int)
