"""Accuracy against CPU time of motions that forget their start: the table, the chart and the page of experiments/studies/contracting.sh.

Usage: contracting.py RUNS OUT.csv TODAY.csv OUT.md OUT.png. RUNS is what the study leaves. The page and the chart are made of the tables alone.
"""

from __future__ import annotations

import csv
import datetime
import tomllib
from collections.abc import Iterable
from dataclasses import astuple, dataclass, fields
from pathlib import Path
from typing import Any

import numpy as np

import contracting_today as today
import plots
import tables
from forces import STATIONS, moments_of, off, shown, through
from hagfish_log import HagfishLog, LogError
from script import run_script
from study import pareto

PRESETS = Path(__file__).resolve().parents[2] / "data" / "presets.toml"
# s: of the slide, which begins when the program has ended. By Eq. 6 two places of the strand touch in turn later on, and the knot's head
# end goes to and fro between them.
WINDOWS = {"reflex": (11.8, 16.8), "paper": (13.8, 15.8)}
FRAME, LONG = 0.1, 5  # s between frames; frames of a long mean
MEASURES = {"knot": "knot's path, cm", "place": "places, cm", "torque": "torques, %", "force": "f_thigmo, %"}
OF_LAW = {"reflex": ("knot", "place", "torque"), "paper": ("knot", "place", "torque", "force")}
SIZES = {50: 3.0, 100: 5.0, 200: 7.0, 400: 9.0}  # of markers, by bodies
USUAL = 100  # bodies
NOISE = 0.1  # share of an error by which runs must differ to be told apart
FRONTS = {"reflex": "knot", "paper": "force"}  # the measure by which runs are chosen
CONTACT = "5"  # ms, of MuJoCo's contacts, where runs are compared with each other


@dataclass
class Row:
    """A run. Errors are root mean squares: of the knot's head end and of places along the body in cm, of the muscles' moments (means of
    FRAME) and of f_thigmo (means of LONG frames) in % of themselves. None: not known."""

    law: str  # "reflex" or "paper"
    simulator: str  # "here" or "MuJoCo"
    rule: str
    back_end: str  # or, in MuJoCo, the contacts' time constant in ms
    bodies: int
    step: float  # ms
    cpu: float  # s
    outcome: str  # "ok", or why it ended early
    knot: float | None = None  # against the reference
    place: float | None = None
    torque: float | None = None
    force: float | None = None
    still_knot: float | None = None  # against the same bodies in the same simulator, extrapolated to no step
    still_place: float | None = None
    still_torque: float | None = None
    still_force: float | None = None
    here_knot: float | None = None  # of MuJoCo's, against the same bodies here, extrapolated to no step

    def error(self, measure: str) -> float | None:
        return getattr(self, measure)


UNITS = {"step": "step_ms", "cpu": "cpu_s", **{f"{of}{name}": f"{of}{name}_{unit}" for of in ("", "still_", "here_") for name, unit in
                                               (("knot", "cm"), ("place", "cm"), ("torque", "percent"), ("force", "percent"))}}
HEADING = [UNITS.get(field.name, field.name) for field in fields(Row)]


@dataclass
class Motion:
    """At the frames of a window: the knot's head end (cm of arc), places at STATIONS (frames x 99 x 3, cm), moments there (dyn cm)."""

    knot: np.ndarray
    place: np.ndarray
    torque: np.ndarray
    force: np.ndarray

    def __add__(self, other: Motion) -> Motion:
        return Motion(*(a + b for a, b in zip(vars(self).values(), vars(other).values())))

    def __sub__(self, other: Motion) -> Motion:
        return self + other * -1.0

    def __mul__(self, share: float) -> Motion:
        return Motion(*(share * a for a in vars(self).values()))


def long_means(force: np.ndarray, frames: int) -> np.ndarray:
    whole = len(force) // frames
    return force[:whole * frames].reshape(whole, frames, -1).mean(axis=1)


