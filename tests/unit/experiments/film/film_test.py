"""`hagfish midlines` and `against`: midlines of a run, with the noise of digitising, give back its knot and its midlines."""

from __future__ import annotations

import sys
from pathlib import Path

import h5py
import numpy as np
import pytest

sys.dont_write_bytecode = True
sys.path.insert(0, str(Path(__file__).parents[3] / "support"))

from program import hagfish, refused, table  # noqa: E402

NOISE = 0.1  # cm, on each coordinate of each point
WITHIN = 0.3  # cm, rms, of the program's shapes from the true midlines
STIFF = 7e6  # dyn cm^2, of muscles: those of the scene, 5e5, lag behind their program in the water, by as much again as the film's did


def write_film(path, time, s, points, unit="cm", names=("x", "y", "z")):
    rows = [",".join(["time_s", f"s_{unit}", *(f"{name}_{unit}" for name in names)])]
    for k, t in enumerate(time):
        rows += [",".join(f"{value:.6g}" for value in (t, s[i], *points[k, i, :len(names)])) for i in range(len(s))]
    path.write_text("\n".join(rows) + "\n")


@pytest.fixture(scope="module")
def film(tmp_path_factory):
    """A living animal's run, and a film of it while it ties its knot, as seen by a camera that stands somewhere else."""
    folder = tmp_path_factory.mktemp("film")
    hagfish(folder, "run", "living_overhand", "--quiet", "--out", "a.h5")
    hagfish(folder, "export", "a.h5", "--out", "a")
    t, knot = table(folder / "a/midline.csv"), table(folder / "a/knot.csv")
    frames = int((knot["phase"] == "form").sum())
    points = np.stack([t[f"{axis}_cm"] for axis in "xyz"], axis=1).reshape(len(knot["frame"]), -1, 3)[:frames:2]
    noisy = points + NOISE * np.random.default_rng(1).standard_normal(points.shape)
    s = t["s_cm"].reshape(len(knot["frame"]), -1)[0]
    angle = 0.7
    turn = np.array([[np.cos(angle), -np.sin(angle), 0], [np.sin(angle), np.cos(angle), 0], [0, 0, 1]])
    write_film(folder / "true.csv", knot["time_s"][:frames:2], s, points)
    write_film(folder / "film.csv", knot["time_s"][:frames:2], s, noisy @ turn.T + [5, -3, 2])
    write_film(folder / "pixels.csv", knot["time_s"][:frames:2], 80 * s, 80 * (noisy @ turn.T), unit="px")
    return folder


def rms_of(text):
    return float(text.split(" cm from ")[0].split(": ")[-1])


def test_a_run_is_on_its_own_film(film):
    assert rms_of(hagfish(film, "against", "a.h5", "true.csv", "--as-is")) < 1e-4  # six digits of some 40 cm are written
    before = set(film.iterdir())
    said = hagfish(film, "against", "a.h5", "film.csv", "--csv", "off.csv", "--png", "off.png")
    assert {path.name for path in set(film.iterdir()) - before} == {"off.csv", "off.png"}
    assert rms_of(said) == pytest.approx(NOISE * np.sqrt(3), rel=0.03)  # nothing but the noise
    off = table(film / "off.csv")
    assert np.sqrt(np.mean(off["distance_cm"] ** 2)) == pytest.approx(rms_of(said), rel=0.01)
    assert rms_of(hagfish(film, "against", "a.h5", "film.csv", "--as-is")) > 1
    said = hagfish(film, "against", "a.h5", "pixels.csv", "--scale", 80)
    assert rms_of(said) == pytest.approx(NOISE * np.sqrt(3), rel=0.03)


def test_a_film_gives_back_knot_and_midlines(film):
    said = hagfish(film, "midlines", "film.csv", "--out", "p.csv", "--times", 48)
    assert "20 stations x 48 times" in said and "three dimensions" in said
    residual = float(said.split(" lie ")[1].split(" cm")[0])
    assert residual == pytest.approx(NOISE * np.sqrt(3), rel=0.1)  # the film's noise, and hardly more
    assert f"--set controller.tighten_from={table(film / 'film.csv')['time_s'][-1]:g}" in said
    # A run by the program, with muscles that follow it, ties the knot and is where the animal was.
    hagfish(film, "run", "living_overhand", "--quiet", "--set", "script.program=p.csv", "--set", "controller.tighten_from=11.7",
            "--set", f"active.stiffness={STIFF:g}", "--until", "form", "--out", "again.h5")
    knot = h5py.File(film / "again.h5")["knot/determinant"][()]
    assert knot[0] == 1 and knot[-1] == 3
    assert rms_of(hagfish(film, "against", "again.h5", "true.csv")) < WITHIN
    # Its own shapes, without the water, are the animal's: a program of the noisy film, held against the true midlines.
    assert program_distance(film, "p.csv", "true.csv") < WITHIN


