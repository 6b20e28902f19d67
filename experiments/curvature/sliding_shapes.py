"""Shapes of torque along the body by which a knot was slid in a run, for `controller.reduced_basis.file`: the first SVD modes of
f_thigmo at the hinges, as means from frame to frame. Usage: sliding_shapes.py LOG.h5 OUT.csv FRAME COUNT [MARGIN], where FRAME is
"knot", the window from MARGIN (cm, 2) before the knot's first contact to as much behind its last, or "body".
"""

from __future__ import annotations

import argparse
import csv
import sys
from pathlib import Path

import h5py
import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "figures"))
from hagfish_log import LogError, dataset_of, open_hdf5, values_of  # noqa: E402

AXES = ("bend_y", "bend_z", "twist")
STATIONS = 61


def forces_in_slide(log: h5py.File) -> tuple[np.ndarray, np.ndarray, np.ndarray, float]:
    """Of the frames of the slide f_thigmo at each hinge (dyn cm), and the knot's ends (cm); the hinges' names; length (cm)."""
    phase = dataset_of(log, "/trajectory/phase")
    slides = values_of(phase) == h5py.check_enum_dtype(phase.dtype)["slide"]
    force = values_of(dataset_of(log, "/mean/forces/thigmotaxis"))
    known = slides & np.isfinite(force).all(axis=1) & (np.abs(force[:, 6:]).sum(axis=1) > 0)
    if known.sum() < 2:
        raise LogError(f"{log.filename}: f_thigmo slides no knot in it")
    ends = np.stack([values_of(dataset_of(log, f"/knot/{end}_end")) for end in ("head", "tail")], axis=1)
    dofs = [name.decode() for name in values_of(dataset_of(log, "/model/dof_name"))]
    length = float(np.sum(values_of(dataset_of(log, "/model/length"))))
    return force[known][:, 6:], ends[known], np.array(dofs[6:]), length


def sampled(force: np.ndarray, ends: np.ndarray, hinges: np.ndarray, length: float, margin: float | None) -> np.ndarray:
    """Each frame's three axes at the stations, one after the other."""
    bodies = 1 + max(int(name[1:].split("_")[0]) for name in hinges)
    share = np.linspace(0, 1, STATIONS)
    rows = []
    for values, (first, last) in zip(force, ends):
        arc = share * length if margin is None else first - margin + share * (last - first + 2 * margin)
        row = []
        for axis in AXES:
            own = np.array([name.endswith(axis) for name in hinges])
            place = np.array([int(name[1:].split("_")[0]) for name in hinges[own]]) * length / bodies
            row.append(np.interp(arc, place, values[own], left=0, right=0))
        rows.append(np.concatenate(row))
    return np.array(rows)


def learn(source: Path, out: Path, frame: str, count: int, margin: float) -> None:
    with open_hdf5(source) as log:
        force, ends, hinges, length = forces_in_slide(log)
    rows = sampled(force, ends, hinges, length, margin if frame == "knot" else None)
    _, size, modes = np.linalg.svd(rows, full_matrices=False)
    held = np.cumsum(size**2) / np.sum(size**2)
    share = np.linspace(0, 1, STATIONS)
    with out.open("w", newline="") as file:
        file.write(f"# {count} SVD modes of f_thigmo, {100 * held[count - 1]:.1f} % of its squares\n")
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(["shape", "station (window)" if frame == "knot" else "station (cm)", "bend_y (1)", "bend_z (1)",
                         "twist (1)"])
        for k in range(count):
            shape = modes[k].reshape(3, STATIONS) / np.abs(modes[k]).max()
            for x, values in zip(share if frame == "knot" else share * length, shape.T):
                writer.writerow([k + 1, f"{x:.6g}", *(f"{v:.5f}" for v in values)])
    print(f"{count} of {len(size)} modes hold {100 * held[count - 1]:.1f} % of the squares of f_thigmo")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("log", type=Path)
    parser.add_argument("out", type=Path)
    parser.add_argument("frame", choices=["knot", "body"])
    parser.add_argument("count", type=int)
    parser.add_argument("margin", type=float, nargs="?", default=2.0)
    of = parser.parse_args()
    try:
        learn(of.log, of.out, of.frame, of.count, of.margin)
    except LogError as error:
        parser.error(str(error))


if __name__ == "__main__":
    main()
