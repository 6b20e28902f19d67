"""The reflex: its table, its page and its figure.

Usage: reflex.py FOLDER OUT.csv OUT.md OUT.png (writes a PDF beside). FOLDER is what experiments/studies/reflex.sh leaves. The page
is made of the table alone: a test makes it again.
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
USUAL, FINE_MESH, FINE_STEP = "100; 2", "200; 2", "100; 1"  # bodies; step, ms
ASKED_MESH = 3  # %, by which the time of the slide may differ between meshes
STIFFNESS, RIGIDITY, DAMPING = 5e5, 2e5, 3e3  # B_a of living_overhand; B and C of the specimen: dyn cm^2, dyn cm^2, dyn cm^2 s
UNTIED = "not tied"
NAMES = {"delay": "senses late by, s", "noise": "senses wrong by, share of each angle", "bodies": "bodies", "step": "step, s",
         "drag": "drag across the body, g/(s cm)", "muscle": "muscles B_a, dyn cm²", "damping": "damping C, dyn cm² s",
         "stiffness": "body EI, dyn cm²", "animals": "other animals", "starts": "starts with 3° of noise"}


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
            for name, row in (("reflex", own), ("paper", paper)):
                if row is not None:
                    body.append([f"{knot}, {head}", name, came(row), row.held, figure_of(row.torque, 2), figure_of(row.effort, 2),
                                 figure_of(row.put_in, 2), figure_of(row.work, 2), figure_of(row.wave, 2), figure_of(row.travel, 2)])
    return tables.markdown(["knot, head", "law", "way, cm, in time", "type held", "largest torque, dyn cm", "effort, dyn s",
                            "work put in, erg/cm", "net work, erg/cm", "wave's speed, of the knot's", "travel, share of change"], body)


def mesh_table(rows: list[Row]) -> list[str]:
    settings = [USUAL, FINE_MESH, FINE_STEP]
    body = []
    for head in ("clamped", "free"):
        for knot in KNOTS:
            found = [one(rows, study="knots", knot=knot, head=head, setting=setting) for setting in settings]
            coarse, fine = found[:2]
            known = coarse and fine and coarse.time and fine.time
            body.append([f"{knot}, {head}", *(figure_of(row.time if row else None) for row in found),
                         f"{100 * (fine.time / coarse.time - 1):+.1f}" if known else "-",
                         f"{100 * (fine.speed / coarse.speed - 1):+.1f}" if known else "-"])
    return tables.markdown(["time of the slide, s", *(f"{s.split('; ')[0]} bodies, {s.split('; ')[1]} ms" for s in settings),
                            "time, 200 against 100 bodies at 2 ms, %", "speed, the same, %"], body)


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
    for study, name in (("knots", "reflex"), ("paper", "paper")):
        for knot in KNOTS:
            row = one(rows, study=study, knot=knot, head="clamped", setting=USUAL)
            if row is not None and row.behind is not None:
                body.append([knot, name, figure_of(row.behind, 2), figure_of(row.near, 2), row.rank, figure_of(row.rough_space, 2),
                             figure_of(row.rough_time, 2), figure_of(row.likeness, 2)])
    return tables.markdown(["knot", "law", "largest behind the knot, of the largest", "near the head, of far from it", "grows to the head",
                            "roughness along the body", "roughness in time", "cosine with the curvature's gradient"], body)


def pull_table(rows: list[Row]) -> list[str]:
    body = [[row.knot, "paper's law" if row.setting == "paper" else "reflex, scene's Δ", figure_of(row.pull, 2), row.held]
            for row in pick(rows, study="pull")]
    body += [[row.knot, f"reflex, Δ = {row.setting} cm", figure_of(row.pull, 2), row.held] for row in pick(rows, study="pull_shift")]
    return tables.markdown(["knot", "law", "pull, N", "type held"], sorted(body, key=lambda cells: cells[0]))


def mujoco_table(rows: list[Row]) -> list[str]:
    body = []
    for row in pick(rows, study="mujoco"):
        own = one(rows, study="knots", knot=row.knot, head=row.head, setting=USUAL)
        body.append([f"{row.knot}, {row.head}", came(row), row.held, came(own), f"{row.speed / own.speed:.2f}" if own else "-"])
    return tables.markdown(["knot, head", "MuJoCo: way, cm, in time", "type held", "here", "speed there, of that here"], body)


def counted(rows: list[Row], study: str) -> tuple[int, int]:
    own = [row for row in pick(rows, study=study) if row.way is not None]
    return len(pick(own, slid="yes")), len(own)


def page(rows: list[Row], notes: list[str]) -> list[str]:
    usual = [row for row in pick(rows, study="knots", setting=USUAL)]
    paper = pick(rows, study="paper")
    all_slid = f"{len(pick(usual, slid='yes'))} of {len(usual)}"
    efforts = [own.effort / other.effort for own in usual if own.effort
               for other in pick(paper, knot=own.knot, head=own.head) if other.effort]
    starts, animals = counted(rows, "starts"), counted(rows, "animals")
    off = lambda setting: max((100 * abs(other.time / own.time - 1) for own in usual if own.time
                               for other in pick(rows, study="knots", setting=setting, knot=own.knot, head=own.head) if other.time), default=np.nan)
    mesh, step = off(FINE_MESH), off(FINE_STEP)
    free = [row.speed / law_speed(0.0106) for row in usual if row.head == "free"]  # the scenes' 2.5e-4 L
    nothing = [row.way for row in pick(rows, study="knockouts", setting="nothing copied")]
    shuffled = [row for row in pick(rows, study="laws") if row.setting.startswith("shuffled")]
    reflex_pull, paper_pull = pick(rows, study="pull", setting="reflex"), pick(rows, study="pull", setting="paper")
    mujoco = [row.speed / own.speed for row in pick(rows, study="mujoco")
              for own in pick(usual, knot=row.knot, head=row.head)]
    pulls = "; ".join(f"{knot}: {figure_of(one(reflex_pull, knot=knot).pull, 2)} N against {figure_of(one(paper_pull, knot=knot).pull, 2)} N"
                      for knot in KNOTS if one(reflex_pull, knot=knot) and one(paper_pull, knot=knot))
    return [
        "# One local rule slides every knot: the reflex", "",
        "`bash experiments/studies/reflex.sh` makes this page, [its table](reflex.csv) and the figure. " + " ".join(notes), "",
        "**Question.** How could a hagfish control so many joints while a knot slides to its head?", "",
        "**Answer.** It need not compute forces: if every joint copies its tailward neighbour, each of the four knots slides. "
        f"Here {all_slid} runs did, with the head held and free, by one number.", "",
        "![Ways, torque and gradient, law of speed, and where the rule holds](../figures/reflex.png)", "",
        "## Why", "",
        "Each joint takes the curvature that its body has a small length Δ behind it. Muscles of stiffness B_a pull there:", "",
        "    torque = B_a (κ(s + Δ) - κ(s)) ≈ B_a Δ ∂κ/∂s          and the same share of the body's own stiffness B",
        "    C ∂κ/∂t = (B_a + B) Δ ∂κ/∂s   has the solution   κ(s, t) = κ(s + v t, 0),   v = Δ (B_a + B) / C", "",
        "C is the damping of the body, s the arc length from the head. Any shape travels to the head as it is. A knot is a shape. No term knows of knots, contacts or forces.", "",
        "## All four knots, beside the paper's law", "",
        "The animal is the same, and so is the program that ties the knot. Effort is the mean over the body of all torque, for each cm of way. "
        "*Travel* is the share of the shape's change that a wave to the head explains.", "",
        *knots_table(rows),
        f"- The reflex takes {span(efforts, lambda v: f'{v:.2f}')} times the effort of the paper's law.",
        f"- Its shape travels: {span([row.travel for row in usual])} of all change; by the paper's law {span([row.travel for row in paper])}.",
        f"- The wave has {span([row.wave for row in usual])} times the speed of the knot.",
        "- Its net work is negative: the body's springs, bent by the program, give more back than water and joints take.", "",
        *mesh_table(rows),
        f"Between the two meshes the time of the slide differs by up to {mesh:.1f} %: {'within' if mesh <= ASKED_MESH else 'more than'} "
        f"the {ASKED_MESH} % that were asked for. Between the steps it differs by up to {step:.1f} %. Frames are 20 ms apart.", "",
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
        "Fewer joints, from the same tied knot (`experiments/studies/reflex_laws.py`, without the C++ law):", "",
        *grid_table(rows, "laws"),
        f"- Shuffled neighbours lose the knot: {len(pick(shuffled, held='no'))} of {len(shuffled)} runs.",
        "- Joints of the knot are enough. Those outside it do nothing: cutting them changes little.",
        "- Each joint must copy: one joint of two is not enough.",
        "- The first third of the knot is enough for some knots, and slow.",
        "- Muscles of one side are enough, and take longer.", "",
        "## How robust it is", "",
        f"Of starts that tied, {starts[0]} of {starts[1]} slid; of other animals that tied, {animals[0]} of {animals[1]}." if animals[1] else
        f"Of starts that tied, {starts[0]} of {starts[1]} slid. Other animals were not run.", "",
        *robust_table(rows),
        "- *Not tied* is no failure of the reflex: the program could not bend so stiff a body, or so coarse a chain.",
        "- Senses may be later than the slide is long: then the torques stay what they were at its start. A short slide needs no feedback at all.", "",
        "## The paper's claims about the sliding force", "",
        "Held against the reflex's own torque, which is what its muscles do beyond holding the body's shape (clamped, means over 20 ms).", "",
        *claims_table(rows),
        "- *Zero behind the knot*: no. Joints that are bent behind the last contact copy too.",
        "- *Larger near the head*: no. It follows the shape, and the shape hardly changes.",
        "- *Smooth along the body, noisy in time*: the other way round. It is smooth in time, and as rough along the body as the shape's gradient.", "",
        "## Pulling at food, tightening", "",
        *pull_table(rows),
        f"- Does it pull at food? Yes, harder than the paper's law as its scenes are set: {pulls}.",
        "- Does it tighten? No. The program pulls the knot together before it.",
        "- Does it keep a knot that Eq. 6 loses? Not tried: on these animals the paper's law lost none of the eight." if
        all(row.held == "yes" for row in paper) and len(paper) == 8 else
        "- Does it keep a knot that Eq. 6 loses? "
        + ("Yes: " + ", ".join(f"{row.knot} {row.head}" for row in paper if row.held == "no" and
                               one(usual, knot=row.knot, head=row.head, slid="yes")) + "." if any(row.held == "no" for row in paper) else "Not tried."), "",
        *(["## In MuJoCo, in closed loop", "", "`hagfish mujoco-run`: MuJoCo's own soft contacts and limits, h = 2 ms, from the straight body on. No restarts.", "",
           *mujoco_table(rows), f"The knot's speed there is {span(mujoco)} times that here.", ""] if mujoco else []),
        "## What an experiment could look for", "",
        "1. The wave of bending along the body has the knot's own speed. By f_thigmo it has not.",
        "2. Late senses do no harm: a knot slides on when its animal cannot feel what it does.",
        "3. Cutting the feedback beyond the knot changes nothing.",
        "4. Stiffer muscles slide the knot faster; more damping of the body slows it.", "",
        "## What f_thigmo tells that the reflex does not", "",
        "f_thigmo is what joints must do so that the body slides along itself at given speeds. It bounds the speed at contacts, "
        "and says where forces must act if nothing behind the knot may. It is not the gradient of the shape, as its cosine shows. "
        "The reflex commands no speed at a contact: contacts, water and damping decide. Inverse dynamics tell what is needed; the reflex tells how little is enough.", "",
        "## What is new", "",
        "A controller of one number that knows neither knot, contact nor model slides all four knots, and a closed form of its speed. "
        "Muscle torques are found by each joint alone.", "",
        "## What this page does not show", "",
        "- That a hagfish does it: nobody has measured how bending travels in a sliding knot.",
        "- Friction and flesh, which the model lacks. Forming a knot from a loose loop was not tried.",
        "- Robustness with a free head, and pairs of changes at once.",
        "- Knots in MuJoCo, laws and other animals that the tables lack: they were not run.",
        "- 200 bodies at 1 ms; the law of speed at large Δ with a free head."]


def draw_ways(axes: Any, folder: Path) -> None:
    table = reflex_runs.read_sweep(folder / "knots/table.csv")
    rows = reflex_runs.sweep_rows("knots", table, reflex_runs.both_axes(table, "model.bodies", "time.step"))
    for cell, row in enumerate(rows):
        if row.setting == USUAL and row.head == "clamped":
            log, look = HagfishLog(log_of(folder / "knots", str(cell))), plots.KNOTS[row.knot]
            frames = log.in_phase("slide")
            axes.plot(log["/trajectory/time"][frames] - log["/trajectory/time"][frames[0]], log["/knot/head_end"][frames], color=look.colour,
                      label=look.label)
    for path in sorted(folder.glob("mujoco/*.h5")):
        log, look = HagfishLog(path), plots.KNOTS[reflex_runs.knot_of(path.stem)]
        frames = log.in_phase("slide")
        if frames.size:
            axes.plot(log["/trajectory/time"][frames] - log["/trajectory/time"][frames[0]], log["/knot/head_end"][frames], color=look.colour, ls="--")
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


def notes_of(folder: Path) -> list[str]:
    log = HagfishLog(log_of(folder / "knots", "0"))
    date = datetime.datetime.fromtimestamp((folder / "knots/table.csv").stat().st_mtime, datetime.UTC)
    return [f"Measured at {str(log.attribute('git_revision'))[:12]} on {log.attribute('cpu')}, {date:%Y-%m-%d}."]


def main(folder: Path, table: Path, out: Path, figure: Path) -> None:
    reflex_runs.write_table(table, reflex_runs.read_study(folder), notes_of(folder))
    rows, notes = read_table(table)
    tables.write_page(out, page(rows, notes))
    draw(folder, rows, figure)


if __name__ == "__main__":
    run_script(__doc__, ["FOLDER", "OUT.csv", "OUT.md", "OUT.png"], main)
