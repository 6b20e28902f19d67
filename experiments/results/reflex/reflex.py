"""The reflex: its table, its page and its figure.

Usage: reflex.py FOLDER OUT.csv OUT.md OUT.png (writes a PDF beside). FOLDER is what study.sh leaves. Rows of OUT.csv
stay where FOLDER has not their part of the study, so that a part can be made anew by itself. The page is made of the table alone: a test
makes it again.
"""

from __future__ import annotations

import datetime
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any

import numpy as np

import plots
import reflex_runs
import tables
from hagfish_log import HagfishLog
from reflex_runs import Row, read_table
from script import run_script
from slides import log_of

KNOTS = list(plots.KNOTS)
USUAL, FINE_MESH, FINE_STEP, FINEST = "100; 2", "200; 2", "100; 1", "200; 1"  # bodies; step, ms
ASKED_MESH = 3  # %, by which the time of the slide may differ between meshes
STIFFNESS, RIGIDITY, DAMPING = 5e5, 2e5, 3e3  # B_a of living_overhand; B and C of the specimen: dyn cm^2, dyn cm^2, dyn cm^2 s
NAMES = {"delay": "senses late by, s", "noise": "senses wrong by, share of each angle", "bodies": "bodies", "step": "step, s",
         "drag": "drag across the body, g/(s cm)", "muscle": "muscles B_a, dyn cm²", "damping": "damping C, dyn cm² s",
         "stiffness": "body EI, dyn cm²", "animals": "other animals", "starts": "starts with 3° of noise"}
UNTIED = "not tied"
CHANGES = {"shift": "Δ, cm", "delay": NAMES["delay"], "noise": NAMES["noise"], "normal": NAMES["drag"], "bending_damping": NAMES["damping"],
           "noise_deg": "starts with noise, degrees"}
LOOSE = {"tighten": "where the knot is first there", "form": "a second before that"}


def pick(rows: Iterable[Row], **wanted: str) -> list[Row]:
    return [row for row in rows if all(getattr(row, key) == value for key, value in wanted.items())]


def one(rows: Iterable[Row], **wanted: str) -> Row | None:
    return next(iter(pick(rows, **wanted)), None)


def law_speed(shift: float) -> float:
    """v = Δ (B_a + B) / C, cm/s."""
    return shift * (STIFFNESS + RIGIDITY) / DAMPING


def figure_of(value: float | None, digits: int = 3) -> str:
    if value is None or np.isnan(value):
        return "-"
    text = f"{value:.{digits}g}"
    return text.replace("e+0", "e").replace("e-0", "e-")


def came(row: Row | None) -> str:
    """How far the knot came, in words."""
    if row is None:
        return "not run"
    if row.way is None or row.time is None:
        return UNTIED
    return f"{row.way:.1f} in {row.time:.1f} s" if row.slid == "yes" else f"lost at {row.way:.1f}" if row.held == "no" else f"{row.way:.1f}"


def span(values: Iterable[float | None], form: Callable[[float], str] = lambda v: figure_of(v, 2)) -> str:
    known = [value for value in values if value is not None and not np.isnan(value)]
    least, most = form(min(known)), form(max(known))
    return least if least == most else f"{least} to {most}"


def knots_table(rows: list[Row]) -> list[str]:
    body = []
    for head in ("clamped", "free"):
        for knot in KNOTS:
            own, paper = one(rows, study="knots", knot=knot, head=head, setting=USUAL), one(rows, study="paper", knot=knot, head=head)
            for name, row in (("reflex", own), ("Eq. 6", paper)):
                if row is not None:
                    body.append([f"{knot}, {head}", name, came(row), row.held, figure_of(row.torque, 2), figure_of(row.effort, 2),
                                 figure_of(row.put_in, 2), figure_of(row.work, 2), figure_of(row.wave, 2), figure_of(row.travel, 2)])
    return tables.markdown(["knot, head", "law", "way, cm, in time", "type held", "largest torque, dyn cm", "effort, dyn s",
                            "work put in, erg/cm", "net work, erg/cm", "wave's speed, of the knot's", "travel, share of change"], body)


