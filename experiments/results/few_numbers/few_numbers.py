"""How few numbers slide each knot, in which frame, how often found, what they take against f_thigmo; other animals, numbers played by
the knot's place, and learned shapes. Usage: few_numbers.py FOLDER. FOLDER is what
study.sh leaves.
"""

from dataclasses import replace
from pathlib import Path

import numpy as np

import few_numbers_picture as picture
import plots
import tables
from few_numbers_picture import ENOUGH, FRAMES
from hagfish_log import HagfishLog, LogError
from means import effort_per_cm, read_means
from script import run_script
from sweep_columns import read_cells

SCENES = {f"living_{name}": knot for name, knot in plots.SCENES.items()}
NUMBERS = (3, 6, 9, 12, 18)
TRANSFERS = {"": "as found", "_start": "3 degrees of noise at the start", "_step": "h = 2 ms", "_bodies": "60 bodies", "_mirror": "mirrored"}


FRAME, PERIOD, LENGTH = "controller.reduced_basis.frame", "controller.reduced_basis.period", "specimen.length"
Ways = dict[tuple[str, ...], list[float]]


def ways_of(sweep: Path, *axes: str) -> dict[str, dict[int, Ways]]:
    """Ways of the knot's head end, cm, by knot, how many numbers (0 by the paper's law), and places on these axes; 0 where the knot is lost
    or never tied."""
    found: dict[str, dict[int, Ways]] = {}
    for cell in read_cells(sweep):
        of, way = cell.axes, cell.figures["slide_distance_cm"]
        count = 3 * int(of["controller.reduced_basis.cosines"]) if of["controller.law"] == "reduced_basis" else 0
        own = found.setdefault(plots.knot_of(of["scene"]), {}).setdefault(count, {})
        own.setdefault(tuple(of[axis] for axis in axes), []).append(way if cell.outcome == "ok" and way > 0 else 0.0)
    return found


def full_way(counts: dict[int, Ways]) -> float:
    """By the paper's law."""
    return float(np.median(sum(counts[0].values(), [])))


def counts_of(ways: dict[str, dict[int, Ways]]) -> list[int]:
    return sorted({count for counts in ways.values() for count in counts if count})


def shares(sweep: Path) -> dict[tuple[str, str, float, int], list[float]]:
    """Of the full way, one for each start, by knot, frame, period (s) and numbers."""
    found = {}
    for knot, counts in ways_of(sweep, FRAME, PERIOD).items():
        if not full_way(counts) > 0:
            raise LogError(f"the paper's law slides no {knot}")
        found |= {(knot, frame, float(period), count): [way / full_way(counts) for way in ways]
                  for count, own in counts.items() if count for (frame, period), ways in own.items()}
    return found


def least(found: dict[tuple[str, str, float, int], list[float]], knot: str, frame: str, period: float) -> str:
    """Numbers from which on, up to the most tried, all starts slide far enough."""
    enough = "-"
    for count in sorted({key[3] for key in found}, reverse=True):
        if min(found.get((knot, frame, period, count), [0])) < ENOUGH:
            break
        enough = str(count)
    return enough


def starts(sweep: Path) -> list[list[str]]:
    ways = ways_of(sweep)
    far = lambda of, count: sum(way >= ENOUGH * full_way(of) for way in of[count][()])
    return [[f"starts that {count} numbers slide", *(f"{far(of, count)} of {len(of[count][()])}" for of in ways.values())]
            for count in counts_of(ways)]


def animals(sweep: Path) -> list[list[str]]:
    """Of the animals that the paper's law slides, how many numbers slide as far, and the shares of the way."""
    ways = ways_of(sweep, LENGTH)

    def told(of: dict[int, Ways], count: int) -> str:
        own = np.array([of[count][animal][0] / full for animal, (full,) in of[0].items() if full > 0])
        return f"{(own >= ENOUGH).sum()} of {len(own)}; {np.median(own):.2f}, {own.min():.2f}"

    return [[f"other animals that {count} numbers slide; share of the way: median, least", *(told(of, count) for of in ways.values())]
            for count in counts_of(ways)]


def free_head(sweep: Path) -> list[list[str]]:
    """Shares of the way by the paper's law, by how often numbers are found: 0 also where the knot is lost."""
    ways = ways_of(sweep, PERIOD)
    told = lambda of, count: ", ".join(f"{of[count][period][0] / full_way(of):.2f}" for period in sorted(of[count], key=lambda p: float(*p)))
    return [[f"{count} numbers", *(told(of, count) for of in ways.values())] for count in counts_of(ways)]


