"""All figures of one log: overview, Figures 7 and 8, the paper's claims, and the summary. What a log does not show, as where
the knot never slid, is said in one line and left out. `hagfish figures` calls this.

Usage: of_log.py LOG.h5 HAGFISH OUT_FOLDER, where HAGFISH is the program.
"""

from __future__ import annotations

import subprocess
from collections.abc import Callable
from pathlib import Path

import figure7
import figure8
import overview
import summary
from hagfish_log import HagfishLog, LogError
from script import run_script


def main(path: Path, hagfish: Path, folder: Path) -> None:
    HagfishLog(path)  # what is no log ends it here
    folder.mkdir(parents=True, exist_ok=True)
    check = folder / "check.csv"
    subprocess.run([hagfish, "check", path, "--csv", check, "--force"], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    drawings: list[tuple[str, Callable[[], None]]] = [
        ("overview.png", lambda: overview.main(path, folder / "overview.png")),
        ("figure7.png", lambda: figure7.main(path, hagfish, folder / "figure7.png")),
        ("figure8.png and claims.png", lambda: figure8.main(path, folder / "figure8.png", folder / "claims.png")),
        ("summary.md", lambda: summary.main(path, check, folder / "summary.md"))]
    for name, draw in drawings:
        try:
            draw()
        except LogError as error:
            print(f"{name}: left out: {error}")
        else:
            print(f"{folder / name.split(' ')[0]}" if " and " not in name else f"{folder / 'figure8.png'}, {folder / 'claims.png'}")


if __name__ == "__main__":
    run_script(__doc__, ["LOG.h5", "HAGFISH", "OUT_FOLDER"], main)
