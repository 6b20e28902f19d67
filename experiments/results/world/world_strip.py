"""A film strip, a row each: a head pulled out of a hole by a reflex and by Eq. 6, a front out of a burrow, a knot round a pole, a robot's.

Usage: world_strip.py REFLEX.h5 PAPER.h5 BURROW.h5 POLE.h5 ROBOT.h5 OUT.png. Needs the program as built (HAGFISH_PROGRAM).
"""

from pathlib import Path

import matplotlib.image
import numpy as np

from hagfish_log import HagfishLog
from log_pictures import take_pictures
from script import run_script

SIZE = "420x330"  # pixels
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
    strips = ((reflex, moments), (paper, moments), (burrow, moments), (pole, moments_of_slide), (robot, moments_of_slide))
    rows = [np.hstack([each.pixels for each in take_pictures(path, moments_of(HagfishLog(path)), "--size", SIZE)]) for path, moments_of in strips]
    matplotlib.image.imsave(out, np.vstack(rows))


if __name__ == "__main__":
    run_script(__doc__, ["REFLEX.h5", "PAPER.h5", "BURROW.h5", "POLE.h5", "ROBOT.h5", "OUT.png"], main)
