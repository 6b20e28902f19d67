"""Pushes the strands of a curvature program apart, so that thicker bodies pass through its loops.

Usage: widen_program.py LOG.h5 PROGRAM.csv OUT.csv [--thicker 1.12] [--times 36] [--through BODY TIME]... [--pull FROM TO]

LOG is of the animal that the program was made for. Its centreline is laid out by the program alone at every 74 ms. What is
minimised, over the values of the program, is the squared overlap of strands of a body so many times as thick, which grows
to that from 0.6, what joints bend beyond 0.85 of their limits, and, weakly, the change of the program. No step moves a body by
more than 1.5 mm, so that strands do not pass through each other. An end can still slip out of a loop: --through holds that from
TIME (s) on a straight ray from BODY on takes part, as if the tail were endless. Between the times of --pull the shapes go
back to those of PROGRAM, in which strands overlap: so the knot is pulled together.
"""

import argparse
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1] / "drawing"))
from hagfish_log import KINDS, HagfishLog, LogError  # noqa: E402
from script import fail  # noqa: E402

HEADING = "time (s),station (L),bend_y (rad/L),bend_z (rad/L),twist (rad/L)"
FIRST, EVERY = 4.0, 0.074  # s, times looked at
LEAST_ARC = 2.0  # mean diameters: parts with less body between them may touch
RAY = 0.19  # body lengths
ROOM = 2.5 / 42.4  # body lengths that the knot keeps from the head, so that there is a way to slide
HEADWARD = 3.0 / 42.4  # body lengths of ray ahead of the head
NECK = 0.3  # share of the bodies that ROOM and that ray do not hold for
BEND, TWIST = 0.85, 0.8  # share of the limits
WEIGHT_BEND, WEIGHT_TWIST, WEIGHT_ROOM = 200.0, 6000.0, 0.3  # per cm^2 of overlap: rad^2, rad^2, cm^2
KEEP = 1e-4  # weight of the change of each value, (rad/L)^2, and of its second differences; 0.3 times that each round
GROWTH = [0.6, 0.7, 0.8, 0.85, 0.9, 0.95, 1.0, 1.03, 1.06, 1.09, 1.12]  # thicknesses on the way
ROUNDS, ITERATIONS, MEMORY = 6, 50, 20
ENOUGH = 0.01  # cm of overlap
LARGEST_MOVE = 0.15  # cm
COLUMN = [2, 0, 1]  # of the program, by axis


class Body:
    """The chain of a log; lengths in cm."""

    def __init__(self, log: HagfishLog) -> None:
        self.each = float(log["/model/length"][0])
        self.radius = log["/model/radius"]
        self.count = len(self.radius)
        _, self.body, kind = log.hinges()
        self.axis = np.array([KINDS.index(each) for each in kind])
        self.limit = np.minimum(-log["/model/limit_lower"], log["/model/limit_upper"])[6:]
        last = np.minimum(self.body + 1, self.count)
        last[self.body + 2 >= self.count] = self.count
        self.span = (last - np.where(self.body <= 2, 0, self.body - 1)) / self.count  # of a hinge, body lengths

    def chain(self, angles: np.ndarray) -> tuple[np.ndarray, ...]:
        """Centres, joints, directions (times x bodies x 3) and hinge axes (times x hinges x 3); the head lies along x."""
        times = len(angles)
        frame, joint = np.tile(np.eye(3), (times, 1, 1)), np.zeros((times, 3))
        joints, directions = np.empty((2, times, self.count, 3))
        axes = np.empty((times, len(self.body), 3))
        hinge = 0
        for body in range(self.count):
            if body:
                joint = joint + self.each * frame[:, :, 0]
            while hinge < len(self.body) and self.body[hinge] == body:
                a = self.axis[hinge]
                b, c = (a + 1) % 3, (a + 2) % 3
                axes[:, hinge] = frame[:, :, a]
                cosine, sine = np.cos(angles[:, hinge])[:, None], np.sin(angles[:, hinge])[:, None]
                old = frame.copy()
                frame[:, :, b] = cosine * old[:, :, b] + sine * old[:, :, c]
                frame[:, :, c] = cosine * old[:, :, c] - sine * old[:, :, b]
                hinge += 1
            joints[:, body], directions[:, body] = joint, frame[:, :, 0]
        return joints + self.each / 2 * directions, joints, directions, axes


def shares(knots: np.ndarray, at: np.ndarray) -> np.ndarray:
    """What each knot (columns) gives a place (rows) by linear interpolation."""
    return np.array([np.interp(at, knots, one) for one in np.eye(len(knots))]).T


