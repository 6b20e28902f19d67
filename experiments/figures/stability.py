"""The failure map: a heat map of outcomes for every stress scene, and the largest step that each method survives.

Usage: stability.py STABILITY.csv OUT_FOLDER (SCENE.png, summary.png, each with a PDF beside, and summary.md)
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
from matplotlib.patches import Patch, Rectangle

import plots
from hagfish_log import LogError
from script import run_script
from tables import of_page, read_csv, write_page

LEGEND_COLUMNS, LEGEND_ROWS = 5, 2
CELL, LETTER = 0.3, 0.075  # inches, of a cell's side and of a label's letter
# Outcome: letter, colour (Paul Tol's light and muted schemes, told apart without red and green).
LOOKS = {"ok": ("", "#e8f4f0"), "energy gain": ("E", "#ee8866"), "non-finite": ("N", "#000000"),
         "tunnelled": ("T", "#882255"), "penetration": ("P", "#77aadd"), "limits": ("L", "#eedd88"),
         "solver failed": ("S", "#332288"), "infeasible": ("I", "#aaaa00"), "capped": ("C", "#bbbbbb"),
         "never tied": ("U", "#ffaabb"),
         "knot lost": ("K", "#ddaa33"), "speed": ("V", "#cc6677"), "crashed": ("X", "#ff0000"),
         "not applicable": ("-", "#ffffff")}
DARK = {"non-finite", "tunnelled", "solver failed"}
METHODS = ["default", "no_watch", "midpoint", "violated", "baumgarte_0.2", "baumgarte_1", "hard_thigmotaxis", "ipopt", "mujoco_euler",
           "mujoco_implicit", "mujoco_rk4"]
TITLES = {"no_watch": "no watch", "midpoint": "midpoint, no watch", "baumgarte_0.2": "Baumgarte 0.2",
          "baumgarte_1": "Baumgarte 1", "hard_thigmotaxis": "hard Eq. 6",
          "ipopt": "Ipopt", "mujoco_euler": "MuJoCo Euler", "mujoco_implicit": "MuJoCo implicit",
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


def cell_grid(axes: Any, rows: list[str], columns: list[str]) -> None:
    """Axes for cells of one unit, the first row at the top."""
    axes.set(xlim=(0, len(columns)), ylim=(len(rows), 0))
    axes.set_xticks([x + 0.5 for x in range(len(columns))], columns)
    axes.set_yticks([y + 0.5 for y in range(len(rows))], rows)
    axes.tick_params(length=0)
    axes.grid(visible=False)
    axes.spines[:].set_visible(False)


def draw_cell(axes: Any, place: tuple[int, int], colour: Any, applicable: bool, text: str, ink: str) -> None:
    axes.add_patch(Rectangle(place, 1, 1, fc=colour, ec="white", lw=1.5, hatch=None if applicable else "///"))
    axes.text(place[0] + 0.5, place[1] + 0.52, text, ha="center", va="center", fontsize=8, color=ink)


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


def draw_summary(cells: list[Cell], png: Path) -> None:
    scenes = scenes_of(cells)
    steps = sorted({step_of(cell) for cell in cells})
    figure, axes = plt.subplots(figsize=(10.5, 0.36 * len(scenes) + 1.6), layout="constrained")
    shades = plt.get_cmap("cividis")
    for y, scene in enumerate(scenes):
        for x, method in enumerate(METHODS):
            own = own_cells(cells, scene, method)
            text, largest = survived(own)
            if not own:
                continue
            rank = -1 if largest is None else steps.index(largest)
            shade = "#ffffff" if text == "n/a" else shades((rank + 1) / len(steps))
            letter = "" if text == "n/a" or text.startswith("all") else LOOKS[first_failure(own)][0]
            words = "" if text == "n/a" else ("none" if largest is None else f"{largest:g}")
            draw_cell(axes, (x, y), shade, text != "n/a", f"{words} {letter}".strip(),
                      "white" if rank + 1 < 0.55 * len(steps) and text != "n/a" else plots.INK)
    cell_grid(axes, [SCENES.get(s, s) for s in scenes], [TITLES.get(m, m).replace(" ", "\n", 1) for m in METHODS])
    axes.xaxis.tick_top()
    axes.tick_params(axis="x", length=0)
    codes = ", ".join(f"{letter} {name}" for name, (letter, _) in LOOKS.items() if letter not in ("", "-"))
    figure.supxlabel("Largest step, ms, up to which every step is survived, and what comes first beyond it; blank: not run.\n" + codes,
                     fontsize=7.5)
    plots.save(figure, png)


def behind_mujoco(cells: list[Cell]) -> list[str]:
    """Cells in which MuJoCo's default survives and the core's does not."""
    ours = {(c["scene"], c["level"], c["h_ms"]): c for c in cells if c["method"] == "default"}
    return [f"{SCENES.get(c['scene'], c['scene'])}, {c['level']}, {c['h_ms']} ms: {mine['outcome']}"
            for c in cells if c["method"] == "mujoco_euler" and c["outcome"] == "ok"
            and (mine := ours.get((c["scene"], c["level"], c["h_ms"]))) and mine["outcome"] != "ok"]


def summary_page(cells: list[Cell], out: Path) -> list[str]:
    lines = ["# Where it fails", "", "Largest h (ms) up to which every step is survived, and the first outcome beyond it.",
             "", *of_page(out, "stability", ["scene", *(TITLES.get(m, m) for m in METHODS)],
                           [[SCENES.get(scene, scene), *(survived(own_cells(cells, scene, m))[0] for m in METHODS)]
                            for scene in scenes_of(cells)])]
    seeds = [cell for cell in cells if cell["level"].startswith("seed")]
    rows = []
    for step in sorted({step_of(c) for c in seeds}):
        counts = Counter(c["outcome"] for c in seeds if step_of(c) == step)
        others = ", ".join(f"{n} {name}" for name, n in counts.most_common() if name != "ok")
        rows.append([f"{step:g}", f"{counts['ok']} of {counts.total()}", others])
    if rows:
        lines += ["Perturbed starts of the Table 1 run:", "", *of_page(out, "stability_starts", ["h, ms", "ok", "otherwise"], rows)]
    counts = Counter(cell["outcome"] for cell in cells)
    worse = behind_mujoco(cells)
    return [*lines, f"{len(cells)} cells: " + ", ".join(f"{n} {name}" for name, n in counts.most_common()) + ".", "",
            f"Cells in which MuJoCo's default (Euler) survives and the core's does not: {len(worse)}.",
            *(f"- {text}" for text in worse)]


def main(table: Path, out: Path) -> None:
    cells = read(table)
    for scene in scenes_of(cells):
        draw_scene(scene, [cell for cell in cells if cell["scene"] == scene], out / f"{scene}.png")
    draw_summary(cells, out / "summary.png")
    write_page(out / "summary.md", summary_page(cells, out))


if __name__ == "__main__":
    run_script(__doc__, ["STABILITY.csv", "OUT_FOLDER"], main)
