"""The reflex: its tables and figures.

Usage: reflex.py FOLDER KNOWN.csv. FOLDER is what study.sh leaves, KNOWN.csv the table of all runs as the page has it. Its rows
stay where FOLDER has not their part of the study, so that a part can be made anew by itself: of an empty FOLDER all tables are
made of those that are known. A test makes them so.
"""

import datetime
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any

import matplotlib
import numpy as np

import plots
import reflex_runs
import skin
import tables
from hagfish_log import HagfishLog
from log_pictures import take_pictures
from reflex_runs import Row, read_table
from script import run_script
from sweep_columns import BOTH_ENDS, read_cells
from tables import shown

KNOTS = list(plots.KNOTS)
CASES = [(knot, head) for head in ("clamped", "free") for knot in KNOTS]
USUAL, FINE_MESH, FINE_STEP, FINEST = "100; 2", "200; 2", "100; 1", "200; 1"  # bodies; step, ms
STIFFNESS, RIGIDITY, DAMPING = 5e5, 2e5, 3e3  # B_a of living_overhand; B and C of the specimen: dyn cm^2, dyn cm^2, dyn cm^2 s
NAMES = {"delay": "senses late by, s", "noise": "senses wrong by, share of each angle", "bodies": "bodies", "step": "step, s",
         "drag": "drag across the body, g/(s cm)", "muscle": "muscles B_a, dyn cm²", "damping": "damping C, dyn cm² s",
         "stiffness": "body EI, dyn cm²", "animals": "other animals that tied", "starts": "starts with 3° of noise that tied"}
SHIFT = 0.0106  # cm: the scenes' 2.5e-4 L
UNTIED = "not tied"
CHANGES = {"shift": "Δ", "delay": NAMES["delay"], "noise": NAMES["noise"], "normal": NAMES["drag"], "bending_damping": NAMES["damping"],
           "noise_deg": "starts with noise, degrees"}
SIZE, LEGEND = "560x500", 80  # pixels of a picture, and of these its legend's height
LOOSE = {"tighten": "where the knot is first there", "form": "a second before that"}


Cells = tuple[list[str], list[list[str]]]  # heading and rows of a table


def pick(rows: Iterable[Row], **wanted: str) -> list[Row]:
    return [row for row in rows if all(getattr(row, key) == value for key, value in wanted.items())]


def one(rows: Iterable[Row], **wanted: str) -> Row | None:
    return next(iter(pick(rows, **wanted)), None)


def law_speed(shift: float) -> float:
    """v = Δ (B_a + B) / C, cm/s."""
    return shift * (STIFFNESS + RIGIDITY) / DAMPING


def came(row: Row | None) -> str:
    """How far the knot came, in words."""
    if row is None:
        return "not run"
    if row.way is None or row.time is None:
        return UNTIED
    if row.held == "no":
        return f"lost at {row.way:.1f}"
    if row.slid == "yes":
        return f"{row.way:.1f} in {row.time:.1f} s"
    return f"{row.way:.1f}" + (f": {row.kind}" if row.kind not in ("", "does not slide", BOTH_ENDS) else "")


def knots_table(rows: list[Row]) -> Cells:
    body = []
    for knot, head in CASES:
        for name, row in (("reflex", one(rows, study="knots", knot=knot, head=head, setting=USUAL)),
                          ("Eq. 6", one(rows, study="paper", knot=knot, head=head))):
            if row is not None:
                figures = (row.torque, row.effort, row.put_in, row.work, row.wave, row.travel)
                body.append([f"{knot}, {head}", name, came(row), row.held, *(shown(value, ".2g") for value in figures)])
    return ["knot, head", "law", "way, cm, in time", "type held", "largest torque, dyn cm", "effort, dyn s",
            "work put in, erg/cm", "net work, erg/cm", "wave's speed, of the knot's", "travel, share of change"], body


def apart(a: float | None, b: float | None) -> str:
    """By how much b differs from a, %."""
    return f"{100 * (b / a - 1):+.1f}" if a and b else "-"