def apart(a: float | None, b: float | None) -> str:
    """By how much b differs from a, %."""
    return f"{100 * (b / a - 1):+.1f}" if a and b else "-"


def mesh_table(rows: list[Row]) -> list[str]:
    settings = [USUAL, FINE_MESH, FINE_STEP, FINEST]
    body = []
    for head in ("clamped", "free"):
        for knot in KNOTS:
            found = [one(rows, study="knots", knot=knot, head=head, setting=setting) for setting in settings]
            of = lambda key: [getattr(row, key) if row else None for row in found]
            time, middle = of("time"), of("middle")
            body.append([f"{knot}, {head}", *("; ".join(figure_of(value) for value in pair) for pair in zip(time, middle)),
                         *(apart(values[0], values[1]) for values in (time, middle)), apart(middle[1], middle[3])])
    return tables.markdown(["slide; its middle, s", *(f"{s.split('; ')[0]} bodies, {s.split('; ')[1]} ms" for s in settings),
                            "slide, 200 against 100 bodies, %", "middle, the same, %", "middle, 1 against 2 ms, 200 bodies, %"], body)


def meshes_table(rows: list[Row]) -> list[str]:
    own = pick(rows, study="meshes")
    counts = list(dict.fromkeys(row.setting for row in own))
    body = []
    for head in ("clamped", "free"):
        for knot in KNOTS:
            found = [one(own, knot=knot, head=head, setting=count) for count in counts]
            times = {count: row.middle for count, row in zip(counts, found) if row}
            body.append([f"{knot}, {head}", *(figure_of(times.get(count)) for count in counts), apart(times.get("200"), times.get("400"))])
    return tables.markdown(["middle of the slide, s", *(f"{count} bodies" for count in counts), "400 against 200, %"], body)


def changed_table(rows: list[Row]) -> list[str]:
    """The free head: one setting changed at a time, and starts."""
    own = pick(rows, study="free")
    body = []
    for setting in dict.fromkeys(row.setting for row in own):
        name, _, value = setting.partition(" = ")
        cells = []
        for knot in KNOTS:
            runs = pick(own, knot=knot, setting=setting)
            cells.append(came(runs[0]) if len(runs) == 1 else f"{len(pick(runs, slid='yes'))} of {len(runs)}")
        body.append([f"{CHANGES.get(name, name)}: {value}" if value else setting, *cells])
    programs = pick(rows, study="free_programs")
    if programs:
        tied = lambda knot: [row for row in pick(programs, knot=knot) if row.way is not None]
        body.append(["programs with noise of 0.2 rad/L", *(f"{len(pick(tied(knot), slid='yes'))} of {len(tied(knot))} tied" for knot in KNOTS)])
    return tables.markdown(["3_1 to 5_2, free, h = 5 ms", *KNOTS], body)


def wiped_table(rows: list[Row]) -> list[str]:
    body = []
    for head in ("clamped", "free"):
        for knot in KNOTS:
            pair = [one(rows, study=study, knot=knot, head=head, setting=USUAL) for study in ("knots", "paper")]
            body.append([f"{knot}, {head}", *(figure_of(getattr(row, key) if row else None, 2) for row in pair for key in ("rings", "skin"))])
    return tables.markdown(["share that skin pressed on", "reflex: length", "reflex: skin", "Eq. 6: length", "Eq. 6: skin"], body)


def loose_table(rows: list[Row]) -> list[str]:
    body = [[row.knot, LOOSE[row.study], row.setting, figure_of(row.time, 2), row.types.replace(" ", ", "), figure_of(row.span_from), figure_of(row.span_to)]
            for row in rows if row.study in ("tighten", "form")]
    return tables.markdown(["knot", "the reflex begins", "Δ at the tail end, of that at the head end", "for, s", "what there was, in turn", "span then, cm",
                            "least span, cm"], body)


def grid_table(rows: list[Row], study: str) -> list[str]:
    own = pick(rows, study=study)
    settings = list(dict.fromkeys(row.setting for row in own))
    return tables.markdown(["what copies", *KNOTS], [[setting, *(came(one(own, knot=knot, setting=setting)) for knot in KNOTS)]
                                                     for setting in settings])


