"""What the study of the reflex measured: a row a run, read from its sweeps and logs (`read_study`), or from the table that is kept
of them (`read_table`), of which the page's tables are made."""

from collections.abc import Callable
from dataclasses import astuple, dataclass, fields
from pathlib import Path

import numpy as np

import audits
import claims
import plots
import skin
import tables
from hagfish_log import HagfishLog
from sweep_columns import BOTH_ENDS, Cell, read_cells

APART = 5  # frames between two shapes of which the wave's speed is found: 0.1 s
KINDS = ("bend_y", "bend_z")
# Arcs from the head, cm, between which a slide is timed: what begins and ends a slide, contacts that come and go, is not of it.
MIDDLE = {"3_1": (9.3, 3.0), "4_1": (5.4, 2.4), "5_1": (4.4, 2.2), "5_2": (4.5, 2.2)}


@dataclass
class Row:
    """One run; cm, s, dyn. None: not measured."""

    study: str  # which grid
    knot: str  # expected type
    head: str  # "clamped" or "free"
    setting: str  # what the run differs by
    way: float | None = None  # of the knot's head end while it slides
    time: float | None = None  # of the slide
    held: str = ""  # the knot kept its type: "yes" or "no"
    slid: str = ""  # it did, and slid by both ends as far as the scene asks
    kind: str = ""  # what the slide is by both ends: as `hagfish sweep` names it, or its share; empty where it was not judged
    torque: float | None = None  # largest of a hinge in the slide, dyn cm
    effort: float | None = None  # (1/L) integral |torque| ds dt for each cm of way, dyn s
    work: float | None = None  # net, of all torques, for each cm, erg/cm
    put_in: float | None = None  # the same, of hinges that turn as they are pulled alone, erg/cm
    pull: float | None = None  # N
    wave: float | None = None  # speed of the shape's travel, of the knot's
    travel: float | None = None  # share of the shape's change that is its travel
    likeness: float | None = None  # cosine of f_thigmo, or of the reflex's torque, with the curvature's gradient
    behind: float | None = None  # largest torque behind the knot, of the largest
    near: float | None = None  # sum of torques in the third of the way nearest the head, of that in the furthest
    rank: str = ""  # claim (b): "agrees", "undecided", "disagrees"
    rough_space: str = ""  # roughness along the body, 1 of white noise: of bends Y and Z and of twist
    rough_time: str = ""  # in time, of the same
    middle: float | None = None  # time of the knot's place between the two arcs of MIDDLE
    rings: float | None = None  # share of the body's length whose skin touched skin in the slide
    skin: float | None = None  # the same of its area
    span_from: float | None = None  # of a loose knot, where the reflex begins, cm
    span_to: float | None = None  # the least that it comes to, cm
    types: str = ""  # of the knot, in turn
    commit: str = ""  # of the program that made the run

    @property
    def speed(self) -> float:
        return self.way / self.time if self.way is not None and self.time else float("nan")


UNITS = {"way": "way_cm", "time": "time_s", "torque": "torque_dyn_cm", "effort": "effort_dyn_s",
         "work": "work_erg_per_cm", "put_in": "put_in_erg_per_cm",
         "pull": "pull_N", "wave": "wave_of_knot_speed", "travel": "travel_share", "near": "near_of_far",
         "middle": "middle_s", "rings": "rings_swept", "skin": "skin_swept",
         "span_from": "span_from_cm", "span_to": "span_least_cm"}
HEADING = [UNITS.get(field.name, field.name) for field in fields(Row)]


def head_of(scene: str) -> str:
    return "free" if scene.endswith("_free") else "clamped"


def number(text: str) -> str:
    """A setting as it is shown: of an array its first element, to three digits."""
    first = text.strip("[]").split(",")[0]
    try:
        return tables.short(float(first))
    except ValueError:
        return first


def sweep_row(study: str, setting: str, cell: Cell) -> Row:
    scene, of, held = cell.axes["scene"], cell.figures, cell.outcome == "ok"
    known = lambda value: None if np.isnan(value) else value
    return Row(study, plots.knot_of(scene), head_of(scene), setting, known(of["slide_distance_cm"]),
               known(of["duration_s"] - of["slide_from_s"]), "yes" if held else "no", "yes" if cell.slid else "no", cell.texts["slide"], pull=known(of["pull_N"]))


Axes = dict[str, str]  # of a run: its place on each axis of the sweep


