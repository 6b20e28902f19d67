"""A film strip of one slide here (above) and in MuJoCo (below), at the same times.

Usage: reflex_strip.py HERE.h5 THERE.h5 OUT.png. Needs the program as built (HAGFISH_PROGRAM).
"""

from __future__ import annotations

from pathlib import Path

import matplotlib.image
import numpy as np

from hagfish_log import HagfishLog
from log_pictures import pictures_of
from script import run_script

FRAMES = 4
SHOWN = 0.75  # of the height: below it is the legend of colours, too small to be read here


def main(here: Path, there: Path, out: Path) -> None:
    logs = [HagfishLog(path) for path in (here, there)]
    slides = [log["/trajectory/time"][log.in_phase("slide")] for log in logs]
    times = np.linspace(max(slide[0] for slide in slides), min(slide[-1] for slide in slides), FRAMES)
    rows = [np.hstack([each[:int(SHOWN * len(each))] for each in pictures_of(path, times, "--colour", "active")]) for path in (here, there)]
    matplotlib.image.imsave(out, np.vstack(rows))


if __name__ == "__main__":
    run_script(__doc__, ["HERE.h5", "THERE.h5", "OUT.png"], main)
