"""The pull at food as a log has it: how hard, on what, and how its forces run along the body. In N, N cm and cm.

Means are over the settled part of the phase `pull`: from expect.pull_settled after it began.
"""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from hagfish_log import HagfishLog, LogError

NEWTON = 1e5  # dyn


def weights(parameter: np.ndarray, bodies: int) -> tuple[np.ndarray, np.ndarray]:
    """Of all body centres in the point of the spline at `parameter` (P) and in its derivative, P x N each: uniform
    Catmull-Rom with phantoms beyond both ends (core/contact/spline.cpp)."""
    segment = np.clip(np.floor(parameter).astype(int), 0, bodies - 2)
    t = parameter - segment
    point = 0.5 * np.stack([-t + 2 * t**2 - t**3, 2 - 5 * t**2 + 3 * t**3, t + 4 * t**2 - 3 * t**3, t**3 - t**2])
    slope = 0.5 * np.stack([-1 + 4 * t - 3 * t**2, -10 * t + 9 * t**2, 1 + 8 * t - 9 * t**2, 3 * t**2 - 2 * t])
    found = []
    for four in (point, slope):
        wide = np.zeros((len(segment), bodies + 2))  # with the two phantoms
        for k in range(4):
            wide[np.arange(len(segment)), segment + k] += four[k]
        wide[:, 1] += 2 * wide[:, 0]
        wide[:, 2] -= wide[:, 0]
        wide[:, -2] += 2 * wide[:, -1]
        wide[:, -3] -= wide[:, -1]
        found.append(wide[:, 1:-1])
    return found[0], found[1]


def settled(log: HagfishLog) -> np.ndarray:
    """Indices of the frames of the settled pull."""
    frames = log.intervals_in("pull")
    if not frames.size:
        return frames
    time = log["/trajectory/time"]
    return frames[time[frames] >= time[frames[0]] + float(log.scene()["expect"]["pull_settled"])]


@dataclass
class Rows:
    """Rows of Eq. 6 at some frames, in one list."""

    at: np.ndarray  # place of the frame among these
    along: np.ndarray  # 0 along the tangent of strand a, 1 of strand b
    a: np.ndarray  # spline parameters on the two strands
    b: np.ndarray
    force: np.ndarray  # λ / h, N

    def sums(self, frames: int, factor: np.ndarray | float = 1.0) -> np.ndarray:
        return np.bincount(self.at, self.force * factor, frames)


def rows_of(log: HagfishLog, frames: np.ndarray) -> Rows:
    """Of a law at all contacts, or the four of the paper's."""
    if log.scene()["controller"]["law"] == "paper":
        ends = [np.repeat(log[f"/thigmotaxis/spline_{strand}"][frames], 2, axis=1) for strand in "ab"]
        force = log["/thigmotaxis/lambda"][frames]
        at, along = np.nonzero(~np.isnan(ends[0]))
        return Rows(at, along % 2, ends[0][at, along], ends[1][at, along], force[at, along] / NEWTON)
    frame = log["/eq6/frame"]
    which = np.flatnonzero(np.isin(frame, frames))
    of = lambda name: log[f"/eq6/{name}"][which]
    return Rows(np.searchsorted(frames, frame[which]), of("along"), of("spline_a"), of("spline_b"), of("lambda") / NEWTON)


def tangents(log: HagfishLog, frames: np.ndarray, rows: Rows) -> tuple[np.ndarray, np.ndarray]:
    """Of the two strands of each row, both to the tail: R x 3."""
    position = log["/trajectory/position"][frames][rows.at]
    found = []
    for parameter in (rows.a, rows.b):
        slope = np.einsum("rb,rbx->rx", weights(parameter, position.shape[1])[1], position)
        found.append(slope / np.linalg.norm(slope, axis=1, keepdims=True))
    return found[0], found[1]


@dataclass
class Pull:
    """The settled pull of one run; a value for each frame."""

    time: np.ndarray  # s
    force: np.ndarray  # mean over the interval before, N
    plate: np.ndarray  # N
    rows: np.ndarray  # sum of λ / h of the rows of Eq. 6, N
    estimate: np.ndarray  # pull of a frictionless rope in the same knot, sum of λ (1 - cos θ) / h, N
    torque: np.ndarray  # largest of a hinge, N cm
    cap: float  # of a row at the end, N

    @property
    def mean(self) -> float:
        return float(self.force.mean()) if self.force.size else np.nan

    def over(self, seconds: float) -> tuple[np.ndarray, np.ndarray]:
        """Time since it settled, s, and mean force, N, of each whole stretch of so many seconds."""
        if not self.time.size:
            return np.array([]), np.array([])
        stretch = ((self.time - self.time[0]) / seconds).astype(int)
        whole = np.arange(int((self.time[-1] - self.time[0]) / seconds + 1e-6))
        return (whole + 0.5) * seconds, np.array([self.force[stretch == k].mean() for k in whole])


