"""How few numbers slide each knot, in which frame, how often found. Usage: few_numbers.py TABLE.csv OUT.png OUT.md (writes a PDF
beside). TABLE is that of experiments/studies/grids/few_numbers.toml.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

import plots
import tables
from hagfish_log import LogError
from script import run_script
from sweep_columns import SweepTable, read_sweep

SCENES = {"living_overhand": "3_1", "living_figure_eight": "4_1", "living_double_overhand": "5_1", "living_three_twist": "5_2"}
FRAMES = {"knot": "in the knot's window", "body": "along the body"}
ENOUGH = 0.9  # of the way by the paper's law
COLOURS = [plots.GREY, plots.BLUE, plots.ORANGE, plots.VERMILION]
MARKERS = "osD^"


class Grid:
    """Shares of the full way by scene, frame, period (s) and numbers: one for each start."""

    def __init__(self, table: SweepTable) -> None:
        axes = table.axes
        self.scene, self.frame = np.array(axes["scene"]), np.array(axes["controller.reduced_basis.frame"])
        self.period = np.array(axes["controller.reduced_basis.period"], dtype=float)
        self.numbers = 3 * np.array(axes["controller.reduced_basis.cosines"], dtype=int)
        self.reduced = np.array(axes["controller.law"]) == "reduced_basis"
        held = np.array(table.texts["outcome"]) == "ok"
        distance = np.where(held, np.nan_to_num(table.figures["slide_distance_cm"]), 0)
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


def draw(grid: Grid, out: Path) -> None:
    names = [plots.KNOTS[knot].label for knot in SCENES.values()]
    figure, panels = plots.panels(2, 4, (11, 5), names + [""] * 4, sharex=True, sharey=True)
    panels = np.array(panels).reshape(2, 4)
    for row, (frame, words) in enumerate(FRAMES.items()):
        for column, scene in enumerate(SCENES):
            axes = panels[row, column]
            for colour, marker, period in zip(COLOURS, MARKERS, grid.periods()):
                points = [(count, share) for count in grid.counts() for share in grid.shares(scene, frame, period, count)]
                mean = [np.mean(grid.shares(scene, frame, period, count)) if len(grid.shares(scene, frame, period, count)) else np.nan
                        for count in grid.counts()]
                axes.plot(grid.counts(), np.clip(mean, 0, None), color=colour, lw=1)
                axes.plot(*np.clip(np.array(points).T, 0, None), marker, color=colour, ms=4, label=f"{1000 * period:g} ms")
            axes.axhline(ENOUGH, color=plots.GREY, lw=0.8, ls="--", zorder=0)
            axes.set_xticks(grid.counts())
            if row == 1:
                axes.set_xlabel("numbers")
        panels[row, 0].set_ylabel(f"share of the full way,\nshapes {words}")
    panels[0, 0].legend(title="found each", fontsize=7)
    plots.save(figure, out)


def work(source: Path, png: Path, page: Path) -> None:
    grid = Grid(read_sweep(source))
    draw(grid, png)
    head = ["least numbers from which on all slide", *(f"{knot}" for knot in SCENES.values())]
    rows = [[f"{words}, each {1000 * period:g} ms", *(grid.least(scene, frame, period) for scene in SCENES)]
            for frame, words in FRAMES.items() for period in grid.periods()]
    tables.write_page(page, tables.markdown(head, rows))


if __name__ == "__main__":
    run_script(__doc__, ["TABLE.csv", "OUT.png", "OUT.md"], work)
