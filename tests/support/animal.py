"""The animal's geometry by formulas of the tests' own, which logs, tables and pages are held against."""

import h5py
import numpy as np


def spans(log: h5py.File) -> np.ndarray:
    """Length of body that each joint stands for (core/chain/model.hpp), by the joint; there is no joint 0."""
    n, length = len(log["/model/length"]), log["/model/length"][0]
    return length * np.array([0, *((n if j + 2 >= n else j + 1) - (0 if j <= 2 else j - 1) for j in range(1, n))])


def total_bend(y: np.ndarray, z: np.ndarray) -> np.ndarray:
    """The angle between two bodies that bend by y and z, without what cancels in 1 - cos."""
    return 2 * np.arcsin(np.sqrt(np.sin(y / 2) ** 2 + np.cos(y) * np.sin(z / 2) ** 2))


def turned(axis: np.ndarray, angle: float, vector: np.ndarray) -> np.ndarray:
    """Vectors turned about a unit axis (Rodrigues)."""
    along = (axis * vector).sum(axis=-1, keepdims=True) * axis
    return along + np.cos(angle) * (vector - along) + np.sin(angle) * np.cross(axis, vector)


def axes_along(angles: np.ndarray, names: list[str]) -> tuple[np.ndarray, np.ndarray]:
    """Axes of each body (bodies x 3 x 3, rows X, Y, Z) and of each hinge, by its name, seen from the first body."""
    bodies, hinges = [np.eye(3)], []
    for angle, name in zip(angles, names):
        joint = int(name[1:3])
        if joint == len(bodies):
            bodies.append(bodies[-1])
        hinges.append(bodies[joint][{"twist": 0, "bend_y": 1, "bend_z": 2}[name[4:]]])
        bodies[joint] = turned(hinges[-1], angle, bodies[joint])
    return np.array(bodies), np.array(hinges)


def spline_point(centres: np.ndarray, length: float, s: float) -> np.ndarray:
    """Where the uniform Catmull-Rom spline of bodies of one length is at arc length s."""
    parameter = s / length - 0.5
    i = min(int(parameter), len(centres) - 2)
    t, p = parameter - i, np.vstack([2 * centres[0] - centres[1], centres, 2 * centres[-1] - centres[-2]])[i:i + 4]
    return 0.5 * np.array([-t + 2 * t**2 - t**3, 2 - 5 * t**2 + 3 * t**3, t + 4 * t**2 - 3 * t**3, t**3 - t**2]) @ p
