"""Measured figures of a run next to the paper's Table 1, as Markdown.

Usage: summary.py LOG.h5 CHECK.csv OUT.md, where CHECK.csv is what `hagfish check --csv` says of the log.
"""

from collections import Counter
from pathlib import Path
from typing import Any

import numpy as np

import audits
import tables
from hagfish_log import HagfishLog, LogError
from script import run_script, whole

ROWS = ("first, t_a", "first, t_b", "last, t_a", "last, t_b")
MET = 1e-6  # slack of a row of Eq. 6 that counts as met, of its command or of 1 cm/s: Ipopt's own tolerance
QP_TIME = 4e-3  # s, median of a QP: a matter of the machine, so that no scene expects it
# Paper, Table 1.
PAPER_SPECIMEN = {"length": ("Length", "42.4", "cm"), "mass": ("Mass", "80", "g"),
                  "circumference": ("Circumference", "5.6, 5.5, 5.6, 4.3", "cm"),
                  "bending_limit": ("Bending limit", "21, 75, 45, 51", "deg"),
                  "twist_limit": ("Twisting limit", "48", "deg")}
PAPER_SPEEDS = {("tighten", "head"): (0.0, 0.0), ("tighten", "tail"): (0.5, 2.0),
                ("slide", "head"): (2.0, 2.0), ("slide", "tail"): (2.0, 2.0)}


def table(head: list[str], rows: list[list[str]]) -> list[str]:
    return [*tables.markdown(head, rows), ""]


def figures(values: Any) -> str:
    """Numbers in short, with commas between."""
    return ", ".join(f"{float(value):.6g}" for value in np.atleast_1d(values))


def setting(log: HagfishLog, *keys: str) -> Any:
    """One value of the resolved scene; angles, which a scene gives in _deg or _rad, in degrees."""
    found: Any = log.scene()
    for key in keys[:-1]:
        found = found.get(key, {})
    name = keys[-1]
    if name in found:
        return found[name]
    if f"{name}_deg" in found:
        return found[f"{name}_deg"]
    if f"{name}_rad" in found:
        return np.degrees(found[f"{name}_rad"])
    raise LogError(f"{log.path}: the scene in the log has no {'.'.join(keys)}")


def commanded(log: HagfishLog, phase: str) -> np.ndarray:
    """Speeds that Eq. 6 asks for: first contact a, b, last contact a, b; cm/s."""
    return np.array([setting(log, "controller", f"{phase}_{end}", row) for end in ("head", "tail") for row in "ab"])


def rows_met(log: HagfishLog, phase: str) -> np.ndarray:
    """Share of the steps of a phase that have a row of Eq. 6 at which it was met without slack (4); nan
    where no step has it."""
    slack = log["/steps/thigmotaxis_slack"][step_phases(log) == phase]
    present = np.isfinite(slack)
    met = (slack <= MET * np.maximum(1.0, np.abs(commanded(log, phase)))).sum(axis=0)  # a nan is not
    return met / np.where(present.any(axis=0), present.sum(axis=0), np.nan)


def mean_rows(log: HagfishLog, phase: str, what: str) -> np.ndarray:
    """Means of the rows of Eq. 6 between the frames of a phase, where all four were there: F x 4."""
    frames = log.intervals_in(phase)
    ruled = np.all(np.isfinite(log["/mean/thigmotaxis/speed"][frames]), axis=1)
    return log[f"/mean/thigmotaxis/{what}"][frames][ruled]


def interval(log: HagfishLog) -> str:
    """Time between frames, over which /mean is taken."""
    return f"{1000 * np.median(np.diff(log['/trajectory/time'])):.3g} ms" if log.frames > 1 else "no time"


def limits(log: HagfishLog, kind: str) -> tuple[np.ndarray, np.ndarray]:
    """Arc length (cm) and upper limit (degrees) of each hinge of a kind."""
    dof, joint, kinds = log.hinges()
    own = kinds == kind
    return log.joint_arc()[joint[own]], np.degrees(log["/model/limit_upper"][dof[own]])


def is_the_paper_s(log: HagfishLog) -> bool:
    """Whether the animal is the one of the paper's Table 1, by length and mass."""
    return all(setting(log, "specimen", key) == float(PAPER_SPECIMEN[key][1]) for key in ("length", "mass"))


