"""Tables: Markdown for readers, CSV for programs."""

import csv
import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from hagfish_log import LogError


@dataclass
class Table:
    """A CSV file: notes (lines behind a #), headings, rows of text."""

    head: list[str]
    rows: list[list[str]]
    notes: list[str] = field(default_factory=list)


def short(value: float, form: str = ".3g") -> str:
    """In a format, without the nought of an exponent."""
    return f"{value:{form}}".replace("e+0", "e").replace("e-0", "e-")


def shown(value: float | None, form: str = ".3g") -> str:
    """The same, or a dash where there is no value."""
    return "-" if value is None or math.isnan(value) else short(value, form)


def grouped(rows: Iterable[Any], key: Callable[[Any], Any]) -> dict[Any, list[Any]]:
    """By key, in the order in which keys first come."""
    found: dict[Any, list[Any]] = {}
    for row in rows:
        found.setdefault(key(row), []).append(row)
    return found


def span(values: Iterable[float], form: str) -> str:
    """The least to the largest of those that are numbers, in a format; the one where they read alike, nothing of none."""
    known = [value for value in values if not math.isnan(value)]
    return " to ".join(dict.fromkeys(f"{end(known):{form}}" for end in (min, max))) if known else ""


def markdown(head: Sequence[str], rows: Iterable[Sequence[str]]) -> list[str]:
    """The lines of a table."""
    line = lambda cells: "| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |"
    return [line(head), "|" + "---|" * len(head), *map(line, rows)]


def write_table(
        folder: Path, name: str, head: Sequence[str], rows: Iterable[Sequence[Any]], notes: Sequence[str] = ()) -> None:
    """A table of a page of results, where results.py takes it."""
    (folder / "tables").mkdir(parents=True, exist_ok=True)
    write_csv(folder / "tables" / f"{name}.csv", head, rows, notes)


def write_csv(path: Path, head: Sequence[str], rows: Iterable[Sequence[Any]], notes: Sequence[str] = ()) -> None:
    """Floats to six digits; `notes` are lines above the heading, each behind a #."""
    with path.open("w", newline="", encoding="utf-8") as file:
        file.writelines(f"# {note}\n" for note in notes)
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(head)
        writer.writerows([f"{cell:.6g}" if isinstance(cell, float) else cell for cell in row] for row in rows)


def read_table(path: Path) -> Table:
    try:
        lines = path.read_text(encoding="utf-8").splitlines(keepends=True)
    except OSError as error:
        raise LogError(f"{path}: {error.strerror}") from None
    rows = [row for row in csv.reader(line for line in lines if not line.startswith("#")) if row]
    head = rows.pop(0) if rows else []
    for row in rows:
        if len(row) != len(head):
            raise LogError(f"{path}: a row of {len(row)} cells under {len(head)} headings: {row[0]}")
    return Table(head, rows, [line[1:].strip() for line in lines if line.startswith("#")])


def read_csv(path: Path, wanted: Iterable[str]) -> list[dict[str, str]]:
    """Rows by column name; a file without rows or without a column of `wanted` is an error."""
    table = read_table(path)
    if not table.rows:
        raise LogError(f"{path}: holds no rows")
    for name in wanted:
        if name not in table.head:
            raise LogError(f"{path}: has no column {name}")
    return [dict(zip(table.head, row)) for row in table.rows]
