"""What f_thigmo is worth: tables of study.sh.

Usage: forces.py FOLDER. FOLDER is what the study leaves. The tables come in its folder tables.
"""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

import plots
import tables
from accuracy import STATIONS, moments_of, off, through
from hagfish_log import HagfishLog, LogError
from script import run_script
from sweep_columns import read_cells

PLACES = 200  # of the knot's head end, at which moments are compared
USUAL = "2 ms"
# Runs, by their titles in the grid, and those that they are compared with.
PAIRS = {"step, 5 against 1 ms": [("5 ms", "1 ms")], "step, 2 against 1 ms": [(USUAL, "1 ms")],
         "midpoint rule, 5 against 1 ms": [("midpoint, 5 ms", "midpoint, 1 ms")],
         "mesh, 100 against 200 bodies": [(USUAL, "200 bodies")], "mesh, 100 against 400 bodies": [(USUAL, "400 bodies")],
         "mesh, 200 against 400 bodies": [("200 bodies", "400 bodies")],
         "universal joints, 100 against 200 bodies": [("universal", "universal, 200 bodies")],
         "girth, 2.2 % more, 100 bodies": [("girth", USUAL)], "girth, 2.2 % more, 200 bodies": [("girth, 200 bodies", "200 bodies")],
         "start, 0.1 degree off": [("start 1", USUAL), ("start 2", USUAL)]}
SUMS = ("multipliers", "work", "way")
LENGTH, RADIUS = 42.4, 2.0  # cm, of a body without forces and of a circle, on which turns are compared
ORDERS = {"turns about Y before Z": False, "turns about Y before Z and Z before Y, joint by joint": True}


@dataclass
class Slide:
    """One run's; cm, s, dyn, erg."""

    way: float  # of the knot's head end
    multipliers: float  # sum of all rows of Eq. 6, mean over the frames
    work: float  # of f_thigmo for each cm of way
    force: np.ndarray  # moments of f_thigmo, means from frame to frame: frames x (3 axes times stations), dyn cm
    place: np.ndarray  # of the knot's head end at these frames, the least so far
    both_ends: bool = True  # whether it is a slide of both ends


def slide_of(log: HagfishLog, way: float, both_ends: bool) -> Slide:
    means = log.intervals_in("slide")
    work = log["/diagnostics/work_thigmotaxis"][log.in_phase("slide")]
    return Slide(way, float(log["/mean/thigmotaxis/sum"][means].mean()), float(work[-1] - work[0]) / way, moments_of(log, "thigmotaxis", means),
                 np.minimum.accumulate(log["/knot/head_end"][means]), both_ends)


def read_slides(folder: Path) -> dict[tuple[str, str, str], Slide]:
    """By title, animals and knot."""
    found = {}
    for cell in read_cells(folder):
        scene = cell.axes["scene"]
        if cell.outcome != "ok":
            raise LogError(f"{cell.path}, {scene}: {cell.outcome}")
        knot = plots.knot_of(scene)
        found[cell.axes["title"].strip('"'), "living" if "living" in scene else "towed", knot] = slide_of(
            cell.log, cell.figures["slide_distance_cm"], cell.both_ends)
    return found


def named(slides: dict[tuple[str, str, str], Slide], pairs: list[tuple[str, str]], animals: str) -> str:
    """The animals, and which knots fall short of a slide by both ends in a run of theirs."""
    grown = [knot for knot in plots.KNOTS if not all(slides[run, animals, knot].both_ends for pair in pairs for run in pair)]
    return f"{animals} ({', '.join(grown)}: not by both ends)" if grown else animals


def at_places(slide: Slide, places: np.ndarray) -> np.ndarray:
    """Its moments where the knot's head end comes to these places, between frames in proportion."""
    frames = np.arange(len(slide.place))
    at = np.interp(places, slide.place[::-1], frames[::-1])
    before = np.minimum(at.astype(int), len(frames) - 2)
    after = (at - before)[:, None]
    return (1 - after) * slide.force[before] + after * slide.force[before + 1]


def differences(one: Slide, other: Slide) -> dict[str, float]:
    """How far one is from the other, % of that."""
    both = min(len(one.force), len(other.force))
    places = np.linspace(min(one.place[0], other.place[0]), max(one.place[-1], other.place[-1]), PLACES)
    return {**{name: 100 * abs(getattr(one, name) / getattr(other, name) - 1) for name in SUMS},
            "mean": off(one.force.mean(axis=0), other.force.mean(axis=0)), "time": off(one.force[:both], other.force[:both]),
            "place": off(at_places(one, places), at_places(other, places))}