def basis_torque(log: HagfishLog) -> np.ndarray:
    """u = B a at the hinges, frames x hinges, dyn cm; nan outside of the slide. Of cosines in the knot's window."""
    basis = log.scene()["controller"]["reduced_basis"]
    _, joint, kind = log.hinges()
    arc = log.joint_arc()[joint]
    window, numbers = log["/basis/window"], log["/basis/amplitude"]
    first, last = window[:, :1] - basis["margin"], window[:, 1:] + basis["margin"]
    share = (arc - first) / (last - first)
    count = int(basis["cosines"])
    torque = np.zeros(share.shape)
    for axis, name in enumerate(("bend_y", "bend_z", "twist")):
        own = kind == name
        for j in range(count):
            torque[:, own] += numbers[:, [axis * count + j]] * np.cos(np.pi * j * share[:, own])
    return np.where((share >= 0) & (share <= 1), torque, 0 * window[:, :1])


class Run:
    """One log of the study."""

    def __init__(self, path: Path) -> None:
        log = HagfishLog(path)
        frames = log.in_phase("slide")
        self.ok = log.attribute("status") == "complete" and frames.size > 1
        self.way = self.seconds = self.effort = np.nan
        if not self.ok:
            return
        end, time = log["/knot/head_end"][frames], log["/trajectory/time"][frames]
        self.way, self.seconds = float(end[0] - end[-1]), float(time[-1] - time[0])
        means = read_means(log)
        if path.stem.startswith("numbers_"):
            means = replace(means, force=basis_torque(log)[means.end])
        self.effort = effort_per_cm(log, means)


def efforts(runs: dict[str, Run]) -> list[list[str]]:
    """The effort over that of f_thigmo, of those alone that slide all the way."""
    rows = [["f_thigmo of the paper's law, dyn s for each cm", *(f"{runs[f'paper_{short(s)}'].effort:.0f}" for s in SCENES)]]
    for count in NUMBERS:
        row = [f"{count} numbers, over that"]
        for scene in SCENES:
            paper, own = runs[f"paper_{short(scene)}"], runs[f"numbers_{short(scene)}_{count}"]
            all_the_way = own.ok and own.way >= ENOUGH * paper.way
            row.append(f"{own.effort / paper.effort:.2f}" if all_the_way else "-")
        rows.append(row)
    return rows


def short(scene: str) -> str:
    return scene.removeprefix("living_")


def transfers(runs: dict[str, Run], name: str) -> list[list[str]]:
    rows = []
    for suffix, words in TRANSFERS.items():
        row = [words]
        for scene in SCENES:
            own, paper = runs[f"{name}_{short(scene)}{suffix}"], runs[f"paper_{short(scene)}"]
            row.append(f"{own.way / paper.way:.2f}; {own.seconds:.1f}" if own.ok else "lost")
        rows.append(row)
    return rows


def main(folder: Path) -> None:
    found = shares(folder / "numbers")
    periods, counts = (sorted({key[k] for key in found}) for k in (2, 3))
    runs = {path.stem: Run(path) for path in sorted((folder / "runs").glob("*.h5"))}
    points = [[knot, frame, f"{period:g}", str(count), f"{share:.3f}"] for knot in SCENES.values() for frame in FRAMES for period in periods
              for count in counts for share in found[knot, frame, period, count]]
    picture.draw([dict(zip(picture.HEAD, row)) for row in points], folder / "few_numbers.png")
    fewest = [[f"{words}, each {1000 * period:g} ms", *(least(found, knot, frame, period) for knot in SCENES.values())]
              for frame, words in FRAMES.items() for period in periods]
    free = sorted({float(cell.axes[PERIOD]) for cell in read_cells(folder / "free")})
    each = ", ".join(f"{1000 * period:g}" for period in free)
    table = lambda name, first, rows: tables.write_table(folder, f"few_numbers{name}", [first, *SCENES.values()], rows)
    tables.write_table(folder, "few_numbers_points", picture.HEAD, points)
    table("", "least numbers from which on all slide", fewest)
    table("_starts", "all the way", starts(folder / "starts") + animals(folder / "animals"))
    table("_effort", "effort in the knot's window, each 100 ms", efforts(runs))
    table("_free", f"free head: share of the way, each {each} ms", free_head(folder / "free"))
    table("_played", "played by the knot's place: share of the way; s", transfers(runs, "played"))
    table("_learned", "learned shapes: share of the way; s", transfers(runs, "learned"))


if __name__ == "__main__":
    run_script(__doc__, ["FOLDER"], main)
