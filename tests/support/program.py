"""The program (HAGFISH_PROGRAM) from Python: for tests that read what it writes."""

from __future__ import annotations

import csv
import os
import subprocess
from pathlib import Path

import numpy as np

HAGFISH = Path(os.environ.get("HAGFISH_PROGRAM", Path(__file__).parents[2] / "build/release/experiments/hagfish"))


def hagfish(folder: Path, *arguments: object, code: int = 0) -> str:
    """Runs the program in `folder`; it must end with `code`. Returns all that it said."""
    done = subprocess.run([HAGFISH, *map(str, arguments)], cwd=folder, capture_output=True, text=True)
    assert done.returncode == code, done.stdout + done.stderr
    return done.stdout + done.stderr


def refused(folder: Path, *arguments: object, parts: tuple[str, ...] = ()) -> None:
    """Bad input: exit 2, one line that holds every part, nothing left behind."""
    before = sorted(folder.rglob("*"))
    text = hagfish(folder, *arguments, code=2)
    assert text.count("\n") == 1, text
    for part in parts:
        assert part in text, text
    assert sorted(folder.rglob("*")) == before


def table(path: Path) -> dict[str, np.ndarray]:
    """A CSV by its columns: numbers, with nan where a field is empty, or words."""
    with path.open(newline="") as file:
        heading, *rows = csv.reader(file)
    columns = {}
    for k, name in enumerate(heading):
        fields = [row[k] for row in rows]
        try:
            if any("_" in field for field in fields):  # Python takes 3_1 for 31
                raise ValueError
            columns[name] = np.array([float(field) if field else np.nan for field in fields])
        except ValueError:
            columns[name] = np.array(fields)
    return columns
