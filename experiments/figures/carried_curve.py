"""The curve on which a knot of many bodies begins to slide, carried over to bodies of other counts: scenes for experiments/studies/forces_mesh.sh.

Usage: carried_curve.py COUNTS FOLDER. COUNTS is a sweep over scenes and counts of bodies that kept its logs. FOLDER gets a scene
NAME-BODIES.toml for each, and misplaced.csv: how far the nearest chain of so many bodies is from that curve.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

import tables
from hagfish_log import HagfishLog
from script import run_script
from slides import log_of
from sweep_columns import read_sweep

FROM, TO = 400, (100, 200, 400)  # bodies
INSIDE = 5 / 24  # h^2 kappa by which the centres of bodies that bend at every other joint lie inside a circle of as much turn for each length
AXES = {"twist": 0, "bend_y": 1, "bend_z": 2}
LOYALTY = 0.02  # cm/rad: how much an angle holds to that of the same curvature, against a centre to its place
PASSES = 12


@dataclass
class Chain:
    """Bodies of length h, cm, whose hinges turn one joint each, about an axis."""

    bodies: int
    h: float
    joint: np.ndarray
    kind: np.ndarray

    def middles(self) -> np.ndarray:
        return (np.arange(self.bodies) + 0.5) * self.h

    def edges(self, kind: str) -> np.ndarray:
        """Arc lengths between which the hinges of a kind stand for the body, cm."""
        arc = self.h * self.joint[self.kind == kind]
        return np.concatenate([[0.0], 0.5 * (arc[1:] + arc[:-1]), [self.bodies * self.h]])


def chain_of(log: HagfishLog) -> Chain:
    _, joint, kind = log.hinges()
    return Chain(len(log["/model/length"]), float(log["/model/length"][0]), joint, kind)


def turn(axis: int, angle: float) -> np.ndarray:
    matrix, (j, k) = np.eye(3), ((axis + 1) % 3, (axis + 2) % 3)
    matrix[j, j] = matrix[k, k] = np.cos(angle)
    matrix[k, j] = np.sin(angle)
    matrix[j, k] = -matrix[k, j]
    return matrix


def orientation(w: float, x: float, y: float, z: float) -> np.ndarray:
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                     [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                     [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]])


def places(chain: Chain, q: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Centres (N x 3, cm), and of each hinge its axis and where it is."""
    frame, front = orientation(*q[3:7]), q[:3].copy()
    centres = np.zeros((chain.bodies, 3))
    axes, at = np.zeros((len(chain.joint), 3)), np.zeros((len(chain.joint), 3))
    hinge = 0
    for body in range(chain.bodies):
        while hinge < len(chain.joint) and chain.joint[hinge] == body:
            axis = AXES[chain.kind[hinge]]
            axes[hinge], at[hinge] = frame[:, axis], front
            frame = frame @ turn(axis, q[7 + hinge])
            hinge += 1
        centres[body] = front + 0.5 * chain.h * frame[:, 0]
        front = front + chain.h * frame[:, 0]
    return centres, axes, at


def same_curvature(fine: Chain, q: np.ndarray, chain: Chain) -> np.ndarray:
    """Coordinates of `chain` whose hinges turn by what the stretch that they stand for turns."""
    found = np.concatenate([q[:7], np.zeros(len(chain.joint))])
    for kind in AXES:
        turned = np.concatenate([[0.0], np.cumsum(q[7:][fine.kind == kind])])
        found[7:][chain.kind == kind] = np.diff(np.interp(chain.edges(kind), fine.edges(kind), turned))
    return found


def through(points: np.ndarray, at: np.ndarray) -> np.ndarray:
    """The Catmull-Rom spline of points at parameters 0.5, 1.5, ..., straight beyond its ends."""
    i = np.clip(np.floor(at - 0.5).astype(int), 0, len(points) - 2)
    t = (at - 0.5 - i)[:, None]
    more = np.concatenate([[2 * points[0] - points[1]], points, [2 * points[-1] - points[-2]]])
    a, b, c, d = (more[i + k] for k in range(4))
    return b + 0.5 * t * (c - a + t * (2 * a - 5 * b + 4 * c - d + t * (3 * (b - c) + d - a)))


def bend(points: np.ndarray) -> np.ndarray:
    """Second differences, none at the ends."""
    second = np.zeros_like(points)
    second[1:-1] = points[2:] - 2 * points[1:-1] + points[:-2]
    return second


