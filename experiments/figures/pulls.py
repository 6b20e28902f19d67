"""The pull at food as a log has it: how hard, on what, and how its forces run along the body. In N, N cm and cm.

Means are over the settled part of the phase `pull`: from expect.pull_settled after it began.
"""

from __future__ import annotations

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
class Pull:
    """The settled pull of one run."""

    force: np.ndarray  # of each frame, mean over its 20 ms, N
    plate: np.ndarray  # N
    rows: np.ndarray  # λ / h of the four rows of Eq. 6, F x 4, N
    torque: np.ndarray  # largest of a hinge, N cm
    bearing: np.ndarray  # y, z of the plate's force, F x 2, cm
    turn: np.ndarray  # 1 - cos θ at the first and the last contact, F x 2

    @property
    def mean(self) -> float:
        return float(self.force.mean()) if self.force.size else np.nan

    @property
    def sum(self) -> float:
        """Of the four rows, N."""
        return float(self.rows.sum(axis=1).mean()) if self.force.size else np.nan

    @property
    def estimate(self) -> float:
        """Pull of a frictionless rope in the same knot, sum of λ (1 - cos θ) / h, N."""
        return float((self.rows * np.repeat(self.turn, 2, axis=1)).sum(axis=1).mean()) if self.force.size else np.nan


def turns(log: HagfishLog, frames: np.ndarray) -> np.ndarray:
    """1 - cos θ between the tangents of the two strands, both to the tail, at the contacts followed: F x 2."""
    position = log["/trajectory/position"][frames]
    bodies = position.shape[1]
    tangent = []
    for strand in "ab":
        parameter = log[f"/thigmotaxis/spline_{strand}"][frames]
        slope = np.stack([np.einsum("fb,fbx->fx", weights(np.nan_to_num(parameter[:, k]), bodies)[1], position) for k in (0, 1)], 1)
        tangent.append(slope / np.linalg.norm(slope, axis=2, keepdims=True))
    turn = 1 - (tangent[0] * tangent[1]).sum(axis=2)
    return np.where(np.isnan(log["/thigmotaxis/spline_a"][frames]), 0, turn)


def read_pull(log: HagfishLog) -> Pull:
    frames = settled(log)
    rows = log["/mean/thigmotaxis/lambda"][frames]
    return Pull(log["/pull/force"][frames] / NEWTON, log["/pull/plate"][frames] / NEWTON, rows / NEWTON,
                log["/pull/torque"][frames] / NEWTON, log["/pull/bearing"][frames], turns(log, frames))


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
    value = log["/thigmotaxis/lambda"][frames]
    ends = [log[f"/thigmotaxis/spline_{strand}"][frames] for strand in "ab"]
    for place in (0, 1):
        there = np.flatnonzero(~np.isnan(ends[0][:, place]))
        (point_a, slope_a), (point_b, slope_b) = (weights(end[there, place], bodies) for end in ends)
        for k, frame in enumerate(there):
            t_a, t_b = slope_a[k] @ position[frame], slope_b[k] @ position[frame]
            push = value[frame, 2 * place] * t_a / np.linalg.norm(t_a) - value[frame, 2 * place + 1] * t_b / np.linalg.norm(t_b)
            thigmotaxis[frame] += np.outer(point_a[k] - point_b[k], push)
    along = lambda force: float((force * tangent).sum(axis=(1, 2)).mean()) / NEWTON
    behind = np.cumsum((contact + thigmotaxis + plate)[:, ::-1], axis=1)[:, ::-1]
    length = log["/model/length"]
    return Strand(np.cumsum(length) - 0.5 * length, (behind * tangent).sum(axis=2).mean(axis=0) / NEWTON,
                  np.linalg.norm(contact, axis=2).mean(axis=0) / NEWTON,
                  (thigmotaxis * tangent).sum(axis=2).mean(axis=0) / NEWTON, plate[:, :, 0].mean(axis=0) / NEWTON,
                  {"rows": along(thigmotaxis), "contacts": along(contact), "plate": along(plate)})


def open_pull(path: Path) -> Pull:
    return read_pull(HagfishLog(path))