def program_distance(folder, program, film):
    """Distance, rms, of a film's points from a program's shapes, computed anew: the head still at the origin, the film moved as a whole."""
    p, t = table(folder / program), table(folder / film)
    times, stations, n, length = np.unique(p["time (s)"]), np.unique(p["station (L)"]), 100, 42.4
    values = [p[f"bend_{axis} (rad/L)"].reshape(len(times), len(stations)) for axis in "yz"]
    film_times = np.unique(t["time_s"])
    points = np.stack([t[f"{a}_cm"] for a in "xyz"], axis=1).reshape(len(film_times), -1, 3)
    place = t["s_cm"].reshape(len(film_times), -1)[0] / t["s_cm"].max() * n
    joints = np.arange(1, n, 2)
    low, high = np.where(joints <= 2, 0, joints - 1), np.where(joints + 2 >= n, n, joints + 1)
    bodies = np.minimum(place.astype(int), n - 1)
    own = []
    for time in film_times:
        at = [np.array([np.interp(time, times, v[:, k]) for k in range(len(stations))]) for v in values]
        # A joint takes the mean over the body that it stands for, times that share of the body.
        share = lambda v: np.array([np.mean(np.interp(np.linspace(a, b, 9) / n, stations, v)) * (b - a) / n for a, b in zip(low, high)])
        y, z = map(share, at)
        turn, origin, places = np.eye(3), np.zeros(3), []
        for body in range(n):
            if body % 2:
                cy, sy, cz, sz = np.cos(y[body // 2]), np.sin(y[body // 2]), np.cos(z[body // 2]), np.sin(z[body // 2])
                turn = turn @ np.array([[cy, 0, sy], [0, 1, 0], [-sy, 0, cy]]) @ np.array([[cz, -sz, 0], [sz, cz, 0], [0, 0, 1]])
            places.append((origin, turn[:, 0]))
            origin = origin + turn[:, 0] * length / n
        own.append([places[b][0] + (k - b) * length / n * places[b][1] for b, k in zip(bodies, place)])
    own, points = np.array(own).reshape(-1, 3), points.reshape(-1, 3)
    a, b = points - points.mean(axis=0), own - own.mean(axis=0)
    u, _, v = np.linalg.svd(b.T @ a)
    turn = u @ np.diag([1, 1, np.linalg.det(u @ v)]) @ v
    return float(np.sqrt(np.mean(np.sum((a @ turn.T - b) ** 2, axis=1))))


def test_a_flat_film_makes_a_flat_program(tmp_path):
    s, time = np.linspace(0, 30, 40), np.linspace(0, 2, 21)
    bent = []
    for t in time:  # an arc of a growing curvature
        k = 1e-6 + 0.05 * t
        bent.append(np.stack([np.sin(k * s) / k, (1 - np.cos(k * s)) / k, 0 * s], axis=1))
    write_film(tmp_path / "flat.csv", time, s, np.array(bent), names=("x", "y"))
    said = hagfish(tmp_path, "midlines", "flat.csv", "--out", "p.csv", "--stations", 5, "--times", 5)
    assert "two dimensions" in said
    p = table(tmp_path / "p.csv")
    # An arc of 30 cm at 0.05 t /cm, of an animal of any length: 1.5 t rad per length, all along it.
    inner = (p["station (L)"] > 0.1) & (p["station (L)"] < 0.9)
    total = np.hypot(p["bend_y (rad/L)"], p["bend_z (rad/L)"])
    # Which way a still head looks is found to a hundredth or two of a radian.
    np.testing.assert_allclose(total[inner], 1.5 * p["time (s)"][inner], atol=0.15)
    # Points without s, placed by the way between them, say the same.
    rows = (tmp_path / "flat.csv").read_text().splitlines()
    by_point = ["time_s,point,x_cm,y_cm"] + [",".join([r.split(",")[0], str(i % 40), *r.split(",")[2:]]) for i, r in enumerate(rows[1:])]
    (tmp_path / "points.csv").write_text("\n".join(by_point) + "\n")
    hagfish(tmp_path, "midlines", "points.csv", "--out", "q.csv", "--stations", 5, "--times", 5)
    np.testing.assert_allclose(np.hypot(*(table(tmp_path / "q.csv")[f"bend_{a} (rad/L)"] for a in "yz")), total, atol=0.05)


def test_a_film_has_a_clock_and_an_animal_of_its_own(film, tmp_path):
    """Started later, of an animal four fifths as long, and saved by Excel, it says the same."""
    t = table(film / "film.csv")
    rows = [f"{a + 3:.9g},{0.8 * s:.9g},{0.8 * x:.9g},{0.8 * y:.9g},{0.8 * z:.9g}" for a, s, x, y, z in
            zip(t["time_s"], t["s_cm"], t["x_cm"], t["y_cm"], t["z_cm"])]
    path = tmp_path / "other one.csv"
    path.write_bytes(b"\xef\xbb\xbf" + "\r\n".join(["time_s,s_cm,x_cm,y_cm,z_cm", *rows, "", ""]).encode())
    hagfish(film, "midlines", "film.csv", "--out", tmp_path / "a.csv")
    said = hagfish(film, "midlines", path, "--out", tmp_path / "b.csv")
    a, b = table(tmp_path / "a.csv"), table(tmp_path / "b.csv")
    for name in a:
        np.testing.assert_allclose(b[name], a[name], atol=1e-2)
    length = t["s_cm"].max()
    assert f"animal of {0.8 * length:.3g} cm scaled" in said
    against = [line for line in said.splitlines() if line.startswith("hagfish against")][0]
    assert against == f"hagfish against mine.h5 '{path}' --start 0"
    said = hagfish(film, "against", "a.h5", path, "--start", 0, "--csv", tmp_path / "off.csv")
    np.testing.assert_allclose(np.unique(table(tmp_path / "off.csv")["time_s"]), np.unique(t["time_s"]), atol=1e-6)  # the log's clock
    assert rms_of(said) == pytest.approx(NOISE * np.sqrt(3), rel=0.03)
    midlines = len(np.unique(t["time_s"]))
    assert f"{midlines} of its {midlines} midlines" in said
    apart = hagfish(film, "against", "a.h5", path)  # the film's clock is taken for the log's
    assert rms_of(apart) > 1


def test_bad_films_are_one_line(tmp_path, film):
    good = "time_s,s_cm,x_cm,y_cm\n" + "".join(f"{t},{s},{s},0\n" for t in (0, 1) for s in range(6))
    cases = {"no time": (good.replace("time_s", "t"), "time_s"), "no unit": (good.replace("x_cm", "x"), "unit"),
             "pixels": (good.replace("x_cm", "x_px"), "--scale"), "no y": (good.replace("y_cm", "w_cm"), "y_cm"),
             "word": (good.replace("1,3,3,0", "1,3,three,0"), "three"), "back": (good.replace("1,3,3,0", "0.5,3,3,0"), "rise"),
             "few": ("time_s,s_cm,x_cm,y_cm\n0,0,0,0\n1,0,0,0\n", "points"), "order": (good.replace("0,2,2,0", "0,1,2,0"), "rise"),
             "one": (good[:good.index("1,0,0,0")], "two times"), "empty": ("", "time_s"), "semicolons": (good.replace(",", ";"), "the 1 that commas separate"),
             "millimetres": (good.replace("x_cm", "x_mm"), "another unit"), "metres": (good.replace("s_cm", "s_m"), "another unit"), "inf": (good.replace("1,3,3,0", "1,3,inf,0"), "number"),
             "huge": (good.replace("1,3,3,0", "1,3,1e300,0"), "at most"), "far": (good.replace("x_cm", "x_m").replace("1,3,3,0", "1,3,1e8,0"), "at most"),
             "tiny": ("time_s,s_cm,x_cm,y_cm\n" + "".join(f"{t},{s}e-300,{s},0\n" for t in (0, 1) for s in range(6)), "cm long")}
    for name, (text, part) in cases.items():
        (tmp_path / "bad.csv").write_text(text)
        refused(tmp_path, "midlines", "bad.csv", "--out", "p.csv", parts=("bad.csv", part))
    refused(tmp_path, "midlines", "none.csv", "--out", "p.csv", parts=("none.csv",))
    (tmp_path / "good.csv").write_text(good)
    refused(tmp_path, "midlines", "good.csv", "--out", "p.csv", parts=("good.csv", "2 midlines", "--times 24"))
    refused(tmp_path, "midlines", "good.csv", "--out", "p.csv", "--until", 0.5, "--times", 2, parts=("1 midlines up to 0.5 s",))
    refused(tmp_path, "midlines", "good.csv", "--out", "p.csv", "--times", 2, "--stations", 26, parts=("--stations 26", "25 at most"))
    refused(tmp_path, "against", "none.h5", "good.csv", parts=("none.h5",))
    late = good.replace("\n0,", "\n1000,").replace("\n1,", "\n1001,")
    (film / "late.csv").write_text(late)
    refused(film, "against", "a.h5", "late.csv", parts=("a.h5", "no time"))
    (film / "huge.csv").write_text(good.replace("1,3,3,0", "1,3,1e300,0"))
    refused(film, "against", "a.h5", "huge.csv", parts=("huge.csv", "at most"))
