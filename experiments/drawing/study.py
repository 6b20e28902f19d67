"""Runs of `experiments/results/speed_accuracy/study.sh`: what each cost and what became of it.

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

FORCE_WINDOW = 0.1  # s, of the means of forces: a multiple of every interval between frames in the study


@dataclass
class Run:
    """One run; cm, s, dyn."""

    name: str
    cpu: float  # the least of the repeats
    failure: str  # why the knot did not slide to the head; empty where it did
    unmet: list[str]  # what the audit names, the penetration aside
    penetration: float  # deepest of every step
    slide: float  # headward travel of the knot's head end, cm
    force: float  # sum of the multipliers of Eq. 6 / h while sliding: median of means over FORCE_WINDOW


def cause(status: str) -> str:
    """Why a run stopped, without its numbers."""
    text = status.removeprefix("failed: ").split(" at step ")[0].split(",")[0]
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


def read_run(folder: Path, name: str) -> Run:
    log = HagfishLog(folder / f"{name}.h5")
    try:
        cpu = [sum(map(float, line.split())) for line in (folder / f"{name}.cpu").read_text().splitlines()]
    except OSError as error:
        raise LogError(f"{error.filename}: cannot be read ({error.strerror})") from None
    unmet = audits.unmet(audits.read_findings(folder / f"{name}.check.csv"))
    slides = log.in_phase("slide")
    known = slides[np.isfinite(log["/knot/head_end"][slides])]
    force = read_means(log, "slide", FORCE_WINDOW).total
    head_end = log["/knot/head_end"][known]
    return Run(name, min(cpu), failure_of(log, unmet), [what for what in unmet if what != "penetration"],
               float(log["/steps/penetration"].max()), float(head_end[0] - head_end[-1]) if known.size else np.nan,
               float(np.median(force)) if force.size else np.nan)


def read_runs(folder: Path, prefix: str) -> list[Run]:
    """All runs called PREFIX_..., by name."""
    names = sorted(path.stem for path in folder.glob(f"{prefix}_*.cpu"))
    if not names:
        raise LogError(f"{folder}: holds no run {prefix}_*")
    return [read_run(folder, name) for name in names]