def motion(log: HagfishLog, law: str) -> Motion:
    time = log["/trajectory/time"]
    first, last = WINDOWS[law]
    frames = np.flatnonzero((time > first + 0.5 * FRAME) & (time < last + 0.5 * FRAME))
    bodies = len(log["/model/length"])
    place = np.array([through(centres, STATIONS * bodies) for centres in log["/trajectory/position"][frames]])
    of = lambda name: moments_of(log, name, frames)
    return Motion(log["/knot/head_end"][frames], place, of("active"), long_means(of("thigmotaxis"), LONG))


def apart(one: Motion, other: Motion) -> dict[str, float | None]:
    return {"knot": float(np.sqrt(((one.knot - other.knot) ** 2).mean())), "place": float(np.sqrt(((one.place - other.place) ** 2).sum(axis=2).mean())),
            "torque": off(one.torque, other.torque), "force": off(one.force, other.force) if other.force.any() else None}


def read_runs(folder: Path) -> list[tuple[Row, Motion | None]]:
    found = []
    for path in sorted(path for law in WINDOWS for path in folder.glob(f"{law}_*.cpu")):
        law, method, rule, bodies, step = path.stem.split("_")
        simulator, _, contact = method.partition("-") if method.startswith("mujoco") else ("here", "", "")
        cpu = sum(map(float, path.read_text(encoding="utf-8").split()))
        row = Row(law, "MuJoCo" if contact else "here", rule, f"{1e3 * float(contact):g}" if contact else method, int(bodies), 1e3 * float(step), cpu, "ok")
        own = None
        try:
            log = HagfishLog(path.with_suffix(".h5"))
            if log.attribute("status") == "complete":
                own = motion(log, law)
        except LogError:  # without frames
            pass
        if own is None:
            row.outcome = path.with_suffix(".err").read_text(encoding="utf-8").split("failed: ")[-1].split(" at step ")[0].split(";")[0].strip()
        found.append((row, own))
    return found


def stills(runs: list[tuple[Row, Motion | None]]) -> dict[tuple[str, str, int], Motion]:
    """Of each law, simulator and number of bodies: Euler's two smallest steps, of which one is half the other, extrapolated to no step.
    Euler's errors fall evenly, in the first order, to the smallest steps; the midpoint rule's do not."""
    found = {}
    for law, simulator, bodies in {(row.law, row.simulator, row.bodies) for row, _ in runs}:
        own = {row.step: moved for row, moved in runs if moved is not None and (row.law, row.simulator, row.bodies, row.rule) == (law, simulator, bodies, "euler")
               and row.back_end in ("active-set", CONTACT)}
        least = min(own, default=0)
        if least and least <= 1 and 2 * least in own:
            found[law, simulator, bodies] = own[least] + (own[least] - own[2 * least])
    return found


def mesh_order(still: dict[tuple[str, str, int], Motion], law: str) -> float:
    """By how places of the three finest meshes differ."""
    coarse, middle, fine = sorted(bodies for of, simulator, bodies in still if (of, simulator) == (law, "here"))[-3:]
    at = lambda one, other: apart(still[law, "here", one], still[law, "here", other])["place"]
    return float(np.log2(at(coarse, middle) / at(middle, fine)))


def reference_of(still: dict[tuple[str, str, int], Motion], law: str) -> Motion:
    """The finest mesh's, extrapolated to no length of a body."""
    middle, fine = sorted(bodies for of, simulator, bodies in still if (of, simulator) == (law, "here"))[-2:]
    best = still[law, "here", fine]
    return best + (best - still[law, "here", middle]) * (1 / (2 ** np.clip(mesh_order(still, law), 1, 2) - 1))


