"""All figures of one log: overview, Figures 7 and 8, the paper's claims, activations, and the summary. What a log does not show, as where
the knot never slid, is said in one line and left out. `hagfish figures` calls this.

Usage: of_log.py LOG HAGFISH OUT_FOLDER, where HAGFISH is the program.
"""

import contextlib
import subprocess
from collections.abc import Callable
from pathlib import Path

import figure7
import figure8
import muscles
import overview
import summary
from hagfish_log import HagfishLog, LogError
from script import printable, run_script, whole


def audited(path: Path, hagfish: Path, check: Path) -> str:
    """Writes what `hagfish check` finds; why it cannot, where it cannot."""
    done = subprocess.run([hagfish, "check", path, "--csv", check, "--force"], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    if done.returncode < 2:
        return ""
    check.unlink(missing_ok=True)
    return done.stderr.strip().removeprefix("hagfish: ")


def claims(path: Path, folder: Path) -> None:
    with whole(folder / "claims.txt") as part, part.open("w") as words, contextlib.redirect_stdout(words):
        figure8.main(path, folder / "figure8.png", folder / "claims.png")


def summarise(path: Path, hagfish: Path, folder: Path) -> None:
    if why := audited(path, hagfish, folder / "check.csv"):
        raise LogError(f"the log cannot be audited: {why}")
    summary.main(path, folder / "check.csv", folder / "summary.md")


def main(path: Path, hagfish: Path, folder: Path) -> None:
    log = HagfishLog(path)  # what is no log ends it here
    folder.mkdir(parents=True, exist_ok=True)
    drawings: list[tuple[tuple[str, ...], Callable[[], None]]] = [
        (("overview.png",), lambda: overview.main(path, folder / "overview.png")),
        (("figure7.png",), lambda: figure7.main(path, hagfish, folder / "figure7.png")),
        (("figure8.png", "claims.png", "claims.txt"), lambda: claims(path, folder)),
        (("summary.md", "check.csv"), lambda: summarise(path, hagfish, folder))]
    if log.scene().get("muscle", {}).get("present"):
        drawings.append((("muscles.png",), lambda: muscles.main(path, folder / "muscles.png")))
    for names, draw in drawings:
        try:
            draw()
        except LogError as error:
            print(printable(f"{names[0]}: left out: {error}"))
        else:
            print(printable(", ".join(str(folder / name) for name in names)))


if __name__ == "__main__":
    run_script(__doc__, ["LOG", "HAGFISH", "OUT_FOLDER"], main)