def mesh_table(rows: list[Row]) -> Cells:
    settings = [USUAL, FINE_MESH, FINE_STEP, FINEST]
    body = []
    for knot, head in CASES:
        found = [one(rows, study="knots", knot=knot, head=head, setting=setting) for setting in settings]
        time, middle = ([getattr(row, key) if row else None for row in found] for key in ("time", "middle"))
        body.append([f"{knot}, {head}", *("; ".join(map(shown, pair)) for pair in zip(time, middle)),
                     apart(*time[:2]), apart(*middle[:2]), apart(middle[1], middle[3])])
    return ["slide; its middle, s", *("{} bodies, {} ms".format(*setting.split("; ")) for setting in settings),
            "slide, 200 against 100 bodies, %", "middle, the same, %", "middle, 1 against 2 ms, 200 bodies, %"], body


def meshes_table(rows: list[Row]) -> Cells:
    own = pick(rows, study="meshes")
    counts = list(dict.fromkeys(row.setting for row in own))
    body = []
    for knot, head in CASES:
        times = {row.setting: row.middle for row in pick(own, knot=knot, head=head)}
        body.append([f"{knot}, {head}", *(shown(times.get(count)) for count in counts), apart(times.get("200"), times.get("400"))])
    return ["middle of the slide, s", *(f"{count} bodies" for count in counts), "400 against 200, %"], body


def wiped_table(rows: list[Row]) -> Cells:
    share = lambda row, key: shown(getattr(row, key) if row else None, ".2g")
    return ["share that skin pressed on", "reflex: length", "reflex: skin", "Eq. 6: length", "Eq. 6: skin"], [
        [f"{knot}, {head}", *(share(one(rows, study=study, knot=knot, head=head, setting=USUAL), key)
                              for study in ("knots", "paper") for key in ("rings", "skin"))] for knot, head in CASES]


def loose_table(rows: list[Row]) -> Cells:
    return ["knot", "the reflex begins", "Δ at the tail end, of that at the head end", "for, s",
            "what there was, in turn", "span then, cm", "least span, cm"], [
        [row.knot, LOOSE[row.study], row.setting, shown(row.time, ".2g"), row.types.replace(" ", ", "),
         shown(row.span_from), shown(row.span_to)] for row in rows if row.study in LOOSE]


def grid_table(rows: list[Row], study: str) -> Cells:
    own = pick(rows, study=study)
    settings = list(dict.fromkeys(row.setting for row in own))
    return ["what copies", *KNOTS], [[setting, *(came(one(own, knot=knot, setting=setting)) for knot in KNOTS)] for setting in settings]


def speed_table(rows: list[Row]) -> Cells:
    own = pick(rows, study="speed")
    cases = list(dict.fromkeys((row.knot, row.head) for row in own))
    body = []
    for shift in dict.fromkeys(row.setting.split("; ")[0] for row in own):
        law = law_speed(float(shift))
        pairs = ([one(own, knot=knot, head=head, setting=f"{shift}; {step}") for step in (5, 2)] for knot, head in cases)
        body.append([shift, shown(law), *("; ".join(f"{row.speed / law:.2f}" + ("" if row.slid == "yes" else "*")
                                                        for row in pair if row and row.way) for pair in pairs)])
    return ["Δ, cm", "law, cm/s", *(f"{knot}, {head}: measured of law, 5 ms; 2 ms" for knot, head in cases)], body


def slid_of(rows: list[Row]) -> str:
    return f"{len(pick(rows, slid='yes'))} of {len(rows)}"


def robust_table(rows: list[Row]) -> Cells:
    """One setting changed at a time, other animals and starts."""
    body = []
    tied = lambda own, knot: [row for row in pick(own, knot=knot) if row.way is not None]
    for study, name in NAMES.items():
        own = pick(rows, study=study)
        if study in ("animals", "starts"):
            body += [[f"clamped, {name}", *(slid_of(tied(own, knot)) for knot in KNOTS)]] if own else []
            continue
        for setting in dict.fromkeys(row.setting for row in own):
            body.append([f"clamped, {name}: {setting}",
                         *(came(one(own, knot=knot, setting=setting)) for knot in KNOTS)])
    own = pick(rows, study="free")
    for setting in dict.fromkeys(row.setting for row in own):
        name, _, value = setting.partition(" = ")
        runs = [pick(own, knot=knot, setting=setting) for knot in KNOTS]
        body.append([f"free, {CHANGES.get(name, name)}: {value}" if value else f"free, {setting}",
                     *(came(each[0]) if len(each) == 1 else slid_of(each) for each in runs)])
    if programs := pick(rows, study="free_programs"):
        body.append(["free, programs with noise of 0.2 rad/L that tied",
                     *(slid_of(tied(programs, knot)) for knot in KNOTS)])
    return ["3_1 to 5_2, h = 5 ms", *KNOTS], body