def read_study(folder: Path) -> list[Row]:
    runs = read_runs(folder)
    still = stills(runs)
    reference = {law: reference_of(still, law) for law in WINDOWS}
    for row, own in runs:
        if own is None:
            continue
        for name, value in apart(own, reference[row.law]).items():
            setattr(row, name, value)
        if (row.law, row.simulator, row.bodies) in still:
            for name, value in apart(own, still[row.law, row.simulator, row.bodies]).items():
                setattr(row, f"still_{name}", value)
        if row.simulator == "MuJoCo":
            row.here_knot = apart(own, still[row.law, "here", row.bodies])["knot"]
    extrapolated = [Row(law, simulator, "euler", "active-set" if simulator == "here" else CONTACT, bodies, 0.0, float("nan"), "extrapolated",
                        **apart(moved, reference[law]), here_knot=apart(moved, still[law, "here", bodies])["knot"] if simulator == "MuJoCo" else None)
                    for (law, simulator, bodies), moved in still.items()]
    order = lambda row: (row.law != "reflex", row.simulator, row.back_end, row.rule, row.bodies, -row.step)
    return sorted([row for row, _ in runs] + extrapolated, key=order)


def read_table(path: Path) -> tuple[list[Row], list[str]]:
    """Rows, and the notes above them."""
    lines = path.read_text(encoding="utf-8").splitlines()
    kinds = {field.name: {"str": str, "int": int}.get(str(field.type), float) for field in fields(Row)}
    rows = []
    for line in csv.DictReader(line for line in lines if not line.startswith("# ")):
        cells = {field.name: line[name] for field, name in zip(fields(Row), HEADING)}
        rows.append(Row(**{name: kinds[name](text) if text or kinds[name] is str else None for name, text in cells.items()}))
    return rows, [line[2:] for line in lines if line.startswith("# ")]


def pick(rows: Iterable[Row], **wanted: object) -> list[Row]:
    return [row for row in rows if all(getattr(row, key) == value for key, value in wanted.items())]


def one(rows: Iterable[Row], **wanted: object) -> Row | None:
    return next(iter(pick(rows, **wanted)), None)


def done(rows: list[Row], **wanted: object) -> list[Row]:
    return [row for row in pick(rows, outcome="ok", **wanted) if row.place is not None]


def front(rows: list[Row], measure: str) -> list[Row]:
    """The runs than which none is both quicker and nearer, quickest first; none that is nearer than the last by less than NOISE."""
    known = [row for row in rows if row.error(measure) is not None]
    kept: list[Row] = []
    for k in pareto(np.array([row.cpu for row in known]), np.array([row.error(measure) for row in known])):
        if not kept or known[k].error(measure) < (1 - NOISE) * kept[-1].error(measure):
            kept.append(known[k])
    return kept


def on_front(row: Row, rows: list[Row], measure: str) -> bool:
    """Whether no run that takes no longer is nearer by more than NOISE."""
    return not any(other.cpu <= row.cpu and other.error(measure) < (1 - NOISE) * row.error(measure) for other in rows)


def name_of(row: Row) -> str:
    where = {"here": "", "MuJoCo": "MuJoCo, "}[row.simulator]
    return f"{where}{row.rule}{', Ipopt' if row.back_end == 'ipopt' else ''}, {row.bodies} bodies, {row.step:g} ms"


def cell(row: Row | None, of: str, measures: Iterable[str]) -> str:
    """Errors and, in brackets, CPU time."""
    if row is None:
        return "-"
    if row.outcome not in ("ok", "extrapolated"):
        return "fails"
    errors = "; ".join(shown(row.error(f"{of}{measure}"), ".2g") for measure in measures)
    return errors if np.isnan(row.cpu) else f"{errors} ({row.cpu:.2g} s)"


METHODS = {"Euler": {"simulator": "here", "rule": "euler", "back_end": "active-set"}, "midpoint": {"simulator": "here", "rule": "midpoint", "back_end": "active-set"},
           "Euler, Ipopt": {"simulator": "here", "rule": "euler", "back_end": "ipopt"}, "MuJoCo Euler": {"simulator": "MuJoCo", "rule": "euler", "back_end": CONTACT},
           "MuJoCo implicit": {"simulator": "MuJoCo", "rule": "implicit", "back_end": CONTACT}}
