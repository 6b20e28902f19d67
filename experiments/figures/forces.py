"""How far the forces of Eq. 6 depend on the step, the mesh and chance: the table and the page of experiments/studies/forces.sh.

Usage: forces.py FOLDER OUT.csv OUT.md. FOLDER is what the study leaves. The page is made of the table alone: a test makes it again.
"""

from __future__ import annotations

import csv
import datetime
from collections.abc import Iterable
from dataclasses import astuple, dataclass, fields
from pathlib import Path

import numpy as np

import plots
import sure
import tables
from hagfish_log import HagfishLog
from script import run_script
from slides import log_of
from sweep_columns import SweepTable, read_sweep

KINDS = ("bend_y", "bend_z", "twist")
STATIONS = np.linspace(0.01, 0.99, 99)  # along the body, at which moments of two meshes are compared
LONG = 0.5  # s, of the longer means
HOP = 0.1  # cm, by which an end of the knot moves in a frame where it hops
KNOTS, ANIMALS = list(plots.KNOTS), ("towed", "living")
ASKED = {"mean": 5, "long": 15, "way": 3, "pull": 5, "met": 95, "alike": 0.97}  # %, and a correlation


@dataclass
class Row:
    """One run; cm, s, dyn, erg. Figures from `off_20_ms` on are against the run that its study compares with; None: not measured."""

    study: str  # which grid
    knot: str  # expected type
    animal: str  # "towed" by its tail, or "living"
    bodies: int
    step: float  # ms
    variant: str  # seed, stiffness over that of the scene, or what `hagfish sure` changes
    outcome: str  # "ok" where the run came to its end
    way: float | None = None  # of the knot's head end while it slides
    time: float | None = None  # of the slide
    met: float | None = None  # sliding steps that meet Eq. 6, %
    capped: float | None = None  # steps with a row at its cap, %
    multipliers: float | None = None  # sum of the four, over h: mean
    work: float | None = None  # of f_thigmo for each cm of way
    moment: float | None = None  # |f_thigmo| of the slide's mean, dyn cm
    hops: float | None = None  # frames, 20 ms apart, between which an end moves by more than HOP
    travel: float | None = None  # of the tail end, all moves added up
    pull: float | None = None  # N
    off_20_ms: float | None = None  # |f - f'| of means over 20 ms, of |f'|, %
    off_long: float | None = None  # the same of means over LONG, %
    off_mean: float | None = None  # of the slide's mean, %
    alike: float | None = None  # correlation of means over 20 ms
    off_way: float | None = None  # %


UNITS = {"step": "step_ms", "way": "way_cm", "time": "time_s", "met": "met_percent", "capped": "capped_percent", "multipliers": "multipliers_dyn",
         "work": "work_erg_per_cm", "moment": "mean_moment_dyn_cm", "hops": "hops", "travel": "tail_end_travel_cm", "pull": "pull_N",
         "off_20_ms": "off_20_ms_percent", "off_long": "off_500_ms_percent", "off_mean": "off_mean_percent", "alike": "correlation_20_ms",
         "off_way": "off_way_percent"}
HEADING = [UNITS.get(field.name, field.name) for field in fields(Row)]


def knot_of(scene: str) -> str:
    """The type that a scene of this name is of."""
    return plots.SCENES[scene.removeprefix("pull_").removeprefix("living_").removesuffix("_waypoints")]


def moments_of(log: HagfishLog, force: str, frames: np.ndarray) -> np.ndarray:
    """Moments of one kind of force at STATIONS: frames x (3 axes times stations), dyn cm. They are the body's, which any mesh has."""
    _, joint, kind = log.hinges()
    arc = log.joint_arc()
    place, values = arc[joint] / (arc[-1] + log["/model/length"][-1]), log.at_hinges(log.moments(force)[frames])
    return np.concatenate([[np.interp(STATIONS, place[kind == each], row[kind == each]) for row in values] for each in KINDS], axis=1)


