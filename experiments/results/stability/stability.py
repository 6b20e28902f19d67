"""The failure map: a heat map of outcomes for every stress scene, and the largest step that each method survives.

Usage: stability.py STABILITY.csv OUT_FOLDER (SCENE.png, stability.png, each with a PDF beside, and summary.md)
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
from matplotlib.patches import Patch

import plots
from hagfish_log import LogError
from script import run_script
from stability_picture import DARK, LOOKS, cell_grid, draw_cell, draw_summary
from tables import read_csv, write_table

LEGEND_COLUMNS, LEGEND_ROWS = 5, 2
CELL, LETTER = 0.3, 0.075  # inches, of a cell's side and of a label's letter
# Without the watch beside MuJoCo, which has none.
METHODS = ["default", "violated", "baumgarte_0.2", "baumgarte_1", "hard_thigmotaxis", "ipopt", "no_watch", "midpoint", "mujoco_euler",
           "mujoco_hard", "mujoco_implicit", "mujoco_rk4"]
TITLES = {"no_watch": "Euler, no watch", "midpoint": "midpoint, no watch", "baumgarte_0.2": "Baumgarte 0.2",
          "baumgarte_1": "Baumgarte 1", "hard_thigmotaxis": "hard Eq. 6",
          "ipopt": "Ipopt", "mujoco_euler": "MuJoCo Euler", "mujoco_hard": "MuJoCo Euler, stiff", "mujoco_implicit": "MuJoCo implicit",
          "mujoco_rk4": "MuJoCo RK4"}
SCENES = {"whip": "fast undamped whip", "spinning": "spin near 90°", "coil": "coil from its limits",
          "stiff_joints": "stiff joints", "mass_ratio": "mass ratio", "stiff_tip": "stiff tip spring",
          "tight_limits": "tight limits", "redundant": "redundant rows", "contradictory": "contradictory rows",
          "closing": "strands closing", "overlap": "initial penetration", "tight_bend": "tight bend",
          "short_bodies": "short bodies", "pulled_knot": "pulled knot", "knot_into_head": "knot into head",
          "parallel": "parallel strands", "table1": "Table 1 run"}
AS_IS = "as is"

Cell = dict[str, str]


@dataclass
class Panel:
    """One heat map: cells by row and column, as they are called."""

    title: str
    across: str  # what its columns are
    rows: list[str]
    columns: list[str]
    cells: dict[tuple[str, str], Cell]

    @property
    def margin(self) -> float:
        """Inches that the longest name of a row takes."""
        return LETTER * max(map(len, self.rows)) + 0.25

    @property
    def size(self) -> tuple[float, float]:
        return CELL * len(self.columns), CELL * len(self.rows)


def read(path: Path) -> list[Cell]:
    cells = read_csv(path, ("scene", "level", "method", "h_ms", "outcome"))
    for cell in cells:
        for what, known in (("outcome", LOOKS), ("method", METHODS)):
            if cell[what] not in known:
                raise LogError(f"{path}: no such {what}: {cell[what]}")
    return cells


def step_of(cell: Cell) -> float:
    return float(cell["h_ms"])


def panel_of(title: str, cells: list[Cell], row: Callable[[Cell], str], rows: list[str]) -> Panel:
    """Over time steps."""
    steps = [f"{step:g}" for step in sorted({step_of(cell) for cell in cells})]
    return Panel(title, "h, ms", rows, steps, {(row(cell), f"{step_of(cell):g}"): cell for cell in cells})


def draw_panel(axes: Any, panel: Panel) -> None:
    cell_grid(axes, panel.rows, panel.columns)
    axes.set_xlabel(panel.across)
    for (row, column), cell in panel.cells.items():
        letter, colour = LOOKS[cell["outcome"]]
        draw_cell(axes, (panel.columns.index(column), panel.rows.index(row)), colour, cell["outcome"] != "not applicable", letter,
                  "white" if cell["outcome"] in DARK else plots.INK)


def legend(figure: Any, cells: list[Cell]) -> None:
    seen = {cell["outcome"] for cell in cells}
    patches = [Patch(fc=colour, ec="#999999", label=f"{name} ({letter})" if letter else name)
               for name, (letter, colour) in LOOKS.items() if name in seen]
    figure.legend(handles=patches, loc="lower center", ncols=LEGEND_COLUMNS, fontsize=8, frameon=False)


def by_level(cells: list[Cell]) -> list[tuple[str, list[Cell]]]:
    """Level sweeps by method, the seeds aside; each with the level of the scene itself."""
    levels = [cell["level"] for cell in cells if cell["level"] != AS_IS and not cell["level"].startswith("seed")]
    groups = []
    for method in METHODS:
        own = [cell for cell in cells if cell["method"] == method and cell["level"] in levels]
        if own:
            groups.append((method, own))
    return groups


def level_order(level: str) -> float:
    for word in level.split():
        try:
            return float(word)
        except ValueError:
            continue
    return 0.0


def panels_of(cells: list[Cell]) -> tuple[list[Panel], list[Panel]]:
    """Methods and levels of stress, side by side; below them perturbed starts."""
    whole = [cell for cell in cells if cell["level"] == AS_IS]
    name = lambda cell: TITLES.get(cell["method"], cell["method"])
    known = {cell["method"] for cell in whole}
    upper = [panel_of("methods", whole, name, [TITLES.get(method, method) for method in METHODS if method in known])]
    for method, own in by_level(cells):
        upper.append(panel_of(TITLES.get(method, method), own, lambda cell: cell["level"],
                              sorted({cell["level"] for cell in own}, key=level_order)))
    seeds = [cell for cell in cells if cell["level"].startswith("seed")]
    if not seeds:
        return upper, []
    number = lambda cell: f"{level_order(cell['level']):g}"
    lower = Panel("perturbed starts, default", "seed", [f"{step:g} ms" for step in sorted({step_of(cell) for cell in seeds})],
                  sorted({number(cell) for cell in seeds}, key=float),
                  {(f"{step_of(cell):g} ms", number(cell)): cell for cell in seeds})
    return upper, [lower]


def draw_scene(scene: str, cells: list[Cell], png: Path) -> None:
    """Cells of one size in every panel, laid out in inches."""
    lines = [line for line in panels_of(cells) if line]
    heights = [max(panel.size[1] for panel in line) + 0.75 for line in lines]
    width = max(6.8, *(sum(panel.margin + panel.size[0] for panel in line) + 0.5 for line in lines))
    height = sum(heights) + 0.4 + 0.2 * LEGEND_ROWS
    figure, drawn, top = plt.figure(figsize=(width, height)), [], height - 0.65
    for line, tall in zip(lines, heights):
        left = 0.0
        for panel in line:
            wide, high = panel.size
            left += panel.margin
            axes = figure.add_axes((left / width, (top - high) / height, wide / width, high / height))
            draw_panel(axes, panel)
            drawn.append(axes)
            left += wide
        top -= tall
    plots.name_panels(drawn, [panel.title for line in lines for panel in line])
    figure.suptitle(SCENES.get(scene, scene), fontsize=11, y=1 - 0.08 / height, va="top")
    legend(figure, cells)
    plots.save(figure, png)


def survived(cells: list[Cell]) -> tuple[str, float | None]:
    """The largest step from which every smaller one is ok, as text and in ms (None where there is none)."""
    if not cells:
        return "", None
    if all(cell["outcome"] == "not applicable" for cell in cells):
        return "n/a", None
    largest = None
    for cell in sorted(cells, key=step_of):
        if cell["outcome"] != "ok":
            break
        largest = step_of(cell)
    if all(cell["outcome"] == "ok" for cell in cells):
        return f"all ({largest:g})", largest
    return f"{'none' if largest is None else format(largest, 'g')} ({first_failure(cells)})", largest


def first_failure(cells: list[Cell]) -> str:
    return next(cell["outcome"] for cell in sorted(cells, key=step_of) if cell["outcome"] != "ok")


def scenes_of(cells: list[Cell]) -> list[str]:
    known = {cell["scene"] for cell in cells}
    return [scene for scene in SCENES if scene in known] + sorted(known - set(SCENES))


def own_cells(cells: list[Cell], scene: str, method: str) -> list[Cell]:
    return [c for c in cells if c["scene"] == scene and c["method"] == method and c["level"] == AS_IS]


def behind_mujoco(cells: list[Cell], method: str) -> list[str]:
    """Cells in which MuJoCo's default survives and this method of the core does not."""
    ours = {(c["scene"], c["level"], c["h_ms"]): c for c in cells if c["method"] == method}
    return [f"{SCENES.get(c['scene'], c['scene'])}, {c['level']}, {c['h_ms']} ms: {mine['outcome']}"
            for c in cells if c["method"] == "mujoco_euler" and c["outcome"] == "ok"
            and (mine := ours.get((c["scene"], c["level"], c["h_ms"]))) and mine["outcome"] != "ok"]