def speed_table(rows: list[Row]) -> list[str]:
    own = pick(rows, study="speed")
    cases = list(dict.fromkeys((row.knot, row.head) for row in own))
    shifts = list(dict.fromkeys(row.setting.split("; ")[0] for row in own))
    body = []
    for shift in shifts:
        law = law_speed(float(shift))
        cells = []
        for knot, head in cases:
            pair = [one(own, knot=knot, head=head, setting=f"{shift}; {step}") for step in (5, 2)]
            cells.append("; ".join(f"{row.speed / law:.2f}" + ("" if row.slid == "yes" else "*") for row in pair if row and row.way))
        body.append([shift, figure_of(law), *cells])
    return tables.markdown(["Δ, cm", "law, cm/s", *(f"{knot}, {head}: measured of law, 5 ms; 2 ms" for knot, head in cases)], body)


def robust_table(rows: list[Row]) -> list[str]:
    body = []
    for study, name in NAMES.items():
        own = pick(rows, study=study)
        if not own:
            continue
        if study in ("animals", "starts"):
            tied = lambda knot: [row for row in pick(own, knot=knot) if row.way is not None]
            body.append([name, *(f"{len(pick(tied(k), slid='yes'))} of {len(tied(k))} tied" for k in KNOTS)])
            continue
        for setting in dict.fromkeys(row.setting for row in own):
            body.append([f"{name}: {setting}", *(came(one(own, knot=knot, setting=setting)) for knot in KNOTS)])
    return tables.markdown(["3_1 to 5_2, clamped, h = 5 ms", *KNOTS], body)


def claims_table(rows: list[Row]) -> list[str]:
    body = []
    for study, name in (("knots", "reflex"), ("paper", "Eq. 6")):
        for knot in KNOTS:
            row = one(rows, study=study, knot=knot, head="clamped", setting=USUAL)
            if row is not None and row.behind is not None:
                body.append([knot, name, figure_of(row.behind, 2), figure_of(row.near, 2), row.rank, figure_of(row.rough_space, 2),
                             figure_of(row.rough_time, 2), figure_of(row.likeness, 2)])
    return tables.markdown(["knot", "law", "largest behind the knot, of the largest", "near the head, of far from it", "grows to the head",
                            "roughness along the body", "roughness in time", "cosine with the curvature's gradient"], body)


def pull_table(rows: list[Row]) -> list[str]:
    body = [[row.knot, "Eq. 6 at all contacts" if row.setting == "paper" else "reflex, scene's Δ", figure_of(row.pull, 2), row.held]
            for row in pick(rows, study="pull")]
    body += [[row.knot, f"reflex, Δ = {row.setting} cm", figure_of(row.pull, 2), row.held] for row in pick(rows, study="pull_shift")]
    return tables.markdown(["knot", "law", "pull, N", "type held"], sorted(body, key=lambda cells: cells[0]))


def beside(rows: list[Row], row: Row) -> Row | None:
    """The run here that a run in MuJoCo is held against: the same without the head plate."""
    return one(rows, study="beside", knot=row.knot, head=row.head, setting=row.setting if row.setting.startswith("no drag") else "with drag")


def mujoco_table(rows: list[Row]) -> list[str]:
    body = []
    for row in pick(rows, study="mujoco"):
        own = beside(rows, row)
        body.append([f"{row.knot}, {row.head}", row.setting or "from the straight body", came(row), row.held, came(own),
                     figure_of(own.time / row.time if own and own.time else None), figure_of(own.middle / row.middle if own and own.middle and row.middle else None)])
    return tables.markdown(["knot, head", "run", "MuJoCo: way, cm, in time", "type held", "here", "speed there, of that here", "the same, middle of the slide"], body)


def counted(rows: list[Row], study: str) -> tuple[int, int]:
    own = [row for row in pick(rows, study=study) if row.way is not None]
    return len(pick(own, slid="yes")), len(own)