def moments(log: HagfishLog) -> np.ndarray:
    """Those of f_thigmo in the slide, means from frame to frame."""
    return moments_of(log, "thigmotaxis", log.intervals_in("slide"))


def off(found: np.ndarray, wanted: np.ndarray) -> float:
    return float(100 * np.linalg.norm(found - wanted) / np.linalg.norm(wanted))


def long_means(force: np.ndarray, frames: int) -> np.ndarray:
    whole = len(force) // frames
    return force[:whole * frames].reshape(whole, frames, -1).mean(axis=1)


def way_of(log: HagfishLog) -> float:
    """Of the knot's head end in the slide, cm, to where the head is let go. Frames beside that may have the head end elsewhere, which goes
    to and fro there; the step of the release has it at release_at."""
    head, scene = log["/knot/head_end"][log.in_phase("slide")], log.scene()
    let_go = log["/trajectory/time"][-1] < scene["time"]["duration"]
    return float(head[0] - (min(head[-1], scene["controller"]["release_at"]) if let_go else head[-1]))


def add_log(row: Row, log: HagfishLog) -> None:
    """What only a log shows of a run by itself."""
    frames = log.in_phase("slide")
    steps = log["/trajectory/step"].astype(int) - int(log["/trajectory/step"][0])
    own = slice(steps[frames[0]], steps[frames[-1]])
    multipliers = log["/steps/thigmotaxis_lambda"][own]
    head, tail = log["/knot/head_end"][frames], log["/knot/tail_end"][frames]
    row.way = way_of(log)
    work = log["/diagnostics/work_thigmotaxis"][frames]
    row.capped = float(100 * (np.nanmax(multipliers, axis=1) >= 0.999999 * log.scene()["controller"]["cap"]).mean())
    row.multipliers = float(np.nansum(multipliers, axis=1).mean())
    row.work = float((work[-1] - work[0]) / row.way)
    row.moment = float(np.linalg.norm(moments(log).mean(axis=0)))
    row.hops = float(sum((np.abs(np.diff(end)) > HOP).sum() for end in (head, tail)))
    row.travel = float(np.abs(np.diff(tail)).sum())


def compare(row: Row, log: HagfishLog, with_row: Row, with_log: HagfishLog) -> None:
    found, wanted = moments(log), moments(with_log)
    both = min(len(found), len(wanted))
    window = round(LONG / float(np.median(np.diff(log["/trajectory/time"]))))
    row.off_20_ms = off(found[:both], wanted[:both])
    row.off_long = off(long_means(found[:both], window), long_means(wanted[:both], window)) if both >= window else None
    row.off_mean = off(found.mean(axis=0), wanted.mean(axis=0))
    row.alike = float(np.corrcoef(found[:both].ravel(), wanted[:both].ravel())[0, 1])
    row.off_way = 100 * (row.way / with_row.way - 1) if row.way and with_row.way else None


def sweep_rows(study: str, table: SweepTable, variants: Iterable[str]) -> list[Row]:
    known = lambda value: None if np.isnan(value) else float(value)
    rows = []
    for i, variant in enumerate(variants):
        scene, of = table.axes["scene"][i], {key: known(values[i]) for key, values in table.figures.items()}
        axis = lambda key, default: float(table.axes[key][i]) if key in table.axes else default
        span = None if of["duration_s"] is None or of["slide_from_s"] is None else of["duration_s"] - of["slide_from_s"]
        rows.append(Row(study, knot_of(scene), "living" if "living" in scene else "towed", int(axis("model.bodies", 100)), 1e3 * axis("time.step", 0.002),
                        variant, table.texts["outcome"][i], of["slide_distance_cm"], span, of["eq6_percent"], pull=of["pull_N"]))
    return rows