def claims_table(rows: list[Row]) -> Cells:
    body = []
    for study, name in (("knots", "reflex"), ("paper", "Eq. 6")):
        for row in pick(rows, study=study, head="clamped", setting=USUAL):
            if row.behind is not None:
                body.append([row.knot, name, shown(row.behind, ".2g"), shown(row.near, ".2g"), row.rank,
                             row.rough_space, row.rough_time, shown(row.likeness, ".2g")])
    return ["knot", "law", "largest behind the knot, of the largest", "near the head, of far from it",
            "grows to the head", "roughness along the body: bend Y; bend Z; twist", "roughness in time: the same",
            "cosine with the curvature's gradient"], body


def pull_table(rows: list[Row]) -> Cells:
    laws = {"paper": "Eq. 6 at all contacts", "reflex": "reflex, scene's Δ"}
    runs = [*pick(rows, study="pull"), *pick(rows, study="pull_shift")]
    body = [[row.knot, laws.get(row.setting, f"reflex, Δ = {row.setting} cm"), shown(row.pull, ".2g"), row.held] for row in runs]
    return ["knot", "law", "pull, N", "type held"], sorted(body, key=lambda cells: cells[0])


def soft_pairs(rows: list[Row]) -> list[tuple[Row, Row]]:
    """The same soft body slid by the reflex and by Eq. 6."""
    return [(own, other) for other in pick(rows, study="paper_soft")
            for own in pick(rows, study="stiffness", knot=other.knot, setting=other.setting)]


def soft_table(rows: list[Row]) -> Cells:
    return ["knot, EI, dyn cm²", "reflex", "Eq. 6 at all contacts"], [
        [f"{own.knot}, {own.setting}", came(own), came(other)] for own, other in soft_pairs(rows)]


def beside(rows: list[Row], row: Row) -> Row | None:
    """The run here that a run in MuJoCo is held against: the same without the head plate."""
    return one(rows, study="beside", knot=row.knot, head=row.head,
               setting=row.setting if row.setting.startswith("no drag") else "with drag")


def mujoco_table(rows: list[Row]) -> Cells:
    body = []
    for row in pick(rows, study="mujoco"):
        own = beside(rows, row)
        body.append([f"{row.knot}, {row.head}", row.setting or "from the straight body", came(row), row.held, came(own),
                     shown(own.time / row.time if own and own.time else None),
                     shown(own.middle / row.middle if own and own.middle and row.middle else None)])
    return ["knot, head", "run", "MuJoCo: way, cm, in time", "type held", "here", "speed there, of that here",
            "the same, middle of the slide"], body


