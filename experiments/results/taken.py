"""What a study needs of logs: a JSON file for each, after which the log is removed.

Usage: taken.py MODULE.FUNCTION FOLDER. The function makes of an open log what is written.
"""

import importlib
import json
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import tables
from hagfish_log import HagfishLog
from script import whole


def take(folder: Path, of: Callable[[HagfishLog], dict[str, Any]]) -> None:
    for path in sorted(folder.glob("*.h5")):
        found = of(HagfishLog(path))
        with whole(path.with_suffix(".json")) as file:
            file.write_text(json.dumps(found) + "\n", encoding="utf-8")
        path.unlink()


def taken(folder: Path) -> list[dict[str, Any]]:
    """In the order of their names, which numbers are."""
    paths = sorted(folder.glob("*.json"), key=lambda path: (len(path.stem), path.stem) if path.stem.isdigit() else (0, path.stem))
    return [json.loads(path.read_text(encoding="utf-8")) for path in paths]


def taken_of_sweep(folder: Path) -> list[dict[str, Any]]:
    """Of a sweep made in parts, in the order of its cells: what was taken of each log, and the name of its slide."""
    cells = [row for part in folder.glob("table.*.csv") for row in tables.read_csv(part, ["cell", "slide"])]
    cells.sort(key=lambda row: int(row["cell"]))
    return [found | {"slide": row["slide"]} for row, found in zip(cells, taken(folder / "logs"), strict=True)]


def main(name: str, folder: Path) -> None:
    module, _, function = name.partition(".")
    take(folder, getattr(importlib.import_module(module), function))


if __name__ == "__main__":
    main(sys.argv[1], Path(sys.argv[2]))
