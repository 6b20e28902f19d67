"""What each choice of the Table 1 scene costs and buys: the run with one choice changed, against the scene as it is.

Usage: choices.py list                     of each run its name and its settings
       choices.py table RUNS OUT_FOLDER    with RUNS as study.sh leaves it. Needs the program as built (HAGFISH_PROGRAM).
"""

import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np

import audits
from accuracy import cpu_of
from hagfish_log import HagfishLog, LogError
from means import read_means
from script import run_script
from slides import failure_of
from sweep_columns import BOTH_ENDS
from tables import write_table

AS_IS = "as_is"
# Run, the choice as it is, what is tried instead, and by which settings.
CHOICES = {
    "bodies_25": ("100 bodies", "25", "model.bodies=25"),
    "bodies_50": ("100 bodies", "50", "model.bodies=50"),
    "bodies_200": ("100 bodies", "200", "model.bodies=200"),
    "violated": ("speculative rows", "violated rows only", "constraints.activation=violated"),
    "margin_0.06": ("rows from a gap of 0.1 cm", "0.06 cm", "contact.margin=0.06"),
    "margin_0.3": ("rows from a gap of 0.1 cm", "0.3 cm", "contact.margin=0.3"),
    "least_arc_2.12": ("contacts 2.97 cm of body apart", "2.12 cm", "contact.least_arc=2.12"),
    "least_arc_4.24": ("contacts 2.97 cm of body apart", "4.24 cm", "contact.least_arc=4.24"),
    "no_stiffness": ("joint stiffness", "none", "model.bending_stiffness=0 model.twist_stiffness=0"),
    "no_drag": ("water drag", "none", "drag.normal=0 drag.tangential=0"),
    "baumgarte_0.2": ("half a violation pushed out", "a fifth", "constraints.baumgarte=0.2"),
    "baumgarte_1": ("half a violation pushed out", "all", "constraints.baumgarte=1"),
    "no_corrections": ("steps corrected along their path", "not corrected", "constraints.corrections=0"),
    "cap_1000": ("thigmotaxis up to 5000 dyn", "1000 dyn", "controller.cap=1000"),
    "no_cap": ("thigmotaxis up to 5000 dyn", "no cap", "controller.cap=1e9"),
    "votes_5": ("15 votes on the knot", "5", "knot.votes=5"),
    "votes_45": ("15 votes on the knot", "45", "knot.votes=45"),
    "no_wall": ("head plate", "none", "wall.present=false"),
}
LEAST_SAVING = 0.1  # of CPU time, to change what works
LEAST_FACTOR = 2  # of penetration, to count as deeper
LEAST_FORCE = 2  # % of the sliding force, to count as another: chance makes far less
HEADING = ["choice", "instead", "CPU time, of the scene's", "head end of the knot, cm more", "sliding force, % more", "penetration, cm", "verdict"]
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


def read_run(folder: Path, name: str) -> Run:
    log = HagfishLog(folder / f"{name}.h5")
    unmet = audits.unmet(audits.audit(log.path))
    slides = log.in_phase("slide")
    known = slides[np.isfinite(log["/knot/head_end"][slides])]
    force = read_means(log, "slide", FORCE_WINDOW).total
    head_end = log["/knot/head_end"][known]
    return Run(name, cpu_of(folder / f"{name}.cpu"), failure_of(log, unmet), [what for what in unmet if what != "penetration"],
               float(log["/steps/penetration"].max()), float(head_end[0] - head_end[-1]) if known.size else np.nan,
               float(np.median(force)) if force.size else np.nan)


def read_runs(folder: Path, prefix: str) -> list[Run]:
    """All runs called PREFIX_..., by name."""
    names = sorted(path.stem for path in folder.glob(f"{prefix}_*.cpu"))
    if not names:
        raise LogError(f"{folder}: holds no run {prefix}_*")
    return [read_run(folder, name) for name in names]


def verdict_of(run: Run, as_is: Run) -> str:
    """Keep or change, and why, from the figures alone."""
    saving = 1 - run.cpu / as_is.cpu
    if run.failure:
        return f"keep: else {run.failure}"
    if run.unmet:
        return f"keep: else the audit fails ({', '.join(run.unmet)})"
    if run.penetration > LEAST_FACTOR * as_is.penetration:
        return "keep: else strands overlap more"
    force = 100 * (run.force / as_is.force - 1)
    if abs(force) > LEAST_FORCE:
        return "keep: else the sliding force is another" + (", and it takes longer" if saving <= -LEAST_SAVING else "")
    if run.penetration < as_is.penetration / LEAST_FACTOR and saving > -LEAST_SAVING:
        return "change: strands overlap less"
    same = (run.slide, run.force, run.penetration) == (as_is.slide, as_is.force, as_is.penetration)
    if saving >= LEAST_SAVING:
        return "change: saves time"
    if saving <= -LEAST_SAVING:
        return "keep: else it takes longer"
    return "keep: the same motion to the last bit" if same else "keep: no difference that counts"


def rows(folder: Path) -> list[list[object]]:
    runs = {run.name.removeprefix("choice_"): run for run in read_runs(folder, "choice")}
    missing = {AS_IS, *CHOICES} - set(runs)
    if missing:
        raise LogError(f"{folder}: without run choice_{sorted(missing)[0]}")
    as_is = runs[AS_IS]
    found: list[list[object]] = [["as it is", "", "1", "", "", f"{as_is.penetration:.2g}", as_is.failure or ", ".join(as_is.unmet) or BOTH_ENDS]]
    for name, (choice, instead, _) in CHOICES.items():
        run = runs[name]
        slid = not run.failure and np.isfinite(run.force)
        found.append([choice, instead, f"{run.cpu / as_is.cpu:.2f}", f"{run.slide - as_is.slide:+.2f}" if slid else "",
                      f"{100 * (run.force / as_is.force - 1):+.0f}" if slid else "", f"{run.penetration:.2g}", verdict_of(run, as_is)])
    return found


def main(folder: Path, out: Path) -> None:
    write_table(out, "speed_accuracy_choices", HEADING, rows(folder))


if __name__ == "__main__":
    if sys.argv[1:] == ["list"]:
        print(AS_IS, *(f"{name} {settings}" for name, (_, _, settings) in CHOICES.items()), sep="\n")
    else:
        run_script(__doc__, ["table", "RUNS", "OUT_FOLDER"], lambda _, runs, out: main(runs, out))