def knockout(axes: Axes) -> str:
    of = lambda key: axes[f"controller.reflex.{key}"]
    kinds = [name for name, key in (("bend Y", "bend_y"), ("bend Z", "bend_z"), ("twist", "twist")) if of(key) == "true"]
    if of("gate") == "touch":
        return f"joints within {float(of('reach')):g} cm of a contact"
    if len(kinds) < 3:
        return "both bends" if len(kinds) == 2 else f"{kinds[0]} alone"
    return "all" if float(of("shift")) >= 1e-3 else "nothing copied" if float(of("shift")) > 0 else "headward neighbour"


def both_axes(first: str, second: str) -> Callable[[Axes], str]:
    """Two settings in one: "100 bodies, 2 ms"."""
    return lambda axes: f"{number(axes[first])}; {1000 * float(axes[second]):g}"


SETTING: dict[str, Callable[[Axes], str]] = {  # what a run of a sweep differs by, in words
    "paper": lambda axes: "100; 2", "knots": both_axes("model.bodies", "time.step"), "knockouts": knockout,
    "beside": lambda axes: "with drag" if float(axes["drag.normal"]) > 0 else "no drag",
    "speed": both_axes("controller.reflex.shift", "time.step"), "pull": lambda axes: "reflex" if "reflex" in axes["scene"] else "paper"}


def settings_of(study: str, runs: list[Axes]) -> list[str]:
    """Of runs of one sweep: the values of the first axis besides the scene; of animals their number; of axes that go together what a run
    changes of the first run's."""
    if study in SETTING:
        return [SETTING[study](axes) for axes in runs]
    keys = [key for key in runs[0] if key not in ("scene", "seed")]
    if study == "free":
        changed = lambda axes: [f"{key.split('.')[-1]} = {number(axes[key])}" for key in keys if axes[key] != runs[0][key]]
        return [next(iter(changed(axes)), "as it is") for axes in runs]
    if "specimen.length" in keys:
        lengths = list(dict.fromkeys(axes["specimen.length"] for axes in runs))
        return [str(1 + lengths.index(axes["specimen.length"])) for axes in runs]
    return [number(axes[keys[0]]) if keys else "" for axes in runs]


def shape(log: HagfishLog, frames: np.ndarray) -> tuple[np.ndarray, np.ndarray, float]:
    """Curvature of both bends, frames x kinds x joints, rad/cm; their arc, cm; from joint to joint, cm."""
    dof, joint, kind = log.hinges()
    own = [np.flatnonzero(kind == each) for each in KINDS]
    arc = log.joint_arc()[joint[own[0]]]
    apart = float(np.median(np.diff(arc)))
    angles = log["/trajectory/q"][frames][:, dof + 1]  # the root's rotation is a quaternion, which has one more
    return np.stack([angles[:, each] / apart for each in own], axis=1), arc, apart


def travel_of(log: HagfishLog) -> tuple[float, float]:
    """Speed at which the shape travels to the head, of the knot's, and the share of its change that this is: medians."""
    frames = log.in_phase("slide")
    head, time = log["/knot/head_end"][frames], log["/trajectory/time"][frames]
    curvature, _, apart = shape(log, frames)
    if frames.size <= 3 * APART:
        return float("nan"), float("nan")
    change = (curvature[APART:] - curvature[:-APART]) / (time[APART:] - time[:-APART])[:, None, None]
    slope = np.gradient((curvature[APART:] + curvature[:-APART]) / 2, apart, axis=2)
    speed = (change * slope).sum(axis=(1, 2)) / (slope**2).sum(axis=(1, 2))
    left = ((change - speed[:, None, None] * slope) ** 2).sum(axis=(1, 2)) / (change**2).sum(axis=(1, 2))
    knot = (head[0] - head[-1]) / (time[-1] - time[0])
    return float(np.nanmean(speed) / knot), float(1 - np.nanmedian(left))


def torques(log: HagfishLog, frames: np.ndarray) -> np.ndarray:
    """What slides the knot: moments of the muscles and of Eq. 6 together, means from frame to frame, frames x hinges."""
    return log.at_hinges((log.moments("active") + log.moments("thigmotaxis"))[frames])


