"""How well `hagfish midlines` gives back what was filmed: closed forms, ten runs as films with a tracker's faults, 300 damaged films.

Usage: films.py [--only forms|runs|damaged] [--run SCENE]... [--out DIR]. Needs the program as built (HAGFISH_PROGRAM), python3-numpy and python3-h5py.
Writes DIR/films_PART.csv for each part and, from those that are there, experiments/results/films.md.
"""

from __future__ import annotations

import argparse
import csv
import os
import subprocess
from pathlib import Path

import h5py
import numpy as np

ROOT = Path(__file__).resolve().parents[2]
HAGFISH = Path(os.environ.get("HAGFISH_PROGRAM", ROOT / "build/release/experiments/hagfish"))
LENGTH, BODIES = 42.4, 100  # cm, of the animal of the scenes
NOISE = 0.1  # cm, on each coordinate of each point
WITHIN = 1.645  # standard errors, of a band of 90 %
RUNS = [("living_overhand", False), ("living_overhand", True), ("living_overhand_free", False), ("living_figure_eight", False), ("living_figure_eight_free", False),
        ("living_double_overhand", False), ("living_double_overhand", True), ("living_double_overhand_free", False), ("living_three_twist", False), ("living_three_twist", True)]


def hagfish(folder: Path, *arguments: object) -> tuple[int, str]:
    done = subprocess.run([HAGFISH, *map(str, arguments)], cwd=folder, capture_output=True, text=True, timeout=1200)
    return done.returncode, done.stdout + done.stderr


def read(path: Path) -> dict[str, np.ndarray]:
    with path.open(newline="") as file:
        heading, *rows = csv.reader(file)
    return {name: np.array([float(row[k]) for row in rows]) for k, name in enumerate(heading)}