LOOKS = {"Euler": plots.INTEGRATORS["core"], "midpoint": plots.INTEGRATORS["core_midpoint"], "MuJoCo Euler": plots.INTEGRATORS["mujoco_euler"],
         "MuJoCo implicit": plots.INTEGRATORS["mujoco_implicit"]}


def steps_table(rows: list[Row], law: str) -> list[str]:
    methods = {name: of for name, of in METHODS.items() if pick(rows, law=law, bodies=USUAL, **of)}
    steps = sorted({row.step for row in pick(rows, law=law, bodies=USUAL) if row.step > 0}, reverse=True)
    body = [[f"{step:g}", *(cell(one(rows, law=law, bodies=USUAL, step=step, **of), "still_", OF_LAW[law]) for of in methods.values())] for step in steps]
    return tables.markdown(["step, ms", *methods], body)


def orders(rows: list[Row], law: str, method: str, measure: str) -> str:
    """From each step to its half, 100 bodies."""
    own = {row.step: row.error(f"still_{measure}") for row in done(rows, law=law, bodies=USUAL, **METHODS[method])}
    found = [np.log2(own[2 * step] / own[step]) for step in own if 2 * step in own and step > 2 * min(own)]
    return f"{min(found):.1f} to {max(found):.1f}"


def meshes_table(rows: list[Row]) -> list[str]:
    sizes = sorted({row.bodies for row in pick(rows, outcome="extrapolated")})
    still = lambda law, simulator, bodies: cell(one(rows, outcome="extrapolated", law=law, simulator=simulator, bodies=bodies), "", OF_LAW[law])
    body = [[str(bodies), still("reflex", "here", bodies), still("reflex", "MuJoCo", bodies), still("paper", "here", bodies)] for bodies in sizes]
    return tables.markdown(["bodies", "reflex", "reflex, MuJoCo", "Eq. 6"], body)


def orders_of_mesh(rows: list[Row], law: str, measure: str = "place") -> str:
    still = {row.bodies: row.error(measure) for row in pick(rows, outcome="extrapolated", law=law, simulator="here")}
    return " and ".join(f"{np.log2(still[bodies] / still[2 * bodies]):.1f} ({bodies} to {2 * bodies})" for bodies in sorted(still) if 2 * bodies in still)


def front_table(rows: list[Row]) -> list[str]:
    body = [[LAWS[law], name_of(row), f"{row.cpu:.2g}", *(shown(row.error(each), ".2g") if each in OF_LAW[law] else "" for each in MEASURES)]
            for law, measure in FRONTS.items() for row in front(done(rows, law=law), measure)]
    return tables.markdown(["slide by", "run", "CPU, s", *MEASURES.values()], body)


LAWS = {"reflex": "reflex", "paper": "Eq. 6"}


def presets() -> dict[str, dict[str, Any]]:
    """Rule, bodies and step (ms) of each preset, as these scenes have them."""
    found = {}
    for preset in tomllib.loads(PRESETS.read_text(encoding="utf-8"))["preset"]:
        of = dict(setting.split("=") for setting in preset["set"])
        found[preset["name"]] = {"rule": of.get("time.rule", "euler"), "bodies": int(of.get("model.bodies", 100)), "step": 1e3 * float(of.get("time.step", 0.005))}
    return found