def table_one(log: HagfishLog) -> list[str]:
    """Specimen values and speeds: the scene's and what the run measured, and the paper's where it is of this animal."""
    rows = []
    for key, (name, paper, unit) in PAPER_SPECIMEN.items():
        measured = {"length": log["/model/length"].sum(), "mass": log["/model/mass"].sum()}.get(key)
        at = np.array(setting(log, "specimen", "station")) * log["/model/length"].sum()
        if key == "circumference":
            middle = np.cumsum(log["/model/length"]) - log["/model/length"] / 2
            measured = 2 * np.pi * np.interp(at, middle, log["/model/radius"])
        elif key == "bending_limit":
            measured = np.interp(at, *limits(log, "bend_y"))
        elif key == "twist_limit":
            measured = limits(log, "twist")[1].sum()
        model = figures(np.round(measured, 3))
        rows.append([name, paper, figures(setting(log, "specimen", key)), model, unit])
    for (phase, end), paper_speeds in PAPER_SPEEDS.items():
        columns = slice(0, 2) if end == "head" else slice(2, 4)
        speed = mean_rows(log, phase, "speed")[:, columns]
        median = figures(np.round(np.median(speed, axis=0), 3)) if len(speed) else "no frames"
        rows.append([f"v_a, v_b ({'tightening' if phase == 'tighten' else 'sliding'}, {end})", figures(paper_speeds),
                     figures(commanded(log, phase)[columns]), median, "cm/s"])
    heading = ["Data", "Paper", "Scene", f"Model, or median of means over {interval(log)}", "Units"]
    if is_the_paper_s(log):
        return ["## Table 1", "", *table(heading, rows)]
    name = log.scene()["specimen"].get("name", "the animal")
    return [f"## {name}", "", *table([heading[0], *heading[2:]], [[row[0], *row[2:]] for row in rows])]


def span(values: np.ndarray) -> str:
    """First and last finite value."""
    known = values[np.isfinite(values)]
    return f"{known[0]:.2f} to {known[-1]:.2f}" if known.size else "none"


def timetable(log: HagfishLog) -> list[str]:
    """Each phase: when, how long, the knot and where its ends were."""
    rows, time = [], log["/trajectory/time"]
    for phase in log.strings("/enumerations/phase"):
        frames = log.in_phase(phase)
        if not frames.size:
            rows.append([phase, "not reached", "", "", "", ""])
            continue
        end = time[min(frames[-1] + 1, log.frames - 1)]
        kinds = ", ".join(f"{name} ({count})" for name, count in Counter(log.knots(frames)).items())
        rows.append([phase, f"{time[frames[0]]:.2f} to {end:.2f}", f"{end - time[frames[0]]:.2f}", kinds,
                     span(log["/knot/head_end"][frames]), span(log["/knot/tail_end"][frames])])
    return ["## Phases", "", *table(["Phase", "Time, s", "Duration, s", "Knot types (frames)", "Head end of knot, cm",
                                     "Tail end of knot, cm"], rows)]


def eq6(log: HagfishLog) -> list[str]:
    """Eq. 6 while tightening and sliding, row by row."""
    rows = []
    for phase in ("tighten", "slide"):
        speed, force = (mean_rows(log, phase, what) for what in ("speed", "lambda"))
        if not len(speed):
            continue
        steps = step_phases(log) == phase
        slack, single = log["/steps/thigmotaxis_slack"][steps], log["/steps/thigmotaxis_lambda"][steps]
        met = rows_met(log, phase)
        for k, name in enumerate(ROWS):
            rows.append([phase, name, figures(commanded(log, phase)[k]), f"{np.median(speed[:, k]):.3f}",
                         f"{np.percentile(speed[:, k], 5):.3f} to {np.percentile(speed[:, k], 95):.3f}",
                         f"{np.median(force[:, k]):.0f}", f"{force[:, k].max():.0f}", f"{single[:, k].max():.0f}",
                         f"{np.nanmax(slack[:, k]):.2g}", f"{100 * met[k]:.1f} %"])
    mean = f"means over {interval(log)}"
    return ["## Eq. 6", "", f"Speeds and multipliers are {mean}, from frame to frame of the log; a step's multiplier is an "
            "impulse over h. Slack and the share met are of every step.", "",
            *table(["Phase", "Row", "Commanded, cm/s", "Median, cm/s", "5 to 95 %, cm/s", "Median λ/h, dyn",
                    "Largest λ/h, dyn", "Largest at a step, dyn", "Largest slack, cm/s", "Met without slack"], rows)]


