"""A knot's name goes in, a program that the animal ties by itself comes out: `hagfish design`."""

import csv
import shutil
import subprocess
from dataclasses import dataclass
from os import PathLike
from pathlib import Path

from ._core import InputError

_FOUND, _BAD_INPUT, _NOT_FOUND = 0, 2, 3  # exit codes of the program


@dataclass(frozen=True)
class Design:
    """What a search left in its folder: the found program, or that which came nearest."""

    folder: Path
    found: bool
    message: str  # one line: how sure it is, or how near it came

    @property
    def scene(self) -> Path:
        return self.folder / "scene.toml"

    @property
    def log(self) -> Path:
        return self.folder / "knot.h5"

    @property
    def figures(self) -> dict[str, str]:
        """What the search took and what the knot takes, by name with units; empty where no path tied the knot."""
        table = self.folder / "result.csv"
        if not table.exists():
            return {}
        with table.open(newline="", encoding="utf-8") as file:
            return next(csv.DictReader(file))


def design(
    knot: str,
    *,
    out: str | PathLike[str],
    specimen: str | PathLike[str] | None = None,
    budget: str = "15m",
    threads: int | None = None,
    seed: int = 1,
    animals: bool = False,
    start: str | PathLike[str] | None = None,
    resume: bool = False,
) -> Design:
    """Searches a program by which the animal of `specimen` (Table 1's) ties `knot`, and leaves it in the folder `out`.

    The options are those of `hagfish design`, which does the work. Raises InputError for a knot that is unknown or that the
    animal is too short for, and RuntimeError where the search was interrupted or failed.
    """
    command = [_program(), "design", knot, "--out", str(out), "--budget", budget, "--seed", str(seed), "--quiet"]
    if specimen is not None:
        command += ["--specimen", str(specimen)]
    if start is not None:
        command += ["--start", str(start)]
    if threads is not None:
        command += ["--threads", str(threads)]
    command += ["--animals"] * animals + ["--resume"] * resume
    done = subprocess.run(command, stderr=subprocess.PIPE, text=True, check=False)
    message = done.stderr.strip().removeprefix("hagfish: ")
    if done.returncode == _BAD_INPUT:
        raise InputError(message)
    if done.returncode not in (_FOUND, _NOT_FOUND):
        raise RuntimeError(message)
    return Design(Path(out), done.returncode == _FOUND, message)


def _program() -> str:
    """The program beside this package in the build tree, else the installed one."""
    built = Path(__file__).resolve().parents[2] / "hagfish"
    found = str(built) if built.is_file() else shutil.which("hagfish")
    if not found:
        raise FileNotFoundError("the program `hagfish` is not on the PATH")
    return found
