"""Pictures of moments of a log, as `hagfish picture` draws them."""

import csv
import subprocess
import tempfile
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

import matplotlib.image
import numpy as np

from hagfish_log import LogError
from script import HAGFISH


@dataclass
class Picture:
    """One moment in the picture plane; all of a log have one scale."""

    pixels: np.ndarray  # rows from the top, RGB, 0 to 1
    left: float  # cm, as all that follow
    right: float
    bottom: float
    top: float


def take_pictures(log: Path, times: Iterable[float], *options: str, hagfish: Path = HAGFISH) -> list[Picture]:
    """One for each time (s), of one view. `options` are more of the command's."""
    if not hagfish.is_file():
        raise LogError(f"{hagfish}: no such program")
    with tempfile.TemporaryDirectory() as folder:
        command = [hagfish.absolute(), "picture", log, "--out", f"{folder}/picture.png", *options]
        done = subprocess.run([*command, *(f"--time={float(time)!r}" for time in times)], capture_output=True, text=True)
        if done.returncode != 0:
            raise LogError(done.stderr.strip() or f"{hagfish}: ended with code {done.returncode}")
        pictures = []
        for row in csv.DictReader(done.stdout.splitlines(), delimiter="\t"):
            pixels, size = matplotlib.image.imread(row["file"])[..., :3], float(row["cm_per_pixel"])
            left, bottom = float(row["left_cm"]), float(row["bottom_cm"])
            pictures.append(Picture(pixels, left, left + size * pixels.shape[1], bottom, bottom + size * pixels.shape[0]))
        return pictures
