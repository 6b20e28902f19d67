"""How fast animals of three sizes could tie: their programs run faster and faster, and what helps where they fail.

Usage: haste.py WORK FOLDER. WORK is grid: of FOLDER/KNOT_LENGTH.toml, the scenes of `hagfish specimen`, it makes FOLDER/haste.toml for
`hagfish sweep`, and faster programs; or table: of the sweep in FOLDER/haste it makes tables/knot_in_numbers_haste.csv.
"""

import tomllib
from itertools import product
from pathlib import Path

import numpy as np

import plots
import results
from script import run_script
from sweep_columns import read_sweep
from tables import span, write_table

LENGTHS, HASTES = (25, 42, 60), (1, 2, 4, 8, 16)  # cm
# Factors of the drag, and of the muscles' stiffness and largest torque.
HELPS = {"": (1, 1), "a tenth of the drag": (0.1, 1), "muscles ten times as strong": (1, 10)}
CELLS = list(product(plots.SCENES, LENGTHS, HASTES, HELPS))


def program_of(name: str) -> np.ndarray:
    return np.loadtxt(results.ROOT / f"data/programs/{name}.csv", delimiter=",", skiprows=1)


def make_grid(folder: Path) -> None:
    axis: dict[str, list] = {}
    for name, length, haste, helps in CELLS:
        own, program = folder / f"{plots.SCENES[name]}_{length}.toml", folder / f"{name}_{haste}.csv"
        rows = program_of(name) / [haste, 1, 1, 1, 1]
        np.savetxt(program, rows, "%.9g", ",", header="time (s),station (L),bend_y (rad/L),bend_z (rad/L),twist (rad/L)", comments="")
        scene = tomllib.loads(own.read_text(encoding="utf-8"))
        water, muscles = HELPS[helps]
        for key, value in {"scene": str(own), "script.program": str(program), "controller.tighten_from": float(rows[-1, 0]),
                           **{f"drag.{key}": water * scene["drag"][key] for key in ("normal", "tangential")},
                           **{f"active.{key}": muscles * scene["active"][key] for key in ("stiffness", "capacity")}}.items():
            axis.setdefault(key, []).append(value)
    lines = ['set = ["time.until=form", "expect.types=[]"]', "[[axis]]", *(f'"{key}" = {values}' for key, values in axis.items())]
    (folder / "haste.toml").write_text("\n".join(lines) + "\n", encoding="utf-8")


def make_table(folder: Path) -> None:
    tied = dict(zip(CELLS, (outcome == "ok" for outcome in read_sweep(folder / "haste/table.csv").texts["outcome"])))
    rows, seconds = [], {}
    for name, length in product(plots.SCENES, LENGTHS):
        lasts, first = program_of(name)[-1, 0], next((haste for haste in HASTES if not tied[name, length, haste, ""]), None)
        slower = [lasts / haste for haste in HASTES if first is None or haste < first]
        helps = [each for each in HELPS if first and tied[name, length, first, each]]
        seconds.setdefault(length, []).append(slower[-1] if slower else np.nan)
        rows.append([plots.SCENES[name], str(length), f"{slower[-1]:.3g}" if slower else "none", f"{lasts / first:.3g}" if first else "none",
                     " or ".join(helps) or ("neither" if first else "")])
    rows += [["all", str(length), span(own, ".3g"), "", ""] for length, own in seconds.items()]
    write_table(folder, "knot_in_numbers_haste", ["knot", "length, cm", "tied in, s", "not tied in, s", "what ties it there"], rows)


def main(work: str, folder: Path) -> None:
    (make_grid if work == "grid" else make_table)(folder)


if __name__ == "__main__":
    run_script(__doc__, ["WORK", "FOLDER"], main)