def springs(log: HagfishLog, frames: np.ndarray) -> np.ndarray:
    """What the body's own springs take to hold its shape, in the mean since the frame before: frames x hinges, dyn cm."""
    dof, _, kind = log.hinges()
    apart = 2 * float(np.median(log["/model/length"]))  # hinges of one kind are two bodies apart
    passive = log.scene()["specimen"]["passive"]
    rigidity = np.where(kind == "twist", passive["twist_stiffness"][0], passive["bending_stiffness"][0])
    q = log["/trajectory/q"][:, dof + 1]
    return (q[frames] + q[frames - 1]) / 2 * rigidity / apart


def asked_torques(log: HagfishLog, frames: np.ndarray) -> np.ndarray:
    """What a law asks for to slide the knot, frames x hinges, dyn cm: f_thigmo, or the reflex's torque beyond what holds the shape."""
    thigmotaxis = log.at_hinges(log.moments("thigmotaxis")[frames])
    if np.any(thigmotaxis):
        return thigmotaxis
    # Of hinges, as springs are: against the moment in other axes the small rest would be lost.
    return log["/mean/forces/active"][frames][:, log.hinges()[0]] - springs(log, frames)


def gradient_likeness(log: HagfishLog, frames: np.ndarray, torque: np.ndarray) -> float:
    """Cosine of torques with the gradient of curvature, over both bends: median of frames."""
    _, _, kind = log.hinges()
    curvature, _, apart = shape(log, frames)
    slope = np.gradient(curvature, apart, axis=2).reshape(frames.size, -1)
    own = np.concatenate([torque[:, kind == each] for each in KINDS], axis=1)
    scale = np.linalg.norm(slope, axis=1) * np.linalg.norm(own, axis=1)
    return float(np.nanmedian(np.where(scale > 0, (slope * own).sum(axis=1) / np.where(scale > 0, scale, 1), np.nan)))


def add_log(row: Row, log: HagfishLog) -> None:
    """What only a log shows."""
    frames = log.intervals_in("slide")
    _, joint, kind = log.hinges()
    force, time = torques(log, frames), log["/trajectory/time"]
    head, tail = log["/knot/head_end"][frames], log["/knot/tail_end"][frames]
    interval = float(np.median(time[frames] - time[frames - 1]))
    way = float(head[0] - head[-1])
    work = sum(log[f"/diagnostics/work_{name}"] for name in ("active", "thigmotaxis"))
    row.torque = float(np.abs(force).max())
    row.effort = float(np.abs(force).sum() * interval * 2 / (joint.max() + 1)) / way
    row.work = float(work[frames[-1]] - work[frames[0]]) / way
    row.wave, row.travel = travel_of(log)
    turned = np.diff(log["/trajectory/q"], axis=0)[frames - 1][:, log.hinges()[0] + 1]
    row.put_in = float(np.maximum(force * turned, 0).sum()) / way
    asked = asked_torques(log, frames)
    row.likeness = gradient_likeness(log, frames, asked)
    arc = log.joint_arc()[joint]
    past = np.abs(asked)[arc[None, :] > tail[:, None]]
    row.behind = float(past.max() / np.abs(asked).max()) if past.size else 0.0
    size = np.abs(asked).sum(axis=1)
    row.near = claims.near_over_far(head, size)
    row.rank = claims.grows(row.near)
    row.rough_space, row.rough_time = ("; ".join(tables.short(claims.roughness(asked[:, kind == each], axis), ".2g")
                                                 for each in (*KINDS, "twist")) for axis in (1, 0))
    row.middle = middle_of(log, row.knot)
    row.rings, row.skin = skin.swept(log, log.in_phase("slide"))


def middle_of(log: HagfishLog, knot: str) -> float:
    """Time of the knot's place from one arc of MIDDLE to the other, s."""
    frames = log.in_phase("slide")
    place, time = skin.knot_place(log, frames), log["/trajectory/time"][frames]
    first, last = (skin.passed(time, place, arc) for arc in MIDDLE[knot])
    return last - first


SWEEPS = ("delay", "noise", "bodies", "step", "drag", "muscle", "damping", "stiffness", "starts", "animals",
          "pull_shift", "paper_soft", "free", "free_programs")


def add_middle(row: Row, log: HagfishLog) -> None:
    row.middle = middle_of(log, row.knot)


# Sweeps that keep their logs, and what is read from those.
LOGGED = {"knots": add_log, "meshes": add_middle, "beside": add_middle, "paper": add_log}


