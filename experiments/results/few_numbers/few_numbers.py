"""How few numbers slide each knot, in which frame, how often found, what they take against f_thigmo; other animals, numbers played by
the knot's place, and learned shapes. Usage: few_numbers.py FOLDER. FOLDER is what
study.sh leaves.

A run slides its knot if both ends and the curvature come along, as far as `hagfish check` asks. Its share is the one of a slide by both ends.
"""

from dataclasses import replace
from pathlib import Path

import numpy as np

import few_numbers_picture as picture
import plots
import tables
from few_numbers_picture import FRAMES
from hagfish_log import HagfishLog
from means import effort_per_cm, read_means
from script import run_script
from sweep_columns import Cell, read_cells

KNOTS = plots.SCENES.values()
FRAME, PERIOD = "controller.reduced_basis.frame", "controller.reduced_basis.period"


def count_of(cell: Cell) -> int:
    """How many numbers; 0 where Eq. 6 slides the knot."""
    return 3 * int(cell.axes["controller.reduced_basis.cosines"])


def share(cell: Cell) -> float:
    """Of a slide by both ends; 0 where the knot is lost or never tied."""
    return max(cell.figures["both_ends_percent"] / 100, 0.0) if cell.outcome == "ok" and cell.figures["slide_distance_cm"] > 0 else 0.0


def by(sweep: Path, *keys: str) -> dict[str, dict[int, dict[tuple[str, ...], list[Cell]]]]:
    """Cells by knot, how many numbers, and places on these axes."""
    found: dict[str, dict[int, dict[tuple[str, ...], list[Cell]]]] = {}
    for cell in read_cells(sweep):
        own = found.setdefault(plots.knot_of(cell.axes["scene"]), {}).setdefault(count_of(cell), {})
        own.setdefault(tuple(cell.axes[key] for key in keys), []).append(cell)
    return found


def least(counts: dict[int, dict[tuple[str, ...], list[Cell]]], place: tuple[str, ...]) -> str:
    """Numbers from which on, up to the most tried, all starts slide."""
    enough = "-"
    for count in sorted(counts, reverse=True):
        if not all(cell.slid for cell in counts[count][place]):
            break
        enough = str(count)
    return enough


def told(cells: list[Cell]) -> str:
    shares = [share(cell) for cell in cells]
    return f"{sum(cell.slid for cell in cells)} of {len(cells)}; {np.median(shares):.2f}, {min(shares):.2f}"


def words_of(cell: Cell) -> str:
    return f"{count_of(cell)} numbers, {FRAMES[cell.axes[FRAME]]}"


Rows = dict[str, dict[str, str]]  # of a table: cells by the words of a row and the knot


def starts_and_animals(folder: Path) -> Rows:
    """Of starts, and of the animals whose knot Eq. 6 slides, how many slide, with the median and the least share."""
    rows: dict[str, dict[str, list[Cell]]] = {}
    by_eq6 = {}
    for sweep, start in (("starts", "starts"), ("animals", "other animals")):
        for cell in read_cells(folder / sweep):
            knot, animal = plots.knot_of(cell.axes["scene"]), cell.axes.get("specimen.length")
            if not count_of(cell):
                by_eq6[knot, animal] = cell.slid
            elif by_eq6.get((knot, animal), True):
                rows.setdefault(f"{start} by {words_of(cell)}", {}).setdefault(knot, []).append(cell)
    return {words: {knot: told(cells) for knot, cells in of.items()} for words, of in rows.items()}


def meshes(sweep: Path) -> Rows:
    """Shares by numbers, bodies and step."""
    rows: Rows = {}
    for cell in read_cells(sweep):
        where = f"{words_of(cell)}; {cell.axes['model.bodies']} bodies, {1000 * float(cell.axes['time.step']):g} ms"
        rows.setdefault(where, {})[plots.knot_of(cell.axes["scene"])] = f"{share(cell):.2f}"
    return rows


def basis_torque(log: HagfishLog) -> np.ndarray:
    """u = B a at the hinges, frames x hinges, dyn cm; nan outside of the slide. Of cosines."""
    basis = log.scene()["controller"]["reduced_basis"]
    _, joint, kind = log.hinges()
    arc = log.joint_arc()[joint]
    window, numbers = log["/basis/window"], log["/basis/amplitude"]
    first, last = window[:, :1] - basis["margin"], window[:, 1:] + basis["margin"]
    if basis["frame"] == "body":
        first, last = 0 * first, 0 * last + np.sum(log["/model/length"])
    place = (arc - first) / (last - first)
    count = int(basis["cosines"])
    torque = np.zeros(place.shape)
    for axis, name in enumerate(("bend_y", "bend_z", "twist")):
        own = kind == name
        for j in range(count):
            torque[:, own] += numbers[:, [axis * count + j]] * np.cos(np.pi * j * place[:, own])
    return np.where((place >= 0) & (place <= 1), torque, 0 * window[:, :1])