def interval_rows(folder: Path) -> list[Row]:
    """What `hagfish sure` found of each slide, by chance, steps and bodies: a row a run that counts."""
    rows = []
    for path in sorted(folder.iterdir()):
        found = sure.read(path)
        of = found.table.figures
        animal, step = ("living", 0.005) if "living" in path.name else ("towed", 0.002)  # the scenes' own
        axis = lambda key, cell, own: float(found.table.axes[key][cell] or own)
        for cell, cause in enumerate(found.causes):
            if cause not in (sure.AS_IS, *sure.NUMERICS) or not found.counted[cell]:
                continue
            way = float(of["slide_distance_cm"][cell])
            rows.append(Row("sure", knot_of(path.name), animal, int(axis("model.bodies", cell, 100)), 1e3 * axis("time.step", cell, step), cause, "ok", way,
                            multipliers=float(of["sliding_force_dyn"][cell]), work=float(of["work_thigmotaxis_erg"][cell]) / way if way > 0 else None))
    return rows


def compared_with(row: Row) -> dict[str, object]:
    """The run of its knot and study that a run is compared with: 100 bodies at 1 ms or, at 2 ms, twice the bodies; of starts the first."""
    if row.study == "starts":
        return {"variant": "1"}
    return {"bodies": 100, "step": 1.0} if row.step != 2 else {"bodies": 2 * row.bodies, "step": 2.0}


def read_study(folder: Path) -> list[Row]:
    """Every run that the study left in its folder."""
    rows: list[Row] = []
    for study in ("meshes", "midpoint", "starts"):
        table = read_sweep(folder / study / "table.csv")
        own = sweep_rows(study, table, table.axes.get("start.seed", [""] * len(table.axes["scene"])))
        logs = [HagfishLog(log_of(folder / study, str(cell))) for cell in range(len(own))]
        for row, log in zip(own, logs):
            if row.way is None:
                continue
            add_log(row, log)
            other = one(own, knot=row.knot, animal=row.animal, **compared_with(row))
            if other is not None and other is not row and other.way is not None:
                compare(row, log, other, logs[own.index(other)])
        rows += own
    ratio = lambda text: f"{float(text.strip('[]').split(',')[0]) / 2e5:.3f}"
    for study in ("pulls", "stiffness"):
        if (folder / study / "table.csv").is_file():
            table = read_sweep(folder / study / "table.csv")
            axis = table.axes.get("specimen.passive.bending_stiffness")
            rows += sweep_rows(study, table, map(ratio, axis) if axis else [""] * len(table.axes["scene"]))
    return rows + (interval_rows(folder / "sure") if (folder / "sure").is_dir() else [])


def read_table(path: Path) -> tuple[list[Row], list[str]]:
    """Rows, and the notes above them."""
    lines = path.read_text(encoding="utf-8").splitlines()
    notes = [line[2:] for line in lines if line.startswith("# ")]
    kinds = {field.name: {"str": str, "int": int}.get(str(field.type), float) for field in fields(Row)}
    rows = []
    for line in csv.DictReader(line for line in lines if not line.startswith("# ")):
        cells = {field.name: line[name] for field, name in zip(fields(Row), HEADING)}
        rows.append(Row(**{name: kinds[name](text) if text or kinds[name] is str else None for name, text in cells.items()}))
    return rows, notes


def pick(rows: Iterable[Row], **wanted: object) -> list[Row]:
    return [row for row in rows if all(getattr(row, key) == value for key, value in wanted.items())]


def one(rows: Iterable[Row], **wanted: object) -> Row | None:
    return next(iter(pick(rows, **wanted)), None)


def shown(value: float | None, form: str = ".0f") -> str:
    return "-" if value is None or np.isnan(value) else f"{value:{form}}".replace("e+0", "e")


def animals(rows: list[Row]) -> list[tuple[str, str]]:
    return [(knot, animal) for animal in ANIMALS for knot in KNOTS if pick(rows, knot=knot, animal=animal)]