def presets_table(rows: list[Row]) -> list[str]:
    body = []
    for law, measures in OF_LAW.items():
        own = done(rows, law=law)
        for name, of in presets().items():
            row = one(own, simulator="here", back_end="active-set", **of)
            if row is None:
                continue
            on = [MEASURES[measure].split(",")[0] for measure in measures if on_front(row, own, measure)]
            body.append([f"`{name}`", LAWS[law], f"{row.rule}, {row.bodies} bodies, {row.step:g} ms", f"{row.cpu:.2g}",
                         *(shown(row.error(measure), ".2g") if measure in measures else "" for measure in MEASURES), ", ".join(on) or "none"])
    return tables.markdown(["preset", "slide by", "what it is", "CPU, s", *MEASURES.values(), "on the front of"], body)


def rivals_table(rows: list[Row]) -> list[str]:
    """MuJoCo's runs, and the quickest one here that is as near to the reference."""
    body = []
    here = done(rows, law="reflex", simulator="here")
    for row in pick(rows, law="reflex", simulator="MuJoCo"):
        if row.outcome == "extrapolated":
            continue
        as_near = [own for own in here if row.knot is not None and own.knot <= row.knot]
        by_step = [own for own in here if row.still_knot is not None and own.bodies == row.bodies and own.still_knot is not None and own.still_knot <= row.still_knot]
        ratio = lambda own: f"{row.cpu / min(of.cpu for of in own):.0f}" if own else "-"
        body.append([row.rule, str(row.bodies), f"{row.step:g}", row.back_end, f"{row.cpu:.2g}", *(shown(value, ".2g") for value in (row.still_knot, row.here_knot, row.knot)),
                     ratio(by_step), ratio(as_near)])
    return tables.markdown(["MuJoCo's rule", "bodies", "step, ms", "contacts, ms", "CPU, s", "knot's path off its own, cm", "off the path here", "off the reference",
                            "CPU, of a run here as near to its own", "of one as near to the reference"], body)


def back_ends(rows: list[Row]) -> str:
    pairs = [(row, one(rows, law=row.law, rule=row.rule, bodies=row.bodies, step=row.step, back_end="active-set")) for row in done(rows, back_end="ipopt")]
    ratios = [slow.cpu / quick.cpu for slow, quick in pairs if quick]
    moved = [abs(slow.place - quick.place) for slow, quick in pairs if quick and slow.place is not None]
    return f"Ipopt takes {min(ratios):.0f} to {max(ratios):.0f} times the CPU time of the active set; errors of places are the same" \
        + (" to each digit of the table." if max(moved) == 0 else f" to {max(moved):.0e} cm.")


def draw(rows: list[Row], out: Path) -> None:
    shows = [("reflex", "knot"), ("reflex", "torque"), ("paper", "knot"), ("paper", "force")]
    figure, axes = plots.panels(2, 4, (11.5, 5.6), [f"{LAWS[law]}: {MEASURES[measure].replace(', %', '')}" if measure != "knot" else f"{LAWS[law]}: knot's path"
                                                    for law, measure in shows] + ["by the step alone, 100 bodies"] * 4)
    for panel, (law, measure) in zip(axes, shows):
        for method, look in LOOKS.items():
            for bodies, size in SIZES.items():
                own = sorted(done(rows, law=law, bodies=bodies, **METHODS[method]), key=lambda row: row.cpu)
                panel.plot([row.cpu for row in own], [row.error(measure) for row in own], color=look.colour, marker=look.marker, markersize=size, linewidth=0.6)
        best = front(done(rows, law=law), measure)
        panel.plot([row.cpu for row in best], [row.error(measure) for row in best], color=plots.GREY, linewidth=5, alpha=0.3, zorder=0)
    for panel, (law, measure) in zip(axes[4:], shows):
        for method, look in LOOKS.items():
            own = sorted(done(rows, law=law, bodies=USUAL, **METHODS[method]), key=lambda row: row.cpu)
            panel.plot([row.cpu for row in own], [row.error(f"still_{measure}") for row in own], linewidth=0.8, **look.style)
        panel.set_xlabel("CPU time of the run, s")
    for panel, (_, measure) in zip(axes, shows * 2):
        panel.set(xscale="log", yscale="log", ylabel="error, %" if measure != "knot" else "error, cm")
        least, most = panel.get_ylim()
        ticks = [m * 10.0**k for k in range(-4, 3) for m in (1, 2, 5)] if most < 100 * least else [10.0**k for k in range(-4, 3)]
        plots.plain_ticks(panel.yaxis, [tick for tick in ticks if least <= tick <= most])
    line = lambda **of: plots.plt.Line2D([], [], **of)
    handles = [line(label=look.label, **look.style) for look in LOOKS.values()]
    handles += [line(color=plots.GREY, marker="o", ls="", markersize=size, label=f"{bodies} bodies") for bodies, size in SIZES.items()]
    plots.legend_above(figure, [*handles, line(color=plots.GREY, linewidth=5, alpha=0.3, label="front")], 9, 0.06)
    plots.save(figure, out)