def turned(bodies: int, in_turn: bool, bend: float = 0.0) -> np.ndarray:
    """Centres of bodies whose joints twist and bend in turn, as smooth curvatures have it, or a `bend` about Y that is the same everywhere, 1/cm.
    Universal joints turn about Y before Z, all or, `in_turn` as the simulator's, every other one; the others the other way round."""
    h = LENGTH / bodies
    swell = lambda s: np.sin(np.pi * s / LENGTH)
    along = [lambda s: 0.05 * swell(s), lambda s: 0.35 * swell(s)**2, lambda s: 0.3 * swell(s)**2 * np.cos(0.2 * s)]
    if bend:
        along = [lambda s: 0 * s, lambda s: bend + 0 * s, lambda s: 0 * s]
    frame, front, centres = np.eye(3), np.zeros(3), []
    for body in range(bodies):
        for axis in [0] if body % 2 == 0 else [1, 2][:: -1 if in_turn and body // 2 % 2 == 0 else 1]:
            angle = 2 * h * along[axis](h * np.linspace(body - 1, body + 1, 9)).mean()
            a, b = frame[:, (axis + 1) % 3], frame[:, (axis + 2) % 3]
            turn = np.cos(angle) * np.stack([a, b]) + np.sin(angle) * np.stack([b, -a])
            frame[:, [(axis + 1) % 3, (axis + 2) % 3]] = turn.T
        centres.append(front + 0.5 * h * frame[:, 0])
        front = front + h * frame[:, 0]
    return np.array(centres)


def turns_off(bodies: int, in_turn: bool) -> float:
    """How far such a body is from one of twice as many bodies, cm, root mean square."""
    at = [through(turned(count, in_turn), STATIONS * count) for count in (bodies, 2 * bodies)]
    return float(np.sqrt(((at[0] - at[1])**2).sum(axis=1).mean()))


def inside(bodies: int) -> float:
    """How far inside a circle of RADIUS the centres are of bodies that stand for it, cm."""
    a, b, c = turned(bodies, True, 1 / RADIUS)[[bodies // 10 * k for k in (2, 3, 4)]]
    sides = [np.linalg.norm(x - y) for x, y in ((a, b), (b, c), (c, a))]
    return float(RADIUS - np.prod(sides) / (2 * np.linalg.norm(np.cross(b - a, c - a))))


def turns_rows() -> list[list[str]]:
    counts = (100, 200, 400)
    rows = {**{words: [turns_off(bodies, in_turn) for bodies in counts] for words, in_turn in ORDERS.items()},
            f"centres, on a circle of {RADIUS:g} cm, inside it": [inside(bodies) for bodies in counts]}
    return [[words, *(tables.shown(value, ".4f") for value in values), tables.shown(np.log2(values[-2] / values[-1]), ".1f")] for words,
            values in rows.items()]


def main(folder: Path) -> None:
    slides = read_slides(folder / "slides")
    sums, spread = [], []
    for change, pairs in PAIRS.items():
        for animals in ("towed", "living"):
            each = [[differences(slides[run, animals, knot], slides[other, animals, knot]) for run, other in pairs] for knot in plots.KNOTS]
            worst = {name: [max(found[name] for found in of) for of in each] for name in each[0][0]}
            ends = lambda name: [tables.shown(np.median(worst[name]), ".1f"), tables.shown(max(worst[name]), ".1f")]
            sums.append([change, named(slides, pairs, animals), *(cell for name in SUMS for cell in ends(name))])
            spread.append([change, sums[-1][1], *(tables.shown(value, ".1f") for value in worst["mean"]), ends("mean")[0], *ends("time"),
                           *ends("place")])
    both = lambda names: [f"{name}, {end}" for name in names for end in ("median", "at most")]
    tables.write_table(folder, "forces", ["change", "animals", *both(SUMS)], sums)
    tables.write_table(folder, "forces_spread", ["change", "animals", *plots.KNOTS, "median",
                                                 *both(["frames at equal time", "frames at equal place"])], spread)
    tables.write_table(folder, "forces_turns", ["", "100 bodies, cm", "200 bodies, cm", "400 bodies, cm", "order"], turns_rows())


if __name__ == "__main__":
    run_script(__doc__, ["FOLDER"], main)
