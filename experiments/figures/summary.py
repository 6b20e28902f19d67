"""Measured figures of a run next to the paper's Table 1, as Markdown.

Usage: summary.py LOG.h5 OUT.md
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

import claims
from hagfish_log import HagfishLog, LogError
from script import run_script
from tables import markdown, write_page

PHASES = ("form", "tighten", "slide", "release", "free")
KNOTS = {(1, 0): "unknot", (3, 1): "3_1", (5, -1): "4_1", (5, 3): "5_1", (7, 2): "5_2"}
WORKS = ("tip", "thigmotaxis", "contact", "limit", "head", "wall")
ROWS = ("first, t_a", "first, t_b", "last, t_a", "last, t_b")
MET = 1e-6  # slack of a row of Eq. 6 that counts as met, of its command or of 1 cm/s: Ipopt's own tolerance
LEDGER = 1e-9  # of the largest term of the energy ledger: rounding of some 10^4 summed steps
# Paper, Table 1.
PAPER_SPECIMEN = {"length": ("Length", "42.4", "cm"), "mass": ("Mass", "80", "g"),
                  "circumference": ("Circumference", "5.6, 5.5, 5.6, 4.3", "cm"),
                  "bending_limit": ("Bending limit", "21, 75, 45, 51", "deg"),
                  "twist_limit": ("Twisting limit", "48", "deg")}
PAPER_SPEEDS = {("tighten", "head"): (0.0, 0.0), ("tighten", "tail"): (0.5, 2.0),
                ("slide", "head"): (2.0, 2.0), ("slide", "tail"): (2.0, 2.0)}


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


def table_one(log: HagfishLog) -> list[str]:
    """Specimen values and speeds: the paper's, the scene's, and what the run measured."""
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
    return ["## Table 1", "", *markdown(["Data", "Paper", "Scene", f"Model, or median of means over {interval(log)}", "Units"], rows)]


def knot_types(log: HagfishLog, frames: np.ndarray) -> dict[str, int]:
    """Knot types of the frames and how many frames each."""
    names = [KNOTS.get((int(d), int(v)), f"det {d}, v2 {v}") for d, v in
             zip(log["/knot/determinant"][frames], log["/knot/v2"][frames])]
    return {name: names.count(name) for name in dict.fromkeys(names)}


def span(values: np.ndarray) -> str:
    """First and last finite value."""
    known = values[np.isfinite(values)]
    return f"{known[0]:.2f} to {known[-1]:.2f}" if known.size else "none"


def timetable(log: HagfishLog) -> list[str]:
    """Each phase: when, how long, the knot and where its ends were."""
    rows, time = [], log["/trajectory/time"]
    for phase in PHASES:
        frames = log.in_phase(phase)
        if not frames.size:
            rows.append([phase, "not reached", "", "", "", ""])
            continue
        end = time[min(frames[-1] + 1, log.frames - 1)]
        kinds = ", ".join(f"{name} ({count})" for name, count in knot_types(log, frames).items())
        rows.append([phase, f"{time[frames[0]]:.2f} to {end:.2f}", f"{end - time[frames[0]]:.2f}", kinds,
                     span(log["/knot/head_end"][frames]), span(log["/knot/tail_end"][frames])])
    return ["## Phases", "", *markdown(["Phase", "Time, s", "Duration, s", "Knot types (frames)", "Head end of knot, cm",
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
            *markdown(["Phase", "Row", "Commanded, cm/s", "Median, cm/s", "5 to 95 %, cm/s", "Median λ/h, dyn",
                    "Largest λ/h, dyn", "Largest at a step, dyn", "Largest slack, cm/s", "Met without slack"], rows)]


def ledger(log: HagfishLog) -> tuple[list[str], float]:
    """The energy ledger's table, and how far it is from closing at worst, of its largest term."""
    read = lambda name: log[f"/diagnostics/{name}"] - log[f"/diagnostics/{name}"][0]
    stored = read("kinetic_energy") + read("elastic_energy") + read("gravity_energy")
    works = {f"work of {name}": read(f"work_{name}") for name in WORKS}
    lost, integrator = read("dissipated"), read("integrator_error")
    gap = stored - (sum(works.values()) - lost + integrator)
    terms = {"kinetic + elastic energy": stored, **works, "dissipated": lost, "integrator error": integrator,
             "left over": gap}
    scale = max(float(np.abs(values).max()) for values in terms.values()) or 1.0
    rows = [[name, f"{values[-1]:.6g}", f"{np.abs(values).max():.3g}"] for name, values in terms.items()]
    lines = ["## Energy ledger", "",
             "kinetic + elastic = works - dissipated + integrator error, counted from the first frame.", "",
             *markdown(["Term", "At the end, erg", "Largest, erg"], rows)]
    return lines, float(np.abs(gap).max()) / scale


def step_phases(log: HagfishLog) -> np.ndarray:
    """The phase of every step: that of the last frame before it."""
    step = log["/trajectory/step"]
    frame = np.searchsorted(step, step[0] + np.arange(len(log["/steps/eq6"])), side="right") - 1
    return log.labels("/trajectory/phase")[frame]


