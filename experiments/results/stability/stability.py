"""The failure map: a heat map of outcomes for every stress scene, and the largest step that each method survives.

Usage: stability.py jobs      a line a cell of cells.toml: `cell SCENE LEVEL METHOD STEP SETTINGS`, large steps first, which are quick and show most
       stability.py page STABILITY.csv OUT_FOLDER (SCENE.png and stability.png, each with a PDF beside, and tables)
"""

import re
import shlex
import sys
import tomllib
from collections import Counter
from itertools import product
from pathlib import Path

import matplotlib.pyplot as plt
from matplotlib.patches import Patch

import plots
from hagfish_log import LogError
from script import run_script
from stability_picture import DARK, LOOKS, cell_grid, draw_cell, draw_summary
from tables import read_csv, write_table

CELL = 0.3  # inches, of a cell's side
# Without the guard on energy beside MuJoCo, which has none.
METHODS = ["default", "violated", "baumgarte_0.2", "baumgarte_1", "hard_thigmotaxis", "ipopt", "no_watch", "midpoint", "mujoco_euler",
           "mujoco_hard", "mujoco_implicit", "mujoco_rk4"]
TITLES = {"no_watch": "Euler, no guard", "midpoint": "midpoint, no guard", "baumgarte_0.2": "Baumgarte 0.2",
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


def read(path: Path) -> list[Cell]:
    cells = read_csv(path, ("scene", "level", "method", "h_ms", "outcome"))
    for cell in cells:
        for what, known in (("outcome", LOOKS), ("method", METHODS)):
            if cell[what] not in known:
                raise LogError(f"{path}: no such {what}: {cell[what]}")
    return cells


def step_of(cell: Cell) -> float:
    return float(cell["h_ms"])


def level_order(level: str) -> float:
    return next((float(word) for word in level.split() if re.fullmatch(r"[\d.]+(?:e-?\d+)?", word)), 0.0)


def draw_scene(scene: str, cells: list[Cell], png: Path) -> None:
    """Outcomes over steps: a row a method, then one a method and level of stress or perturbed start."""
    cells = sorted(cells, key=lambda cell: (cell["level"] != AS_IS, METHODS.index(cell["method"]), level_order(cell["level"])))
    name = lambda cell: TITLES.get(cell["method"], cell["method"]) + (f", {cell['level']}" if cell["level"] != AS_IS else "")
    rows, steps = list(dict.fromkeys(map(name, cells))), sorted({step_of(cell) for cell in cells})
    figure, axes = plt.subplots(figsize=(6.8, CELL * len(rows) + 1.6), layout="constrained")
    cell_grid(axes, rows, [f"{step:g}" for step in steps])
    for cell in cells:
        letter, colour = LOOKS[cell["outcome"]]
        draw_cell(axes, (steps.index(step_of(cell)), rows.index(name(cell))), colour, cell["outcome"] != "not applicable", letter,
                  "white" if cell["outcome"] in DARK else plots.INK)
    axes.set(title=SCENES.get(scene, scene), xlabel="h, ms", aspect="equal")
    seen = {cell["outcome"] for cell in cells}
    patches = [Patch(fc=colour, ec="#999999", label=f"{name} ({letter})" if letter else name)
               for name, (letter, colour) in LOOKS.items() if name in seen]
    axes.legend(handles=patches, loc="upper left", bbox_to_anchor=(1.02, 1), frameon=False)
    plots.save(figure, png)


def survived(cells: list[Cell]) -> str:
    """The largest step from which every smaller one is ok, ms, and what comes first beyond it."""
    if not cells or all(cell["outcome"] == "not applicable" for cell in cells):
        return "n/a" if cells else ""
    largest = "none"
    for cell in sorted(cells, key=step_of):
        if cell["outcome"] != "ok":
            return f"{largest} ({cell['outcome']})"
        largest = f"{step_of(cell):g}"
    return f"all ({largest})"


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
    return ["scene", *(TITLES.get(m, m) for m in methods)], [
        [SCENES.get(scene, scene), *(survived(own_cells(cells, scene, m)) for m in methods)] for scene in scenes_of(cells)]


def write_tables(cells: list[Cell], out: Path) -> None:
    write_table(out, "stability", *summary_table(cells))
    seeds = [cell for cell in cells if cell["level"].startswith("seed")]
    rows = []
    for step in sorted({step_of(c) for c in seeds}):
        counts = Counter(c["outcome"] for c in seeds if step_of(c) == step)
        others = ", ".join(f"{n} {name}" for name, n in counts.most_common() if name != "ok")
        rows.append([f"{step:g}", f"{counts['ok']} of {counts.total()}", others])
    write_table(out, "stability_starts", ["h, ms", "ok", "otherwise"], rows)


def jobs() -> None:
    known, found = tomllib.loads((Path(__file__).parent / "cells.toml").read_text(encoding="utf-8")), []
    for of in known["cells"]:
        for scene, level, method, step in product(of["scenes"].split(), of.get("levels", [AS_IS]), of["methods"].split(), known["steps"][of["steps"]]):
            named, settings = (of.get(key, default).replace("{}", str(level)) for key, default in (("level", "{}"), ("set", "")))
            found.append((step, ["cell", scene, named, method, str(step), settings]))
    for _, words in sorted(found, key=lambda cell: -cell[0]):
        print(shlex.join(words))


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
    if sys.argv[1:] == ["jobs"]:
        jobs()
    else:
        run_script(__doc__, ["page", "STABILITY.csv", "OUT_FOLDER"], lambda _, table, out: main(table, out))
