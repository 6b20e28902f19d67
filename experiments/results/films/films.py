"""How well `hagfish midlines` gives back what was filmed: closed forms, ten runs as films with a tracker's faults, 300 damaged
films; what the tutorial takes; and how well `hagfish animal` gives back animals that are let go.

Usage: films.py RUNS OUT_FOLDER. Needs the program as built (HAGFISH_PROGRAM). Runs that RUNS has a row of are not made again.
"""

import os
import re
import resource
import shutil
import subprocess
from pathlib import Path
from time import monotonic
from typing import Any

import h5py
import numpy as np

import tables
from script import HAGFISH, run_script

TUTORIAL = Path(__file__).resolve().parents[2] / "docs/tutorials/film_to_torques.md"
LENGTH, BODIES = 42.4, 100  # cm, of the animal of the scenes
NOISE = 0.1  # cm, on each coordinate of each point
WITHIN, SURELY = 1.645, 2.576  # standard errors, of bands of 90 and 99 %
RUNS = [("living_overhand", False), ("living_overhand", True), ("living_overhand_free", False), ("living_figure_eight", False),
        ("living_figure_eight_free", False), ("living_double_overhand", False), ("living_double_overhand", True),
        ("living_double_overhand_free", False), ("living_three_twist", False), ("living_three_twist", True)]


def hagfish(folder: Path, *arguments: object) -> tuple[int, str]:
    done = subprocess.run([HAGFISH, *map(str, arguments)], cwd=folder, capture_output=True, text=True, timeout=1200)
    return done.returncode, done.stdout + done.stderr


def cpu() -> float:
    """Of all commands so far, s."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def read(path: Path) -> dict[str, np.ndarray]:
    table = tables.read_table(path)
    return {name: np.array([float(row[k]) for row in table.rows]) for k, name in enumerate(table.head)}


class Program:
    """A curvature program's bends and their standard errors: times x stations, complex y + i z, rad per length."""

    def __init__(self, path: Path) -> None:
        p = read(path)
        self.time, self.station = np.unique(p["time (s)"]), np.unique(p["station (L)"])
        shape = len(self.time), len(self.station)
        grid = lambda name: p[name].reshape(shape)
        self.bend = grid("bend_y (rad/L)") + 1j * grid("bend_z (rad/L)")
        self.error = grid("bend_y error (rad/L)") + 1j * grid("bend_z error (rad/L)")


# The chain, computed anew: a joint at every other body, which turns about its Z and then about its Y, the next one the other way round.
JOINTS = np.arange(1, BODIES, 2)
SPAN = (np.where(JOINTS + 2 >= BODIES, BODIES, JOINTS + 1) - np.where(JOINTS <= 2, 0, JOINTS - 1)) / BODIES


def of_angle(angle: float | np.ndarray) -> tuple[Any, Any]:
    return np.cos(angle), np.sin(angle)


def turns(angle: np.ndarray, joint: int) -> np.ndarray:
    """Of a joint's angles y + i z, by its place in JOINTS."""
    cy, sy, cz, sz, none = *of_angle(angle.real), *of_angle(angle.imag), 0 * angle.real
    rows = ([cz * cy, -sz, cz * sy, sz * cy, cz, sz * sy, -sy, none, cy] if joint % 2 == 0
            else [cy * cz, -cy * sz, sy, sz, cz, none, -sy * cz, sy * sz, cy])
    return np.stack(rows, axis=-1).reshape(*angle.shape, 3, 3)


def joints_of(bend: np.ndarray, station: np.ndarray) -> np.ndarray:
    """Angles of the joints, times x joints, of bends at stations."""
    return np.array([np.interp(JOINTS / BODIES, station, row.real) + 1j * np.interp(JOINTS / BODIES, station, row.imag) for row in bend]) * SPAN


def ways(angle: np.ndarray) -> np.ndarray:
    """Directions of the stretches between joints, times x (joints + 1) x 3, the head's first."""
    turn, way = np.broadcast_to(np.eye(3), (len(angle), 3, 3)), [np.broadcast_to([1.0, 0, 0], (len(angle), 3))]
    for joint, each in enumerate(angle.T):
        turn = turn @ turns(each, joint)
        way.append(turn[..., 0])
    return np.stack(way, axis=1)