def effort_of(cell: Cell) -> float:
    means = read_means(cell.log)
    return effort_per_cm(cell.log, replace(means, force=basis_torque(cell.log)[means.end]) if count_of(cell) else means)


def efforts(sweep: Path) -> Rows:
    """The effort over that of f_thigmo, of those alone that slide."""
    eq6: dict[str, float] = {}
    rows: Rows = {"f_thigmo of Eq. 6, dyn s for each cm": {}}
    for cell in read_cells(sweep):  # of each knot Eq. 6 comes first
        knot = plots.knot_of(cell.axes["scene"])
        if count := count_of(cell):
            rows.setdefault(f"{count} numbers, over that", {})[knot] = f"{effort_of(cell) / eq6[knot]:.2f}" if cell.slid else "-"
        else:
            eq6[knot] = effort_of(cell)
            rows["f_thigmo of Eq. 6, dyn s for each cm"][knot] = f"{eq6[knot]:.0f}"
    return rows


def circumstance(axes: dict[str, str]) -> str:
    """What a run of transfers.toml has otherwise than the run that its numbers or shapes were found in."""
    noise, step = float(axes["start.noise_deg"]), 1000 * float(axes["time.step"])
    other = {f"{noise:g} degrees of noise at the start": noise > 0, f"h = {step:g} ms": step != 5,
             f"{axes['model.bodies']} bodies": axes["model.bodies"] != "100", "mirrored": axes["mirror"] == "true"}
    return next((words for words, so in other.items() if so), "as found")


def transfers(sweep: Path, name: str) -> Rows:
    rows: Rows = {}
    for cell in read_cells(sweep):
        which, _, short = Path(cell.axes["scene"]).stem.partition("_")
        if which == name:
            rows.setdefault(circumstance(cell.axes), {})[plots.SCENES[short]] = (
                f"{share(cell):.2f}; {cell.figures['duration_s'] - cell.figures['slide_from_s']:.1f}" if share(cell) else "lost")
    return rows


def main(folder: Path) -> None:
    numbers, free = by(folder / "numbers", FRAME, PERIOD), by(folder / "free", PERIOD)
    places = sorted({place for counts in numbers.values() for of in counts.values() for place in of}, key=lambda p: (p[0] != "knot", float(p[1])))
    points = [[knot, frame, period, str(count), f"{share(cell):.3f}"] for knot, counts in numbers.items() for frame, period in places
              for count in counts for cell in counts[count][frame, period]]
    picture.draw([dict(zip(picture.HEAD, row)) for row in points], folder / "few_numbers.png")

    def table(name: str, first: str, rows: Rows) -> None:
        tables.write_table(folder, f"few_numbers{name}", [first, *KNOTS], [[words, *(of[knot] for knot in KNOTS)] for words, of in rows.items()])

    tables.write_table(folder, "few_numbers_points", picture.HEAD, points)
    table("", "least numbers from which on all slide by both ends", {
        f"{FRAMES[place[0]]}, each {1000 * float(place[1]):g} ms": {knot: least(counts, place) for knot, counts in numbers.items()} for place in places})
    table("_starts", "slide by both ends; share: median, least", starts_and_animals(folder))
    table("_meshes", "share of a slide by both ends, of which 0.7 is one", meshes(folder / "meshes"))
    table("_effort", "effort along the body, each 100 ms", efforts(folder / "effort"))
    periods = [period for period, in next(iter(next(iter(free.values())).values()))]
    table("_free", f"free head: share of a slide by both ends, each {', '.join(f'{1000 * float(p):g}' for p in periods)} ms", {
        f"{count} numbers": {knot: ", ".join(f"{share(of[count][p,][0]):.2f}" for p in periods) for knot, of in free.items()}
        for count in next(iter(free.values()))})
    table("_played", "played by the knot's place: share of a slide by both ends; s", transfers(folder / "transfers", "played"))
    table("_learned", "learned shapes: share of a slide by both ends; s", transfers(folder / "transfers", "learned"))


if __name__ == "__main__":
    run_script(__doc__, ["FOLDER"], main)
