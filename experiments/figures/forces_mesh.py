"""Where the mesh's share of the forces of Eq. 6 comes from: the table and the page of experiments/studies/forces_mesh.sh.

Usage: forces_mesh.py FOLDER OUT.csv OUT.md. FOLDER is what the study leaves. The page is made of the table alone: a test makes it again.
"""

from __future__ import annotations

import csv
from collections.abc import Iterable
from dataclasses import astuple, dataclass, fields
from fractions import Fraction
from pathlib import Path

import numpy as np

import tables
from carried_curve import FROM, INSIDE, TO, turns_off
from forces import ANIMALS, HOP, KNOTS, LONG, knot_of, long_means, moments, notes_of, off, shown, way_of
from hagfish_log import HagfishLog
from script import run_script
from slides import log_of
from sweep_columns import read_sweep

GROUPS = {100: (92, 96, 100, 104, 108), 200: (184, 192, 200, 208, 216)}  # bodies, by the count that a group stands for
ELSEWHERE = 1.0  # cm of arc: a contact whose other strand moves by more in a frame has gone over to another one
AROUND = 25  # steps on both sides, of whose multipliers the median is usual


@dataclass
class Row:
    """Figures of one run or of a comparison; cm, dyn, %. None: not measured."""

    part: str  # "run"; "group": runs of five counts of bodies; "carried": from the curve of the most bodies; "turns": no run
    knot: str  # of "turns": in which order universal joints turn
    animal: str
    bodies: int
    way: float | None = None  # of the knot's head end from the slide's first frame to where the head is let go
    multipliers: float | None = None  # sum of the four, mean
    sudden: float | None = None  # share of that which single steps have beyond what is usual around them, where they have twice as much
    swaps: float | None = None  # frames at which a contact's other strand is another one, %
    hops: float | None = None  # frames at which an end of the knot itself moves by more than HOP, %
    scatter: float | None = None  # of a group's slides from their mean, median, % of |f|
    off_mean: float | None = None  # slide's mean of f_thigmo against that of twice the bodies, % of |f|
    off_long: float | None = None  # means over LONG, likewise
    off_way: float | None = None
    misplaced: float | None = None  # largest distance of a body's centre from its place on the carried curve; of "turns" see turns_off
    corrected: float | None = None  # the same where the contacts' curve lies INSIDE h^2 kappa outside the centres
    head_end: float | None = None  # where the knot's head end is on the carried curve, less where it is with the most bodies
    tail_end: float | None = None


UNITS = {"way": "way_cm", "multipliers": "multipliers_dyn", "sudden": "sudden_percent", "swaps": "swaps_percent", "hops": "hops_percent",
         "scatter": "scatter_percent", "off_mean": "off_mean_percent", "off_long": "off_500_ms_percent", "off_way": "off_way_percent",
         "misplaced": "misplaced_cm", "corrected": "misplaced_corrected_cm", "head_end": "head_end_off_cm", "tail_end": "tail_end_off_cm"}
HEADING = [UNITS.get(field.name, field.name) for field in fields(Row)]


@dataclass
class Slid:
    """A slide and its forces."""

    row: Row
    force: np.ndarray  # frames x figures
    window: int  # frames of LONG


def sudden_share(multipliers: np.ndarray) -> float:
    usual = np.array([np.median(multipliers[max(0, k - AROUND):k + AROUND + 1]) for k in range(multipliers.size)])
    more = multipliers > 2 * usual
    return float(100 * (multipliers - usual)[more].sum() / multipliers.sum())


def slid(part: str, scene: str, bodies: int, log: HagfishLog) -> Slid:
    frames = log.in_phase("slide")
    head, tail = log["/knot/head_end"], log["/knot/tail_end"]
    steps = log["/trajectory/step"].astype(int) - int(log["/trajectory/step"][0])
    multipliers = np.nansum(log["/steps/thigmotaxis_lambda"][steps[frames[0]]:steps[frames[-1]]], axis=1)
    h = float(log["/model/length"][0])
    other = h * np.stack([log["/thigmotaxis/spline_b"][frames, 0], log["/thigmotaxis/spline_a"][frames, 1]])
    jumps = lambda places, most: float(100 * (np.abs(np.diff(places)) > most).any(axis=0).mean())
    row = Row(part, knot_of(scene), "living" if "living" in scene else "towed", bodies, way_of(log),
              float(multipliers.mean()), sudden_share(multipliers), jumps(other, ELSEWHERE), jumps(np.stack([head[frames], tail[frames]]), HOP))
    return Slid(row, moments(log), round(LONG / float(np.median(np.diff(log["/trajectory/time"])))))