def requirements(log: HagfishLog, unclosed: float) -> list[str]:
    """What a Table 1 run at h = 2 ms must show, and what this one shows."""
    rows: list[list[str]] = []

    def ask(name: str, shown: str, required: str, met: bool) -> None:
        rows.append([name, shown, required, "yes" if met else "**no**"])

    phases = log.labels("/trajectory/phase")
    ask("status", str(log.attribute("status")), "complete", log.attribute("status") == "complete")
    ask("phases reached", ", ".join(p for p in PHASES if p in phases), "all five", set(PHASES) <= set(phases))
    held = np.flatnonzero(np.isin(phases, ("tighten", "slide")))
    kinds = knot_types(log, held)
    ask("knot from tightening to release", str(kinds)[1:-1].replace("'", "") or "no frames", "3_1 at every frame",
        set(kinds) == {"3_1"})
    ends = knot_types(log, np.array([0, log.frames - 1]))
    ask("knot at start and end", ", ".join(ends), "unknot", set(ends) == {"unknot"})
    slide = log.in_phase("slide")
    head_end = log["/knot/head_end"][slide]
    head_end = head_end[np.isfinite(head_end)]
    travel = float(head_end[0] - head_end[-1]) if head_end.size else 0.0
    ask("travel of the knot's head end while sliding", f"{travel:.2f} cm", "at least 9 cm", travel >= 9)
    met = log["/steps/eq6"][step_phases(log) == "slide"] == 1
    share = 100 * float(met.mean()) if met.size else 0.0
    ask("sliding steps with all rows met without slack", f"{share:.2f} %", "at least 95 %", share >= 95)
    for name, dataset, factor, unit, limit in (("penetration", "penetration", 1, "cm", 0.0015),
                                               ("limit violation", "limit_violation", 180 / np.pi, "deg", 0.001),
                                               ("head drift", "head_drift", 1, "cm", 1e-6)):
        values = log[f"/diagnostics/{dataset}"]
        worst = float(np.nanmax(values)) * factor
        ask(f"worst {name}, every step", f"{worst:.3g} {unit}", f"at most {limit:g} {unit}", worst <= limit)
    kkt = float(log["/steps/kkt"].max())
    ask("worst scaled KKT residual, every step", f"{kkt:.2g}", "at most 1e-08", kkt <= 1e-8)
    if claims.ruled_intervals(log) >= claims.LEAST_FRAMES:
        zero = claims.zero_behind(claims.read_sliding(log))
        past = zero["largest_beyond_reach_of_rows_dyn_cm"]
        ask("largest f_thigmo past the knot, single steps at frames", f"{past:g} dyn cm", "exactly 0", past == 0)
    ask("energy ledger, left over of its largest term", f"{unclosed:.2g}", f"at most {LEDGER:g}", unclosed <= LEDGER)
    qp = log["/steps/qp_time"][log.labels("/steps/solve") == "qp"]
    if qp.size:
        ask("median time of a QP, every step", f"{1000 * np.median(qp):.3g} ms", "at most 4 ms", float(np.median(qp)) <= 4e-3)
    return ["## What the run must show", "", "Bounds are those of a Table 1 run at h = 2 ms.", "",
            *markdown(["Figure", "This run", "Required", "Met"], rows)]


def solver(log: HagfishLog) -> list[str]:
    """Solve kinds, sizes, iterations and times."""
    kinds = log.labels("/diagnostics/solve")
    counts = ", ".join(f"{kind} {100 * np.mean(kinds == kind):.1f} %" for kind in ("linear", "kkt", "qp"))
    quick = lambda v: [f"{np.median(v):.4g}", f"{np.percentile(v, 95):.4g}", f"{v.max():.4g}"]
    rows = [[name, *quick(log[f"/diagnostics/{name}"])] for name in ("contacts", "rows", "active")]
    qp = kinds == "qp"
    if qp.any():
        rows.append(["iterations of a QP", *quick(log["/diagnostics/iterations"][qp])])
        rows.append(["time of a QP, ms", *quick(1000 * log["/diagnostics/qp_time"][qp])])
    wall, simulated = log["/diagnostics/wall_time"][-1], log["/trajectory/time"][-1]
    return ["## Solver", "", f"Logged steps by kind: {counts}. {simulated:.2f} s simulated in {wall:.1f} s: "
            f"{simulated / max(wall, 1e-9):.2f} times real time.", "",
            *markdown(["At the logged frames", "Median", "95 %", "Largest"], rows)]


def main(path: Path, out: Path) -> None:
    log = HagfishLog(path)
    energy, unclosed = ledger(log)
    about = [["log", log.path.name], *([name, str(log.attribute(name))] for name in
                                       ("status", "created", "creator", "creator_version", "git_revision", "command",
                                        "libraries", "compiler", "cpu"))]
    about.append(["step h, frames, bodies", f"{figures(setting(log, 'time', 'step'))} s, {log.frames}, "
                                            f"{len(log['/model/mass'])}"])
    text = ["# Summary of a run", "", *markdown(["", ""], about), *requirements(log, unclosed), *table_one(log),
            *timetable(log), *eq6(log), *solver(log), *energy]
    write_page(out, text)


if __name__ == "__main__":
    run_script(__doc__, ["LOG.h5", "OUT.md"], main)
