"""Gathers the parts of a sweep into one table: table.csv and times.csv as `hagfish sweep` writes them for the whole grid,
table.h5 with units, and page.html with maps. Usage: gather.py FOLDER
"""

import re
from pathlib import Path

import h5py
import numpy as np

from hagfish_log import LogError
from script import run_script
from sweep_columns import FIGURES, TEXTS, SweepTable, read_sweep
from sweep_page import write_sweep_page


def parts_of(folder: Path) -> int:
    """How many parts there are."""
    counts = {int(match[1]) for path in folder.glob("table.*-of-*.csv")
              if (match := re.fullmatch(r"table\.\d+-of-(\d+)\.csv", path.name))}
    if len(counts) != 1:
        raise LogError(f"{folder}: holds " + ("no part of a sweep" if not counts else
                                              f"parts of sweeps in {' and '.join(map(str, sorted(counts)))} parts"))
    return counts.pop()


def merge(folder: Path, name: str, count: int) -> None:
    """NAME.csv from NAME.1-of-COUNT.csv and so on: part i holds each COUNT-th row from the i-th on. The text of rows stays as
    it is."""
    headings, parts = set(), []
    for part in range(1, count + 1):
        path = folder / f"{name}.{part}-of-{count}.csv"
        lines = path.read_bytes().splitlines(keepends=True)
        headings.add(lines[0])
        parts.append(lines[1:])
    if len(headings) != 1:
        raise LogError(f"{folder}: parts of {name} differ in their columns")
    rows = [b""] * sum(map(len, parts))
    for index, own in enumerate(parts):
        if len(own) != len(range(index, len(rows), count)):
            raise LogError(f"{folder}: {name}.{index + 1}-of-{count}.csv has {len(own)} rows, not its share of {len(rows)}")
        rows[index::count] = own
    for cell, row in enumerate(rows):
        if int(row.split(b",", 1)[0]) != cell:
            raise LogError(f"{folder}: {name}: row {cell + 1} is not of cell {cell}")
    new = folder / f"{name}.csv.new"
    new.write_bytes(b"".join([headings.pop(), *rows]))
    new.rename(folder / f"{name}.csv")


def write_hdf5(path: Path, table: SweepTable) -> None:
    """Groups axes, texts and figures, a value a cell."""
    new = path.with_name(path.name + ".new")
    options = {"compression": "gzip", "shuffle": True}

    def put(group: h5py.Group, name: str, data: object, unit: str, meaning: str) -> None:
        dataset = group.create_dataset(name, data=data, **options)
        dataset.attrs.update(unit=unit, description=meaning)

    with h5py.File(new, "w") as h5:
        axes, texts, figures = (h5.create_group(name) for name in ("axes", "texts", "figures"))
        for key, values in table.axes.items():
            put(axes, key, as_numbers(values), "as in a scene file", "setting of each cell")
        for key, meaning in TEXTS.items():
            put(texts, key, as_texts(table.texts[key]), "1", meaning)
        for key, (unit, meaning) in FIGURES.items():
            put(figures, key, table.figures[key], unit, meaning)
    new.rename(path)


def as_texts(values: list[str]) -> np.ndarray:
    return np.array(values, dtype=h5py.string_dtype())


def as_numbers(values: list[str]) -> np.ndarray:
    """Numbers where all are, else texts."""
    try:
        return np.array([float(value) for value in values])
    except ValueError:
        return as_texts(values)


def main(folder: Path) -> None:
    count = parts_of(folder)
    for name in ("table", "times"):
        merge(folder, name, count)
    table = read_sweep(folder / "table.csv")
    write_hdf5(folder / "table.h5", table)
    write_sweep_page(table, folder / "page.html")


if __name__ == "__main__":
    run_script(__doc__, ["FOLDER"], main)