class Overlap:
    """What is minimised, of a program of times x stations x 3."""

    def __init__(self, body: Body, times: np.ndarray, stations: np.ndarray, program: np.ndarray, through: list[list[float]]) -> None:
        self.chain, self.program, self.keep = body, program, KEEP
        self.at = np.arange(FIRST, times[-1] + 0.01, EVERY)
        self.in_time = shares(times, self.at)
        self.along = shares(stations, body.body / body.count) * body.span[:, None]
        self.column = np.take(COLUMN, body.axis)
        self.bends = body.axis > 0
        self.limit = body.limit * np.where(self.bends, BEND, TWIST)
        self.limit_weight = np.where(self.bends, WEIGHT_BEND, WEIGHT_TWIST)
        length, count = body.each * body.count, body.count
        ray = np.arange(1, round(RAY * length / body.each) + 1) * body.each
        self.rider = np.concatenate([np.full(len(ray), int(b)) for b, _ in through] or [np.zeros(0, int)])
        self.ahead = np.concatenate([ray for _ in through] or [np.zeros(0)])
        self.since = np.concatenate([np.zeros(count), *[np.full(len(ray), t) for _, t in through]])
        least = LEAST_ARC * 2 * body.radius.mean()
        i, j = np.triu_indices(count, 1)
        near = (j - i) * body.each >= least
        k, l = (each.ravel() for each in np.meshgrid(np.arange(count), np.arange(len(self.rider)), indexing="ij"))
        ridden = ((self.rider[l] - k) * body.each + self.ahead[l] >= least) & (k < self.rider[l] - 6)
        self.i, self.j = np.concatenate([i[near], k[ridden]]), np.concatenate([j[near], count + l[ridden]])
        radius = np.concatenate([body.radius, np.full(len(self.rider), body.radius[-1])])
        self.reach = radius[self.i] + radius[self.j]
        self.neck, self.room = int(NECK * count), ROOM * length
        place = -(np.arange(round(HEADWARD * length / body.each)) + 0.5) * body.each
        self.headward = np.stack([place, 0 * place, 0 * place], 1)
        self.head_reach = body.radius[0] + body.radius[self.neck:]
        self.thicker = 1.0

    def angles(self, values: np.ndarray) -> np.ndarray:
        shape = np.einsum("tk,ksa->tsa", self.in_time, values.reshape(self.program.shape))
        result = np.empty((len(self.at), len(self.column)))
        for a in range(3):
            own = self.column == a
            result[:, own] = shape[:, :, a] @ self.along[own].T
        return result

    def centres(self, values: np.ndarray) -> np.ndarray:
        return self.chain.chain(self.angles(values))[0]

    def __call__(self, values: np.ndarray) -> tuple[float, np.ndarray, float]:
        """The sum, its gradient and the deepest overlap, cm."""
        angles = self.angles(values)
        centre, joint, direction, axis = self.chain.chain(angles)
        points = np.concatenate([centre, centre[:, self.rider] + self.ahead[:, None] * direction[:, self.rider]], 1)
        force = np.zeros_like(points)  # gradient by points
        total, deepest, count = 0.0, 0.0, self.chain.count
        reach = self.thicker * self.reach
        for k, time in enumerate(self.at):
            p = points[k]
            square = (p * p).sum(1)
            apart = (square[:, None] + square - 2 * p @ p.T)[self.i, self.j]
            close = np.nonzero((apart < reach**2) & (self.since[self.j] <= time))[0]
            i, j, distance = self.i[close], self.j[close], np.sqrt(apart[close])
            gap = reach[close] - distance
            total += (gap**2).sum()
            deepest = max(deepest, gap.max(initial=0))
            push = (p[i] - p[j]) * (-2 * gap / distance)[:, None]
            np.add.at(force[k], i, push)
            np.add.at(force[k], j, -push)
            away = p[self.neck:count, None] - self.headward
            distance = np.sqrt((away**2).sum(2))
            gap = np.maximum(self.thicker * self.head_reach[:, None] - distance, 0)
            total += (gap**2).sum()
            force[k, self.neck:count] += (away * (-2 * gap / distance)[:, :, None]).sum(1)
        short = np.maximum(self.room - points[:, self.neck:count, 0], 0)
        total += WEIGHT_ROOM * (short**2).sum()
        force[:, self.neck:count, 0] -= 2 * WEIGHT_ROOM * short
        by_angle = self.pull_back(points, force, joint, axis)
        beyond = np.maximum(np.abs(angles) - self.limit, 0)
        total += (self.limit_weight * beyond**2).sum()
        by_angle += 2 * self.limit_weight * beyond * np.sign(angles)
        by_shape = np.stack([by_angle[:, self.column == a] @ self.along[self.column == a] for a in range(3)], 2)
        gradient = np.einsum("tk,tsa->ksa", self.in_time, by_shape)
        change = values.reshape(self.program.shape) - self.program
        total += self.keep * (change**2).sum()
        gradient += 2 * self.keep * change
        for one in (0, 1):  # second differences in time, along the body
            back = np.moveaxis(change, one, 0)
            bend = back[2:] - 2 * back[1:-1] + back[:-2]
            total += self.keep * (bend**2).sum()
            to = np.moveaxis(gradient, one, 0)
            to[2:] += 2 * self.keep * bend
            to[1:-1] -= 4 * self.keep * bend
            to[:-2] += 2 * self.keep * bend
        return total, gradient.ravel(), deepest

    def pull_back(self, points: np.ndarray, force: np.ndarray, joint: np.ndarray, axis: np.ndarray) -> np.ndarray:
        count, hinge = self.chain.count, self.chain.body
        turn = np.cross(points, force)
        on, about = force[:, :count].copy(), turn[:, :count].copy()
        np.add.at(on, (slice(None), self.rider), force[:, count:])
        np.add.at(about, (slice(None), self.rider), turn[:, count:])
        beyond = lambda each: np.cumsum(each[:, ::-1], axis=1)[:, ::-1][:, hinge]  # all from the hinge's body to the tail
        return (axis * (beyond(about) - np.cross(joint[:, hinge], beyond(on)))).sum(2)