def commit_of(folder: Path) -> str:
    """Of the program that made a sweep: the first line of what it says of itself."""
    with (folder / "sweep.toml").open(encoding="utf-8") as file:
        return file.readline().split()[-1]


def read_laws(part: str, path: Path) -> list[Row]:
    return [Row(part, line["knot"], line["head"], line["law"],
                float(line["head_end_from_cm"]) - float(line["head_end_to_cm"]),
                float(line["slide_s"]), line["type_held"], "yes" if line["reached_head"] == "yes" and line["slide"] == BOTH_ENDS else "no",
                line["slide"], commit=line["commit"])
            for line in tables.read_csv(path, ["law"])]


def log_row(study: str, path: Path) -> Row:
    """A run by its log, SCENE.h5, or SCENE-WORDS.h5 where it differs from the others by something."""
    log = HagfishLog(path)
    slide = log.in_phase("slide")
    head, time = log["/knot/head_end"][slide], log["/trajectory/time"][slide]
    scene, _, setting = path.stem.partition("-")
    held = str(log.attribute("status")) == "complete"
    judged = audits.audit(path)
    both = audits.meets(judged, "slide of both ends")
    came = held and log["/trajectory/time"][-1] < log.scene()["time"]["duration"] - 1
    return Row(study, plots.knot_of(scene), head_of(scene), setting.replace("_", " "),
               float(head[0] - np.nanmin(head)), float(time[-1] - time[0]), "yes" if held else "no",
               "yes" if came and both else "no", BOTH_ENDS if both else f"{audits.value_of(judged, 'slide of both ends'):.0f} % by both ends",
               middle=middle_of(log, plots.knot_of(scene)), commit=str(log.attribute("git_revision"))[:12])


def read_loose(path: Path) -> list[Row]:
    return [Row(line["task"], line["knot"], "clamped", line["growth"], time=float(line["slide_s"]),
                span_from=float(line["span_from_cm"]), span_to=float(line["span_least_cm"]), types=line["types"],
                commit=line["commit"]) for line in tables.read_csv(path, ["growth"])]


def read_study(folder: Path) -> dict[str, list[Row]]:
    """Every run that the study left in its folder, by the part that it is of; a part that it has not run is not there."""
    parts: dict[str, list[Row]] = {}
    for study in (*LOGGED, "knockouts", "speed", *SWEEPS, "pull"):
        own = folder / study
        if not (own / "table.csv").is_file():
            continue
        cells = list(read_cells(own))
        settings = settings_of(study, [cell.axes for cell in cells])
        parts[study] = [sweep_row(study, setting, cell) for setting, cell in zip(settings, cells)]
        for row, cell in zip(parts[study], cells):
            row.commit = commit_of(own)
            if study in LOGGED and row.held == "yes":
                LOGGED[study](row, HagfishLog(cell.path))
    for part in ("laws", "rate"):
        if (folder / f"{part}.csv").is_file():
            parts[part] = read_laws(part, folder / f"{part}.csv")
    if (folder / "loose.csv").is_file():
        rows = read_loose(folder / "loose.csv")
        parts |= {task: [row for row in rows if row.study == task] for task in ("tighten", "form")}
    for part in ("curves", "mujoco", "beside"):
        rows = [log_row(part, path) for path in sorted(folder.glob(f"{part}/*.h5"))]
        if rows:
            parts[part] = parts.get(part, []) + rows
    return parts


PARTS = ("knots", "meshes", "curves", "paper", "knockouts", "laws", "rate", "speed", *SWEEPS, "pull", "tighten", "form", "beside", "mujoco")


def with_parts(rows: list[Row], parts: dict[str, list[Row]]) -> list[Row]:
    """Rows of a table, those of some parts of the study made anew."""
    return [row for part in PARTS for row in (parts[part] if part in parts
                                              else [row for row in rows if row.study == part])]


def cells_of(rows: list[Row]) -> list[list[object]]:
    return [["" if cell is None else cell for cell in astuple(row)] for row in rows]


def read_table(path: Path) -> tuple[list[Row], list[str]]:
    """Rows, and the notes above them."""
    table = tables.read_table(path)
    words = {field.name for field in fields(Row) if field.type is str}
    rows = []
    for line in table.rows:
        cells = {field.name: text for field, text in zip(fields(Row), line, strict=True)}
        rows.append(Row(**{name: text if name in words else float(text) if text else None for name, text in cells.items()}))
    return rows, table.notes