def figures_table(rows: list[Row]) -> Cells:
    """What sentences of the page say and no other table has."""
    usual, paper, rate = pick(rows, study="knots", setting=USUAL), pick(rows, study="paper"), pick(rows, study="rate")
    twice = [(own, other) for own in usual if own.effort for other in pick(paper, knot=own.knot, head=own.head) if other.effort]
    torque = lambda row: row.effort * row.speed
    tied = lambda *studies: [row for study in studies for row in pick(rows, study=study) if row.way is not None]
    shuffled = [row for row in pick(rows, study="laws") if row.setting.startswith("shuffled")]
    free = [row.speed / law_speed(SHIFT) for row in usual if row.head == "free"]
    nothing = [row.way for row in pick(rows, study="knockouts", setting="nothing copied") if row.way is not None]
    soft = soft_pairs(rows)
    lost = [own for own, other in soft if other.held == "no"]
    there = [(beside(rows, row), row) for row in pick(rows, study="mujoco")]

    def off(key: str, setting: str, base: str = USUAL, **of: str) -> float:
        """The most by which runs of a setting differ from those of another, %."""
        pairs = [(getattr(own, key), getattr(other, key)) for own in pick(rows, study="knots", setting=base, **of)
                 for other in pick(rows, study="knots", setting=setting, knot=own.knot, head=own.head)]
        return max((100 * abs(other / own - 1) for own, other in pairs if own and other), default=np.nan)

    def ratios(key: str, wanted: Callable[[str], bool]) -> str:
        pairs = [(getattr(own, key), getattr(row, key)) for own, row in there if own and wanted(row.setting)]
        return tables.span([own / other for own, other in pairs if own and other], ".2f")

    def curved(knot: str) -> str:
        middles = [row.middle for setting in ("100", "200")
                   for row in pick(rows, study="curves", knot=knot, setting=setting)]
        return apart(*middles)

    with_drag = lambda setting: not setting.startswith("no drag")
    plate, no_plate = (one(rows, study=study, knot="5_2", head="clamped", setting=setting) for study, setting in (
        ("knots", USUAL), ("mujoco", "from the slide")))
    steps = max(off(key, *settings) for key in ("time", "middle") for settings in ((FINE_STEP,), (FINEST, FINE_MESH)))
    return ["figure", "value"], [["runs that slid", slid_of(usual)],
        ["effort, of that of Eq. 6", tables.span([own.effort / other.effort for own, other in twice], ".2f")],
        ["mean torque, of that of Eq. 6", tables.span([torque(own) / torque(other) for own, other in twice], ".2f")],
        ["times at two steps differ by at most, %", f"{steps:.1f}"],
        ["skins touch within, cm", f"{skin.TOUCHING:g}"],
        *([f"arcs of the middle, {knot}, cm", f"{first:g} to {last:g}"] for knot, (first, last) in reflex_runs.MIDDLE.items()),
        *([f"meshes differ, {head}, %", f"{off('middle', FINE_MESH, head=head):.1f}"] for head in ("free", "clamped")),
        *([f"meshes by a parabola, {knot}, %", curved(knot)] for knot in KNOTS if pick(rows, study="curves", knot=knot)),
        ["speed of a free head, of the law's", tables.span(free, ".2f")],
        ["way where nothing is copied, cm", tables.span(nothing, ".1f")],
        ["shuffled neighbours that lose the knot", f"{len(pick(shuffled, held='no'))} of {len(shuffled)}"],
        ["runs of held commands that slid", slid_of([row for row in rate if row.setting != "all joints"])],
        ["leap of a shape held for a second, cm", shown(law_speed(SHIFT), ".2g")],
        ["starts that slid", slid_of(tied("starts"))],
        ["animals that slid", slid_of(tied("animals"))],
        ["free heads that tied", str(len(tied("free", "free_programs")))],
        ["free heads that slid", str(len(pick(tied("free", "free_programs"), slid="yes")))],
        ["lost by Eq. 6", f"{len(lost)} of {len(soft)}"],
        ["of these kept by the reflex", str(len(pick(lost, held="yes")))],
        ["soft bodies at the head by the reflex", str(len(pick([own for own, _ in soft], slid="yes")))],
        ["soft bodies at the head by Eq. 6", str(len(pick([other for _, other in soft], slid="yes")))],
        ["MuJoCo, from the straight body: slid", slid_of(pick(rows, study="mujoco", setting=""))],
        ["MuJoCo with drag, whole slide", ratios("time", with_drag)],
        ["MuJoCo with drag, middle", ratios("middle", with_drag)],
        ["MuJoCo without drag", ratios("time", lambda setting: setting == "no drag")],
        ["MuJoCo without it, fine mesh", ratios("time", lambda setting: "200 bodies" in setting)],
        ["5_2 here with a head plate, of MuJoCo's time", f"{plate.time / no_plate.time:.2f}"]]


TABLES: dict[str, Callable[[list[Row]], Cells]] = {
    "knots": knots_table, "mesh": mesh_table, "meshes": meshes_table, "speed": speed_table,
    "knockouts": lambda rows: grid_table(rows, "knockouts"), "laws": lambda rows: grid_table(rows, "laws"),
    "rate": lambda rows: grid_table(rows, "rate"), "robust": robust_table, "claims": claims_table, "pull": pull_table,
    "loose": loose_table, "wiped": wiped_table, "soft": soft_table, "mujoco": mujoco_table, "figures": figures_table}


