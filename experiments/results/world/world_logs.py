"""What tables and figures of a world to knot in need of logs (taken.py): of a hole, wave, pull, skin or robot. Needs the program as built
(HAGFISH_PROGRAM)."""

import subprocess
import tempfile
from pathlib import Path
from typing import Any

import numpy as np

import audits
from hagfish_log import HagfishLog
from script import HAGFISH
from tables import read_csv

SETTLED = 4.0  # s, after which a wave runs evenly
LAWS = {"all_contacts": "Eq. 6", "reflex": "reflex"}


def knot_and_law(log: HagfishLog) -> dict[str, str]:
    scene = log.scene()
    return {"knot": scene["expect"]["knot"], "law": scene["controller"]["law"]}


def first(time: np.ndarray, where: np.ndarray) -> float:
    return float(time[np.argmax(where)]) if where.any() else np.nan


def penetration(log: HagfishLog) -> float:
    return float(np.max(log["/diagnostics/penetration"]))


def hole(log: HagfishLog) -> dict[str, Any]:
    scene, time, phase = log.scene(), log["/trajectory/time"], log.labels("/trajectory/phase")
    plate = next(each for each in scene["obstacle"] if each["name"] == scene["expect"]["out_of"])
    pulls = first(time, phase == "pull")
    out = first(time, (log["/trajectory/q"][:, 0] > plate["point"][0]) & (time > pulls))
    held = set(log.knots(np.flatnonzero((time >= pulls) & (time <= out)))) <= {scene["expect"]["knot"]}
    return {**knot_and_law(log), "strength": scene["food"]["strength"], "step": scene["time"]["step"], "pulls": pulls,
            "gives": first(time, phase == "release"),
            "out": out, "held": held, "penetration": penetration(log)}


def wave(log: HagfishLog) -> dict[str, Any]:
    """The pull is a mean over a frame's time, as that at which food gives, N."""
    late, strength = log["/trajectory/time"] > SETTLED, log.scene()["food"]["strength"]
    pull = -log["/mean/forces/head"][late, 0] / 1e5
    return {"wave": log.scene()["title"].split(), "mean": float(pull.mean()), "peak": float(pull.max()), "over": float((pull > strength).mean()),
            "strength": strength, "torque": float(np.abs(log["/mean/forces/active"][late]).max())}


def pull(log: HagfishLog) -> dict[str, Any]:
    """The largest pull, of means over a frame's time, N, and what it is of."""
    scene = log.scene()
    rim = next(each for each in scene["obstacle"] if each["kind"] == "strand")
    points = np.array(rim["points"])  # evenly round the hole
    width = 2 * (np.linalg.norm(points - points.mean(axis=0), axis=1).mean() - rim["radius"])
    return {**knot_and_law(log), "pull": float(np.nanmax(log["/pull/force"], initial=0)) / 1e5, "width": width,
            "plate": "plane" if rim["name"] == "rim" else "rings", "girth": float(max(log["/model/radius"])) * 2 * np.pi,
            "stiffness": scene["active"]["stiffness"]}


def skin(log: HagfishLog) -> dict[str, Any]:
    """A row a side of the body, a column a ring: when the knot first touched it, s; nan where it never did."""
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([HAGFISH, "export", log.path, "--out", folder], check=True, stdout=subprocess.DEVNULL)
        cells = read_csv(Path(folder) / "skin.csv", ["since_s"])
    s, side = (np.unique([float(cell[name]) for cell in cells]) for name in ("s_cm", "side_rad"))
    table = lambda name: np.array([float(cell[name] or "nan") for cell in cells]).reshape(s.size, side.size).T
    back = log.in_phase("reverse")
    return {**knot_and_law(log), "back": log.scene()["controller"]["leave_by"] == "tail",
            "turn": float(log["/trajectory/time"][back[0]]) if back.size else np.nan,
            "s": s.tolist(), "area": table("area_cm2").tolist(), "since": table("since_s").tolist()}


def robot(log: HagfishLog) -> dict[str, Any]:
    scene, phase, slide = log.scene(), log.labels("/trajectory/phase"), log.in_phase("slide")
    way = float(log["/knot/head_end"][slide[0]] - log["/knot/head_end"][slide[-1]]) if slide.size else np.nan
    return {"weight": abs(scene["gravity"][2]) / 981, "drag": scene["drag"]["normal"] / 10, "mass": scene["specimen"]["mass"] / 1e3,
            "capacity": scene["active"]["capacity"] / 1e7,
            "stiffness": scene["active"]["stiffness"] / 4e7, "off": bool((phase == "free").any()), "way": way, "share": audits.value_of(audits.audit(log.path), "slide of both ends"),
            "torque": float(np.nanmax(np.abs(log["/mean/forces/active"][:, 6:]))) / 1e7, "penetration": penetration(log)}