def ledger(log: HagfishLog) -> list[str]:
    """The energy ledger's table."""
    read = lambda name: log[f"/diagnostics/{name}"] - log[f"/diagnostics/{name}"][0]
    stored = read("kinetic_energy") + read("elastic_energy") + read("gravity_energy")
    works = {f"work of {name}": read(f"work_{name}") for name in log.strings("/enumerations/force")}
    losses = {name.replace("_", " "): read(name) for name in log.strings("/enumerations/loss")}
    integrator = read("integrator_error")
    gap = stored - (sum(works.values()) - sum(losses.values()) + integrator)
    terms = {"kinetic + elastic energy": stored, **works, **losses, "integrator error": integrator, "left over": gap}
    rows = [[name, f"{values[-1]:.6g}", f"{np.abs(values).max():.3g}"] for name, values in terms.items()]
    return ["## Energy ledger", "",
            "kinetic + elastic = works - dissipated - impact loss + integrator error, counted from the first frame.", "",
            *table(["Term", "At the end, erg", "Largest, erg"], rows)]


def step_phases(log: HagfishLog) -> np.ndarray:
    """The phase of every step: that of the last frame before it."""
    step = log["/trajectory/step"]
    frame = np.searchsorted(step, step[0] + np.arange(len(log["/steps/eq6"])), side="right") - 1
    return log.labels("/trajectory/phase")[frame]


def figure(text: str, unit: str = "") -> str:
    """A figure of the audit in short, with its unit; words, such as 0_1, as they are."""
    try:
        short = text if "_" in text else f"{float(text):.4g}"
    except ValueError:
        short = text
    return f"{short} {unit}".strip() if short else "none"


def requirements(log: HagfishLog, findings: list[audits.Finding]) -> list[str]:
    """What a run of the scene must show, as its audit has it, and what this one shows."""
    rows = [[f.criterion, figure(f.value, f.unit), figure(f.bound), "yes" if f.met else "**no**"] for f in findings]
    qp = log["/steps/qp_time"][log.labels("/steps/solve") == "qp"]
    if qp.size:
        median = float(np.median(qp))
        rows.append(["median time of a QP, every step", f"{1000 * median:.3g} ms", f"{1000 * QP_TIME:g}",
                     "yes" if median <= QP_TIME else "**no**"])
    return ["## What the run must show", "", "Bounds are those of `hagfish check`: most of them are the scene's `[expect]`.", "",
            *table(["Figure", "This run", "Bound", "Met"], rows)]


def solver(log: HagfishLog) -> list[str]:
    """Solve kinds, sizes, iterations and times."""
    at_steps = lambda name: log[f"/diagnostics/{name}"][: log.begun()]
    kinds = log.labels("/diagnostics/solve")[: log.begun()]
    counts = ", ".join(f"{kind} {100 * np.mean(kinds == kind):.1f} %" for kind in ("linear", "kkt", "qp"))
    quick = lambda v: [f"{np.median(v):.4g}", f"{np.percentile(v, 95):.4g}", f"{v.max():.4g}"]
    rows = [[name, *quick(at_steps(name))] for name in ("contacts", "rows", "active")]
    qp = kinds == "qp"
    if qp.any():
        rows.append(["iterations of a QP", *quick(at_steps("iterations")[qp])])
        rows.append(["time of a QP, ms", *quick(1000 * at_steps("qp_time")[qp])])
    wall, simulated = log["/diagnostics/wall_time"][-1], log["/trajectory/time"][-1]
    return ["## Solver", "", f"Logged steps by kind: {counts}. {simulated:.2f} s simulated in {wall:.1f} s: "
            f"{simulated / max(wall, 1e-9):.2f} times real time.", "",
            *table(["At the logged frames", "Median", "95 %", "Largest"], rows)]


def main(path: Path, check: Path, out: Path) -> None:
    log = HagfishLog(path)
    about = [["log", log.path.name], *([name, str(log.attribute(name))] for name in
                                       ("status", "created", "creator", "creator_version", "git_revision", "command",
                                        "libraries", "compiler", "cpu"))]
    about.append(["step h, frames, bodies", f"{figures(setting(log, 'time', 'step'))} s, {log.frames}, "
                                            f"{len(log['/model/mass'])}"])
    text = ["# Summary of a run", "", *table(["", ""], about), *requirements(log, audits.read_findings(check)), *table_one(log),
            *timetable(log), *eq6(log), *solver(log), *ledger(log)]
    with whole(out) as part:
        part.write_text("\n".join(text).rstrip() + "\n", encoding="utf-8")


if __name__ == "__main__":
    run_script(__doc__, ["LOG.h5", "CHECK.csv", "OUT.md"], main)
