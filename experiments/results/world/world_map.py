"""The largest pull of a head in a hole by the hole's width, the animal's girth and its muscles: medians and ranges of starts.

Usage: world_map.py WORLD_MAP.csv OUT.png, of world.py.
"""

import re
from pathlib import Path

import numpy as np

import plots
import tables
from script import run_script

CHANGED = re.compile(r"hole ([\d.]+) cm, (\w+); girth ([\d.]+) cm; muscles ([\d.e]+) dyn")
PULL = re.compile(r"([\d.]+) \(([\d.]+) to ([\d.]+)\)")
GIRTH, MUSCLES = 5.6, 5e5  # cm, dyn cm^2: of rows where the other is changed
STYLES = {"Eq. 6": {"ls": "-", "marker": "o"}, "reflex": {"ls": "--", "marker": "s"}}


def pull_of(cell: str) -> tuple[float, ...]:
    """Median, least and most, N; nan where nothing tied."""
    match = PULL.match(cell)
    return tuple(map(float, match.groups())) if match else (np.nan,) * 3


def main(table: Path, out: Path) -> None:
    rows = tables.read_csv(table, ["changed"])
    panels: list[list[tuple[float, dict[str, str]]]] = [[], [], []]
    for row in rows:
        match = CHANGED.match(row["changed"])
        assert match, row["changed"]
        width, plate, girth, muscles = float(match[1]), match[2], float(match[3]), float(match[4])
        if plate == "rings":
            panels[0].append((width, row))
            continue
        if muscles == MUSCLES:
            panels[1].append((girth, row))
        if girth == GIRTH:
            panels[2].append((muscles / 1e5, row))
    figure, grid = plots.plt.subplots(1, 3, figsize=(9, 3.8), layout="constrained", sharey=True)
    for axes, points, label in zip(grid, panels, ("width of the hole, cm (rings)", "girth of the animal, cm",
                                                  "stiffness of muscles, 1e5 dyn cm²")):
        points.sort(key=lambda point: point[0])
        at = [point[0] for point in points]
        for head in (head for head in rows[0] if head != "changed"):
            knot, law = head.split(", ")
            middle, least, most = np.array([pull_of(row[head]) for _, row in points]).T
            colour = plots.KNOTS[knot].style["color"]
            axes.errorbar(at, middle, [middle - least, most - middle], color=colour, capsize=2, ms=4, lw=1.2,
                          label=f"{plots.KNOTS[knot].label}, {law}", **STYLES[law])
            loose = np.array(at)[np.isnan(middle)]
            if loose.size:
                axes.plot(loose, 0 * loose, "x", color=colour, ms=8 if law == "Eq. 6" else 5, clip_on=False)
        axes.set(xlabel=label, xticks=at)
        axes.axhline(0.5, color=plots.GREY, lw=0.8, zorder=0)
    grid[0].set(ylabel="largest pull, N", ylim=(0, None))
    grid[2].plot([], [], "x", color=plots.GREY, label="not tied")
    handles = grid[2].get_legend_handles_labels()[0]
    plots.legend_above(figure, [*handles[1:], handles[0]], 4, 0.14)
    plots.save(figure, out)


if __name__ == "__main__":
    run_script(__doc__, ["WORLD_MAP.csv", "OUT.png"], main)