def descend(overlap: Overlap, x: np.ndarray) -> tuple[np.ndarray, float]:
    """L-BFGS with a bound on how far bodies move. Gives the point and its deepest overlap."""
    past: list[tuple[np.ndarray, np.ndarray, float]] = []
    value, gradient, deepest = overlap(x)
    centres = overlap.centres(x)
    for _ in range(ITERATIONS):
        step, taken = gradient.copy(), []
        for s, y, r in reversed(past):
            taken.append(r * (s @ step))
            step -= taken[-1] * y
        step *= past[-1][0] @ past[-1][1] / (past[-1][1] @ past[-1][1]) if past else 1e-3 / np.abs(gradient).max()
        for (s, y, r), share in zip(past, reversed(taken)):
            step += s * (share - r * (y @ step))
        if step @ gradient <= 0:
            past = []
            continue
        size = 1.0
        while size > 1e-6:
            new = x - size * step
            places = overlap.centres(new)
            move = np.sqrt(((places - centres) ** 2).sum(2)).max()
            if move > LARGEST_MOVE:
                size *= max(0.1, 0.9 * LARGEST_MOVE / move)
                continue
            new_value, new_gradient, new_deepest = overlap(new)
            if new_value <= value - 1e-4 * size * (step @ gradient):
                break
            size *= 0.5
        else:
            if not past:
                break
            past = []
            continue
        s, y = new - x, new_gradient - gradient
        if s @ y > 1e-12:
            past = [*past, (s, y, 1 / (s @ y))][-MEMORY:]
        gained = value - new_value
        x, value, gradient, deepest, centres = new, new_value, new_gradient, new_deepest, places
        if gained < 1e-5 * value:
            break
    return x, deepest


def widen(overlap: Overlap, thicker: float) -> np.ndarray:
    x = overlap.program.ravel().copy()
    for overlap.thicker in [c for c in GROWTH if c < thicker]:
        x, deepest = descend(overlap, x)
        print(f"{overlap.thicker:g} times as thick: overlap {deepest:.3f} cm", flush=True)
    overlap.thicker = thicker
    for _ in range(ROUNDS):
        x, deepest = descend(overlap, x)
        print(f"{thicker:g} times as thick: overlap {deepest:.3f} cm", flush=True)
        if deepest < ENOUGH:
            break
        overlap.keep *= 0.3
    return x.reshape(overlap.program.shape)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    for name in ("LOG", "PROGRAM", "OUT"):
        parser.add_argument(name, type=Path)
    parser.add_argument("--thicker", type=float, default=1.12)
    parser.add_argument("--times", type=int, default=36)
    parser.add_argument("--through", type=float, nargs=2, action="append", default=[], metavar=("BODY", "TIME"))
    parser.add_argument("--pull", type=float, nargs=2, metavar=("FROM", "TO"))
    wanted = parser.parse_args()
    try:
        body = Body(HagfishLog(wanted.LOG))
        rows = np.loadtxt(wanted.PROGRAM, delimiter=",", skiprows=1)
    except (LogError, OSError, ValueError) as error:
        fail(str(error))
    times, stations = np.unique(rows[:, 0]), np.unique(rows[:, 1])
    finer = np.linspace(0, times[-1], wanted.times)
    program = np.einsum("tk,ksa->tsa", shares(times, finer), rows[:, 2:].reshape(len(times), len(stations), 3))
    values = widen(Overlap(body, finer, stations, program, wanted.through), wanted.thicker)
    if wanted.pull:
        back = np.clip((finer - wanted.pull[0]) / (wanted.pull[1] - wanted.pull[0]), 0, 1)[:, None, None]
        values = (1 - back) * values + back * program
    with wanted.OUT.open("x", encoding="utf-8") as file:
        print(HEADING, file=file)
        for time, shape in zip(finer, values):
            for station, value in zip(stations, shape):
                print(f"{time:.5g}", f"{station:.5g}", *(f"{round(v, 3) + 0.0:g}" for v in value), sep=",", file=file)


if __name__ == "__main__":
    main()