def summary_table(cells: list[Cell]) -> tuple[list[str], list[list[str]]]:
    methods = [m for m in METHODS if m in {cell["method"] for cell in cells}]
    return ["scene", *(TITLES.get(m, m) for m in methods)], [[SCENES.get(scene, scene),
                                                              *(survived(own_cells(cells, scene, m))[0] for m in methods)]
                                                             for scene in scenes_of(cells)]


def write_tables(cells: list[Cell], out: Path) -> None:
    write_table(out, "stability", *summary_table(cells))
    seeds = [cell for cell in cells if cell["level"].startswith("seed")]
    rows = []
    for step in sorted({step_of(c) for c in seeds}):
        counts = Counter(c["outcome"] for c in seeds if step_of(c) == step)
        others = ", ".join(f"{n} {name}" for name, n in counts.most_common() if name != "ok")
        rows.append([f"{step:g}", f"{counts['ok']} of {counts.total()}", others])
    write_table(out, "stability_starts", ["h, ms", "ok", "otherwise"], rows)


def main(table: Path, out: Path) -> None:
    cells = read(table)
    for scene in scenes_of(cells):
        draw_scene(scene, [cell for cell in cells if cell["scene"] == scene], out / f"{scene}.png")
    draw_summary(*summary_table(cells), out / "stability.png")
    write_tables(cells, out)
    for method in ("default", "no_watch"):
        print(f"Cells in which MuJoCo's default survives and the core's ({TITLES.get(method, method)}) does not:",
              *behind_mujoco(cells, method), sep="\n")


if __name__ == "__main__":
    run_script(__doc__, ["STABILITY.csv", "OUT_FOLDER"], main)