def read_pull(log: HagfishLog) -> Pull:
    frames = settled(log)
    rows = rows_of(log, frames)
    t_a, t_b = tangents(log, frames, rows)
    turn = 1 - (t_a * t_b).sum(axis=1)
    return Pull(log["/trajectory/time"][frames], log["/pull/force"][frames] / NEWTON, log["/pull/plate"][frames] / NEWTON,
                rows.sums(len(frames)), rows.sums(len(frames), turn), log["/pull/torque"][frames] / NEWTON,
                float(log.scene()["food"]["cap"]["to"]) / NEWTON)


@dataclass
class Strand:
    """Mean forces along the body in the settled pull; a value for each body centre."""

    arc: np.ndarray  # of the body's centre from the head, cm
    tension: np.ndarray  # what the body behind pulls with, N: all forces from there to the tail, along the tangent
    contact: np.ndarray  # size of the mean contact force on a body, N
    thigmotaxis: np.ndarray  # along the body's tangent, to the tail, N
    plate: np.ndarray  # N
    work: dict[str, float]  # of each force, N cm for each cm that the body slips along itself: "rows", "contacts", "plate"


def read_strand(log: HagfishLog) -> Strand:
    """From the snapshots at the frames: λ / h of the rows and of each contact with a force, at their spline points."""
    frames = settled(log)
    if not frames.size:
        raise LogError(f"{log.path}: holds no settled pull")
    position = log["/trajectory/position"][frames]
    bodies = position.shape[1]
    slope = weights(np.arange(bodies).astype(float), bodies)[1]
    tangent = np.einsum("cb,fbx->fcx", slope, position)
    tangent /= np.linalg.norm(tangent, axis=2, keepdims=True)
    contact, thigmotaxis, plate = (np.zeros_like(position) for _ in range(3))
    row_of = {int(frame): k for k, frame in enumerate(frames)}
    at, a, b, force = (log[f"/contacts/{name}"] for name in ("frame", "spline_a", "spline_b", "force"))
    for i in np.flatnonzero(np.isin(at, frames)):
        k = row_of[int(at[i])]
        on_a = weights(a[i : i + 1], bodies)[0][0]
        if np.isnan(b[i]):
            plate[k, :, 0] += on_a * force[i]
            continue
        on_b = weights(b[i : i + 1], bodies)[0][0]
        normal = (on_a - on_b) @ position[k]
        contact[k] += np.outer(on_a - on_b, force[i] * normal / np.linalg.norm(normal))
    rows = rows_of(log, frames)
    on_a, on_b = (weights(parameter, bodies)[0] for parameter in (rows.a, rows.b))
    push = np.where(rows.along == 0, rows.force, -rows.force)[:, None] * np.where(rows.along[:, None] == 0,
                                                                                  *tangents(log, frames, rows)) * NEWTON
    for k, difference, along_strand in zip(rows.at, on_a - on_b, push):
        thigmotaxis[k] += np.outer(difference, along_strand)
    along = lambda force: float((force * tangent).sum(axis=(1, 2)).mean()) / NEWTON
    behind = np.cumsum((contact + thigmotaxis + plate)[:, ::-1], axis=1)[:, ::-1]
    length = log["/model/length"]
    return Strand(np.cumsum(length) - 0.5 * length, (behind * tangent).sum(axis=2).mean(axis=0) / NEWTON,
                  np.linalg.norm(contact, axis=2).mean(axis=0) / NEWTON,
                  (thigmotaxis * tangent).sum(axis=2).mean(axis=0) / NEWTON, plate[:, :, 0].mean(axis=0) / NEWTON,
                  {"rows": along(thigmotaxis), "contacts": along(contact), "plate": along(plate)})


def open_pull(path: Path) -> Pull:
    """For scripts of readers' own (docs/tutorials/known_force.md)."""
    return read_pull(HagfishLog(path))