class Program:
    """A curvature program's bends and their standard errors: times x stations, complex y + i z, rad per length."""

    def __init__(self, path: Path) -> None:
        p = read(path)
        self.time, self.station = np.unique(p["time (s)"]), np.unique(p["station (L)"])
        shape = len(self.time), len(self.station)
        grid = lambda name: p[name].reshape(shape)
        self.bend = grid("bend_y (rad/L)") + 1j * grid("bend_z (rad/L)")
        self.error = grid("bend_y error (rad/L)") + 1j * grid("bend_z error (rad/L)")

    def bodies(self, time: float) -> np.ndarray:
        """Bodies' centres, BODIES x 3, cm: the head at the origin, by the same chain as the program's but computed anew."""
        at = np.array([np.interp(time, self.time, self.bend[:, k].real) + 1j * np.interp(time, self.time, self.bend[:, k].imag) for k in range(len(self.station))])
        joints = np.arange(1, BODIES, 2)
        low, high = np.where(joints <= 2, 0, joints - 1), np.where(joints + 2 >= BODIES, BODIES, joints + 1)
        here = (np.interp(joints / BODIES, self.station, at.real) + 1j * np.interp(joints / BODIES, self.station, at.imag)) * (high - low) / BODIES
        turn, origin, step, centres = np.eye(3), np.zeros(3), LENGTH / BODIES, []
        for body in range(BODIES):
            if body % 2:
                y, z = here[body // 2].real, here[body // 2].imag
                turn = turn @ np.array([[np.cos(y), 0, np.sin(y)], [0, 1, 0], [-np.sin(y), 0, np.cos(y)]]) @ np.array([[np.cos(z), -np.sin(z), 0], [np.sin(z), np.cos(z), 0], [0, 0, 1]])
            centres.append(origin + 0.5 * step * turn[:, 0])
            origin = origin + step * turn[:, 0]
        return np.array(centres)


def moved_off(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Distances of a's points (n x 3) from b's, a moved as a whole to where it is nearest."""
    p, q = a - a.mean(axis=0), b - b.mean(axis=0)
    u, _, v = np.linalg.svd(q.T @ p)
    return np.linalg.norm(p @ (u @ np.diag([1, 1, np.linalg.det(u @ v)]) @ v).T - q, axis=1)


def rms(x: np.ndarray) -> float:
    return float(np.sqrt(np.mean(np.abs(x) ** 2)))


def in_band(fit: Program, true: np.ndarray) -> float:
    """Share of the bends whose true value lies within their band, but for the one roll of the head about which a midline says nothing."""
    weight = 1 / np.abs(fit.error) ** 2
    roll = np.vdot(fit.bend * weight, true)
    roll = roll / abs(roll) if abs(roll) > 0 else 1
    off, c, s = fit.bend * roll - true, roll.real, roll.imag
    error = np.hypot(c * fit.error.real, s * fit.error.imag) + 1j * np.hypot(s * fit.error.real, c * fit.error.imag)
    flat = np.max(np.abs(fit.bend.real)) == 0
    inside = [np.abs(off.imag) <= WITHIN * error.imag] + ([] if flat else [np.abs(off.real) <= WITHIN * error.real])
    return float(np.mean(inside))


# Closed forms ------------------------------------------------------------------------------------------------------------------------------------

FORMS = {  # bend (rad per length) at time t and place s (share of the length), torsion (the same): the curve's own normal and binormal
    "straight": (lambda t, s: 0 * s, 0.0), "arc of 4 rad": (lambda t, s: 4 + 0 * s, 0.0), "arc of 8 rad": (lambda t, s: 8 + 0 * s, 0.0),
    "growing arc": (lambda t, s: 2 * t + 0 * s, 0.0), "helix": (lambda t, s: 6 + 0 * s, 4.0),
    "S": (lambda t, s: 3 * np.sin(2 * np.pi * s), 0.0), "travelling wave": (lambda t, s: 3 * np.sin(2 * np.pi * (s - t / 2)), 0.0)}


def curve(bend, torsion: float, t: float, places: np.ndarray, steps: int = 1200) -> np.ndarray:
    """Points at `places` of a curve that begins at the origin along X, by exact turns over short steps."""
    s = (np.arange(steps) + 0.5) / steps
    k, frame, at, points = np.broadcast_to(bend(t, s), s.shape), np.eye(3), np.zeros(3), [np.zeros(3)]
    for kappa in k:
        axis = torsion * frame[0] + kappa * frame[2]
        size = np.linalg.norm(axis)
        half = lambda v, a: v if size == 0 else v * np.cos(a) + np.cross(axis / size, v) * np.sin(a) + axis * (axis @ v) / size ** 2 * (1 - np.cos(a))
        at = at + half(frame[0], size / steps / 2) * LENGTH / steps
        frame = np.array([half(v, size / steps) for v in frame])
        points.append(at)
    points = np.array(points)
    return np.stack([np.interp(places, np.linspace(0, 1, steps + 1), points[:, d]) for d in range(3)], axis=1)


def write_film(path: Path, time, s, points, header="time_s,s_cm,x_cm,y_cm,z_cm", kept=None) -> None:
    with path.open("w") as file:
        file.write(header + "\n")
        for f, t in enumerate(time):
            for i, place in enumerate(s):
                if kept is not None and not kept[f, i]:
                    continue
                file.write(f"{t:.6g},{place:.6g}," + ",".join("" if np.isnan(v) else f"{v:.6g}" for v in points[f, i]) + "\n")


def forms(folder: Path) -> list[dict]:
    rows, time, places = [], np.linspace(0, 3, 61), np.linspace(0, 1, 41)
    for name, (bend, torsion) in FORMS.items():
        true = np.array([curve(bend, torsion, t, places) for t in (time if name in ("growing arc", "travelling wave") else time[:1])])
        true = np.broadcast_to(true, (61, *true.shape[1:]))
        for noise in (0, NOISE):
            write_film(folder / "form.csv", time, places * LENGTH, true + noise * np.random.default_rng(1).standard_normal(true.shape))
            code, said = hagfish(folder, "midlines", "form.csv", "--out", "form_p.csv", "--stations", 25, "--force", "--scene", "table1")
            fit = Program(folder / "form_p.csv")
            # The true bend in axes that do not twist about the curve.
            turned = np.exp(1j * torsion * fit.station) * np.array([np.broadcast_to(bend(t, fit.station), fit.station.shape) for t in fit.time]) * 1j
            weight = np.vdot(fit.bend, turned)
            off = fit.bend * (weight / abs(weight) if abs(weight) > 0 else 1) - turned
            rows.append({"form": name, "noise (cm)": noise, "code": code, "verdict": said.split("\n")[1].split(":")[0], "off (cm)": float(said.split("fitted: ")[1].split(" cm")[0]),
                         "bends off, rms (rad/L)": rms(off), "in the middle eight tenths (rad/L)": rms(off[:, (fit.station > 0.1) & (fit.station < 0.9)]),
                         "mean error (rad/L)": float(np.mean(fit.error.imag)), "within bands of 90 %": in_band(fit, turned)})
    return rows


# Runs as films -----------------------------------------------------------------------------------------------------------------------------------

def filmed(log: Path, until: float, seed: int, faults: bool, fps=30, points=50, pixels=25.0):
    """A film of a log, in pixels with y down: its text, and the times at which head and tail are exchanged."""
    random = np.random.default_rng(seed)
    with h5py.File(log) as h5:
        t, x = h5["trajectory/time"][()], h5["trajectory/position"][()]
    time, which = np.arange(0, until + 1e-9, 1 / fps), np.linspace(0, BODIES - 1, points).round().astype(int)
    s = (which + 0.5) * LENGTH / BODIES
    place = np.array([[np.interp(time, t, x[:, i, d]) for d in range(3)] for i in which]).transpose(2, 0, 1)
    kept, exchanged = np.ones(len(time), bool), np.array([], int)
    if faults:
        place = place + NOISE * random.standard_normal(place.shape)
        far = random.random(place.shape[:2]) < 0.01
        place[far] += 15 * random.standard_normal((far.sum(), 3)) / np.sqrt(3)
        place[random.random(place.shape[:2]) < 0.05] = np.nan
        begin = random.uniform(0.2, 0.8) * until
        kept = (time < begin) | (time > begin + 1)
        exchanged = random.choice(np.flatnonzero(kept)[5:-5], 2, replace=False)
    a, b = random.uniform(-1, 1, 2)
    turn = np.array([[np.cos(a), -np.sin(a), 0], [np.sin(a), np.cos(a), 0], [0, 0, 1]]) @ np.array([[1, 0, 0], [0, np.cos(b), -np.sin(b)], [0, np.sin(b), np.cos(b)]])
    place = (place @ turn.T + [20, 30, 10]) * [pixels, -pixels, pixels]
    lines = ["frame,s_cm,x_px,y_px,z_px"]
    for f in np.flatnonzero(kept):
        turned = f in exchanged
        for i in range(points):
            where = LENGTH - s[-1 - i] if turned else s[i]
            lines.append(f"{f},{where:.6g}," + ",".join("" if np.isnan(v) else f"{v:.2f}" for v in place[f, points - 1 - i if turned else i]))
    return "\n".join(lines) + "\n", [f"{f / fps:.4g}" for f in sorted(exchanged)]


def runs(folder: Path, asked: list[str]) -> list[dict]:
    rows = []
    for number, (scene, mirror) in enumerate(RUNS):
        name = scene + (" (mirror)" if mirror else "")
        if asked and name not in asked:
            continue
        hagfish(folder, "run", scene, "--preset", "quick", "--set", f"mirror={'true' if mirror else 'false'}", "--until", "form", "--log", "frames", "--quiet", "--force", "--out", "run.h5")
        with h5py.File(folder / "run.h5") as h5:
            time, centres = h5["trajectory/time"][()], h5["trajectory/position"][()]
        until = time[-1]
        read_as = ["--fps", 30, "--scale", 25, "--animal-length", LENGTH]
        free = ["--free-head"] if scene.endswith("free") else []
        text, exchanged = filmed(folder / "run.h5", until, number, True)
        (folder / "film.csv").write_text(text)
        (folder / "exact.csv").write_text(filmed(folder / "run.h5", until, number, False)[0])
        code, said = hagfish(folder, "midlines", "film.csv", "--scene", scene, "--stations", 25, "--out", "p.csv", "--force", *read_as, *free)
        hagfish(folder, "midlines", "exact.csv", "--scene", "table1", "--stations", 25, "--out", "exact_p.csv", "--force", *read_as, *free)
        row = {"run": name, "code": code, "verdict": next((line.split(":")[0] for line in said.splitlines() if line.split(":")[0] in ("fitted", "doubtful", "failed")), "refused"),
               "exchanged frames named": sum(t in said for t in exchanged)}
        if code == 0:
            fit, exact = Program(folder / "p.csv"), Program(folder / "exact_p.csv")
            true = np.array([[np.interp(t, time, centres[:, b, d]) for b in range(BODIES) for d in range(3)] for t in fit.time[::4]]).reshape(-1, BODIES, 3)
            off = np.array([moved_off(fit.bodies(t), x) for t, x in zip(fit.time[::4], true)])
            same = np.array([np.array([np.interp(fit.time, exact.time, part(exact.bend[:, k])) for k in range(len(exact.station))]).T for part in (np.real, np.imag)])
            tried = [line for line in said.splitlines() if line.startswith("run by it")]
            row |= {"shapes off (cm)": rms(off), "within bands of 90 %": in_band(fit, same[0] + 1j * same[1]), "seen": said.split("film's end: ")[1].split("\n")[0].split(", which")[0],
                    "stiffness (dyn cm^2)": tried[0].split("= ")[1].split(":")[0] if tried else ""}
            code, told = hagfish(folder, "run", "p.toml", "--until", "form", "--quiet", "--force", "--out", "again.h5")
            row["run ties"] = "the same" if code == 0 else told.strip().splitlines()[-1].split("failed: ")[-1]  # the scene expects the knot
            code, told = hagfish(folder, "against", "again.h5", "film.csv", "--start", 0, *read_as)
            if "y the wrong way" in told:
                row["run ties"] = "the mirror image"
            row["run off the film, noise and all (cm)"] = float(told.split(" cm from ")[0].split(": ")[-1]) if code == 0 else np.nan
        rows.append(row)
        print(row, flush=True)
    return rows


# Damaged films -----------------------------------------------------------------------------------------------------------------------------------

def damaged(folder: Path, count: int = 300) -> list[dict]:
    """Films of an arc that grows, with a millimetre of noise and one or two random faults: how the program takes them, and how far it is off."""
    rows, time, places = [], np.arange(46) / 15, np.linspace(0, 1, 21)
    true = np.array([curve(*FORMS["growing arc"], t, places, 300) for t in time])[..., :2]
    for case in range(count):
        random = np.random.default_rng(case)
        points, kept, s = true + NOISE * random.standard_normal(true.shape), np.ones(true.shape[:2], bool), places * LENGTH
        header, arguments, faults = "time_s,s_cm,x_cm,y_cm", [], list(random.choice(
            ["outliers", "lost", "tail", "gap", "zeros", "exchanged", "repeated", "jump", "scale", "units", "cut", "y down", "noise", "order", "times"], random.integers(1, 3), replace=False))
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
        code, said = hagfish(folder, "midlines", "damaged.csv", "--scene", "table1", "--out", "d.csv", "--force", *arguments)
        row = {"case": case, "faults": " + ".join(faults), "code": code}
        told = any(word in said for word in ("look at", "left out", "taken as lost", "turned round", "scaled to", "bridged"))
        if code == 0:
            fit = Program(folder / "d.csv")
            sign = -1 if "y down" in faults else 1  # told by nothing in a plane but said not to be: the animal in its mirror
            z = (fit.bend.imag - sign * 2 * (fit.time[:, None] + time[0])) / fit.error.imag
            row |= {"bends off, in standard errors, rms": rms(z), "within bands of 90 %": float(np.mean(np.abs(z) < WITHIN))}
            right = row["within bands of 90 %"] > 0.75
        row["outcome"] = "refused" if code == 2 else "failed" if code == 3 else "crashed" if code else "right" if right else "told" if told else "silently off"
        rows.append(row)
    return rows


# Tables ------------------------------------------------------------------------------------------------------------------------------------------

def write(path: Path, rows: list[dict]) -> None:
    names = list(dict.fromkeys(name for row in rows for name in row))
    with path.open("w", newline="") as file:
        table = csv.DictWriter(file, names, lineterminator="\n")
        table.writeheader()
        table.writerows({name: f"{v:.3g}" if isinstance(v, float) else v for name, v in row.items()} for row in rows)


def markdown(path: Path) -> str:
    with path.open(newline="") as file:
        heading, *rows = csv.reader(file)
    line = lambda cells: "| " + " | ".join(cells) + " |\n"
    return line(heading) + "|" + "---|" * len(heading) + "\n" + "".join(map(line, rows))


def page(folder: Path) -> str:
    """The parts that have been run."""
    text = """# How well films are given back

Written by `python3 experiments/studies/films.py`; its tables are CSV beside its films. Bends are in rad per body length, bands are 1.645 standard errors to each side.
"""
    if (folder / "films_forms.csv").exists():
        text += f"""
## Closed forms

61 midlines of 41 points, 3 s, without noise and with 1 mm on each coordinate.

{markdown(folder / "films_forms.csv")}"""
    if (folder / "films_runs.csv").exists():
        text += f"""
## Runs as films

The scene at h = 20 ms until its knot is tied, filmed at 30 frames a second: 50 points in pixels, y down, turned; 1 mm of noise, 5 % of the points lost, 1 % of them 15 cm off, 1 s without midlines, head and tail exchanged in two.
Shapes are held against the run's own bodies; bands against the program of the same film without faults.

{markdown(folder / "films_runs.csv")}"""
    if (folder / "films_damaged.csv").exists():
        with (folder / "films_damaged.csv").open(newline="") as file:
            rows = list(csv.DictReader(file))
        outcomes = {o: sum(row["outcome"] == o for row in rows) for o in ("right", "told", "failed", "refused", "silently off", "crashed")}
        counts = "| outcome | films |\n|---|---|\n" + "".join(f"| {o} | {n} |\n" for o, n in outcomes.items())
        text += f"""
## Damaged films

{len(rows)} films of an arc that grows, each with one or two random faults. Right: three quarters of the bends or more are within their bands of 90 %. Told: something is said that a reader must look at.
A film with y down is held against the mirror image: nothing in a plane tells it.

{counts}"""
    return text


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--only", choices=("forms", "runs", "damaged"))
    parser.add_argument("--run", action="append", default=[], help="of the ten runs, such as living_overhand or 'living_overhand (mirror)'; where not given, all")
    parser.add_argument("--out", type=Path, default=ROOT / "out/films")
    options = parser.parse_args()
    options.out.mkdir(parents=True, exist_ok=True)
    for part in (forms, runs, damaged):
        if options.only in (None, part.__name__):
            write(options.out / f"films_{part.__name__}.csv", part(options.out, options.run) if part is runs else part(options.out))
    (ROOT / "experiments/results").mkdir(exist_ok=True)
    (ROOT / "experiments/results/films.md").write_text(page(options.out))


if __name__ == "__main__":
    main()