def page(rows: list[Row], notes: list[str], dry: list[today.Today]) -> list[str]:
    usual = {law: one(rows, law=law, bodies=USUAL, step=5.0, **METHODS["Euler"]) for law in WINDOWS}
    reflex, paper = usual["reflex"], usual["paper"]
    beside = one(rows, law="paper", bodies=USUAL, step=10.0, **METHODS["midpoint"])
    rivals = [row for row in done(rows, law="reflex", simulator="MuJoCo") if row.bodies == USUAL]
    nearest = min(rivals, key=lambda row: row.knot)
    as_near = min((row for row in done(rows, law="reflex", simulator="here") if row.knot <= nearest.knot), key=lambda row: row.cpu)
    failed = [row for row in rows if row.outcome not in ("ok", "extrapolated")]
    return [
        "# What does accuracy cost where a motion forgets its start?", "",
        "`bash experiments/studies/contracting.sh` makes this page, its tables ([contracting.csv](contracting.csv), [contracting_today.csv](contracting_today.csv)) and the chart. " + " ".join(notes), "",
        "**Answer.** Choose the midpoint rule where the knot slides by Eq. 6, and more bodies where it slides by the reflex. "
        f"By the reflex the default settings have the knot's path off by {shown(reflex.knot, '.2g')} cm and torques by {shown(reflex.torque, '.2g')} %, "
        f"of which the step makes {shown(reflex.still_knot, '.2g')} cm and {shown(reflex.still_torque, '.2g')} %. "
        f"By Eq. 6 they have f_thigmo off by {shown(paper.force, '.2g')} %, of which the step makes {shown(paper.still_force, '.2g')} %. "
        f"MuJoCo's nearest run of {USUAL} bodies is off by {shown(nearest.knot, '.2g')} cm and takes {nearest.cpu / as_near.cpu:.0f} times the CPU time of one here that is as near.", "",
        "![Error against CPU time](../figures/contracting.png)", "",
        "A living overhand knot slides, by the reflex (`reflex_overhand`) or by Eq. 6 (`living_overhand`). Starts that differ by rounding stay together, "
        "so that errors are seen down to where they end. The clock of the program starts both slides, so that runs are compared at like times. "
        f"Errors are root mean squares over the first {WINDOWS['reflex'][1] - WINDOWS['reflex'][0]:.0f} s of the slide by reflex, and {WINDOWS['paper'][1] - WINDOWS['paper'][0]:.0f} s by Eq. 6. Torques are the muscles', means over {FRAME:g} s. "
        f"f_thigmo are means over {FRAME * LONG:g} s. Both are compared as moments at {STATIONS.size} stations. "
        "CPU times are those of whole runs from the straight body, with their logs.", "",
        "The reference is extrapolated twice: each mesh by Euler's rule to no step, then the two finest meshes to no length of a body.", "",
        "## Presets", "", *presets_table(rows),
        "## What to choose", "",
        f"The front: no run is both quicker and nearer, by the knot's path (reflex) or by f_thigmo (Eq. 6). Each is nearer than the one above by {100 * NOISE:.0f} % or more.", "",
        *front_table(rows),
        f"- By Eq. 6 choose the midpoint rule: with {USUAL} bodies at {beside.step:g} ms f_thigmo is off by {shown(beside.force, '.2g')} % in {beside.cpu:.2g} s; "
        f"by Euler's rule at {paper.step:g} ms it is by {shown(paper.force, '.2g')} % in {paper.cpu:.2g} s.",
        "- By the reflex choose bodies: the step makes little of the error at any step below 20 ms.",
        "- Places and torques of all runs are in the table.", "",
        "## Steps", "",
        f"Against the same {USUAL} bodies in the same simulator, extrapolated to no step: {', '.join(MEASURES[m] for m in OF_LAW['reflex'])}, and CPU time. By the reflex:", "",
        *steps_table(rows, "reflex"),
        f"By Eq. 6, with {MEASURES['force']}, too:", "", *steps_table(rows, "paper"),
        f"- Orders by the reflex, of torques: Euler {orders(rows, 'reflex', 'Euler', 'torque')}, midpoint {orders(rows, 'reflex', 'midpoint', 'torque')}. "
        f"Of places: {orders(rows, 'reflex', 'Euler', 'place')} and {orders(rows, 'reflex', 'midpoint', 'place')}.",
        f"- Orders by Eq. 6, of f_thigmo: Euler {orders(rows, 'paper', 'Euler', 'force')}, midpoint {orders(rows, 'paper', 'midpoint', 'force')}.",
        f"- {back_ends(rows)}", "",
        "## Meshes", "", "Each mesh, extrapolated to no step, against the reference:", "",
        *meshes_table(rows),
        f"- Orders of the mesh, of places: by the reflex {orders_of_mesh(rows, 'reflex')}; by Eq. 6 {orders_of_mesh(rows, 'paper')}. "
        "The last one of each is what the extrapolation took. "
        "The reflex copies curvature on a straight line between two joints, which smears a shape as it travels, in the first order ([why](reflex.md)).", "",
        "## MuJoCo on the same behaviour", "",
        "`hagfish mujoco-run`: the reflex in closed loop, MuJoCo's own soft contacts and limits. Muscles' share by velocity is damping there, which MuJoCo takes implicitly. "
        "Contacts are as hard as their time constant says, or as two steps.", "",
        *rivals_table(rows),
        *([f"{len(failed)} runs failed: " + "; ".join(f"{name_of(row)}: {row.outcome}" for row in failed) + ".", ""] if failed else []),
        *today.section(dry),
        "## What this page does not show", "",
        "- MuJoCo's RK4: damping is explicit there, so that [its steps](stability.md) are too short for a whole run.",
        "- The build for browsers: it takes the same steps, at [its own price](live.md).",
        "- Eq. 6 in MuJoCo, which has no such rows."]


def notes_of(folder: Path) -> list[str]:
    path = folder / "reflex_active-set_euler_100_0.005.h5"
    log = HagfishLog(path)
    date = datetime.datetime.fromtimestamp(path.stat().st_mtime, datetime.UTC)
    return [f"Measured at {str(log.attribute('git_revision'))[:12]} on {log.attribute('cpu')}, {date:%Y-%m-%d}."]


def main(folder: Path, table: Path, dry: Path, out: Path, chart: Path) -> None:
    rows = [["" if value is None else value for value in astuple(row)] for row in read_study(folder)]
    tables.write_csv(table, HEADING, rows, notes_of(folder))
    if found := today.read(folder):
        today.write_table(dry, found, notes_of(folder))
    read, notes = read_table(table)
    draw(read, chart)
    tables.write_page(out, page(read, notes, today.read_table(dry)))


if __name__ == "__main__":
    run_script(__doc__, ["RUNS", "OUT.csv", "TODAY.csv", "OUT.md", "OUT.png"], main)
