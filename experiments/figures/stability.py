"""The failure map: a heat map of outcomes for every stress scene, and the largest step that each method survives.

Usage: stability.py STABILITY.csv OUT_FOLDER (SCENE.png, summary.png, each with a PDF beside, and summary.md)
"""

from __future__ import annotations

import argparse
import csv
import sys
from collections import Counter
from pathlib import Path
from typing import Any

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
from matplotlib.patches import Patch, Rectangle

from hagfish_log import save_figure

DPI = 160
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
METHODS = ["default", "violated", "baumgarte_0.2", "baumgarte_1", "hard_thigmotaxis", "ipopt", "mujoco_euler",
           "mujoco_implicit", "mujoco_rk4"]
TITLES = {"baumgarte_0.2": "Baumgarte 0.2", "baumgarte_1": "Baumgarte 1", "hard_thigmotaxis": "hard Eq. 6",
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
Grid = dict[tuple[str, float], Cell]  # by row and h, ms


def read(path: Path) -> list[Cell]:
    with path.open(newline="", encoding="utf-8") as file:
        cells = list(csv.DictReader(file))
    for cell in cells:
        if cell["outcome"] not in LOOKS:
            raise ValueError(f"{path}: no such outcome: {cell['outcome']}")
    return cells


def step_of(cell: Cell) -> float:
    return float(cell["h_ms"])


def grid_of(cells: list[Cell], key: Any) -> Grid:
    return {(key(cell), step_of(cell)): cell for cell in cells}


def draw_grid(axes: Any, grid: Grid, rows: list[str], steps: list[float]) -> None:
    for y, row in enumerate(rows):
        for x, step in enumerate(steps):
            cell = grid.get((row, step))
            if cell is None:
                continue
            outcome = cell["outcome"]
            letter, colour = LOOKS[outcome]
            axes.add_patch(Rectangle((x, y), 1, 1, fc=colour, ec="white", lw=1.5,
                                     hatch="///" if outcome == "not applicable" else None))
            axes.text(x + 0.5, y + 0.52, letter, ha="center", va="center", fontsize=8, fontweight="bold",
                      color="white" if outcome in DARK else "#222222")
    axes.set_xlim(0, len(steps))
    axes.set_ylim(len(rows), 0)
    axes.set_xticks([x + 0.5 for x in range(len(steps))], [f"{step:g}" for step in steps], fontsize=8)
    axes.set_yticks([y + 0.5 for y in range(len(rows))], [TITLES.get(row, row) for row in rows], fontsize=8)
    axes.tick_params(length=0)
    axes.set_xlabel("h, ms", fontsize=8)
    for side in axes.spines.values():
        side.set_visible(False)


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


def draw_scene(scene: str, cells: list[Cell], png: Path) -> None:
    whole = [cell for cell in cells if cell["level"] == AS_IS]
    panels = [("methods", grid_of(whole, lambda c: c["method"]),
               [m for m in METHODS if any(c["method"] == m for c in whole)], sorted({step_of(c) for c in whole}))]
    for method, own in by_level(cells):
        levels = sorted({c["level"] for c in own}, key=level_order)
        panels.append((TITLES.get(method, method), grid_of(own, lambda c: c["level"]), levels,
                       sorted({step_of(c) for c in own})))
    seeds = [cell for cell in cells if cell["level"].startswith("seed")]
    if seeds:
        panels.append(("perturbed starts", grid_of(seeds, lambda c: c["level"]),
                       sorted({c["level"] for c in seeds}, key=level_order), sorted({step_of(c) for c in seeds})))
    # Cells of one size in every panel, laid out in inches.
    left = [LETTER * max(len(TITLES.get(row, row)) for row in rows) + 0.25 for _, _, rows, _ in panels]
    width = max(sum(left) + CELL * sum(len(steps) for _, _, _, steps in panels) + 0.3, 6.8)
    below = 0.55 + 0.2 * LEGEND_ROWS
    height = CELL * max(len(rows) for _, _, rows, _ in panels) + below + 0.7
    figure = plt.figure(figsize=(width, height))
    x = 0.0
    for margin, (title, grid, rows, steps) in zip(left, panels):
        wide, high = CELL * len(steps), CELL * len(rows)
        axes = figure.add_axes(((x + margin) / width, (height - 0.7 - high) / height, wide / width, high / height))
        draw_grid(axes, grid, rows, steps)
        axes.set_title(title, fontsize=9, loc="left")
        x += margin + wide
    figure.suptitle(SCENES.get(scene, scene), fontsize=11, y=1 - 0.08 / height, va="top")
    legend(figure, cells)
    save_figure(figure, png, DPI)
    plt.close(figure)


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
    figure, axes = plt.subplots(figsize=(9.5, 0.36 * len(scenes) + 1.6), layout="constrained")
    shades = plt.get_cmap("cividis")
    for y, scene in enumerate(scenes):
        for x, method in enumerate(METHODS):
            own = own_cells(cells, scene, method)
            text, largest = survived(own)
            if not own:
                continue
            rank = -1 if largest is None else steps.index(largest)
            shade = "#ffffff" if text == "n/a" else shades((rank + 1) / len(steps))
            axes.add_patch(Rectangle((x, y), 1, 1, fc=shade, ec="white", lw=1.5,
                                     hatch="///" if text == "n/a" else None))
            letter = "" if text == "n/a" or text.startswith("all") else LOOKS[first_failure(own)][0]
            words = "" if text == "n/a" else ("none" if largest is None else f"{largest:g}")
            axes.text(x + 0.5, y + 0.52, f"{words} {letter}".strip(), ha="center", va="center", fontsize=8,
                      color="white" if rank + 1 < 0.55 * len(steps) and text != "n/a" else "black")
    axes.set_xlim(0, len(METHODS))
    axes.set_ylim(len(scenes), 0)
    axes.set_xticks([x + 0.5 for x in range(len(METHODS))], [TITLES.get(m, m) for m in METHODS], fontsize=8,
                    rotation=20, ha="left")
    axes.xaxis.tick_top()
    axes.set_yticks([y + 0.5 for y in range(len(scenes))], [SCENES.get(s, s) for s in scenes], fontsize=9)
    axes.tick_params(length=0)
    for side in axes.spines.values():
        side.set_visible(False)
    codes = ", ".join(f"{letter} {name}" for name, (letter, _) in LOOKS.items() if letter not in ("", "-"))
    figure.supxlabel("Largest step, ms, up to which every step is survived, and what comes first beyond it; blank: not run.\n" + codes,
                     fontsize=7.5)
    save_figure(figure, png, DPI)


def behind_mujoco(cells: list[Cell]) -> list[str]:
    """Cells in which MuJoCo's default survives and the core's does not."""
    ours = {(c["scene"], c["level"], c["h_ms"]): c for c in cells if c["method"] == "default"}
    return [f"{SCENES.get(c['scene'], c['scene'])}, {c['level']}, {c['h_ms']} ms: {mine['outcome']}"
            for c in cells if c["method"] == "mujoco_euler" and c["outcome"] == "ok"
            and (mine := ours.get((c["scene"], c["level"], c["h_ms"]))) and mine["outcome"] != "ok"]


def write_summary(cells: list[Cell], path: Path) -> None:
    lines = ["# Where it fails", "", "Largest h (ms) up to which every step is survived, and the first outcome beyond it.",
             "", "| scene | " + " | ".join(TITLES.get(m, m) for m in METHODS) + " |", "|---" * (len(METHODS) + 1) + "|"]
    for scene in scenes_of(cells):
        lines.append(f"| {SCENES.get(scene, scene)} | "
                     + " | ".join(survived(own_cells(cells, scene, m))[0] for m in METHODS) + " |")
    seeds = [cell for cell in cells if cell["level"].startswith("seed")]
    if seeds:
        lines += ["", "Perturbed starts of the Table 1 run:", "", "| h, ms | ok | otherwise |", "|---|---|---|"]
        for step in sorted({step_of(c) for c in seeds}):
            counts = Counter(c["outcome"] for c in seeds if step_of(c) == step)
            others = ", ".join(f"{n} {name}" for name, n in counts.most_common() if name != "ok")
            lines.append(f"| {step:g} | {counts['ok']} of {counts.total()} | {others} |")
    counts = Counter(cell["outcome"] for cell in cells)
    lines += ["", f"{len(cells)} cells: " + ", ".join(f"{n} {name}" for name, n in counts.most_common()) + ".", ""]
    worse = behind_mujoco(cells)
    lines += [f"Cells in which MuJoCo's default (Euler) survives and the core's does not: {len(worse)}."]
    lines += [f"- {text}" for text in worse]
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("csv", metavar="STABILITY.csv", type=Path)
    parser.add_argument("out", metavar="OUT_FOLDER", type=Path)
    arguments = parser.parse_args()
    try:
        cells = read(arguments.csv)
        for scene in scenes_of(cells):
            draw_scene(scene, [cell for cell in cells if cell["scene"] == scene], arguments.out / f"{scene}.png")
        draw_summary(cells, arguments.out / "summary.png")
        write_summary(cells, arguments.out / "summary.md")
    except (OSError, ValueError, KeyError) as error:
        print(f"stability.py: {error}", file=sys.stderr)
        sys.exit(2)


if __name__ == "__main__":
    main()
