"""Pictures of moments of a log, as `hagfish picture` draws them. Needs the program as built (HAGFISH_PROGRAM)."""

import subprocess
import tempfile
from collections.abc import Sequence
from pathlib import Path

import matplotlib.image
import numpy as np

from script import HAGFISH

SIZE = "420x330"  # pixels


def pictures_of(log: Path, times: Sequence[float], *options: str, size: str = SIZE) -> list[np.ndarray]:
    """One for each time (s), of one view: height x width x 3, 0 to 1. `options` are more of the command's."""
    with tempfile.TemporaryDirectory() as folder:
        picture = Path(folder) / "picture.png"
        at = [word for time in times for word in ("--time", f"{time:g}")]
        subprocess.run([HAGFISH, "picture", log, "--out", picture, "--size", size, *options, *at], check=True, stdout=subprocess.DEVNULL)
        drawn = [picture] if len(times) == 1 else [picture.with_stem(f"{picture.stem}_{k + 1}") for k in range(len(times))]
        return [matplotlib.image.imread(one)[..., :3] for one in drawn]