def runs_table(rows: list[Row]) -> list[str]:
    body = []
    for knot, animal in animals(rows):
        for row in pick(rows, study="meshes", knot=knot, animal=animal):
            body.append([f"{knot}, {animal}", str(row.bodies), f"{row.step:g}", shown(row.way, ".2f"), shown(row.time, ".2f"), shown(row.met, ".1f"),
                         shown(row.capped, ".1f"), shown(row.multipliers, ".2g"), shown(row.work, ".2g"), shown(row.moment, ".3g"), shown(row.hops),
                         shown(row.travel, ".1f")])
    return tables.markdown(["knot, animal", "bodies", "step, ms", "way, cm", "time, s", "Eq. 6 met, %", "at the cap, %", "multipliers, dyn",
                            "work, erg/cm", "moment of the mean, dyn cm", "hops", "travel of the tail end, cm"], body)


PAIRS = {"5 against 1 ms": ("meshes", 100, 5.0), "the same, midpoint rule": ("midpoint", 100, 5.0), "100 against 200 bodies": ("meshes", 100, 2.0),
         "200 against 400 bodies": ("meshes", 200, 2.0), "50 against 100 bodies": ("meshes", 50, 2.0)}


def pairs_table(rows: list[Row]) -> list[str]:
    pairs = {pair: key for pair, key in PAIRS.items() if any(row.off_mean is not None for row in pick(rows, study=key[0], bodies=key[1], step=key[2]))}
    body = []
    for knot, animal in animals(rows):
        cells = [f"{knot}, {animal}"]
        for study, bodies, step in pairs.values():
            row = one(rows, study=study, knot=knot, animal=animal, bodies=bodies, step=step)
            cells.append("-" if row is None or row.off_mean is None else
                         f"{shown(row.off_mean)}; {shown(row.off_long)}; {shown(row.off_20_ms)}; {shown(row.off_way, '+.0f')}")
        body.append(cells)
    return tables.markdown(["slide's mean; 0.5 s; 20 ms; way: off by, %", *pairs], body)


def starts_table(rows: list[Row]) -> list[str]:
    body = []
    for knot, animal in animals(rows):
        own = [row for row in pick(rows, study="starts", knot=knot, animal=animal) if row.alike is not None]
        if own:
            span = lambda name, form: " and ".join(shown(getattr(row, name), form) for row in own)
            body.append([f"{knot}, {animal}", span("alike", ".2f"), span("off_mean", ".0f"), span("off_long", ".0f"), span("off_20_ms", ".0f"),
                         span("off_way", "+.0f")])
    return tables.markdown(["knot, animal", "correlation of 20 ms means", "slide's mean, %", "0.5 s, %", "20 ms, %", "way, %"], body)


def pulls_table(rows: list[Row]) -> list[str]:
    settings = [(100, 5.0), (100, 2.0), (100, 1.0), (200, 2.0)]
    body = []
    for knot, animal in animals(rows):
        own = [one(rows, study="pulls", knot=knot, animal=animal, bodies=bodies, step=step) for bodies, step in settings]
        known = [row.pull for row in own if row is not None and row.pull]
        body.append([f"{knot}, {animal}", *(shown(row.pull if row else None, ".3f") for row in own),
                     shown(100 * (max(known) - min(known)) / np.mean(known)) if known else "-"])
    return tables.markdown(["pull, N", *(f"{bodies} bodies, {step:g} ms" for bodies, step in settings), "largest less least, % of the mean"], body)


def interval(rows: list[Row], name: str, form: str) -> str:
    known = [value for row in rows if (value := getattr(row, name)) is not None]
    ends = [shown(end, form) for end in (min(known), max(known))]
    return ends[0] if ends[0] == ends[1] else " to ".join(ends)


def intervals_table(rows: list[Row]) -> list[str]:
    """Of each slide: the way, the median sum of multipliers and the work, over chance, steps and bodies apart."""
    body = []
    for knot, animal in animals(pick(rows, study="sure")):
        own = pick(rows, study="sure", knot=knot, animal=animal)
        as_is = pick(own, variant=sure.AS_IS)
        for name, what, form in (("way", "way, cm", ".3g"), ("multipliers", "multipliers, dyn", ".3g"), ("work", "work, erg/cm", ".3g")):
            body.append([f"{knot}, {animal}: {what}", interval(as_is, name, form),
                         *(interval(as_is + pick(own, variant=kind), name, form) for kind in sure.NUMERICS), interval(own, name, form)])
    return tables.markdown(["slide", sure.AS_IS, *sure.NUMERICS, "all three"], body)


