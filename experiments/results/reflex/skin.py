"""Where on its own skin an animal touches itself, from a log: the place of its knot, and what a knot has wiped."""

import numpy as np

from accuracy import through
from hagfish_log import HagfishLog

TOUCHING = 0.05  # cm between skins, as controller.contact_gap
SAMPLES = 600  # of the body's length
SECTORS = 12  # round the body
RING = 1.0  # cm of the body's length


def knot_place(log: HagfishLog, frames: np.ndarray) -> np.ndarray:
    """Arc length, cm, at which the skin first comes within TOUCHING of skin further down, frame by frame. The log's head end is a
    minimum of the gap, and hops from joint to joint by up to a centimetre; this goes evenly."""
    length, radius, count = log["/model/length"], log["/model/radius"], log["/model/length"].size
    parameter = np.linspace(0, count - 1, SAMPLES)
    arc = (parameter + 0.5) * length.sum() / count
    thick = np.interp(parameter, np.arange(count), radius)
    near = np.flatnonzero(arc < 0.35 * length.sum())  # no knot of these begins further down
    apart = arc[None, :] - arc[near, None] >= log.scene()["contact"]["least_arc"] + 1.0
    touching = np.where(apart, (thick[near, None] + thick[None, :] + TOUCHING) ** 2, -1.0)
    place = np.full(frames.size, np.nan)
    for i, frame in enumerate(frames):
        points = through(log["/trajectory/position"][frame].reshape(-1, 3), parameter + 0.5)
        square = (points**2).sum(axis=1)
        over = square[near, None] + square[None, :] - 2 * points[near] @ points.T - touching
        least = np.where(apart, over, np.inf).min(axis=1)
        hits = np.flatnonzero(least <= 0)
        if hits.size:
            k = hits[0]
            share = least[k - 1] / (least[k - 1] - least[k]) if k > 0 and np.isfinite(least[k - 1]) else 1.0
            place[i] = arc[near[k]] - (1 - share) * (arc[1] - arc[0])
    return place


def passed(time: np.ndarray, place: np.ndarray, arc: float) -> float:
    """When a place that goes to the head first came to an arc, s; nan where it never did."""
    there = np.flatnonzero(place <= arc)
    if there.size == 0 or there[0] == 0:
        return float("nan")
    k = there[0]
    return float(time[k - 1] + (place[k - 1] - arc) / (place[k - 1] - place[k]) * (time[k] - time[k - 1]))


def turns(log: HagfishLog, frame: int) -> np.ndarray:
    """Rotation of each body to the world, N x 3 x 3, from q."""
    q = log["/trajectory/q"][frame]
    w, x, y, z = q[3:7]
    turn = np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                     [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                     [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]])
    dof, joint, kind = log.hinges()
    count = log["/model/length"].size
    own: list[list[tuple[str, float]]] = [[] for _ in range(count)]
    for k, body, axis in zip(dof, joint, kind):
        own[body].append((axis, q[k + 1]))
    found = np.empty((count, 3, 3))
    for body in range(count):
        for axis, angle in own[body]:
            c, s = np.cos(angle), np.sin(angle)
            turn = turn @ {"twist": np.array([[1, 0, 0], [0, c, -s], [0, s, c]]),
                           "bend_y": np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]]),
                           "bend_z": np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])}[axis]
        found[body] = turn
    return found


def swept(log: HagfishLog, frames: np.ndarray) -> tuple[float, float]:
    """Share of the body's length, in rings of a centimetre, and of its skin, in twelfths of a ring, that pressed on skin in these
    frames. Contacts of the log are points: a twelfth counts whole if one lies in it."""
    count, length = log["/model/length"].size, log["/model/length"].sum()
    rings = int(np.ceil(length / RING))
    touched = np.zeros((rings, SECTORS), dtype=bool)
    which, own = log["/contacts/frame"], np.isfinite(log["/contacts/spline_b"])  # not of the head plate
    for frame in frames:
        rows = np.flatnonzero((which == frame) & own)
        if rows.size == 0:
            continue
        centres, turn = log["/trajectory/position"][frame].reshape(-1, 3), turns(log, int(frame))
        a, b = log["/contacts/spline_a"][rows], log["/contacts/spline_b"][rows]
        at, other = through(centres, a + 0.5), through(centres, b + 0.5)
        for mine, way in ((a, other - at), (b, at - other)):
            body = np.minimum(np.round(mine).astype(int), count - 1)
            side = np.einsum("nij,ni->nj", turn[body], way)
            sector = np.floor((np.arctan2(side[:, 2], side[:, 1]) / (2 * np.pi) % 1) * SECTORS).astype(int) % SECTORS
            touched[((mine + 0.5) * length / count / RING).astype(int), sector] = True
    return float(touched.any(axis=1).mean()), float(touched.mean())