def draw_ways(axes: Any, folder: Path) -> None:
    """The clamped knots without a head plate, here and, from the same state at the start of the slide, in MuJoCo."""
    for cell in read_cells(folder / "beside"):
        scene, look = cell.axes["scene"], plots.KNOTS[plots.knot_of(cell.axes["scene"])]
        if float(cell.axes["drag.normal"]) == 0 or scene.endswith("_free"):
            continue
        there = HagfishLog(folder / f"mujoco/{scene}-from_the_slide.h5")
        for log, style in ((cell.log, {"marker": look.marker, "markevery": (0.0, 0.2)}), (there, {"ls": "--"})):
            frames = log.in_phase("slide")
            time = log["/trajectory/time"][frames]
            axes.plot(time - time[0], log["/knot/head_end"][frames], color=look.colour, ms=4, **style)
    axes.set(xlabel="since the slide began, s", ylabel="head end, cm from the head", ylim=(0, None))


def draw_torque(axes: Any, folder: Path) -> None:
    """The reflex's own torque along the body beside the gradient of curvature, half way through the slide of the 3_1."""
    log = next(read_cells(folder / "knots")).log
    frames = log.intervals_in("slide")
    frame = frames[frames.size // 2: frames.size // 2 + 1]
    _, joint, kind = log.hinges()
    curvature, arc, apart = reflex_runs.shape(log, frame)
    slope = np.gradient(curvature[0, 0], apart)
    own = reflex_runs.asked_torques(log, frame)[0, kind == "bend_y"]
    scale = (STIFFNESS + RIGIDITY) * float(log.scene()["controller"]["reflex"]["shift"]) / 1e3
    ends = [float(log[f"/knot/{end}_end"][frame[0]]) for end in ("head", "tail")]
    axes.axvspan(*ends, color=plots.GRID, lw=0)
    axes.text(np.mean(ends), 0.98, "the knot", fontsize=8, ha="center", va="top", transform=axes.get_xaxis_transform())
    axes.plot(arc, scale * slope, color=plots.GREY, lw=2.5, label=r"$\Delta\,(B_a+B)\,\partial\kappa/\partial s$")
    axes.plot(arc, own / 1e3, color=plots.VERMILION, marker="o", ms=2.5, lw=1, label="torque: follows it")
    axes.set(xlabel="arc from the head, cm", ylabel="about Y, 1000 dyn cm", xlim=(0, arc[-1]), ylim=(-1.3, 0.8))
    axes.legend(loc="lower right")


def draw_speeds(axes: Any, rows: list[Row]) -> None:
    """Open where the knot came less far than its scene asks, or not by both ends."""
    own = [row for row in pick(rows, study="speed") if row.way and row.setting.endswith("; 2")]
    shift_of = lambda row: float(row.setting.split("; ")[0])
    for row in own:
        axes.plot(shift_of(row), row.speed, **plots.KNOTS[row.knot].style, mfc=None if row.slid == "yes" else "white", zorder=3)
    for knot, head in dict.fromkeys((row.knot, row.head) for row in own):
        of = pick(own, knot=knot, head=head)
        axes.plot([shift_of(row) for row in of], [row.speed for row in of], color=plots.KNOTS[knot].colour,
                  ls="-" if head == "clamped" else "--")
    shifts = sorted({shift_of(row) for row in own})
    axes.plot(shifts, [law_speed(shift) for shift in shifts], color=plots.GREY, lw=0.9, ls=":", zorder=0)
    axes.set(xscale="log", yscale="log", xlabel=r"$\Delta$, cm", ylabel="speed of the knot, cm/s")
    plots.plain_ticks(axes.xaxis, [0.0025, 0.01, 0.04, 0.16])
    plots.plain_ticks(axes.yaxis, [0.5, 1, 2, 5, 10, 20, 50])


def draw(folder: Path, rows: list[Row], out: Path) -> None:
    figure, (ways, torque, speeds) = plots.panels(1, 3, (plots.WIDTH, 3.2), [
        "knots slide to the head", "torque of the $3_1$, half way", "the law of speed"])
    draw_ways(ways, folder)
    draw_torque(torque, folder)
    draw_speeds(speeds, rows)
    handles = plots.knot_handles(ways)
    handles += ways.plot([], [], color=plots.GREY, ls="--", label="in MuJoCo")
    handles += ways.plot([], [], color=plots.INK, marker="o", ls="", mfc="white", label="short, or grows")
    handles += ways.plot([], [], color=plots.GREY, ls=":", label=r"$v=\Delta\,(B_a+B)/C$")
    plots.legend_above(figure, handles, 4, 0.13, columnspacing=1)
    plots.save(figure, out)


def colour_top(log: HagfishLog) -> float:
    """What `hagfish picture` gives the last colour: one in a hundred of the bending moments above 0 is larger, dyn cm."""
    bends = np.unique(log.hinges()[1][log.hinges()[2] != "twist"])
    size = np.linalg.norm(log.moments("active")[1:, bends, 1:], axis=2)
    return float(np.percentile(size[size > 0], 99))


def draw_strip(here: Path, there: Path, out: Path) -> None:
    """One slide here (above) and in MuJoCo (below), at the same times."""
    logs = [HagfishLog(path) for path in (here, there)]
    slides = [log["/trajectory/time"][log.in_phase("slide")] for log in logs]
    times = np.linspace(max(slide[0] for slide in slides), min(slide[-1] for slide in slides), 4)
    # The legend of colours below is too small to be read here.
    pictures = [[each.pixels[:-LEGEND] for each in take_pictures(log.path, times, "--colour", "active", "--size", SIZE)] for log in logs]
    ink = np.min([each.min(axis=2) for row in pictures for each in row], axis=0) < 1
    shown = tuple(slice(*np.flatnonzero(ink.any(axis=axis))[[0, -1]]) for axis in (1, 0))
    figure, grid = plots.plt.subplots(2, 4, figsize=(plots.WIDTH, 3.9), layout="constrained")
    for row, name, panels in zip(pictures, ("here", "in MuJoCo"), grid):
        for axes, each, time in zip(panels, row, times):
            axes.imshow(each[shown])
            axes.set_title(f"{time - times[0]:.1f} s", loc="center", fontsize=9)
            axes.set(xticks=[], yticks=[])
            axes.spines[:].set_visible(False)
        panels[0].set_ylabel(name, fontsize=9)
    colours = matplotlib.cm.ScalarMappable(matplotlib.colors.Normalize(0, max(map(colour_top, logs)) / 1e3), "viridis")
    figure.colorbar(colours, ax=grid, location="bottom", extend="max", shrink=0.6, aspect=40,
                    label="bending moment of the muscles, 1000 dyn cm")
    plots.save(figure, out)


def note_of(folder: Path, rows: list[Row], kept: list[str]) -> str:
    """By which programs, on which machine and when: of the part of the study that was last run."""
    logs = sorted(folder.glob("*/logs/*.h5"), key=lambda path: path.stat().st_mtime)
    if not logs:
        return kept[0]
    date = datetime.datetime.fromtimestamp(logs[-1].stat().st_mtime, datetime.UTC)
    programs = ", ".join(sorted({row.commit for row in rows}))
    return f"Measured at {programs} on {HagfishLog(logs[-1]).attribute('cpu')}, {date:%Y-%m-%d}."


def main(folder: Path, known: Path) -> None:
    kept, notes = read_table(known) if known.is_file() else ([], [])
    rows = reflex_runs.with_parts(kept, reflex_runs.read_study(folder))
    notes = [note_of(folder, rows, notes)]
    tables.write_table(folder, "reflex", reflex_runs.HEADING, reflex_runs.cells_of(rows), notes)
    rows, _ = read_table(folder / "tables/reflex.csv")  # to six digits
    for name, table in TABLES.items():
        tables.write_table(folder, f"reflex_{name}", *table(rows), notes)
    if all((folder / part / "table.csv").is_file() for part in ("knots", "beside")):
        draw(folder, rows, folder / "reflex.png")
        draw_strip(folder / "beside/logs/6.h5", folder / "mujoco/reflex_three_twist.h5", folder / "reflex_strip.png")


if __name__ == "__main__":
    run_script(__doc__, ["FOLDER", "KNOWN.csv"], main)