def furthest(rows: list[Row], kind: str) -> str:
    """How far a kind of change takes the multipliers of any slide, of those as it is: median and largest, %."""
    found = []
    for knot, animal in animals(pick(rows, study="sure")):
        own = pick(rows, study="sure", knot=knot, animal=animal)
        base = pick(own, variant=sure.AS_IS)[0].multipliers
        found.append(max(100 * abs(row.multipliers / base - 1) for row in pick(own, variant=kind)))
    return f"{np.median(found):.2g} % (at most {max(found):.2g} %)"


def within(rows: list[Row], name: str, most: float, **wanted: object) -> str:
    """How many of the runs keep a bound, and the worst."""
    known = [abs(value) for row in pick(rows, **wanted) if (value := getattr(row, name)) is not None]
    return f"{sum(value <= most for value in known)} of {len(known)}; worst {max(known):.0f} %" if known else "not run"


def asked_table(rows: list[Row]) -> list[str]:
    body = []
    for name, key, what in (("off_mean", "mean", "slide's mean"), ("off_long", "long", "0.5 s means"), ("off_way", "way", "way")):
        for pair, (study, bodies, step) in list(PAIRS.items())[:3]:
            body.append([f"{what}, {pair.replace('the same', '5 against 1 ms')}", f"{ASKED[key]} %",
                         within(rows, name, ASKED[key], study=study, bodies=bodies, step=step)])
    met = [row for row in pick(rows, study="meshes") if row.met is not None]
    stiff = [row for row in pick(rows, study="stiffness") if row.met is not None]
    for what, own in (("Eq. 6 met, of the runs above", met), ("Eq. 6 met, 24 bodies of 0.9 to 1.1 times the stiffness at 5 and 2 ms", stiff)):
        if own:
            body.append([what, f"{ASKED['met']} % of steps", f"{sum(row.met >= ASKED['met'] for row in own)} of {len(own)}; least {min(row.met for row in own):.1f} %"])
    alike = [row.alike for row in pick(rows, study="starts") if row.alike is not None]
    if alike:
        body.append(["starts 0.1 degree apart, 20 ms means", f"correlation {ASKED['alike']}",
                     f"{sum(value >= ASKED['alike'] for value in alike)} of {len(alike)}; least {min(alike):.2f}"])
    return tables.markdown(["figure", "asked for", "runs that keep it"], body)


def spread(rows: list[Row], name: str) -> str:
    """By how much a figure of runs of 100 bodies at 5 and 1 ms differs, of their mean: median and largest over knots and animals, %."""
    found = []
    for knot, animal in animals(rows):
        pair = [getattr(row, name) for step in (5.0, 1.0) if (row := one(rows, study="meshes", knot=knot, animal=animal, bodies=100, step=step))]
        if len(pair) == 2 and None not in pair:
            found.append(100 * abs(pair[0] - pair[1]) / abs(np.mean(pair)))
    return f"{np.median(found):.0f} % (at most {max(found):.0f} %)"


