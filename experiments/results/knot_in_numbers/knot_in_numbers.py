"""The figures of a knot: the rows of rows/*.csv, with other pages' figures in their braces.

Usage: knot_in_numbers.py FOLDER. Leaves tables/knot_in_numbers.csv and tables/knot_in_numbers_observed.csv there.

In braces is one of the names of `own`, or FILE.csv; COLUMN; ROW; N; UNIT: the least to the largest of the Nth numbers, times UNIT, of the cells
of that table whose heading and whose row, cells joined by bars, have these patterns. N, 0 for the last, and UNIT are 1 where they are left out.
"""

import re
import tomllib
from pathlib import Path
from typing import Any

import numpy as np

import plots
import results
from hagfish_log import LogError
from script import run_script
from tables import Table, read_table, span, write_table

DATA = results.ROOT / "data"
LEAST_ARC = 1.8  # mean diameters of body between parts that touch: data/living_overhand.toml
KNOTS = "reflex/reflex_knots.csv; ^way; "
Read = dict[str, Table]  # by file


def numbers(read: Read, address: str) -> np.ndarray:
    file, column, row, nth, unit = (address.split("; ") + ["1", "1"])[:5]
    table = read.setdefault(file, read_table(results.RESULTS / file))
    cells = [cell for cells in table.rows if re.search(row, "|".join(cells))
             for head, cell in zip(table.head, cells) if cell and re.search(column, head)]
    if not cells:
        raise LogError(f"{file}: nothing under {column!r} in rows of {row!r}")
    return np.array([float(results.NUMBER.findall(cell)[int(nth) - 1]) for cell in cells]) * float(unit)


def middle(program: np.ndarray, animal: dict[str, Any]) -> float:
    """Half way between the outermost contacts of the last shape of a program (s, L, and three curvatures in rad/L), as a share of L."""
    shape, s = program[program[:, 0] == program[-1, 0]], (np.arange(600) + 0.5) / 600
    at, frame = np.zeros((len(s), 3)), np.eye(3)
    for k, (y, z, x) in enumerate(zip(*(np.interp(s, shape[:, 1], shape[:, c]) / (2 * len(s)) for c in (2, 3, 4)))):
        half = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
        frame = frame @ np.linalg.solve(np.eye(3) - half, np.eye(3) + half)
        at[k] = at[k - 1] + frame[:, 0] * animal["length"] / len(s)
    width = np.interp(s, animal["station"], animal["circumference"]) / np.pi
    apart = np.linalg.norm(at[:, None] - at, axis=2) - (width[:, None] + width) / 2
    touching = (apart < 0) & (abs(s[:, None] - s) * animal["length"] > LEAST_ARC * width.mean())
    return float(s[touching.any(axis=0)][[0, -1]].mean())


def own(read: Read) -> dict[str, str]:
    """What no page's table has as it is."""
    animal, scene = (tomllib.loads((DATA / name).read_text(encoding="utf-8")) for name in ("specimens/pacific_hagfish.toml", "living_overhand.toml"))
    programs = [np.loadtxt(DATA / f"programs/{name}.csv", delimiter=",", skiprows=1) for name in plots.SCENES]
    return {"programs end": span((each[-1, 0] for each in programs), ".3g"),
            "middle": span((100 * middle(each, animal) for each in programs), ".0f"),
            "bend": span((100 * np.hypot(each[:, 2], each[:, 3]).max() / animal["length"] for each in programs), ".0f"),
            "EI": span((1e-5 * each for each in animal["passive"]["bending_stiffness"]), ".3g"),
            "capacity": f"{1e-5 * scene['active']['capacity']:.3g}",
            **{f"speed, {law}": span(numbers(read, KNOTS + law) / numbers(read, f"{KNOTS}{law}; 2"), ".2g") for law in ("reflex", "Eq. 6")}}


def main(folder: Path) -> None:
    read: Read = {}
    known = own(read)
    fill = lambda cell: re.sub(r"\{(.+?)\}", lambda of: known.get(of[1]) or span(numbers(read, of[1]), ".3g"), cell)
    made = {name: read_table(Path(__file__).parent / "rows" / f"{name}.csv") for name in ("knot_in_numbers", "knot_in_numbers_observed")}
    rows = {name: [[fill(cell) for cell in row] for row in table.rows] for name, table in made.items()}
    notes = [found.groups() for table in read.values() for note in table.notes if (found := results.MEASURED.match(note))]
    commits, machines = (sep.join(dict.fromkeys(part for note in notes for part in note[k].split(sep))) for k, sep in ((0, ", "), (1, " and ")))
    for name, table in made.items():
        write_table(folder, name, table.head, rows[name], [f"Measured at {commits} on {machines}, {max(note[2] for note in notes)}."])


if __name__ == "__main__":
    run_script(__doc__, ["FOLDER"], main)
