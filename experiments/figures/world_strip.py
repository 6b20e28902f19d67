"""A film strip, a row each: a head pulled out of a hole by a reflex and by the paper's law, a front out of a burrow, a knot round a pole, a robot's.

Usage: world_strip.py REFLEX.h5 PAPER.h5 BURROW.h5 POLE.h5 ROBOT.h5 OUT.png. Needs the program as built (HAGFISH_PROGRAM).
"""

from __future__ import annotations

import os
import subprocess
import tempfile
from pathlib import Path

import matplotlib.image
import numpy as np

from hagfish_log import HagfishLog
from script import run_script

ROOT = Path(__file__).resolve().parents[2]
HAGFISH = Path(os.environ.get("HAGFISH_PROGRAM", ROOT / "build/release/experiments/hagfish"))
SIZE = "420x330"
OUT_FOR = 0.1  # s, after which the last picture shows it


def moments(log: HagfishLog) -> list[float]:
    """The knot tied, at the plate, when what holds the head gives, and the head out, s."""
    time, phase = log["/trajectory/time"], log.labels("/trajectory/phase")
    start = lambda name: float(time[np.argmax(phase == name)])
    plate = next(each for each in log.scene()["obstacle"] if each["name"] == log.scene()["expect"]["out_of"])
    out = float(time[np.argmax((log["/trajectory/q"][:, 0] > plate["point"][0]) & (time > start("release")))])
    return [start("slide"), start("pull"), start("release"), out + OUT_FOR]


def moments_of_slide(log: HagfishLog) -> list[float]:
    """Half way to the knot, the start of the slide, its middle and its end, s."""
    slide = log["/trajectory/time"][log.in_phase("slide")]
    return [slide[0] / 2, slide[0], (slide[0] + slide[-1]) / 2, slide[-1]]


def main(reflex: Path, paper: Path, burrow: Path, pole: Path, robot: Path, out: Path) -> None:
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        strips = ((reflex, moments), (paper, moments), (burrow, moments), (pole, moments_of_slide), (robot, moments_of_slide))
        for row, (path, moments_of) in enumerate(strips):
            picture = Path(folder) / f"{row}.png"
            at = [word for time in moments_of(HagfishLog(path)) for word in ("--time", f"{time:g}")]
            subprocess.run([HAGFISH, "picture", path, "--out", picture, "--size", SIZE, *at], check=True, stdout=subprocess.DEVNULL)
            rows.append(np.hstack([matplotlib.image.imread(picture.with_stem(f"{picture.stem}_{k + 1}"))[..., :3] for k in range(4)]))
    matplotlib.image.imsave(out, np.vstack(rows))


if __name__ == "__main__":
    run_script(__doc__, ["REFLEX.h5", "PAPER.h5", "BURROW.h5", "POLE.h5", "ROBOT.h5", "OUT.png"], main)