def page(rows: list[Row], notes: list[str]) -> list[str]:
    usual = pick(rows, study="knots", setting=USUAL)
    paper = pick(rows, study="paper")
    all_slid = f"{len(pick(usual, slid='yes'))} of {len(usual)}"
    efforts = [own.effort / other.effort for own in usual if own.effort
               for other in pick(paper, knot=own.knot, head=own.head) if other.effort]
    starts, animals = counted(rows, "starts"), counted(rows, "animals")
    off = lambda key, setting, base=USUAL, **of: max((100 * abs(getattr(other, key) / getattr(own, key) - 1) for own in pick(rows, study="knots", setting=base, **of)
                                                      if getattr(own, key) for other in pick(rows, study="knots", setting=setting, knot=own.knot, head=own.head)
                                                      if getattr(other, key)), default=np.nan)
    middles = lambda study, setting, knot, head: getattr(one(rows, study=study, setting=setting, knot=knot, head=head), "middle", None)
    curves = {knot: apart(middles("curves", "100", knot, "clamped"), middles("curves", "200", knot, "clamped")) for knot in KNOTS}
    free_runs = pick(rows, study="free") + pick(rows, study="free_programs")
    free_tied = [row for row in free_runs if row.way is not None]
    rate = pick(rows, study="rate")
    soft = [(own, other) for other in pick(rows, study="paper_soft") for own in pick(rows, study="stiffness", knot=other.knot, setting=other.setting)]
    lost = [(own, other) for own, other in soft if other.held == "no"]
    free = [row.speed / law_speed(0.0106) for row in usual if row.head == "free"]  # the scenes' 2.5e-4 L
    nothing = [row.way for row in pick(rows, study="knockouts", setting="nothing copied")]
    shuffled = [row for row in pick(rows, study="laws") if row.setting.startswith("shuffled")]
    reflex_pull, paper_pull = pick(rows, study="pull", setting="reflex"), pick(rows, study="pull", setting="paper")
    which = {"drag": lambda row: not row.setting.startswith("no drag"), "none": lambda row: row.setting == "no drag", "fine": lambda row: "200 bodies" in row.setting}
    ratios = lambda key, of: [getattr(own, key) / getattr(row, key) for row in pick(rows, study="mujoco") if which[of](row) for own in [beside(rows, row)]
                              if own and getattr(own, key) and getattr(row, key)]
    pulls = "; ".join(f"{knot}: {figure_of(one(reflex_pull, knot=knot).pull, 2)} N against {figure_of(one(paper_pull, knot=knot).pull, 2)} N"
                      for knot in KNOTS if one(reflex_pull, knot=knot) and one(paper_pull, knot=knot))
    return [
        "# One local rule slides every knot: the reflex", "",
        "`bash study.sh` makes this page, [its table](reflex.csv) and the figure. " + " ".join(notes), "",
        "**Question.** How could a hagfish control so many joints while a knot slides to its head?", "",
        "**Answer.** It need not compute forces: if every joint copies its tailward neighbour, each of the four knots slides. "
        f"Here {all_slid} runs did, with the head held and free, by one number.", "",
        "![Ways, torque and gradient, law of speed, and where the rule holds](../figures/reflex.png)", "",
        "## Why", "",
        "Each joint takes the curvature that its body has a small length Δ behind it. Muscles of stiffness B_a pull there:", "",
        "    torque = B_a (κ(s + Δ) - κ(s)) ≈ B_a Δ ∂κ/∂s          and the same share of the body's own stiffness B",
        "    C ∂κ/∂t = (B_a + B) Δ ∂κ/∂s   has the solution   κ(s, t) = κ(s + v t, 0),   v = Δ (B_a + B) / C", "",
        "C is the damping of the body, s the arc length from the head. Any shape travels to the head as it is. A knot is a shape. No term knows of knots, contacts or forces.", "",
        "## All four knots, beside Eq. 6 at all contacts", "",
        "The animal is the same, and so is the program that ties the knot. Effort is the mean over the body of all torque, for each cm of way. "
        "*Travel* is the share of the shape's change that a wave to the head explains.", "",
        *knots_table(rows),
        f"- The reflex takes {span(efforts, lambda v: f'{v:.2f}')} times the effort of Eq. 6 at all contacts.",
        f"- Its shape travels: {span([row.travel for row in usual])} of all change; by Eq. 6 {span([row.travel for row in paper])}.",
        f"- The wave has {span([row.wave for row in usual])} times the speed of the knot.",
        "- Its net work is negative: the body's springs, bent by the program, give more back than water and joints take.", "",
        *mesh_table(rows),
        f"*Steps.* Between 2 and 1 ms no time differs by more than {max(off('time', FINE_STEP), off('time', FINEST, FINE_MESH), off('middle', FINE_STEP), off('middle', FINEST, FINE_MESH)):.1f} %.", "",
        "*Meshes.* A slide begins and ends with contacts that come and go, and the log's head end hops from joint to joint, by up to a centimetre. The middle of a "
        "slide is timed between two arcs of the place where skins first come within 0.05 cm, which goes evenly "
        f"({'; '.join(f'{knot}: {first:g} to {last:g} cm' for knot, (first, last) in reflex_runs.MIDDLE.items())}).", "",
        f"- Free heads: 200 bodies differ from 100 by up to {off('middle', FINE_MESH, head='free'):.1f} % there, where {ASKED_MESH} % were asked for.",
        f"- Clamped heads: by up to {off('middle', FINE_MESH, head='clamped'):.1f} %: not within {ASKED_MESH} %. A head plate besides holds up the end of these slides.", "",
        *meshes_table(rows),
        "One cause is the rule itself. Between two joints it takes the curvature on a straight line, so that a shape smears as it travels, by v/2 times the spacing of joints. "
        "Where joints copy a parabola through three of them instead, 200 bodies differ from 100, clamped, by "
        + "; ".join(f"{knot}: {value} %" for knot, value in curves.items() if value != "-") + ". That brings the 3_1 within 3 %, and not the 4_1. What holds the others apart was not found.", "",
        "## The law of speed", "",
        "Measured speed over v = Δ (B_a + B) / C. A star marks a knot that came less far than its scene asks.", "",
        *speed_table(rows),
        f"With a free head the four knots have {span(free, lambda v: f'{v:.2f}')} times the law's speed, at the scenes' Δ. "
        "With a clamped head they are slower. At large Δ the speed no longer grows in proportion; what stops it was not measured.", "",
        "## What it needs: knock-outs", "",
        "Way of the head end in cm, and the time where the knot came to the head. Without a time it stayed on the body.", "",
        *grid_table(rows, "knockouts"),
        f"- Where nothing is copied, nothing slides: {span(nothing, lambda v: f'{v:.1f}')} cm in all that time.",
        "- Copying the headward neighbour sends the knot to the tail and off.",
        "- Either bend is enough for some knots, both bends for all. Twist alone slides nothing, and is not needed.",
        "- Joints near a contact are enough if the reach is some centimetres.", "",
        "Fewer joints, from the same tied knot (`experiments/results/reflex/reflex_laws.py`, without the C++ law):", "",
        *grid_table(rows, "laws"),
        f"- Shuffled neighbours lose the knot: {len(pick(shuffled, held='no'))} of {len(shuffled)} runs.",
        "- Joints of the knot are enough. Those outside it do nothing: cutting them changes little.",
        "- Each joint must copy: one joint of two is not enough.",
        "- The first third of the knot is enough for some knots, and slow.",
        "- Muscles of one side are enough, and take longer.", "",
        "Fewer numbers: each joint gets a new command some times a second, and holds it in between. It holds its torque beyond that of its own angle, "
        "or its rest shape, taken as far behind as a shape travels until the next one:", "",
        *grid_table(rows, "rate"),
        f"- {len(pick(rate, slid='yes'))} of {len(rate)} runs came to the head. One new torque a second is enough for each knot.",
        "- One new shape a second is a leap by 2.5 cm, which takes the knot along.", "",
        "## How robust it is", "",
        f"Of starts that tied, {starts[0]} of {starts[1]} slid; of other animals that tied, {animals[0]} of {animals[1]}." if animals[1] else
        f"Of starts that tied, {starts[0]} of {starts[1]} slid. Other animals were not run.", "",
        *robust_table(rows),
        *changed_table(rows),
        f"- Free heads: of {len(free_tied)} runs that tied {len(pick(free_tied, slid='yes'))} slid to the head.",
        "- Noise of the start is gone when the slide begins: the program has the same shape made of it. Noise of the program is not.",
        "- The free 5_2 comes undone at the head a little before its first contact is at the scene's mark. That counts as lost.",
        "- *Not tied* is no failure of the reflex: the program could not bend so stiff a body, or so coarse a chain.",
        "- Senses may be later than the slide is long: then the torques stay what they were at its start. A short slide needs no feedback at all.", "",
        "## The paper's claims about the sliding force", "",
        "Held against the reflex's own torque, which is what its muscles do beyond holding the body's shape (clamped, means over 20 ms).", "",
        *claims_table(rows),
        "- *Zero behind the knot*: no. Joints that are bent behind the last contact copy too.",
        "- *Larger near the head*: no. It follows the shape, and the shape hardly changes.",
        "- *Smooth along the body, noisy in time*: the other way round. It is smooth in time, and as rough along the body as the shape's gradient.", "",
        "## What else it does", "",
        *pull_table(rows),
        f"- Does it pull at food? Yes; here beside Eq. 6 at all contacts, each as its scenes are set: {pulls}.", "",
        *loose_table(rows),
        "- Does it tighten a knot? The 3_1, by a fifth, if Δ is three times as large at the knot's tail end; even, hardly. Others it does not.",
        "- Does it form a knot from a loose loop? No: cut off a second early, no knot came to be what it was to be.", "",
        *wiped_table(rows),
        f"- Does it wipe? Yes: skin pressed on {span([row.rings for row in usual])} of the body's length, and on {span([row.skin for row in usual])} of all skin at least, "
        f"in one slide; by Eq. 6 on {span([row.rings for row in paper])} and {span([row.skin for row in paper])}. Contacts are counted as points.", "",
        *tables.markdown(["knot, EI, dyn cm²", "reflex", "Eq. 6 at all contacts"], [[f"{own.knot}, {own.setting}", came(own), came(other)] for own, other in soft]),
        (f"- Does it keep a knot that Eq. 6 loses? Of the {len(lost)} that Eq. 6 lost here it kept {sum(own.held == 'yes' for own, _ in lost)}. " if lost else
         f"- Does it keep a knot that Eq. 6 loses? None was found: Eq. 6 lost none of {len(soft)} here. ")
        + f"The reflex came to the head in {sum(own.slid == 'yes' for own, _ in soft)} of them, Eq. 6 in {sum(other.slid == 'yes' for _, other in soft)}.", "",
        "## In MuJoCo, in closed loop", "", "`hagfish mujoco-run`: MuJoCo's own soft contacts and limits, h = 2 ms. No restarts. MuJoCo's model has no head plate, so the runs here have none either.", "",
        *mujoco_table(rows),
        f"- With drag the knot's speed there is {span(ratios('time', 'drag'), lambda v: f'{v:.2f}')} times that here over the slide, and {span(ratios('middle', 'drag'), lambda v: f'{v:.2f}')} in its middle.",
        f"- Without drag it is {span(ratios('time', 'none'), lambda v: f'{v:.2f}')} times. The 5_1 alone is apart, and of 200 bodies it is not: there {span(ratios('time', 'fine'), lambda v: f'{v:.2f}')} times.",
        "- Held against runs here with a head plate, the 5_2 was 1.21 times as fast: the plate holds up its last centimetre.", "",
        "![The three-twist knot here and in MuJoCo](../figures/reflex_strip.png)", "",
        "Above: here. Below: MuJoCo. Colours: bending torque of the muscles, to 1.2e5 dyn cm (yellow). Both simulators side by side, as a replay and as films:", "",
        "    hagfish run reflex_three_twist --set wall.present=false --out here.h5",
        "    hagfish mujoco-run reflex_three_twist --out there.h5",
        "    hagfish view here.h5 there.h5 --out replay.html",
        "    hagfish movie there.h5 --out there.mp4 --colour active", "",
        "## What an experiment could look for", "",
        "1. The wave of bending along the body has the knot's own speed. By f_thigmo it has not.",
        "2. Late senses do no harm: a knot slides on when its animal cannot feel what it does.",
        "3. Cutting the feedback beyond the knot changes nothing.",
        "4. Stiffer muscles slide the knot faster; more damping of the body slows it.",
        "5. Muscles may be told anew as rarely as once a second, and the knot slides on.", "",
        "## What f_thigmo tells that the reflex does not", "",
        "f_thigmo is what joints must do so that the body slides along itself at given speeds. It bounds the speed at contacts, "
        "and says where forces must act if nothing behind the knot may. It is not the gradient of the shape, as its cosine shows. "
        "The reflex commands no speed at a contact: contacts, water and damping decide. Inverse dynamics tell what is needed; the reflex tells how little is enough.", "",
        "## What is new", "",
        "A controller of one number that knows neither knot, contact nor model slides all four knots, and a closed form of its speed. "
        "Muscle torques are found by each joint alone.", "",
        "## What this page does not show", "",
        "- That a hagfish does it: nobody has measured how bending travels in a sliding knot.",
        "- Friction and flesh, which the model lacks.",
        "- Pairs of changes at once, and laws that the tables lack: they were not run.",
        "- The law of speed at many Δ with a free head."]


