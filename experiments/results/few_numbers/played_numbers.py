"""The numbers by which a knot was slid in a run (controller.law = "reduced_basis"), as a profile of the knot's place: their means
about PLACES places along the way. Usage: played_numbers.py LOG.h5 OUT.toml PLACES SCENE

OUT is a scene, based on SCENE, a built-in one or a file beside OUT, with `controller.reduced_basis.places` and `played`.
"""

from pathlib import Path

import numpy as np

from hagfish_log import HagfishLog, LogError
from script import run_script


def numbers_in_slide(log: HagfishLog) -> tuple[np.ndarray, np.ndarray]:
    """Of the frames of the slide the head end of the window (cm) and the numbers (dyn cm)."""
    if log.scene()["controller"]["law"] != "reduced_basis":
        raise LogError(f"{log.path}: has no slide of a knot by a reduced basis")
    place, numbers = log["/basis/window"][:, 0], log["/basis/amplitude"]
    known = np.isfinite(place) & np.isfinite(numbers).all(axis=1)
    if known.sum() < 2:
        raise LogError(f"{log.path}: has no slide of the knot")
    return place[known], numbers[known]


def profile(place: np.ndarray, numbers: np.ndarray, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Places evenly along the way, and at each the mean of the numbers of the frames that lie nearest to it; where there are
    none, as where the knot hops, the line between its neighbours."""
    places = np.linspace(place.min(), place.max(), count)
    nearest = np.abs(place[:, None] - places).argmin(axis=1)
    filled = np.unique(nearest)
    means = np.stack([numbers[nearest == k].mean(axis=0) for k in filled])
    return places, np.stack([np.interp(places, places[filled], column) for column in means.T], axis=1)


def main(log: Path, out: Path, count: int, base: str) -> None:
    places, played = profile(*numbers_in_slide(HagfishLog(log)), count)
    rows = "\n".join("  " + ", ".join(f"{a:.0f}.0" for a in row) + "," for row in played)
    out.write_text(f'base = "{base}"\n\n[controller.reduced_basis]\nplaces = [{", ".join(f"{x:.3f}" for x in places)}]  # cm of arc\n'
                   f"played = [  # dyn cm\n{rows}\n]\n", encoding="utf-8")


if __name__ == "__main__":
    run_script(__doc__, ["LOG.h5", "OUT.toml", "PLACES", "SCENE"], main)
