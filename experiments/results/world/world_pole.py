"""What a knot tied round a smooth pole holds: weights that pull the whole animal along the pole and across it.

Usage: world_pole.py FOLDER, of study.sh. Goes on from a frame of pole/run.h5, in the slide, with gravity
of other sizes and ways. Leaves tables/world_pole.csv. Needs the program as built (HAGFISH_PROGRAM).
"""

import subprocess
from pathlib import Path

import numpy as np

import tables
from hagfish_log import HagfishLog
from script import HAGFISH, run_script

START, HELD_FOR = 13.0, 1.0  # s: where the slide goes on, and how long a knot must hold
FORCES = (0.01, 0.02, 0.05, 0.1, 0.2, 0.4, 0.8)  # N
NO_DRAG = ("drag.normal=0", "drag.tangential=0")


class Pole:
    """The line of a straight pole, with two axes across it."""

    def __init__(self, log: HagfishLog) -> None:
        points = np.array(next(each for each in log.scene()["obstacle"] if each["name"] == "pole")["points"])
        self.point, along = points[0], points[-1] - points[0]
        self.axis = along / np.linalg.norm(along)
        first = np.cross(self.axis, [0, 0, 1])
        self.across = (first / np.linalg.norm(first), np.cross(self.axis, first / np.linalg.norm(first)))

    def turns(self, centres: np.ndarray) -> float:
        """How often the body goes round it."""
        off = centres - self.point
        angle = np.unwrap(np.arctan2(off @ self.across[1], off @ self.across[0]))
        return float(angle[-1] - angle[0]) / (2 * np.pi)


def pulled(run: Path, force: np.ndarray, *settings: str) -> HagfishLog:
    """The slide under a weight of `force` (N), to its end or its knot's."""
    log = run.with_name("pulled.h5")
    gravity = ",".join(f"{x:.9g}" for x in force * 1e5 / HagfishLog(run)["/model/mass"].sum())
    every = [word for setting in (f"gravity=[{gravity}]", *settings) for word in ("--set", setting)]
    log.unlink(missing_ok=True)
    subprocess.run([HAGFISH, "branch", run, "--time", f"{START:g}", *every, "--out", log, "--force", "--quiet"], check=False,
                   stderr=subprocess.DEVNULL)
    return HagfishLog(log)


def held(pole: Pole, log: HagfishLog) -> bool:
    """Whether the knot is there and round the pole for HELD_FOR."""
    time, centres = log["/trajectory/time"], log["/trajectory/position"]
    early = (time >= START) & (time <= START + HELD_FOR)
    return bool(time[-1] > START + HELD_FOR and (log["/knot/determinant"][early] == 3).all() and
                all(abs(pole.turns(each)) >= 1 for each in centres[early]))


def way_along(pole: Pole, log: HagfishLog) -> float:
    """Of the centre of mass in HELD_FOR, cm."""
    time, mass = log["/trajectory/time"], log["/model/mass"]
    centre = np.einsum("fbx,b->fx", log["/trajectory/position"], mass) / mass.sum()
    first, last = np.argmin(np.abs(time - START)), np.argmin(np.abs(time - START - HELD_FOR))
    return float((centre[last] - centre[first]) @ pole.axis)


def main(folder: Path) -> None:
    run = folder / "pole" / "run.h5"
    pole, mass = Pole(HagfishLog(run)), HagfishLog(run)["/model/mass"].sum()
    still = way_along(pole, pulled(run, 0 * pole.axis, *NO_DRAG))
    rows = []
    for force in FORCES:
        way = way_along(pole, pulled(run, force * pole.axis, *NO_DRAG)) - still
        across = [held(pole, pulled(run, sign * force * axis)) for axis in pole.across for sign in (1, -1)]
        rows.append([f"{force:g}", f"{way:.3g}", f"{force * 1e5 / mass * HELD_FOR**2 / 2:.3g}",
                     *("yes" if each else "no" for each in across)])
    tables.write_table(folder, "world_pole", ["force, N", "way along the pole in 1 s, no water, cm", "that of a free fall, cm",
                                              *(f"holds across, {degrees} degrees" for degrees in (0, 180, 90, 270))], rows)


if __name__ == "__main__":
    run_script(__doc__, ["FOLDER"], main)