def page(rows: list[Row], notes: list[str]) -> list[str]:
    lost = [row for row in rows if row.outcome != "ok"]
    usual = [row for row in pick(rows, study="meshes") if row.hops is not None]
    chance = [row.off_mean for row in pick(rows, study="starts") if row.off_mean is not None]
    still = [row for row in usual if row.hops == 0]
    return [
        "# Are the forces of Eq. 6 the animal's, or those of a mesh and a step?", "",
        "`bash experiments/studies/forces.sh` makes this page and [its table](forces.csv). " + " ".join(notes), "",
        f"**Answer.** Sums are the animal's. From 5 to 1 ms the sum of the multipliers changes by {spread(usual, 'multipliers')}, "
        f"the work for each centimetre by {spread(usual, 'work')}, and the way by {spread(usual, 'way')}: medians over knots and animals. "
        f"Mean forces of starts 0.1 degree apart differ by {np.median(chance):.0f} % (at most {max(chance):.0f} %). "
        "How the force is spread over joints and time still depends on the mesh and, by Euler's rule, on the step.", "",
        *asked_table(rows),
        "## Why", "",
        "- The first and the last contact are where the gap between strands reaches `controller.contact_gap` (`core/contact/ends.hpp`). "
        f"Such a place moves as the body does. In {len(still)} of {len(usual)} slides no end of the knot hops.",
        "- Eq. 6 holds in the mean over a patch of contact at either end (`controller.contact_patch`). "
        "The outermost point alone jumps from strand to strand, and the forces jump with it.",
        "- Where strands run side by side, the two rows of one contact contradict each other by the paper's words. "
        "`controller.eq6_slip = \"shape\"` asks for the slip of a knot that keeps its shape, which can be met at any angle.",
        "- Rows need neither hysteresis nor a bounded acceleration. Both were taken out.", "",
        "## What the runs did", "",
        "Towed animals are tied by waypoints of the tail. Living ones tie themselves. All slides are by the paper's law. "
        f"A hop is a move of an end of the knot by more than {HOP:g} cm in 20 ms. Moments are those of f_thigmo at {STATIONS.size} stations.", "",
        *runs_table(rows),
        *([f"{len(lost)} of {len(rows)} runs did not come to their end: "
           + "; ".join(f"{row.study}, {row.knot}, {row.animal}, {row.bodies} bodies, {row.step:g} ms: {row.outcome}" for row in lost) + ".", ""] if lost else []),
        "## Step and mesh", "",
        "Each slide begins from its own tied knot. They are compared by the time since then. |f - f'| is taken over all stations and windows, of |f'|.", "",
        *pairs_table(rows),
        "## Chance", "",
        "Three starts with 0.1 degree of noise on every hinge, tied anew. The second and the third are compared with the first.", "",
        *starts_table(rows),
        *(["## Intervals", "",
           "`hagfish sure` runs each slide as its scene has it, from starts of 1e-6 degree, at smaller steps, and with 60 to 200 bodies. "
           f"Chance takes the multipliers {furthest(rows, 'chance')} from the scene's, steps {furthest(rows, 'step')}, bodies {furthest(rows, 'bodies')}: "
           "medians over slides. Where chance is far less than the others, the difference is the simulator's error and no instability of the body. "
           "Quote a slide's figures with the last column.", "",
           *intervals_table(rows)] if pick(rows, study="sure") else []),
        *(["## Pulls at food", "", *pulls_table(rows)] if pick(rows, study="pulls") else []),
        "## What this page does not show", "",
        "- Slides of one state at other steps. Here tying differs too.",
        "- Why meshes differ, and slides of one curve at other meshes: [another page](forces_mesh.md) has them.",
        "- Animals whose head is free, which slide by the midpoint rule.",
        "- Why a living overhand knot's head end hops: two places of the strand touch in turn, each for some steps. "
        "The last frame of its slide may show the hinder one, so that its way is the least certain figure here."]


def notes_of(sweep: Path) -> list[str]:
    """What was measured, where and when: of a sweep that kept its logs."""
    log = HagfishLog(log_of(sweep, "0"))
    date = datetime.datetime.fromtimestamp((sweep / "table.csv").stat().st_mtime, datetime.UTC)
    return [f"Measured at {str(log.attribute('git_revision'))[:12]} on {log.attribute('cpu')}, {date:%Y-%m-%d}."]


def main(folder: Path, table: Path, out: Path) -> None:
    rows = [["" if cell is None else cell for cell in astuple(row)] for row in read_study(folder)]
    tables.write_csv(table, HEADING, rows, notes_of(folder / "meshes"))
    tables.write_page(out, page(*read_table(table)))


if __name__ == "__main__":
    run_script(__doc__, ["FOLDER", "OUT.csv", "OUT.md"], main)
