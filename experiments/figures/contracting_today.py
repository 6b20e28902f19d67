"""A tied knot that slides by the reflex without water, here, in MuJoCo and in today's MuJoCo: rows for the page of contracting.py."""

from __future__ import annotations

import csv
import json
from dataclasses import astuple, dataclass, fields
from pathlib import Path

import numpy as np

import tables
from forces import shown
from hagfish_log import HagfishLog

UNTIL = 3.5  # s from the tied knot: the slide is not over in any
FRAME = 0.1  # s


@dataclass
class Today:
    simulator: str
    rule: str
    step_ms: float
    cpu_s: float
    own_cm: float  # off the same simulator and rule, extrapolated to no step: centres of bodies, root mean square
    here_cm: float  # off the path here, extrapolated


NAMES = [field.name for field in fields(Today)]


def centres(log: HagfishLog) -> np.ndarray:
    time = log["/trajectory/time"]
    return log["/trajectory/position"][(time > 0.5 * FRAME) & (time < UNTIL + 0.5 * FRAME)]


def read(folder: Path) -> list[Today]:
    """Of the runs that the study left; none where it had no npm."""
    found: dict[tuple[str, str], dict[float, tuple[float, np.ndarray]]] = {}
    for path in sorted(folder.glob("dry_*.cpu")):
        _, method, rule, _, step = path.stem.split("_")
        cpu = sum(map(float, path.read_text(encoding="utf-8").split()))
        found.setdefault(("here" if method == "active-set" else "MuJoCo", rule), {})[1e3 * float(step)] = cpu, centres(HagfishLog(path.with_suffix(".h5")))
    for path in sorted(folder.glob("dry_*.json")):
        run = json.loads(path.read_text(encoding="utf-8"))
        places = np.array(run["places"])[: round(UNTIL / FRAME)]
        found.setdefault((f"MuJoCo {run['version']} (WebAssembly)", run["rule"]), {})[1e3 * run["step"]] = run["cpu"], places
    apart = lambda one, other: float(np.sqrt(((one - other) ** 2).sum(axis=2).mean()))
    still = {}
    for key, runs in found.items():
        least = min(runs)
        still[key] = 2 * runs[least][1] - runs[2 * least][1]
    return [Today(*key, step, cpu, apart(places, still[key]), apart(places, still["here", "euler"]))
            for key, runs in found.items() for step, (cpu, places) in sorted(runs.items(), reverse=True)]


def write_table(path: Path, rows: list[Today], notes: list[str]) -> None:
    tables.write_csv(path, NAMES, [list(astuple(row)) for row in rows], notes)


def read_table(path: Path) -> list[Today]:
    lines = [line for line in path.read_text(encoding="utf-8").splitlines() if not line.startswith("#")]
    return [Today(row["simulator"], row["rule"], *(float(row[name]) for name in NAMES[2:])) for row in csv.DictReader(lines)]


def section(rows: list[Today]) -> list[str]:
    body = [[row.simulator, row.rule, f"{row.step_ms:g}", f"{row.cpu_s:.2g}", shown(row.own_cm, ".2g"), shown(row.here_cm, ".2g")] for row in rows]
    return ["## Today's MuJoCo, without water", "",
            f"From one tied knot at rest, the first {UNTIL:g} s of its slide. CPU times are of the slide alone. In WebAssembly they are not to be held against native ones.", "",
            *tables.markdown(["simulator", "rule", "step, ms", "CPU, s", "places off its own, cm", "off the places here, cm"], body)]