def compare(one: Slid, other: Slid) -> None:
    both = min(len(one.force), len(other.force))
    one.row.off_mean = off(one.force.mean(axis=0), other.force.mean(axis=0))
    if both >= one.window:
        one.row.off_long = off(long_means(one.force[:both], one.window), long_means(other.force[:both], one.window))
    one.row.off_way = 100 * (one.row.way / other.row.way - 1)


def group_rows(scene: str, runs: dict[int, Slid]) -> list[Row]:
    """What the means of two groups differ by, and how far one run of a group is from its mean."""
    rows, means = [], []
    for bodies, counts in GROUPS.items():
        own = np.array([runs[count].force.mean(axis=0) for count in counts])
        means.append(own.mean(axis=0))
        rows.append(Row("group", knot_of(scene), runs[bodies].row.animal, bodies, scatter=float(np.median([off(one, means[-1]) for one in own]))))
    rows[0].off_mean = off(means[0], means[1])
    return rows


def read_counts(folder: Path) -> list[Row]:
    table = read_sweep(folder / "table.csv")
    rows: list[Row] = []
    runs: dict[str, dict[int, Slid]] = {}
    for cell, (scene, bodies) in enumerate(zip(table.axes["scene"], table.axes["model.bodies"])):
        runs.setdefault(scene, {})[int(bodies)] = slid("run", scene, int(bodies), HagfishLog(log_of(folder, str(cell))))
    for scene, own in runs.items():
        for bodies in TO[:-1]:
            compare(own[bodies], own[2 * bodies])
        rows += [run.row for run in own.values()] + group_rows(scene, own)
    return rows


def read_carried(folder: Path) -> list[Row]:
    rows = []
    for line in tables.read_csv(folder / "misplaced.csv", ["scene", "bodies"]):
        scene, bodies = line["scene"], int(line["bodies"])
        if bodies == FROM:
            continue
        log, finest = HagfishLog(folder / f"{scene}-{bodies}.h5"), HagfishLog(folder / f"{scene}-{FROM}.h5")
        row = Row("carried", knot_of(scene), "living" if "living" in scene else "towed", bodies)
        if 2 * bodies == FROM:
            one = slid("carried", scene, bodies, log)
            compare(one, slid("carried", scene, FROM, finest))
            row = one.row
        row.misplaced, row.corrected = float(line["off_cm"]), float(line["off_corrected_cm"])
        row.head_end, row.tail_end = (float(log[f"/knot/{end}_end"][0] - finest[f"/knot/{end}_end"][0]) for end in ("head", "tail"))
        rows.append(row)
    return rows


TURNS = {"Y before Z": False, "Y before Z and Z before Y in turn": True}


def turns_rows() -> list[Row]:
    return [Row("turns", order, "", bodies, misplaced=turns_off(bodies, in_turn)) for order, in_turn in TURNS.items() for bodies in (50, 100, 200)]


def turns_table(rows: list[Row]) -> list[str]:
    body = []
    for turns in TURNS:
        own = [row.misplaced for row in pick(rows, part="turns", knot=turns)]
        body.append([turns, *(shown(off, ".3f") for off in own), order(*own[-2:])])
    return tables.markdown(["universal joints turn about", "50 from 100 bodies, cm", "100 from 200", "200 from 400", "order"], body)


def read_table(path: Path) -> tuple[list[Row], list[str]]:
    """Rows, and the notes above them."""
    lines = path.read_text(encoding="utf-8").splitlines()
    notes = [line[2:] for line in lines if line.startswith("# ")]
    rows = []
    for line in csv.DictReader(line for line in lines if not line.startswith("# ")):
        texts = [line[name] for name in HEADING]
        rows.append(Row(texts[0], texts[1], texts[2], int(texts[3]), *(float(text) if text else None for text in texts[4:])))
    return rows, notes


def pick(rows: Iterable[Row], **wanted: object) -> list[Row]:
    return [row for row in rows if all(getattr(row, key) == value for key, value in wanted.items())]


def the(rows: Iterable[Row], **wanted: object) -> Row:
    return pick(rows, **wanted)[0]


