"""The largest step that each method survives, by scene: of the table on the page.

Usage: stability_picture.py stability.csv OUT.png (writes a PDF beside).
"""

import re
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
from matplotlib.patches import Rectangle

import plots
from script import run_script
from tables import read_csv

# Outcome: letter, colour (Paul Tol's light and muted schemes, told apart without red and green).
LOOKS = {"ok": ("", "#e8f4f0"), "energy gain": ("E", "#ee8866"), "non-finite": ("N", "#000000"),
         "tunnelled": ("T", "#882255"), "penetration": ("P", "#77aadd"), "limits": ("L", "#eedd88"),
         "solver failed": ("S", "#332288"), "infeasible": ("I", "#aaaa00"), "capped": ("C", "#bbbbbb"),
         "never tied": ("U", "#ffaabb"),
         "knot lost": ("K", "#ddaa33"), "speed": ("V", "#cc6677"), "crashed": ("X", "#ff0000"),
         "not applicable": ("-", "#ffffff")}
DARK = {"non-finite", "tunnelled", "solver failed"}
STEPS = (0.2, 0.5, 1, 2, 5, 10, 20, 50)  # ms, of the study
GROUPS = ("Euler, no guard", "MuJoCo Euler")  # where those without a guard begin, and MuJoCo's, which has none


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


def draw_summary(head: list[str], rows: list[list[str]], png: Path) -> None:
    """Rows are a scene and, by method, `20 (energy gain)`, `all (50)`, `none (limits)`, `n/a` or nothing."""
    figure, axes = plt.subplots(figsize=(10.5, 0.36 * len(rows) + 1.6), layout="constrained")
    shades = plt.get_cmap("cividis")
    for y, (_, *cells) in enumerate(rows):
        for x, text in enumerate(cells):
            if not text:
                continue
            if text == "n/a":
                draw_cell(axes, (x, y), "#ffffff", False, "", plots.INK)
                continue
            first, inside = re.fullmatch(r"(\S+) \((.*)\)", text).groups()
            largest = inside if first == "all" else first
            shade = 0.0 if largest == "none" else (STEPS.index(float(largest)) + 1) / len(STEPS)
            letter = "" if first == "all" else LOOKS[inside][0]
            draw_cell(axes, (x, y), shades(shade), True, f"{largest} {letter}".strip(), "white" if shade < 0.55 else plots.INK)
    cell_grid(axes, [row[0] for row in rows], [name.replace(" ", "\n", 1) for name in head[1:]])
    for name in set(GROUPS) & set(head):
        axes.axvline(head.index(name) - 1, color=plots.INK, lw=2)
    axes.xaxis.tick_top()
    axes.tick_params(axis="x", length=0)
    codes = ", ".join(f"{letter} {name}" for name, (letter, _) in LOOKS.items() if letter not in ("", "-"))
    figure.supxlabel("Largest step, ms, up to which every step is survived, and what comes first beyond it; blank: not run.\n" + codes,
                     fontsize=7.5)
    plots.save(figure, png)


def main(table: Path, png: Path) -> None:
    rows = read_csv(table, ["scene"])
    draw_summary(list(rows[0]), [list(row.values()) for row in rows], png)


if __name__ == "__main__":
    run_script(__doc__, ["stability.csv", "OUT.png"], main)
