"""Shapes of torque along the body by which a knot was slid in a run, for `controller.reduced_basis.file`: the first COUNT SVD modes of
f_thigmo at the hinges, as means from frame to frame, in the window from MARGIN before the knot's first contact to as much behind its last.
Usage: sliding_shapes.py LOG.h5 OUT.csv COUNT
"""

from pathlib import Path

import numpy as np

from hagfish_log import HagfishLog, LogError
from script import run_script
from tables import write_csv

AXES = ("bend_y", "bend_z", "twist")
STATIONS = 61
MARGIN = 2.0  # cm


def forces_in_slide(log: HagfishLog) -> tuple[np.ndarray, np.ndarray]:
    """Of the frames of the slide f_thigmo at each hinge (dyn cm), and the knot's ends (cm)."""
    frames = log.in_phase("slide")
    force = log["/mean/forces/thigmotaxis"][frames][:, log.hinges()[0]]
    known = np.isfinite(force).all(axis=1) & (np.abs(force).sum(axis=1) > 0)
    if known.sum() < 2:
        raise LogError(f"{log.path}: has no slide of a knot by f_thigmo")
    ends = np.stack([log[f"/knot/{end}_end"][frames] for end in ("head", "tail")], axis=1)
    return force[known], ends[known]


def sampled(log: HagfishLog, force: np.ndarray, ends: np.ndarray) -> np.ndarray:
    """Each frame's three axes at the stations of the window, one after the other."""
    _, joint, kind = log.hinges()
    place, share = log.joint_arc()[joint], np.linspace(0, 1, STATIONS)
    rows = []
    for values, (first, last) in zip(force, ends):
        arc = first - MARGIN + share * (last - first + 2 * MARGIN)
        rows.append(np.concatenate([np.interp(arc, place[kind == axis], values[kind == axis], left=0, right=0) for axis in AXES]))
    return np.array(rows)


def main(source: Path, out: Path, count: int) -> None:
    log = HagfishLog(source)
    _, size, modes = np.linalg.svd(sampled(log, *forces_in_slide(log)), full_matrices=False)
    held = 100 * np.cumsum(size**2)[count - 1] / np.sum(size**2)
    shapes = [modes[k].reshape(3, STATIONS) / np.abs(modes[k]).max() for k in range(count)]
    rows = [[k + 1, f"{x:.6g}", *(f"{v:.5f}" for v in values)] for k, shape in enumerate(shapes)
            for x, values in zip(np.linspace(0, 1, STATIONS), shape.T)]
    write_csv(out, ["shape", "station (window)", *(f"{axis} (1)" for axis in AXES)], rows,
              [f"{count} SVD modes of f_thigmo, {held:.1f} % of its squares"])
    print(f"{count} of {len(size)} modes hold {held:.1f} % of the squares of f_thigmo")


if __name__ == "__main__":
    run_script(__doc__, ["LOG.h5", "OUT.csv", "COUNT"], main)
