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
from sweep_columns import SweepTable, read_sweep

SCENES = {f"living_{name}": knot for name, knot in plots.SCENES.items()}
NUMBERS = (3, 6, 9, 12, 18)
TRANSFERS = {"": "as found", "_start": "3 degrees of noise at the start", "_step": "h = 2 ms", "_bodies": "60 bodies",
             "_mirror": "mirrored"}


class Grid:
    """Shares of the full way by scene, frame, period (s) and numbers: one for each start."""

    def __init__(self, table: SweepTable) -> None:
        axes = table.axes
        self.scene, self.frame = np.array(axes["scene"]), np.array(axes["controller.reduced_basis.frame"])
        self.period = np.array(axes["controller.reduced_basis.period"], dtype=float)
        self.numbers = numbers_of(table)
        self.reduced = self.numbers > 0
        distance = held_way(table)
        self.share = np.full(len(distance), np.nan)
        for scene in SCENES:
            of = self.scene == scene
            if of.any():
                full = np.median(distance[of & ~self.reduced])
                if not full > 0:
                    raise LogError(f"the paper's law slides nothing in {scene}")
                self.share[of] = distance[of] / full

    def shares(self, scene: str, frame: str, period: float, numbers: int) -> np.ndarray:
        return self.share[self.reduced & (self.scene == scene) & (self.frame == frame) & (self.period == period)
                          & (self.numbers == numbers)]

    def periods(self) -> list[float]:
        return sorted(set(self.period))

    def counts(self) -> list[int]:
        return sorted(set(self.numbers[self.reduced]))

    def least(self, scene: str, frame: str, period: float) -> str:
        """Numbers from which on, up to the most tried, all starts slide far enough."""
        least = ""
        for count in reversed(self.counts()):
            shares = self.shares(scene, frame, period, count)
            if len(shares) == 0 or (shares < ENOUGH).any():
                break
            least = str(count)
        return least or "-"


def numbers_of(table: SweepTable) -> np.ndarray:
    """Of each cell; 0 by the paper's law."""
    reduced = np.array(table.axes["controller.law"]) == "reduced_basis"
    return 3 * np.array(table.axes["controller.reduced_basis.cosines"], dtype=int) * reduced


def held_way(table: SweepTable) -> np.ndarray:
    """Way of the knot's head end, cm; 0 where the knot is lost or never tied."""
    held = np.array(table.texts["outcome"]) == "ok"
    return np.where(held, np.nan_to_num(table.figures["slide_distance_cm"]), 0)


def starts(table: SweepTable) -> list[list[str]]:
    scene, numbers, way = np.array(table.axes["scene"]), numbers_of(table), held_way(table)
    rows = []
    for count in sorted(set(numbers[numbers > 0])):
        row = [f"starts that {count} numbers slide"]
        for one in SCENES:
            full = np.median(way[(scene == one) & (numbers == 0)])
            ways = way[(scene == one) & (numbers == count)]
            row.append(f"{(ways >= ENOUGH * full).sum()} of {len(ways)}")
        rows.append(row)
    return rows


def animals(table: SweepTable) -> list[list[str]]:
    """Of the animals that the paper's law slides, how many numbers slide as far, and the shares of the way."""
    scene, numbers, way = np.array(table.axes["scene"]), numbers_of(table), held_way(table)
    animal = np.array(table.axes["specimen.length"])
    rows: list[list[str]] = []
    for count in sorted(set(numbers[numbers > 0])):
        row = [f"other animals that {count} numbers slide; share of the way: median, least"]
        for one in SCENES:
            full = {a: way[(scene == one) & (numbers == 0) & (animal == a)][0] for a in sorted(set(animal))}
            shares = np.array([way[(scene == one) & (numbers == count) & (animal == a)][0] / full[a] for a in full if full[a] > 0])
            row.append(f"{(shares >= ENOUGH).sum()} of {len(shares)}; {np.median(shares):.2f}, {shares.min():.2f}")
        rows.append(row)
    return rows


def free_head(table: SweepTable) -> list[list[str]]:
    """Shares of the way by the paper's law, by how often numbers are found: 0 also where the knot is lost."""
    scene, numbers, way = np.array([name.removesuffix("_free") for name in table.axes["scene"]]), numbers_of(table), held_way(table)
    period = np.array(table.axes["controller.reduced_basis.period"], dtype=float)
    rows = []
    for count in sorted(set(numbers[numbers > 0])):
        row = [f"{count} numbers"]
        for one in SCENES:
            full = np.median(way[(scene == one) & (numbers == 0)])
            row.append(", ".join(f"{way[(scene == one) & (numbers == count) & (period == each)][0] / full:.2f}"
                                 for each in sorted(set(period))))
        rows.append(row)
    return rows


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


def points_of(grid: Grid) -> list[list[str]]:
    """What the picture shows, a run a row."""
    return [[knot, frame, f"{period:g}", str(count), f"{share:.3f}"] for scene, knot in SCENES.items() for frame in FRAMES
            for period in grid.periods() for count in grid.counts() for share in grid.shares(scene, frame, period, count)]


def main(folder: Path) -> None:
    grid = Grid(read_sweep(folder / "numbers/table.csv"))
    runs = {path.stem: Run(path) for path in sorted((folder / "runs").glob("*.h5"))}
    many, free = read_sweep(folder / "starts/table.csv"), read_sweep(folder / "free/table.csv")
    points = points_of(grid)
    picture.draw([dict(zip(picture.HEAD, row)) for row in points], folder / "few_numbers.png")
    least = [[f"{words}, each {1000 * period:g} ms", *(grid.least(scene, frame, period) for scene in SCENES)]
             for frame, words in FRAMES.items() for period in grid.periods()]
    periods = sorted(set(map(float, free.axes["controller.reduced_basis.period"])))
    each = ", ".join(f"{1000 * period:g}" for period in periods)
    table = lambda name, first, rows: tables.write_table(folder, f"few_numbers{name}", [first, *SCENES.values()], rows)
    tables.write_table(folder, "few_numbers_points", picture.HEAD, points)
    table("", "least numbers from which on all slide", least)
    table("_starts", "all the way", starts(many) + animals(read_sweep(folder / "animals/table.csv")))
    table("_effort", "effort in the knot's window, each 100 ms", efforts(runs))
    table("_free", f"free head: share of the way, each {each} ms", free_head(free))
    table("_played", "played by the knot's place: share of the way; s", transfers(runs, "played"))
    table("_learned", "learned shapes: share of the way; s", transfers(runs, "learned"))


if __name__ == "__main__":
    run_script(__doc__, ["FOLDER"], main)
