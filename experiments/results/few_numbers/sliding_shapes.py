"""Shapes of torque along the body by which a knot was slid in a run, for `controller.reduced_basis.file`: the first SVD modes of
f_thigmo at the hinges, as means from frame to frame. Usage: sliding_shapes.py LOG.h5 OUT.csv FRAME COUNT [MARGIN], where FRAME is
"knot", the window from MARGIN (cm, 2) before the knot's first contact to as much behind its last, or "body".
"""

import argparse
import csv
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "drawing"))
from hagfish_log import HagfishLog, LogError  # noqa: E402

AXES = ("bend_y", "bend_z", "twist")
STATIONS = 61


def forces_in_slide(log: HagfishLog) -> tuple[np.ndarray, np.ndarray]:
    """Of the frames of the slide f_thigmo at each hinge (dyn cm), and the knot's ends (cm)."""
    frames = log.in_phase("slide")
    force = log["/mean/forces/thigmotaxis"][frames][:, log.hinges()[0]]
    known = np.isfinite(force).all(axis=1) & (np.abs(force).sum(axis=1) > 0)
    if known.sum() < 2:
        raise LogError(f"{log.path}: has no slide of a knot by f_thigmo")
    ends = np.stack([log[f"/knot/{end}_end"][frames] for end in ("head", "tail")], axis=1)
    return force[known], ends[known]


def sampled(log: HagfishLog, force: np.ndarray, ends: np.ndarray, margin: float | None) -> np.ndarray:
    """Each frame's three axes at the stations, one after the other."""
    _, joint, kind = log.hinges()
    place, length = log.joint_arc()[joint], log["/model/length"].sum()
    share = np.linspace(0, 1, STATIONS)
    rows = []
    for values, (first, last) in zip(force, ends):
        arc = share * length if margin is None else first - margin + share * (last - first + 2 * margin)
        rows.append(np.concatenate([np.interp(arc, place[kind == axis], values[kind == axis], left=0, right=0) for axis in AXES]))
    return np.array(rows)


def learn(source: Path, out: Path, frame: str, count: int, margin: float) -> None:
    log = HagfishLog(source)
    force, ends = forces_in_slide(log)
    length = log["/model/length"].sum()
    rows = sampled(log, force, ends, margin if frame == "knot" else None)
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