def draw_ways(axes: Any, folder: Path) -> None:
    """The clamped knots without a head plate, here and, from the same state at the start of the slide, in MuJoCo."""
    table = reflex_runs.read_sweep(folder / "beside/table.csv")
    rows = reflex_runs.sweep_rows("beside", table, reflex_runs.settings_of("beside", table))
    for cell, row in enumerate(rows):
        if row.setting != "with drag" or row.head != "clamped":
            continue
        scene, look = table.axes["scene"][cell], plots.KNOTS[row.knot]
        for path, style in ((log_of(folder / "beside", str(cell)), {"label": look.label}), (folder / f"mujoco/{scene}-from_the_slide.h5", {"ls": "--"})):
            log = HagfishLog(path)
            frames = log.in_phase("slide")
            time = log["/trajectory/time"][frames]
            axes.plot(time - time[0], log["/knot/head_end"][frames], color=look.colour, **style)
    axes.plot([], [], color=plots.GREY, ls="--", label="in MuJoCo")
    axes.set(xlabel="time since the start of the slide, s", ylabel="head end of the knot, cm from the head", ylim=(0, 13))
    axes.legend(loc="upper right", ncols=2)


def draw_torque(axes: Any, folder: Path) -> None:
    """The reflex's own torque along the body beside the gradient of curvature, half way through the slide of the 3_1."""
    log = HagfishLog(log_of(folder / "knots", "0"))
    frames = log.intervals_in("slide")
    frame = frames[frames.size // 2: frames.size // 2 + 1]
    _, joint, kind = log.hinges()
    curvature, arc, apart = reflex_runs.shape(log, frame)
    slope = np.gradient(curvature[0, 0], apart)
    own = reflex_runs.asked_torques(log, frame)[0, kind == "bend_y"]
    scale = (STIFFNESS + RIGIDITY) * float(log.scene()["controller"]["reflex"]["shift"]) / 1e3
    axes.axvspan(float(log["/knot/head_end"][frame[0]]), float(log["/knot/tail_end"][frame[0]]), color=plots.GRID, lw=0, label="the knot")
    axes.plot(arc, scale * slope, color=plots.GREY, lw=2.5, label=r"$\Delta\,(B_a+B)\,\partial\kappa/\partial s$")
    axes.plot(arc, own / 1e3, color=plots.VERMILION, marker="o", ms=3, lw=1, label="torque of the reflex")
    axes.set(xlabel="arc length from the head, cm", ylabel="bending about Y, 1000 dyn cm", xlim=(0, arc[-1]))
    axes.legend(loc="upper right")


def draw_speeds(axes: Any, rows: list[Row]) -> None:
    own = [row for row in pick(rows, study="speed") if row.way and row.setting.endswith("; 2")]
    for (knot, head), marker in zip(dict.fromkeys((row.knot, row.head) for row in own), "oDs"):
        of = pick(own, knot=knot, head=head)
        axes.plot([float(row.setting.split("; ")[0]) for row in of], [row.speed for row in of], color=plots.KNOTS[knot].colour, marker=marker,
                  ls="-" if head == "clamped" else "--", mfc="white" if head == "free" else None, label=f"{plots.KNOTS[knot].label}, {head}")
    shifts = sorted({float(row.setting.split("; ")[0]) for row in own})
    axes.plot(shifts, [law_speed(shift) for shift in shifts], color=plots.GREY, lw=0.9, ls=":", label=r"$v=\Delta\,(B_a+B)/C$", zorder=0)
    axes.set(xscale="log", yscale="log", xlabel=r"length by which joints copy, $\Delta$, cm", ylabel="speed of the knot, cm/s")
    plots.plain_ticks(axes.xaxis, shifts)
    axes.legend(loc="upper left")


MAPPED = {"delay": "late, s", "noise": "wrong, share", "bodies": "bodies", "step": "step, s", "drag": "drag, g/(s cm)", "muscle": "$B_a$",
          "damping": "$C$", "stiffness": "$EI$"}


def draw_map(axes: Any, rows: list[Row]) -> None:
    """A line for each setting, a cell for each of its values, split in four: full where the knot came to the head."""
    studies = [study for study in MAPPED if pick(rows, study=study)]
    for y, study in enumerate(studies):
        own = pick(rows, study=study)
        for x, setting in enumerate(dict.fromkeys(row.setting for row in own)):
            for k, knot in enumerate(KNOTS):
                row = one(own, knot=knot, setting=setting)
                if row is None:
                    continue
                tied = row.way is not None
                look = plots.KNOTS[knot]
                axes.plot(x - 0.24 + 0.16 * k, y + 0.16, ls="", marker=look.marker if tied else "x", ms=5.5, mec=look.colour,
                          mfc=look.colour if row.slid == "yes" else "white", color=look.colour)
            axes.text(x, y - 0.26, setting, ha="center", va="center", fontsize=6.5)
    axes.set_yticks(range(len(studies)), [MAPPED[study] for study in studies])
    axes.set_xticks([])
    axes.grid(False)
    axes.set(ylim=(len(studies) - 0.5, -0.6), xlim=(-0.6, 7.6))
    axes.set_xlabel("full: came to the head; open: did not; cross: the program tied no knot", fontsize=8)


def draw(folder: Path, rows: list[Row], out: Path) -> None:
    figure, (ways, torque, speeds, where) = plots.panels(2, 2, (11, 8), [
        "every knot slides to the head", "the torque is the gradient of the shape ($3_1$, half way)", "the law of speed", "where it holds"])
    draw_ways(ways, folder)
    draw_torque(torque, folder)
    draw_speeds(speeds, rows)
    draw_map(where, rows)
    plots.save(figure, out)


def notes_of(folder: Path, kept: list[str]) -> list[str]:
    """Which machine, and when: of the part of the study that was last run."""
    logs = sorted((log for log in folder.glob("*/logs/*.h5")), key=lambda path: path.stat().st_mtime)
    if not logs:
        return kept
    date = datetime.datetime.fromtimestamp(logs[-1].stat().st_mtime, datetime.UTC)
    return [f"Measured on {HagfishLog(logs[-1]).attribute('cpu')}, {date:%Y-%m-%d}; the column commit has the program of each run."]


def main(folder: Path, table: Path, out: Path, figure: Path) -> None:
    kept, notes = read_table(table) if table.is_file() else ([], [])
    rows = reflex_runs.with_parts(kept, reflex_runs.read_study(folder))
    reflex_runs.write_table(table, rows, notes_of(folder, notes))
    rows, notes = read_table(table)
    tables.write_page(out, page(rows, notes))
    if all((folder / part / "table.csv").is_file() for part in ("knots", "beside")):
        draw(folder, rows, figure)


if __name__ == "__main__":
    run_script(__doc__, ["FOLDER", "OUT.csv", "OUT.md", "OUT.png"], main)