def bodies(angle: np.ndarray) -> np.ndarray:
    """Bodies' centres, times x BODIES x 3, cm: the head at the origin."""
    step = LENGTH / BODIES * ways(angle)[:, (np.arange(BODIES) + 1) // 2]
    return np.cumsum(step, axis=1) - step / 2


def joints_along(way: np.ndarray, roll: np.ndarray) -> np.ndarray:
    """Angles of the joints of a chain that takes these ways, its head rolled."""
    c, s, one, none = *of_angle(roll), 1 + 0 * roll, 0 * roll
    turn = np.stack([one, none, none, none, c, -s, none, s, c], axis=-1).reshape(-1, 3, 3)
    angles = []
    for joint, there in enumerate(way[:, 1:].swapaxes(0, 1)):
        x, y, z = np.einsum("tji,tj->it", turn, there)
        angles.append(-np.arcsin(np.clip(z, -1, 1)) + 1j * np.arctan2(y, x) if joint % 2 == 0
                      else np.arctan2(-z, x) + 1j * np.arcsin(np.clip(y, -1, 1)))
        turn = turn @ turns(angles[-1], joint)
    return np.stack(angles, axis=1)


def ways_between(centres: np.ndarray, free: bool) -> np.ndarray:
    """ways() of bodies' centres, times x BODIES x 3, in axes in which the head's way is along X: at the first time, or for a free head at each."""
    way = centres[:, 2::2] - centres[:, 1:-1:2]
    half = LENGTH / BODIES / 2 * way / np.linalg.norm(way, axis=2, keepdims=True)
    way = np.concatenate([(centres[:, 1] - half[:, 0] - centres[:, 0])[:, None], way,
                          (centres[:, -1] - centres[:, -2] - half[:, -1])[:, None]], axis=1)
    way /= np.linalg.norm(way, axis=2, keepdims=True)
    first = way[:, 0] if free else way[:1, 0]
    beside = np.cross(first, np.eye(3)[np.argmin(np.abs(first), axis=1)])
    beside /= np.linalg.norm(beside, axis=1, keepdims=True)
    axes = np.stack([first, beside, np.cross(first, beside)], axis=1)
    return way @ axes.swapaxes(1, 2)


def at_stations(angle: np.ndarray, station: np.ndarray) -> np.ndarray:
    """The bends at stations whose joints are nearest to these angles, least squares."""
    shares = np.array([np.interp(JOINTS / BODIES, station, unit) for unit in np.eye(len(station))])
    return np.linalg.lstsq(shares.T, (angle / SPAN).T, rcond=None)[0].T


def rolled_to(fit: Program, true_by, free: bool) -> np.ndarray:
    """True bends as those of a head rolled as the fit's is, of which a midline says nothing: one roll for all times, or for a free head one for each.

    `true_by` gives them by the rolls at the times."""
    weight, roll = 1 / np.abs(fit.error) ** 2, np.zeros(len(fit.time))
    for _ in range(12):
        true = true_by(roll)
        same = np.sum(np.conj(fit.bend) * true * weight, axis=1)
        roll = roll + np.angle(same if free else np.full(len(roll), same.sum()))
    return true_by(roll)


def moved_off(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Distances of a's points (n x 3) from b's, a moved as a whole to where it is nearest."""
    p, q = a - a.mean(axis=0), b - b.mean(axis=0)
    u, _, v = np.linalg.svd(q.T @ p)
    return np.linalg.norm(p @ (u @ np.diag([1, 1, np.linalg.det(u @ v)]) @ v).T - q, axis=1)


def rms(x: np.ndarray) -> float:
    return float(np.sqrt(np.mean(np.abs(x) ** 2)))


def in_band(fit: Program, true: np.ndarray) -> float:
    """Share of the bends whose true value lies within their band."""
    off, flat = fit.bend - true, np.max(np.abs(fit.bend.real)) == 0
    inside = [np.abs(off.imag) <= WITHIN * fit.error.imag, *([] if flat else [np.abs(off.real) <= WITHIN * fit.error.real])]
    return float(np.mean(inside))


# Closed forms -------------------------------------------------------------------------------------------------------

FORMS = {  # bend (rad per length) at time t and place s (share of the length), torsion (the same): the curve's own normal and binormal
    "straight": (lambda t, s: 0 * s, 0.0), "arc of 4 rad": (lambda t, s: 4 + 0 * s, 0.0), "arc of 8 rad": (lambda t, s: 8 + 0 * s, 0.0),
    "growing arc": (lambda t, s: 2 * t + 0 * s, 0.0), "helix": (lambda t, s: 6 + 0 * s, 4.0), "S": (lambda t, s: 3 * np.sin(2 * np.pi * s), 0.0),
    "travelling wave": (lambda t, s: 3 * np.sin(2 * np.pi * (s - t / 2)), 0.0)}


def curve(bend, torsion: float, t: float, places: np.ndarray, steps: int = 1200) -> np.ndarray:
    """Points at `places` of a curve that begins at the origin along X, by exact turns over short steps."""
    s = (np.arange(steps) + 0.5) / steps
    k, frame, at, points = np.broadcast_to(bend(t, s), s.shape), np.eye(3), np.zeros(3), [np.zeros(3)]
    for kappa in k:
        axis = torsion * frame[0] + kappa * frame[2]
        size = np.linalg.norm(axis)
        unit = axis / size if size else axis
        half = lambda v, a: v * np.cos(a) + np.cross(unit, v) * np.sin(a) + unit * (unit @ v) * (1 - np.cos(a))
        at = at + half(frame[0], size / steps / 2) * LENGTH / steps
        frame = np.array([half(v, size / steps) for v in frame])
        points.append(at)
    points = np.array(points)
    return np.stack([np.interp(places, np.linspace(0, 1, steps + 1), points[:, d]) for d in range(3)], axis=1)


def true_bends(bend, torsion: float, t: float, station: np.ndarray, roll: float) -> np.ndarray:
    """The curve's bends about axes that do not roll about it: joints take turns in which of theirs comes first."""
    s = np.linspace(0, 1, 2001)
    out = 1j * np.broadcast_to(bend(t, s), s.shape) * np.exp(1j * (torsion * s - roll))
    return np.interp(station, s, out.real) + 1j * np.interp(station, s, out.imag)


def cells(values: np.ndarray, form: str) -> str:
    return ",".join("" if np.isnan(v) else f"{v:{form}}" for v in values)


def write_film(path: Path, time, s, points, header="time_s,s_cm,x_cm,y_cm,z_cm", kept=None) -> None:
    with path.open("w") as file:
        file.write(header + "\n")
        for f, t in enumerate(time):
            for i, place in enumerate(s):
                if kept is not None and not kept[f, i]:
                    continue
                file.write(f"{t:.6g},{place:.6g},{cells(points[f, i], '.6g')}\n")


def forms(folder: Path) -> list[dict]:
    rows, time, places = [], np.linspace(0, 3, 61), np.linspace(0, 1, 41)
    for name, (bend, torsion) in FORMS.items():
        true = np.array([curve(bend, torsion, t, places)
                         for t in (time if name in ("growing arc", "travelling wave") else time[:1])])
        true = np.broadcast_to(true, (61, *true.shape[1:]))
        for noise in (0, NOISE):
            write_film(folder / "form.csv", time, places * LENGTH,
                       true + noise * np.random.default_rng(1).standard_normal(true.shape))
            code, said = hagfish(folder, "midlines", "form.csv", "--out", "form_p.csv", "--stations", 25, "--force", "--scene", "table1")
            fit = Program(folder / "form_p.csv")
            true_by = lambda roll: np.array([true_bends(bend, torsion, t, fit.station, r) for t, r in zip(fit.time, roll)])
            turned = rolled_to(fit, true_by, False) if torsion else true_by(np.zeros(len(fit.time)))
            off = fit.bend - turned
            rows.append({"form": name, "noise (cm)": noise, "code": code, "verdict": said.split("\n")[1].split(":")[0],
                         "off (cm)": float(said.split("fitted: ")[1].split(" cm")[0]), "bends off, rms (rad/L)": rms(off),
                         "in the middle eight tenths (rad/L)": rms(off[:, (fit.station > 0.1) & (fit.station < 0.9)]),
                         "mean error (rad/L)": float(np.mean(fit.error.imag)),
                         "within bands of 90 %": in_band(fit, turned)})
    return rows


# Runs as films ------------------------------------------------------------------------------------------------------

def filmed(log: Path, until: float, seed: int, fps=30, points=50, pixels=25.0):
    """A film of a log with a tracker's faults, in pixels: its text, and the times at which head and tail are exchanged."""
    random = np.random.default_rng(seed)
    with h5py.File(log) as h5:
        t, x = h5["trajectory/time"][()], h5["trajectory/position"][()]
    time, which = np.arange(0, until + 1e-9, 1 / fps), np.linspace(0, BODIES - 1, points).round().astype(int)
    s = (which + 0.5) * LENGTH / BODIES
    place = np.array([[np.interp(time, t, x[:, i, d]) for d in range(3)] for i in which]).transpose(2, 0, 1)
    place = place + NOISE * random.standard_normal(place.shape)
    far = random.random(place.shape[:2]) < 0.01
    place[far] += 15 * random.standard_normal((far.sum(), 3)) / np.sqrt(3)
    place[random.random(place.shape[:2]) < 0.05] = np.nan
    begin = random.uniform(0.2, 0.8) * until
    kept = (time < begin) | (time > begin + 1)
    exchanged = random.choice(np.flatnonzero(kept)[5:-5], 2, replace=False)
    (ca, sa), (cb, sb) = map(of_angle, random.uniform(-1, 1, 2))
    turn = np.array([[ca, -sa, 0], [sa, ca, 0], [0, 0, 1]]) @ np.array([[1, 0, 0], [0, cb, -sb], [0, sb, cb]])
    place = (place @ turn.T + [20, 30, 10]) * pixels
    lines = ["frame,s_cm,x_px,y_px,z_px"]
    for f in np.flatnonzero(kept):
        turned = f in exchanged
        for i in range(points):
            where = LENGTH - s[-1 - i] if turned else s[i]
            lines.append(f"{f},{where:.6g},{cells(place[f, points - 1 - i if turned else i], '.2f')}")
    return "\n".join(lines) + "\n", [f"{f / fps:.4g}" for f in sorted(exchanged)]


def run_name(run: tuple[str, bool]) -> str:
    return run[0] + (" (mirror)" if run[1] else "")


def runs(folder: Path) -> list[dict]:
    done = folder / "films_runs.csv"
    rows, before = [], tables.read_csv(done, ["run"]) if done.exists() else []
    for number, (scene, mirror) in enumerate(RUNS):
        name = run_name((scene, mirror))
        known = [row for row in before if row["run"] == name]
        if known:
            rows += known
            continue
        hagfish(folder, "run", scene, "--preset", "quick", "--set", f"mirror={'true' if mirror else 'false'}",
                "--until", "form", "--log", "frames", "--quiet", "--force", "--out", "run.h5")
        with h5py.File(folder / "run.h5") as h5:
            time, centres = h5["trajectory/time"][()], h5["trajectory/position"][()]
        until = time[-1]
        read_as = ["--fps", 30, "--scale", 25, "--animal-length", LENGTH]
        free = ["--free-head"] if scene.endswith("free") else []
        text, exchanged = filmed(folder / "run.h5", until, number)
        (folder / "film.csv").write_text(text)
        begin = cpu()
        code, said = hagfish(folder, "midlines", "film.csv", "--scene", scene, "--stations", 25, "--out", "p.csv", "--force", *read_as, *free)
        took = cpu() - begin
        verdicts = [word for line in said.splitlines() if (word := line.split(":")[0]) in ("fitted", "doubtful", "failed")]
        row = {"run": name, "code": code, "verdict": verdicts[0] if verdicts else "refused",
               "exchanged frames named": sum(t in said for t in exchanged)}
        if code == 0:
            fit = Program(folder / "p.csv")
            true = np.apply_along_axis(lambda values: np.interp(fit.time, time, values), 0, centres)
            off = np.array([moved_off(own, x) for own, x in zip(bodies(joints_of(fit.bend, fit.station)), true)])
            way = ways_between(true, bool(free))
            same = rolled_to(fit, lambda roll: at_stations(joints_along(way, roll), fit.station), bool(free))
            tried = [line for line in said.splitlines() if line.startswith("run by this program")]
            row |= {"shapes off (cm)": rms(off), "within bands of 90 %": in_band(fit, same),
                    "seen": said.split("film's end: ")[1].split("\n")[0].split(", which")[0],
                    "following stiffness (a setting)": tried[0].split("= ")[1].split(" ")[0] if tried else ""}
            code, told = hagfish(folder, "run", "p.toml", "--until", "form", "--quiet", "--force", "--out", "again.h5")
            row["run ties"] = "the same" if code == 0 else told.strip().splitlines()[-1].split("failed: ")[-1]  # the scene expects the knot
            code, told = hagfish(folder, "against", "again.h5", "film.csv", "--start", 0, *read_as)
            if "check the direction of y" in told:
                row["run ties"] = "the mirror image"
            row["run off the film, noise and all (cm)"] = float(told.split(" cm from ")[0].split(": ")[-1]) if code == 0 else np.nan
            row["CPU of midlines (s)"] = took
        rows.append(row)
        tables.write_csv(done, *cells_of(rows))
        print(row, flush=True)
    return rows


# Damaged films ------------------------------------------------------------------------------------------------------

FAULTS = ["outliers", "lost", "tail", "gap", "zeros", "exchanged", "repeated", "jump", "scale", "units", "cut", "y down", "noise", "order",
          "times"]
SAID = ("look at", "left out", "taken as missing", "turned round", "scaled to", "filled in")


def damaged(folder: Path, count: int = 300) -> list[dict]:
    """Films of an arc that grows, with a millimetre of noise and one or two random faults: how the program takes them, and how far it is off."""
    rows, time, places = [], np.arange(46) / 15, np.linspace(0, 1, 21)
    true = np.array([curve(*FORMS["growing arc"], t, places, 300) for t in time])[..., :2]
    for case in range(count):
        random = np.random.default_rng(case)
        points, kept, s = true + NOISE * random.standard_normal(true.shape), np.ones(true.shape[:2], bool), places * LENGTH
        header, arguments, faults = "time_s,s_cm,x_cm,y_cm", [], random.choice(FAULTS, random.integers(1, 3), replace=False)
        begin, some = random.integers(5, 30), random.random(true.shape[:2])
        for fault in faults:
            if fault == "outliers": points[some < random.uniform(0.005, 0.05)] += random.uniform(-15, 15, 2)
            if fault == "lost": points[some < random.uniform(0.02, 0.5)] = np.nan
            if fault == "tail": points[::random.integers(2, 5), -random.integers(2, 8):] = np.nan
            if fault == "gap": kept[begin:begin + random.integers(5, 15)] = False
            if fault == "zeros": points[begin:begin + 6, 8:8 + random.integers(1, 5)] = 0
            if fault == "exchanged": points[random.choice(45, 3)] = points[random.choice(45, 3)][:, ::-1]
            if fault == "repeated": points[begin:begin + 12] = points[begin]
            if fault == "jump": points[begin:] += random.uniform(-10, 10, 2)
            if fault == "scale": points *= random.choice([0.5, 1.2, 1.5, 3])
            if fault == "units": header = header.replace("x_cm,y_cm", "x_mm,y_mm")
            if fault == "cut": points, kept, s = points[:, :16], kept[:, :16], s[:16]
            if fault == "y down": points[..., 1] *= -1
            if fault == "noise": points += random.uniform(0.1, 1) * random.standard_normal(points.shape)
            some = some[:, :points.shape[1]]
        write_film(folder / "damaged.csv", time, s, points, header, kept)
        if "order" in faults:
            heading, *lines = (folder / "damaged.csv").read_text().splitlines()
            (folder / "damaged.csv").write_text("\n".join([heading, *random.permutation(lines)]) + "\n")
        if "times" in faults: arguments += ["--times", random.integers(2, 60)]
        before = cpu()
        code, said = hagfish(folder, "midlines", "damaged.csv", "--scene", "table1", "--out", "d.csv", "--force", *arguments)
        row = {"case": case, "faults": " + ".join(faults), "code": code, "CPU (s)": cpu() - before}
        told = any(word in said for word in SAID)
        if code == 0:
            fit = Program(folder / "d.csv")
            sign = -1 if "y down" in faults else 1  # told by nothing in a plane but said not to be: the animal in its mirror
            z = (fit.bend.imag - sign * 2 * (fit.time[:, None] + time[0])) / fit.error.imag
            row |= {"bends off, in standard errors, rms": rms(z), "within bands of 90 %": float(np.mean(np.abs(z) < WITHIN)),
                    "within bands of 99 %": float(np.mean(np.abs(z) < SURELY))}
            right = row["within bands of 99 %"] > 0.75
        row["told"] = "yes" if told else "no"
        fitted = "right" if code == 0 and right else "told" if told else "silently off"
        row["outcome"] = {0: fitted, 2: "refused", 3: "failed"}.get(code, "crashed")
        rows.append(row)
    return rows


# The tutorial -------------------------------------------------------------------------------------------------------

def tutorial(folder: Path) -> list[dict]:
    """What each chapter of the tutorial takes, from nothing."""
    place, rows = folder / "tutorial", []
    shutil.rmtree(place, ignore_errors=True)
    place.mkdir(parents=True)
    environment = os.environ | {"PATH": f"{HAGFISH.parent}:/usr/bin:/bin", "OPENBLAS_NUM_THREADS": "1"}
    for chapter in TUTORIAL.read_text(encoding="utf-8").split("\n## ")[2:]:
        title, commands = chapter.split("\n", 1)[0].split(". ")[-1], re.findall(r"(?ms)^```bash\n(.*?)^```$", chapter)
        if commands:
            before, begin = cpu(), monotonic()
            subprocess.run(["bash", "-euc", "\n".join(commands)], cwd=place, env=environment, stdout=subprocess.DEVNULL, check=True)
            rows.append({"chapter": title, "CPU (s)": cpu() - before, "by the clock (s)": monotonic() - begin})
    return rows


def ranges(folder: Path) -> list[dict]:
    """Torques by the rigidity that is assumed, as the tutorial measures them."""
    return tables.read_csv(folder / "tutorial/range.csv", [])


# Animals that are let go --------------------------------------------------------------------------------------------

TRAITS = {"stiffness EI": 2e5, "damping": 3e3, "drag": 9.434}  # of the specimen and of the scene table1: dyn cm^2, dyn cm^2 s, g/(s cm)
WITH = ["--scene", "table1", "--set", "model.passive=specimen", "--animal-length", LENGTH]


def let_go(folder: Path, name: str, factor: dict[str, float], bend: float, flat: bool, bodies: int = BODIES, seed: int = 1) -> None:
    """NAME.csv: a film, half a millimetre off, of a body with the traits times `factor` that begins bent by `bend`, rad/cm, and has no
    muscles: held by the head, or (flat) free and seen by one camera."""
    stiffness, damping, drag = (value * factor[trait] for trait, value in TRAITS.items())
    settings = [f"model.bodies={bodies}", "model.passive=specimen", f"clamp_head={str(not flat).lower()}", "script.kind=none",
                "wall.present=false", "time.step=0.001", "time.rule=midpoint", "time.duration=2", "time.frame_interval=0.04",
                f"drag.normal={drag}", f"drag.tangential={drag / 4}",
                f"start.bend=[[0,0,0,{bend}],[0.5,0,{0 if flat else bend / 2},{bend / 2}],[1,0,0,{bend}]]",
                f"specimen.passive.bending_stiffness={[stiffness] * 4}", f"specimen.passive.bending_damping={[damping] * 4}"]
    hagfish(folder, "run", "table1", "--out", f"{name}.h5", "--qp", "active-set", "--log", "frames", "--force", "--quiet",
            *(word for setting in settings for word in ("--set", setting)))  # nothing is tied, which is exit code 3
    with h5py.File(folder / f"{name}.h5") as log:
        time, place = log["trajectory/time"][()], log["trajectory/position"][()]
    points = slice(None, None, bodies // 16)
    place = (place + NOISE / 2 * np.random.default_rng(seed).standard_normal(place.shape))[:, points, :2 if flat else 3]
    s = ((np.arange(bodies) + 0.5) / bodies * LENGTH)[points]
    write_film(folder / f"{name}.csv", time, s, place, "time_s,s_cm,x_cm,y_cm" + ("" if flat else ",z_cm"))


def animals(folder: Path, count: int = 18) -> list[dict]:
    """Films of animals of 150 bodies, fitted by the command's 50: the traits that it finds, as factors."""
    random, rows = np.random.default_rng(1), []
    damping, drag = (random.permutation(np.geomspace(0.4, most, count)) for most in (2.5, 2.7))
    for k, factors in enumerate(zip(np.geomspace(0.15, 6, count), damping, drag)):
        flat = k % 2 == 1
        let_go(folder, "let_go", dict(zip(TRAITS, factors)), 0.06, flat, 150, k)
        _, said = hagfish(folder, "animal", "let_go.csv", *WITH, *(["--free-head"] if flat else []))
        row = {"film": f"{k + 1}, {'free, in a plane' if flat else 'held, in space'}"}
        for trait, true in zip(TRAITS, factors):
            told = re.search(rf"^{trait}: (\S+) times the scene's, (\S+) to (\S+) \(90 %\)", said, re.MULTILINE)
            row |= {trait: float(true), f"{trait}, found": "{} ({} to {})".format(*told.groups()) if told else "not told",
                    f"{trait}, within": "" if not told else "yes" if float(told[2]) <= true <= float(told[3]) else "no"}
        rows.append(row)
        print(row, flush=True)
    return rows


PARTS = forms, runs, damaged, tutorial, ranges, animals

# Tables -------------------------------------------------------------------------------------------------------------

def cells_of(rows: list[dict]) -> tuple[list[str], list[list[str]]]:
    names = list(dict.fromkeys(name for row in rows for name in row))
    text = lambda value: f"{value:.3g}" if isinstance(value, float) else str(value)
    return names, [[text(row.get(name, "")) for name in names] for row in rows]


def outcomes(films: list[dict[str, str]]) -> list[list[str]]:
    """How many damaged films came to each."""
    known = ("right", "told", "failed", "refused", "silently off", "crashed")
    return [[outcome, str(sum(row["outcome"] == outcome for row in films))] for outcome in known]


def figures(forms: list[dict], runs: list[dict], films: list[dict], chapters: list[dict], animals: list[dict]) -> list[list[str]]:
    """What sentences of the page say and no other table has."""
    number = lambda rows, name: [float(row[name]) for row in rows if row.get(name)]
    exact, noisy = ([row for row in forms if (float(row["noise (cm)"]) > 0) == noise] for noise in (False, True))
    bends, worst = "bends off, rms (rad/L)", (lambda rows, name: f"{max(number(rows, name)):.2g}")
    held, took = [100 * share for share in number(runs, "within bands of 90 %")], number(runs, "CPU of midlines (s)")
    times = number(films, "CPU (s)")
    few = [row for row in films if row["outcome"] == "right" and row["told"] == "no" and float(row["within bands of 90 %"]) <= 0.75]
    return [[name, str(value)] for name, value in [
        ("a band of 90 %, standard errors to each side", WITHIN), ("length of the body, cm", LENGTH),
        ("closed forms without noise: points off by at most, cm", worst(exact, "off (cm)")),
        ("closed forms without noise: bends off by at most, rad/L", worst(exact, bends)),
        ("closed forms with noise: bends off by at most, rad/L", worst(noisy, bends)), ("runs as films", len(runs)),
        ("runs that get a program", len(number(runs, "shapes off (cm)"))),
        ("runs: shapes off by at most, cm", worst(runs, "shapes off (cm)")),
        ("runs called doubtful", sum(row["verdict"] == "doubtful" for row in runs)),
        ("runs whose animal ties the same", sum(row.get("run ties") == "the same" for row in runs)),
        ("runs: bends within bands of 90 %, %", f"{min(held):.0f} to {max(held):.0f}"),
        ("runs of which 85 to 95 % are", sum(85 <= share <= 95 for share in held)),
        ("runs: CPU of a film, s", f"{min(took):.0f} to {max(took):.0f}"), ("damaged films", len(films)),
        ("silently off", sum(row["outcome"] == "silently off" for row in films)),
        ("right with few bends in their bands and nothing said", len(few)),
        ("damaged: median fit, s", f"{np.median(times):.2g}"),
        ("damaged: longest fit, s", f"{max(times):.2g}"),
        *((f"animals: {trait} within its interval of 90 %, of films that tell it", "{} of {}".format(
            sum(row[f"{trait}, within"] == "yes" for row in animals), sum(row[f"{trait}, within"] != "" for row in animals))) for trait in TRAITS),
        ("tutorial, minutes", f"{sum(number(chapters, 'by the clock (s)')) / 60:.1f}")]]


def write_summaries(folder: Path) -> None:
    """Of the tables of all parts."""
    forms, runs, films, chapters, _, animals = (tables.read_csv(folder / "tables" / f"films_{part.__name__}.csv", []) for part in PARTS)
    tables.write_table(folder, "films_outcomes", ["outcome", "films"], outcomes(films))
    tables.write_table(folder, "films_figures", ["figure", "value"], figures(forms, runs, films, chapters, animals))


def main(folder: Path, out: Path) -> None:
    for part in PARTS:
        tables.write_table(out, f"films_{part.__name__}", *cells_of(part(folder)))
    write_summaries(out)


if __name__ == "__main__":
    run_script(__doc__, ["RUNS", "OUT_FOLDER"], main)
