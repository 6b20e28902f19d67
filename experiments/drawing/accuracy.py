"""How far one motion is from another: places and moments at the same stations along the body, whatever its mesh."""

import tomllib
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any

import numpy as np

import plots
from hagfish_log import HagfishLog

PRESETS = Path(__file__).resolve().parents[2] / "data" / "presets.toml"
KINDS = ("bend_y", "bend_z", "twist")
Motion = dict[str, np.ndarray]  # by measure: places, cm, frames x points x 3, or forces, whose difference is a share
STATIONS = np.linspace(0.01, 0.99, 99)  # along the body, at which moments of two meshes are compared


def moments_of(log: HagfishLog, force: str, frames: np.ndarray) -> np.ndarray:
    """Moments of one kind of force at STATIONS: frames x (axes times stations), dyn cm. They are the body's, which any mesh has."""
    _, joint, kind = log.hinges()
    arc = log.joint_arc()
    place, values = arc[joint] / (arc[-1] + log["/model/length"][-1]), log.at_hinges(log.moments(force)[frames])
    return np.concatenate([[np.interp(STATIONS, place[kind == each], row[kind == each]) for row in values] for each in KINDS
                           if each in kind], axis=1)


def through(points: np.ndarray, at: np.ndarray) -> np.ndarray:
    """The Catmull-Rom spline of points at parameters 0.5, 1.5, ..., straight beyond its ends."""
    i = np.clip(np.floor(at - 0.5).astype(int), 0, len(points) - 2)
    t = (at - 0.5 - i)[:, None]
    more = np.concatenate([[2 * points[0] - points[1]], points, [2 * points[-1] - points[-2]]])
    a, b, c, d = (more[i + k] for k in range(4))
    return b + 0.5 * t * (c - a + t * (2 * a - 5 * b + 4 * c - d + t * (3 * (b - c) + d - a)))


def places_of(log: HagfishLog, frames: np.ndarray) -> np.ndarray:
    """Of the body's centreline at STATIONS: frames x stations x 3, cm."""
    return np.array([through(centres, STATIONS * len(log["/model/length"])) for centres in log["/trajectory/position"][frames]])


def off(found: np.ndarray, wanted: np.ndarray) -> float:
    """How far one is from the other, % of that."""
    return float(100 * np.linalg.norm(found - wanted) / np.linalg.norm(wanted))


def beyond(coarse: Motion, fine: Motion, share: float = 1) -> Motion:
    """Past the fine one, by a share of what the two differ."""
    return {name: fine[name] + share * (fine[name] - coarse[name]) for name in fine}


def distance(found: np.ndarray, wanted: np.ndarray) -> float:
    """Root mean square of points' distances."""
    return float(np.sqrt(((found - wanted) ** 2).sum(axis=2).mean()))


def apart(found: Motion, wanted: Motion, of: str = "") -> dict[str, float]:
    """How far one motion is from another, measure by measure: of f_thigmo only where there is any."""
    return {of + name: (distance if name.endswith("_cm") else off)(found[name], wanted[name]) for name in wanted if wanted[name].any()}


def pick(rows: Iterable[dict[str, Any]], **wanted: object) -> list[dict[str, Any]]:
    return [row for row in rows if all(row[key] == value for key, value in wanted.items())]


def presets() -> dict[str, dict[str, Any]]:
    """Rule, bodies and step of each preset, as these scenes have them."""
    found = {}
    for preset in tomllib.loads(PRESETS.read_text(encoding="utf-8"))["preset"]:
        of = dict(setting.split("=") for setting in preset["set"])
        found[preset["name"]] = {"rule": of.get("time.rule", "euler"), "bodies": int(of.get("model.bodies", 100)),
                                 "step_ms": 1e3 * float(of.get("time.step", 0.005))}
    return found


def name_of(row: dict[str, Any]) -> str:
    return f"{row['rule']}, {row['bodies']} bodies, {row['step_ms']:g} ms"


def cpu_of(path: Path) -> float:
    """CPU time, s, of a file with user and system time, a line for each repeat: the least."""
    return min(sum(map(float, line.split())) for line in path.read_text(encoding="utf-8").splitlines())


def pareto(cost: np.ndarray, error: np.ndarray) -> np.ndarray:
    """Indices, by rising cost, of what nothing else beats in both."""
    order = np.lexsort((error, cost))
    best, front = np.inf, []
    for i in order:
        if error[i] < best:
            best = error[i]
            front.append(i)
    return np.array(front, dtype=int)


def mark_presets(axes: Any, at: Callable[[dict[str, Any]], tuple[float, float]]) -> None:
    """A ring round each preset's run, which is `at` its place."""
    for name, of in presets().items():
        place = at(of)
        axes.plot(*place, "o", mfc="none", mec=plots.INK, ms=12, mew=0.9, zorder=4)
        axes.annotate(name, place, (-7, -6), textcoords="offset points", fontsize=7.5, ha="right", va="top", style="italic")


def handles_of(looks: Iterable[plots.Look], sizes: dict[int, float]) -> list[Any]:
    """Of a legend: methods by colour, bodies by size, presets."""
    line = lambda **of: plots.plt.Line2D([], [], **of)
    return [*(line(label=look.label, **look.style) for look in looks),
            *(line(color=plots.GREY, marker="o", ls="", markersize=size, label=f"{bodies} bodies") for bodies, size in sizes.items()),
            line(color=plots.INK, marker="o", ls="", mfc="none", ms=11, label="presets")]