def order(coarse: float, fine: float) -> str:
    return shown(float(np.log2(coarse / fine)), ".1f")


def slides_table(rows: list[Row]) -> list[str]:
    body = []
    for animal in ANIMALS:
        for knot in KNOTS:
            of = {"knot": knot, "animal": animal}
            coarse, fine = (the(rows, part="group", bodies=bodies, **of) for bodies in GROUPS)
            half, whole = (the(rows, part="run", bodies=bodies, **of) for bodies in TO[:-1])
            carried = the(rows, part="carried", bodies=FROM // 2, **of)
            body.append([f"{knot}, {animal}", shown(coarse.scatter), shown(fine.scatter), shown(coarse.off_mean), shown(half.off_mean),
                         shown(whole.off_mean), order(half.off_mean, whole.off_mean), shown(half.off_way, "+.1f"), shown(whole.off_way, "+.1f"),
                         f"{shown(carried.off_mean)}; {shown(carried.off_long)}; {shown(carried.off_way, '+.1f')}"])
    return tables.markdown(["slide's mean: off by, % of f", "one run of about 100 from their mean", "one of about 200 from theirs",
                            "mean of about 100 against that of about 200", "100 against 200", "200 against 400", "order", "way, 100 against 200",
                            "way, 200 against 400", "from one curve, 200 against 400: mean; 0.5 s; way"], body)


def curves_table(rows: list[Row]) -> list[str]:
    body = []
    for animal in ANIMALS:
        for knot in KNOTS:
            own = [the(rows, part="carried", knot=knot, animal=animal, bodies=bodies) for bodies in TO[:-1]]
            pair = lambda name, form: " and ".join(shown(getattr(row, name), form) for row in own)
            body.append([f"{knot}, {animal}", pair("misplaced", ".4f"), shown(own[0].misplaced / own[1].misplaced, ".1f"), pair("corrected", ".4f"),
                         pair("head_end", "+.3f"), pair("tail_end", "+.3f")])
    return tables.markdown(["100 and 200 bodies on the curve of 400, cm", "a centre is off by", "ratio", "with the correction", "head end of the knot",
                            "tail end of the knot"], body)


def strands_table(rows: list[Row]) -> list[str]:
    body = []
    for animal in ANIMALS:
        for knot in KNOTS:
            own = [the(rows, part="run", knot=knot, animal=animal, bodies=bodies) for bodies in TO]
            each = lambda name, form=".0f": ", ".join(shown(getattr(row, name), form) for row in own)
            body.append([f"{knot}, {animal}", each("multipliers", ".3g"), each("way", ".2f"), each("hops"), each("swaps"), each("sudden")])
    return tables.markdown(["100, 200, 400 bodies", "multipliers, dyn", "way, cm", "an end hops, % of frames", "its other strand is another one, % of frames",
                            "share of single steps, %"], body)


def page(rows: list[Row], notes: list[str]) -> list[str]:
    groups = {bodies: [row.scatter for row in pick(rows, part="group", bodies=bodies)] for bodies in GROUPS}
    bias = [row.off_mean for row in pick(rows, part="group", bodies=100)]
    carried = {bodies: pick(rows, part="carried", bodies=bodies) for bodies in TO[:-1]}
    ratio = np.median([coarse.misplaced / fine.misplaced for coarse, fine in zip(*carried.values())])
    wanted = (1 - (TO[0] / FROM) ** 2) / ((TO[0] / TO[1]) ** 2 - (TO[0] / FROM) ** 2)
    gain = np.median([row.misplaced / row.corrected for row in pick(rows, part="carried")])
    swaps = [row.swaps for row in pick(rows, part="run", bodies=FROM)]
    hops = [row.hops for row in pick(rows, part="run", bodies=FROM)]
    ways = {bodies: [abs(row.off_way) for row in pick(rows, part="run", bodies=bodies)] for bodies in TO[:-1]}
    counted = [len(counts) for counts in GROUPS.values()]
    errors = [2 * np.sqrt(sum(one**2 / n for one, n in zip(pair, counted))) for pair in zip(*groups.values())]
    sure = sum(two < one for two, one in zip(errors, bias))
    finest = [(the(rows, part="run", knot=row.knot, animal=row.animal, bodies=FROM // 2), row) for row in pick(rows, part="run", bodies=FROM)]
    sums = [100 * abs(half.multipliers / row.multipliers - 1) for half, row in finest]
    return [
        "# Where does the mesh's share of the forces come from?", "",
        "`bash experiments/studies/forces_mesh.sh` makes this page and [its table](forces_mesh.csv). " + " ".join(notes), "",
        f"**Answer.** It is a bias of coarse meshes, not their chance: by over two standard errors in {sure} of {len(bias)} slides. "
        f"Five counts of bodies about 200 agree to {np.median(groups[200]):.0f} % of f_thigmo (at most {max(groups[200]):.0f} %), "
        f"five about 100 to {np.median(groups[100]):.0f} %. The means of both differ by {np.median(bias):.0f} % (at most {max(bias):.0f} %): medians over knots and animals. "
        f"From 200 to 400 bodies the sum of the multipliers changes by {np.median(sums):.0f} % (at most {max(sums):.0f} %) "
        f"and the way by {np.median(ways[200]):.1f} % "
        f"(at most {max(ways[200]):.0f} %). From 100 to 200 the way changes by {np.median(ways[100]):.1f} % (at most {max(ways[100]):.0f} %).", "",
        "## The order of turns", "",
        "Turns do not commute: a universal joint that turns about Y before Z twists the body by half the product of its two angles. "
        "If all joints do, that is a twist for each length of half the joints' distance times both curvatures, an error of first order. "
        "One program of curvatures is then another curve with other bodies. "
        "Below, no run: three smooth curvatures along a body, and how far it lies from one of twice as many bodies, root mean square.", "",
        *turns_table(rows),
        "Where every other joint turns the other way round, as in this simulator, these twists cancel.", "",
        "## Slides", "",
        "Slides of 92 to 108 bodies, of 184 to 216 and of 400, at 2 ms. Order is by the differences of 100, 200 and 400. "
        "The way ends where the head is let go. "
        "The last column starts both slides from one curve: the first of the slide of 400 bodies.", "",
        *slides_table(rows),
        "## One curve", "",
        "The curve of 400 bodies at the start of the slide, carried over to fewer by least squares. "
        f"An error of second order has a ratio of {wanted:.1f}. The median is {ratio:.1f}.", "",
        *curves_table(rows),
        f"- Bodies bend at every other joint. On a circle of curvature κ their centres then lie {Fraction(INSIDE).limit_denominator(100)} h²κ inside "
        "the curve that they stand for, with h a body's length.",
        f"- A contact curve that lies so much outside the centres is nearer by a factor of {gain:.1f}. "
        "It does not bring the forces nearer ([what was tried](../benchmarks/README.md)), so that the spline stays as the paper has it.",
        "- The knot's ends, where the gap reaches `controller.contact_gap`, follow with the same order.", "",
        "## Other strands", "",
        f"The ends of most knots stay, but the strand that they touch does not. With {FROM} bodies an end hops in {np.median(hops):.0f} % of the frames "
        f"(at most {max(hops):.0f} %), "
        f"and its other strand becomes one more than {ELSEWHERE:g} cm away in {np.median(swaps):.0f} % (at most {max(swaps):.0f} %).", "",
        *strands_table(rows),
        "- Two strands then lie beside the end at nearly the same gap. The force on one of them opens its gap, and the next step pushes the other. "
        "Which one it is changes where along the body the force is felt.",
        "- This is also what is left of chatter: where an end itself changes place at each step, hinge rates change sign with it.",
        "- Single steps push far more than those around them, where a strand meets another. Their share falls with the mesh.", "",
        "## What this page does not show", "",
        "- A mean of both strands in one row of Eq. 6. Rows for both did not help.",
        "- Meshes finer than 400 bodies, the most that a scene takes.",
        "- Where one knot slides in two ways: its scatter is large, and some slides are let go early, as a strand near the head touches for a step."]


def main(folder: Path, table: Path, out: Path) -> None:
    found = read_counts(folder / "counts") + read_carried(folder / "carried") + turns_rows()
    notes = notes_of(folder / "counts")
    tables.write_csv(table, HEADING, [["" if cell is None else cell for cell in astuple(row)] for row in found], notes)
    tables.write_page(out, page(*read_table(table)))


if __name__ == "__main__":
    run_script(__doc__, ["FOLDER", "OUT.csv", "OUT.md"], main)
