"""The paper's three claims about Figure 8, as numbers computed from a log.

(a) joints behind the knot carry no force; (b) the force grows as the knot nears the head;
(c) the force is smooth along the body and noisy in time, so that a few modes may hold it.
Forces are the moments of f_thigmo (Eq. 8) at the joints, in dyn cm, in the sliding phase: means over the time
from a frame of the log to the next (impulse over time, by default 20 ms), as a single step's force is an
impulse over h. X is taken at twisting joints, Y and Z at bending ones. Only (a) is of single steps, at frames,
and of the hinges' torques. Nothing else is filtered.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from hagfish_log import HagfishLog, LogError

KINDS = {"X": "twist", "Y": "bend_y", "Z": "bend_z"}
# A contact lies on a spline segment between two bodies and moves with the four nearest ones, so its
# row may reach this many bodies beyond the one it is filed under.
SPLINE_REACH = 2
SHARES = (0.95, 0.99)
SMOOTH = 0.25  # roughness, of white noise's 1
LARGER = 1.1  # effort near the head over that far from it, from which on it is larger; at 1 and below it is not
MOST_RUNS = 0.95  # share of the runs that a verdict over all of them needs
LEAST_FRAMES = 12  # of a slide that can be judged
EFFORT = "sum of magnitudes, dyn cm"
NAMES = ("zero behind the knot", "larger near the head", "smooth in space, noisy in time", "a few Fourier modes would do")


class ShortSlide(LogError):
    """Too few sliding frames to judge."""


@dataclass
class Sliding:
    """The sliding phase; rows are the intervals between its frames."""

    time: np.ndarray  # F, end of the interval, s
    interval: float  # from frame to frame, s
    force: np.ndarray  # F x hinges, moment about the axis of each hinge's kind, mean over the interval, dyn cm
    joint: np.ndarray  # joint of each hinge
    kind: np.ndarray  # its kind
    arc: np.ndarray  # arc length of each hinge, cm
    spacing: float  # length of a body, cm
    head_end: np.ndarray  # F, the knot's at the end of the interval, cm
    tail_end: np.ndarray  # F, the knot's at the end of the interval, cm
    last_body: np.ndarray  # F, the most tailward body of any thigmotaxis row there, -1 where none
    step_force: np.ndarray  # F x hinges, their torques in the single step that begins there, dyn cm
    lambdas: np.ndarray  # F x 4, multipliers / h, mean over the interval, dyn
    step_lambdas: np.ndarray  # steps x 4, of every single step in the intervals, dyn

    def axis(self, name: str) -> tuple[np.ndarray, np.ndarray]:
        """Joint numbers (head 0, tail 50 for 100 bodies: two joints make one) and forces F x n."""
        own = self.kind == KINDS[name]
        return self.joint[own] // 2, self.force[:, own]


def ruled_intervals(log: HagfishLog) -> int:
    """How many intervals of the sliding phase end with both contacts of Eq. 6 and a knot."""
    frames = log.intervals_in("slide")
    ruled = np.all(log["/thigmotaxis/body_b"][frames] >= 0, axis=1) & np.isfinite(log["/knot/head_end"][frames])
    return int(ruled.sum())


def read_sliding(log: HagfishLog) -> Sliding:
    frames, ruled = log.intervals_in("slide"), ruled_intervals(log)
    if ruled < LEAST_FRAMES:
        raise ShortSlide(f"{log.path}: {ruled} sliding frames with thigmotaxis rows; Figure 8 needs {LEAST_FRAMES}")
    dof, joint, kind = log.hinges()
    time = log["/trajectory/time"]
    step = log["/trajectory/step"] - log["/trajectory/step"][0]
    return Sliding(time[frames], float(np.median(time[frames] - time[frames - 1])),
                   log.at_hinges(log.moments("thigmotaxis")[frames]), joint, kind, log.joint_arc()[joint],
                   float(np.median(log["/model/length"])), log["/knot/head_end"][frames],
                   log["/knot/tail_end"][frames], log["/thigmotaxis/body_b"][frames].max(axis=1),
                   log["/forces/thigmotaxis"][frames][:, dof], log["/mean/thigmotaxis/lambda"][frames],
                   log["/steps/thigmotaxis_lambda"][step[frames[0] - 1]:step[frames[-1]]])


def zero_behind(s: Sliding) -> dict[str, Any]:
    """Claim (a): forces at hinges tailward of the last contact, and of the last row's own reach. Of single steps, at
    which it is known where that contact is: within an interval it may hop to the tail and back."""
    ruled = (s.last_body >= 0) & np.isfinite(s.tail_end)
    force, tail_end = np.abs(s.step_force[ruled]), s.tail_end[ruled]
    behind_knot = s.arc[None, :] > tail_end[:, None]
    beyond_row = s.joint[None, :] > s.last_body[ruled][:, None] + SPLINE_REACH
    furthest = np.where(force > 0, s.arc[None, :], -np.inf).max(axis=1)
    past = (furthest - tail_end)[np.isfinite(furthest)]
    largest = lambda mask: float(force[mask].max()) if mask.any() else 0.0
    unruled = s.step_force[s.last_body < 0]
    return {"steps": int(ruled.sum()), "largest_force_dyn_cm": float(np.abs(s.force).max(initial=0.0)),
            "largest_behind_tail_end_dyn_cm": largest(behind_knot),
            "nonzero_behind_tail_end": int((force[behind_knot] > 0).sum()),
            "values_behind_tail_end": int(behind_knot.sum()),
            "largest_beyond_reach_of_rows_dyn_cm": largest(beyond_row),
            "nonzero_beyond_reach_of_rows": int((force[beyond_row] > 0).sum()),
            "values_beyond_reach_of_rows": int(beyond_row.sum()),
            "furthest_nonzero_past_tail_end_cm": float(past.max()) if past.size else 0.0,
            "share_of_plane_zero": float((s.step_force == 0).mean()),
            "largest_in_steps_without_rows_dyn_cm": float(np.abs(unruled).max()) if unruled.size else 0.0}


def ranks(values: np.ndarray) -> np.ndarray:
    """Ranks from 0, ties sharing their mean."""
    _, group, count = np.unique(values, return_inverse=True, return_counts=True)
    return (np.cumsum(count) - (count + 1) / 2)[group]


def spearman(x: np.ndarray, y: np.ndarray) -> float:
    """Rank correlation; 0 where one side is constant."""
    a, b = ranks(x) - (len(x) - 1) / 2, ranks(y) - (len(y) - 1) / 2
    scale = np.sqrt((a @ a) * (b @ b))
    return float(a @ b / scale) if scale > 0 else 0.0


def measures(s: Sliding) -> dict[str, np.ndarray]:
    """Sizes of the mean force, interval by interval."""
    active = np.maximum((s.force != 0).sum(axis=1), 1)
    return {EFFORT: np.abs(s.force).sum(axis=1),
            "rms over all joints, dyn cm": np.sqrt((s.force**2).mean(axis=1)),
            "rms over joints in reach, dyn cm": np.sqrt((s.force**2).sum(axis=1) / active),
            "sum of the multipliers / h, dyn": s.lambdas.sum(axis=1)}


def near_over_far(place: np.ndarray, size: np.ndarray) -> float:
    """Mean of a size in the third of the way nearest to the head, over that in the furthest third."""
    third = np.ptp(place) / 3
    return float(size[place <= place.min() + third].mean() / max(size[place >= place.max() - third].mean(), np.finfo(float).tiny))


def grows(ratio: float) -> str:
    """The verdict on a size that is so many times larger near the head."""
    return "agrees" if ratio >= LARGER else "disagrees" if ratio <= 1 else "undecided"


def larger_near_head(s: Sliding) -> dict[str, Any]:
    """Claim (b): size of the force against the knot's head end."""
    ruled = (s.last_body >= 0) & np.isfinite(s.head_end)
    x = s.head_end[ruled]
    result: dict[str, Any] = {"mean_over_s": s.interval, "intervals": int(ruled.sum()), "measures": {}}
    for name, every in measures(s).items():
        y = every[ruled]
        slope, intercept = np.polyfit(x, y, 1)
        residual, spread = y - (slope * x + intercept), y - y.mean()
        result["measures"][name] = {
            "near_over_far": near_over_far(x, y), "spearman_with_head_end": spearman(x, y),
            "fit_slope_per_cm": float(slope), "fit_intercept": float(intercept),
            "fit_r2": float(1 - residual @ residual / (spread @ spread)) if spread @ spread > 0 else 0.0}
    return result