def carried(fine: Chain, q: np.ndarray, chain: Chain, inside: float) -> tuple[np.ndarray, float]:
    """Coordinates of `chain` nearest to the curve of `fine` at q, and how far its centres are from where they should be at most, cm. A
    curve lies `inside` times the second difference of centres outside them."""
    centres, _, _ = places(fine, q)
    second = bend(centres)
    at = chain.middles() / fine.h
    wanted = through(centres - inside * second, at) + inside * (chain.h / fine.h) ** 2 * through(second, at)
    like = same_curvature(fine, q, chain)
    found = like.copy()
    for _ in range(PASSES):
        now, axes, from_ = places(chain, found)
        moves = np.zeros((chain.bodies, 3, len(chain.joint)))
        for hinge, joint in enumerate(chain.joint):
            moves[joint:, :, hinge] = np.cross(axes[hinge], now[joint:] - from_[hinge])
        system = np.concatenate([moves.reshape(3 * chain.bodies, -1), LOYALTY * np.eye(len(chain.joint))])
        right = np.concatenate([(wanted - now).ravel(), LOYALTY * (like - found)[7:]])
        step = np.linalg.lstsq(system, right, rcond=None)[0]
        found[7:] += step
        if np.abs(step).max() < 1e-6:
            break
    return found, float(np.abs(wanted - places(chain, found)[0]).max())


def turned(bodies: int, in_turn: bool) -> np.ndarray:
    """Places (99 x 3, cm) along a body of 42.4 cm whose curvatures are functions of its length. Its universal joints turn about Y before Z,
    all or, `in_turn` as the simulator's, every other one; the others the other way round."""
    length = 42.4
    along = {"bend_y": lambda s: 0.35 * np.sin(np.pi * s / length) ** 2, "twist": lambda s: 0.05 * np.sin(np.pi * s / length),
             "bend_z": lambda s: 0.3 * np.sin(np.pi * s / length) ** 2 * np.cos(0.2 * s)}
    kinds = lambda body: ["twist"] if body % 2 == 0 else ["bend_y", "bend_z"][:: -1 if in_turn and body // 2 % 2 == 0 else 1]
    hinges = [(body, kind) for body in range(1, bodies) for kind in kinds(body)]
    chain = Chain(bodies, length / bodies, np.array([body for body, _ in hinges]), np.array([kind for _, kind in hinges]))
    q = np.concatenate([[0, 0, 0, 1, 0, 0, 0], np.zeros(len(hinges))])
    for kind, curvature in along.items():
        edges = chain.edges(kind)
        q[7:][chain.kind == kind] = curvature(np.linspace(edges[:-1], edges[1:], 9)).mean(axis=0) * np.diff(edges)
    return through(places(chain, q)[0], np.linspace(0.02, 0.98, 99) * bodies)


def turns_off(bodies: int, in_turn: bool) -> float:
    """How far such a body is from one of twice as many bodies, cm, root mean square."""
    return float(np.sqrt(((turned(bodies, in_turn) - turned(2 * bodies, in_turn)) ** 2).sum(axis=1).mean()))


def scene_text(scene: str, bodies: int, q: np.ndarray) -> str:
    """A slide from q: of half the bodies or more to its end, of fewer its first frame."""
    short = "" if 2 * bodies >= FROM else "duration = 0.02\n"
    return (f'base = "{scene}"\ntitle = "The curve of {FROM} bodies, of {bodies}"\n[model]\nbodies = {bodies}\n'
            f'[time]\nstep = 0.002\nuntil = "slide"\n{short}'
            f'[start]\nphase = "slide"\nq = {q.tolist()}\n[expect]\ntypes = []\nhand = "any"\n[guard]\naction = "warn"\n')


def main(counts: Path, folder: Path) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    table = read_sweep(counts / "table.csv")
    cell = {(scene, int(bodies)): k for k, (scene, bodies) in enumerate(zip(table.axes["scene"], table.axes["model.bodies"]))}
    rows = []
    for scene in dict.fromkeys(table.axes["scene"]):
        log = HagfishLog(log_of(counts, str(cell[scene, FROM])))
        fine, q = chain_of(log), log["/trajectory/q"][log.in_phase("slide")[0]]
        for bodies in TO:
            chain = chain_of(HagfishLog(log_of(counts, str(cell[scene, bodies]))))
            plain, off = (q, 0.0) if bodies == FROM else carried(fine, q, chain, 0.0)
            corrected = 0.0 if bodies == FROM else carried(fine, q, chain, INSIDE)[1]
            rows.append([scene, bodies, off, corrected])
            (folder / f"{scene}-{bodies}.toml").write_text(scene_text(scene, bodies, plain), encoding="utf-8")
    tables.write_csv(folder / "misplaced.csv", ["scene", "bodies", "off_cm", "off_corrected_cm"], rows)


if __name__ == "__main__":
    run_script(__doc__, ["COUNTS", "FOLDER"], main)
