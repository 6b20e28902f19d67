"""A film strip of one slide here (above) and in MuJoCo (below), at the same times.

Usage: reflex_strip.py HERE.h5 THERE.h5 OUT.png. Needs the program as built (HAGFISH_PROGRAM).
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
FRAMES, SIZE = 4, "420x330"
SHOWN = 0.75  # of the height: below it is the legend of colours, too small to be read here


def main(here: Path, there: Path, out: Path) -> None:
    logs = [HagfishLog(path) for path in (here, there)]
    slides = [log["/trajectory/time"][log.in_phase("slide")] for log in logs]
    times = np.linspace(max(slide[0] for slide in slides), min(slide[-1] for slide in slides), FRAMES)
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        for path in (here, there):
            picture = Path(folder) / f"{path.stem}.png"
            at = [word for time in times for word in ("--time", f"{time:g}")]
            subprocess.run([HAGFISH, "picture", path, "--out", picture, "--size", SIZE, "--colour", "active", *at], check=True, stdout=subprocess.DEVNULL)
            pictures = [matplotlib.image.imread(picture.with_stem(f"{picture.stem}_{k + 1}"))[..., :3] for k in range(FRAMES)]
            rows.append(np.hstack([each[:int(SHOWN * len(each))] for each in pictures]))
    matplotlib.image.imsave(out, np.vstack(rows))


if __name__ == "__main__":
    run_script(__doc__, ["HERE.h5", "THERE.h5", "OUT.png"], main)
