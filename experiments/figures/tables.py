"""Tables of the studies: Markdown for readers, CSV for programs."""

from __future__ import annotations

import csv
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

from hagfish_log import LogError
from script import whole


def markdown(head: Sequence[str], rows: Iterable[Sequence[str]]) -> list[str]:
    """The lines of a table, an empty one behind it."""
    line = lambda cells: "| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |"
    return [line(head), "|" + "---|" * len(head), *map(line, rows), ""]


def of_page(folder: Path, name: str, head: Sequence[str], rows: Sequence[Sequence[str]]) -> list[str]:
    """The lines of a table that a page of results shows: it is written as FOLDER/tables/NAME.csv, too, where results.py takes it."""
    (folder / "tables").mkdir(parents=True, exist_ok=True)
    write_csv(folder / "tables" / f"{name}.csv", head, rows)
    return markdown(head, rows)


def write_page(path: Path, lines: Iterable[str]) -> None:
    with whole(path) as part:
        part.write_text("\n".join(lines).rstrip() + "\n", encoding="utf-8")


def write_csv(path: Path, heading: Sequence[str], rows: Iterable[Sequence[Any]], notes: Sequence[str] = ()) -> None:
    """Floats to six digits; `notes` are lines above the heading, each behind a #."""
    with path.open("w", newline="", encoding="utf-8") as file:
        file.writelines(f"# {note}\n" for note in notes)
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(heading)
        writer.writerows([f"{cell:.6g}" if isinstance(cell, float) else cell for cell in row] for row in rows)


def read_csv(path: Path, wanted: Iterable[str]) -> list[dict[str, str]]:
    """Rows by column name, without notes above; a file without rows or without a column of `wanted` is an error."""
    with path.open(newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    if not rows:
        raise LogError(f"{path}: holds no rows")
    for name in wanted:
        if name not in rows[0]:
            raise LogError(f"{path}: has no column {name}")
    return rows