def dct_matrix(n: int) -> np.ndarray:
    """Orthonormal DCT-II; row k is the cosine with k half waves along the body."""
    k, j = np.arange(n)[:, None], np.arange(n)[None, :]
    matrix = np.sqrt(2 / n) * np.cos(np.pi * k * (2 * j + 1) / (2 * n))
    matrix[0] /= np.sqrt(2)
    return matrix


def roughness(values: np.ndarray, axis: int) -> float:
    """Energy of first differences over what unrelated neighbours would have: 0 smooth, 1 white noise."""
    first, second = (np.take(values, range(i, values.shape[axis] + i - 1), axis) for i in (0, 1))
    scale = (first**2).sum() + (second**2).sum()
    return float(((second - first) ** 2).sum() / scale) if scale > 0 else 0.0


def smooth_in_space(s: Sliding) -> dict[str, Any]:
    """Claim (c): modes that hold 95 % and 99 % of the energy, and roughness both ways, per axis."""
    result: dict[str, Any] = {"mean_over_s": s.interval, "axes": {},
                              "multipliers_roughness_in_time": roughness(s.lambdas, 0),
                              "multipliers_roughness_in_time_every_step": roughness(s.step_lambdas, 0)}
    for name in KINDS:
        _, force = s.axis(name)
        energy = {"dct": ((force @ dct_matrix(force.shape[1]).T) ** 2).sum(axis=0),
                  "svd": np.linalg.svd(force, compute_uv=False) ** 2}
        own: dict[str, Any] = {"joints": force.shape[1], "roughness_in_space": roughness(force, 1), "roughness_in_time": roughness(force, 0)}
        for basis, values in energy.items():
            held = np.cumsum(values) / max(values.sum(), np.finfo(float).tiny)
            own[f"{basis}_held"] = held.tolist()
            for share in SHARES:
                own[f"{basis}_modes_{share * 100:.0f}"] = int(np.argmax(held >= share - 1e-12)) + 1
        result["axes"][name] = own
    return result


def over_runs(verdicts: Sequence[str]) -> str:
    """The verdict of nearly all runs, "undecided" where there is none; "" without runs."""
    return next((word for word in dict.fromkeys(verdicts) if verdicts.count(word) >= MOST_RUNS * len(verdicts)), "undecided") if verdicts else ""


def verdicts(a: dict[str, Any], b: dict[str, Any], c: dict[str, Any]) -> dict[str, str]:
    """'agrees', 'disagrees' or 'undecided' for each claim; the rules are printed with them."""
    exact = a["nonzero_beyond_reach_of_rows"] == 0 and a["largest_in_steps_without_rows_dyn_cm"] == 0
    on_axes = lambda holds: "agrees" if all(holds) else "undecided" if any(holds) else "disagrees"
    smooth = on_axes([own["roughness_in_space"] <= min(SMOOTH, own["roughness_in_time"] / 2) for own in c["axes"].values()])
    modes = on_axes([own["dct_modes_95"] <= own["joints"] / 4 for own in c["axes"].values()])
    return dict(zip(NAMES, ("agrees" if exact else "disagrees", grows(b["measures"][EFFORT]["near_over_far"]), smooth, modes)))
