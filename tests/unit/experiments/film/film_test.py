"""`hagfish midlines` and `against`: midlines of a run, with the noise of digitising, give back its knot and its midlines."""

from __future__ import annotations

import sys
from pathlib import Path

import h5py
import numpy as np
import pytest

sys.dont_write_bytecode = True
sys.path.insert(0, str(Path(__file__).parents[3] / "support"))
sys.path[:0] = [str(Path(__file__).parents[4] / "experiments" / folder) for folder in ("drawing", "results/films")]

import films  # noqa: E402
from program import hagfish, refused, table  # noqa: E402

NOISE = 0.1  # cm, on each coordinate of each point
WITHIN = 0.3  # cm, rms, of the program's shapes from the true midlines


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
    said = hagfish(film, "against", "a.h5", "pixels.csv", "--scale", 80, "--y-up")
    assert rms_of(said) == pytest.approx(NOISE * np.sqrt(3), rel=0.03)


def test_a_film_gives_back_knot_and_midlines(film):
    said = hagfish(film, "midlines", "film.csv", "--out", "p.csv", "--times", 48)
    assert "20 stations x 48 times" in said and "three dimensions" in said
    residual = float(said.split("fitted: ")[1].split(" cm")[0])
    assert residual == pytest.approx(NOISE * np.sqrt(3), rel=0.1)  # the film's noise, and hardly more
    # What it says is to be run has muscles that follow the program: the run ties the knot and is where the animal was.
    assert "knot at the film's end: 3_1, right-handed" in said and "as the film does" in said
    run = [line for line in said.splitlines() if line.startswith("hagfish run")][0].split()
    hagfish(film, *run[1:], "--quiet")
    knot = h5py.File(film / "mine.h5")["knot/determinant"][()]
    assert knot[0] == 1 and knot[-1] == 3
    assert rms_of(hagfish(film, "against", "mine.h5", "true.csv")) < WITHIN
    # Its own shapes, without the water, are the animal's: a program of the noisy film, held against the true midlines.
    assert program_distance(film, "p.csv", "true.csv") < WITHIN


def test_bands_of_nine_tenths_hold_nine_tenths(film):
    """Bends of a knot change most where the knot is, and hardly elsewhere: bands must tell the two."""
    hagfish(film, "midlines", "film.csv", "--out", "bands.csv", "--stations", 25)
    fit = films.Program(film / "bands.csv")
    with h5py.File(film / "a.h5") as h5:
        time, centres = h5["trajectory/time"][()], h5["trajectory/position"][()]
    true = np.stack([np.stack([np.interp(fit.time, time, centres[:, k, d]) for d in range(3)], axis=1) for k in range(films.BODIES)], axis=1)
    way = films.ways_between(true, free=False)
    same = films.rolled_to(fit, lambda roll: films.at_stations(films.joints_along(way, roll), fit.station), free=False)
    assert 0.85 <= films.in_band(fit, same) <= 0.95


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
                about_y, about_z = np.array([[cy, 0, sy], [0, 1, 0], [-sy, 0, cy]]), np.array([[cz, -sz, 0], [sz, cz, 0], [0, 0, 1]])
                turn = turn @ (about_z @ about_y if body % 4 == 1 else about_y @ about_z)
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
    assert "neither which strand is on top" in said and "hagfish run" not in said and not (tmp_path / "p.toml").exists()
    p = table(tmp_path / "p.csv")
    # An arc of 30 cm at 0.05 t /cm, of an animal of any length: 1.5 t rad per length, all along it.
    inner = (p["station (L)"] > 0.1) & (p["station (L)"] < 0.9)
    total = np.hypot(p["bend_y (rad/L)"], p["bend_z (rad/L)"])
    np.testing.assert_allclose(total[inner], 1.5 * p["time (s)"][inner], atol=0.02)
    # Of its first half no point is missing.
    assert "fitted: " in (half := hagfish(tmp_path, "midlines", "flat.csv", "--out", "half.csv", "--until", 1, "--times", 5)) and "from 100 % of" in half
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
    hagfish(film, "midlines", "film.csv", "--out", tmp_path / "a.csv", "--times", 48)
    said = hagfish(film, "midlines", path, "--out", tmp_path / "b.csv", "--times", 48)
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
             "word": (good.replace("1,3,3,0", "1,3,three,0"), "three"), "time": (good.replace("1,3,3,0", ",3,3,0"), "missing"),
             "few": ("time_s,s_cm,x_cm,y_cm\n0,0,0,0\n1,0,0,0\n", "points"), "twice": (good.replace("0,2,2,0", "0,1,2,0"), "twice"),
             "one": (good[:good.index("1,0,0,0")], "two times"), "empty": ("", "time_s"), "semicolons": (good.replace(",", ";").replace("x_cm", "w"), "the 4 that semicolons"),
             "millimetres": (good.replace("x_cm", "x_mm"), "check units and scale"), "metres": (good.replace("s_cm", "s_m"), "check units and scale"), "inf": (good.replace("1,3,3,0", "1,3,inf,0"), "number"),
             "one and a half": ("time_s,s_cm,x_cm,y_cm\n" + "".join(f"{t},{s},{1.5 * s},0\n" for t in (0, 1) for s in range(6)), "1.5 times"),
             "huge": (good.replace("1,3,3,0", "1,3,1e300,0"), "at most"), "far": (good.replace("x_cm", "x_m").replace("1,3,3,0", "1,3,1e8,0"), "at most"),
             "frames": (good.replace("time_s", "frame"), "--fps"), "several": ("individual," + good.replace("\n0,", "\na,0,").replace("\n1,", "\nb,1,"), "a, b"),
             "tiny": ("time_s,s_cm,x_cm,y_cm\n" + "".join(f"{t},{s}e-300,{s},0\n" for t in (0, 1) for s in range(6)), "cm long")}
    for name, (text, part) in cases.items():
        (tmp_path / "bad.csv").write_text(text)
        refused(tmp_path, "midlines", "bad.csv", "--out", "p.csv", parts=("bad.csv", part))
    refused(tmp_path, "midlines", "none.csv", "--out", "p.csv", parts=("none.csv",))
    (tmp_path / "good.csv").write_text(good)
    refused(tmp_path, "midlines", "good.csv", "--out", "p.csv", "--until", 0.5, "--times", 2, parts=("1 usable midlines up to 0.5 s",))
    refused(tmp_path, "midlines", "good.csv", "--out", "p.csv", "--times", 2, "--stations", 26, parts=("--stations 26", "at most 25"))
    refused(tmp_path, "against", "none.h5", "good.csv", parts=("none.h5",))
    late = good.replace("\n0,", "\n1000,").replace("\n1,", "\n1001,")
    (film / "late.csv").write_text(late)
    refused(film, "against", "a.h5", "late.csv", parts=("a.h5", "no time"))
    (film / "huge.csv").write_text(good.replace("1,3,3,0", "1,3,1e300,0"))
    refused(film, "against", "a.h5", "huge.csv", parts=("huge.csv", "at most"))


LENGTH = 42.4  # cm, of the animal


def bent(time, total, points=21, start=0.0):
    """Midlines of a body that is an arc of `total`(t) rad, head still at the origin: closed form. frames x points x 2; and s."""
    s = np.linspace(start, LENGTH, points)
    k = np.array([total(t) / LENGTH for t in time])[:, None] + 1e-12
    return s, np.stack([np.sin(k * s) / k, (1 - np.cos(k * s)) / k], axis=2)


def write_rows(path, time, s, points, column="s_cm", kept=lambda f, i: True):
    number = (lambda i: f"{s[i]:.6g}") if column == "s_cm" else (lambda i: str(i + 1))
    rows = [f"{t:.6g},{number(i)},{points[f, i, 0]:.6g},{points[f, i, 1]:.6g}" for f, t in enumerate(time) for i in range(len(s)) if kept(f, i)]
    path.write_text("\n".join([f"time_s,{column},x_cm,y_cm", *rows]) + "\n")


def bends(folder, *arguments, code=0):
    """What the program says, and its table."""
    said = hagfish(folder, "midlines", *arguments, "--out", "p.csv", "--force", code=code)
    return said, table(folder / "p.csv")


@pytest.mark.parametrize("total", [0.0, 2.5, 4.0, -6.0, 8.0])
def test_a_film_that_begins_bent_is_found(tmp_path, total):
    """More than a full turn in a plane crosses itself, of which one camera does not tell enough."""
    time = np.array([0.0, 1.0])
    write_rows(tmp_path / "f.csv", time, *bent(time, lambda t: total))
    said, p = bends(tmp_path, "f.csv")
    assert said.count("fitted: " if abs(total) < 2 * np.pi else "doubtful: ") == 1
    np.testing.assert_allclose(p["bend_z (rad/L)"], total, atol=0.05)
    np.testing.assert_array_equal(p["bend_y (rad/L)"], 0)


@pytest.mark.parametrize("start", [0.0, 1.0, 5.0])
def test_a_head_that_is_not_in_the_film_bends_nothing(tmp_path, start):
    time = np.linspace(0, 2, 41)
    write_rows(tmp_path / "f.csv", time, *bent(time, lambda t: 3 * t, start=start))
    _, p = bends(tmp_path, "f.csv")
    np.testing.assert_allclose(p["bend_z (rad/L)"], 3 * p["time (s)"], atol=0.05)


def test_gaps_in_time_are_told_and_bridged(tmp_path):
    time = np.linspace(0, 10, 101)
    s, points = bent(time, lambda t: 0.6 * t)
    points = points + NOISE * np.random.default_rng(1).standard_normal(points.shape)
    write_rows(tmp_path / "f.csv", time, s, points, kept=lambda f, i: not 3.2 < time[f] < 4.9)
    said, p = bends(tmp_path, "f.csv", "--times", 60)
    assert "no midlines from 3.2 to 4.9 s: filled in between" in said
    np.testing.assert_allclose(p["bend_z (rad/L)"], 0.6 * p["time (s)"], atol=0.15)
    # The film says less there, and so do the standard errors.
    middle = (p["station (L)"] > 0.4) & (p["station (L)"] < 0.6)
    error = lambda a, b: p["bend_z error (rad/L)"][middle & (p["time (s)"] > a) & (p["time (s)"] < b)].mean()
    assert error(3.8, 4.3) > 1.2 * error(1, 2)


def test_points_are_where_their_numbers_say(tmp_path):
    """The last five points are missing in every third midline, as rows, as empty cells, as words; and rows may come in any order."""
    time = np.arange(24) / 10
    s, points = bent(time, lambda t: 2.0)
    write_rows(tmp_path / "rows.csv", time, s, points, column="point", kept=lambda f, i: f % 3 != 1 or i < 16)
    write_rows(tmp_path / "whole.csv", time, s, points, column="point")
    heading, *rows = (tmp_path / "whole.csv").read_text().splitlines()
    for name, missing in {"empty": ",", "words": "NaN,nan", "na": "NA,N/A"}.items():
        lost = [row if k // 21 % 3 != 1 or k % 21 < 16 else ",".join(row.split(",")[:2]) + "," + missing for k, row in enumerate(rows)]
        (tmp_path / f"{name}.csv").write_text("\n".join([heading, *lost]) + "\n")
    shuffled = np.random.default_rng(1).permutation(rows)
    (tmp_path / "any order.csv").write_text("\r".join([heading, *shuffled, rows[3]]) + "\r")  # old line ends, one row twice
    sure = [row + (",0.1" if k % 7 == 3 else ",0.9") for k, row in enumerate(rows)]
    wrong = [row if k % 7 != 3 else row.split(",")[0] + "," + row.split(",")[1] + ",3,3,0.1" for k, row in enumerate(sure)]
    (tmp_path / "unsure.csv").write_text("\n".join([heading + ",likelihood", *wrong]) + "\n")
    decimal = [row.replace(",", ";").replace(".", ",") for row in rows]
    (tmp_path / "comma.csv").write_text("\n".join([heading.replace(",", ";"), *decimal]) + "\n")
    for name in ("rows", "whole", "empty", "words", "na", "any order", "unsure", "comma"):
        said, p = bends(tmp_path, f"{name}.csv", "--times", 8)
        assert "fitted: " in said
        np.testing.assert_allclose(p["bend_z (rad/L)"], 2, atol=0.05, err_msg=name)


def test_a_tail_that_is_never_seen_is_not_bent_nor_scaled_in_silence(tmp_path):
    """A film of the first four fifths: told where it ends, or with the missing points listed, it is right; else what was taken is said."""
    time = np.arange(24) / 10
    s, points = bent(time, lambda t: 1 + t)
    write_rows(tmp_path / "cut.csv", time, s, points, kept=lambda f, i: i < 17)
    points[:, 17:] = np.nan
    write_rows(tmp_path / "listed.csv", time, s, points)
    write_rows(tmp_path / "by point.csv", time, s, points, column="point")
    for arguments in (["listed.csv"], ["by point.csv"], ["cut.csv", "--animal-length", LENGTH]):
        said, p = bends(tmp_path, *arguments)
        assert "scaled" not in said and "tip of the tail" not in said
        np.testing.assert_allclose(p["bend_z (rad/L)"], 1 + p["time (s)"], atol=0.05, err_msg=arguments[0])
    said, _ = bends(tmp_path, "cut.csv")
    assert "animal of 33.9 cm scaled to 42.4 cm" in said and "the last point is taken as the tip of the tail" in said
    refused(tmp_path, "midlines", "by point.csv", "--out", "q.csv", "--animal-length", LENGTH, parts=("by point.csv", "needs a column s_cm"))


def test_points_that_are_not_even_are_placed_by_their_distances(tmp_path):
    time = np.arange(24) / 10
    s, points = bent(time, lambda t: 1 + t, points=41)
    chosen = [0, 1, 3, 4, 5, 8, 12, 15, 20, 28, 33, 36, 39, 40]
    write_rows(tmp_path / "f.csv", time, s[chosen], points[:, chosen], column="point")
    _, p = bends(tmp_path, "f.csv")
    np.testing.assert_allclose(p["bend_z (rad/L)"], 1 + p["time (s)"], atol=0.1)


def test_what_no_body_can_do_is_taken_out_and_told(tmp_path):
    """Each fault alone, on an arc that grows, with a millimetre of noise: the program is within the noise's reach of the true one."""
    time = np.arange(91) / 30
    s, true = bent(time, lambda t: 2 * t, points=41)
    random = np.random.default_rng(2)
    noisy = true + NOISE * random.standard_normal(true.shape)

    def film(name, change):
        points = noisy.copy()
        change(points)
        write_rows(tmp_path / f"{name}.csv", time, s, points)
        said, p = bends(tmp_path, f"{name}.csv")
        inner = (p["station (L)"] > 0.1) & (p["station (L)"] < 0.9)
        np.testing.assert_allclose(p["bend_z (rad/L)"][inner], 2 * p["time (s)"][inner], atol=0.3, err_msg=name)
        assert "fitted: " in said, said
        return said

    def outliers(points):
        points[random.random(points.shape[:2]) < 0.01] += (9, 12)

    def lost(points):
        points[40:44, 5:9] = 0

    def exchanged(points):
        points[[20, 60]] = points[[20, 60], ::-1]

    def repeated(points):
        points[30:45] = points[30]

    def repeated_and_lost(points):
        repeated(points)
        points[random.random(points.shape[:2]) < 0.04] = np.nan

    assert "farther from the others" in film("outliers", outliers)
    assert "16 points at 0,0 in 4 midlines" in film("lost", lost)
    assert "head and tail are exchanged in 2 midlines (0.6667, 2 s)" in film("exchanged", exchanged)
    assert "are copies of one midline: left out" in film("repeated", repeated)
    assert "are copies of one midline: left out" in film("repeated and lost", repeated_and_lost)
    assert all(word not in film("none", lambda points: None) for word in ("left out", "taken as missing", "turned round", "filled in"))


def test_one_camera_does_not_tell_a_knot(film, tmp_path):
    """The film of a knot, seen by one camera: its midlines cross themselves."""
    t = table(film / "film.csv")
    rows = [f"{a:.6g},{s:.6g},{x:.6g},{y:.6g}" for a, s, x, y in zip(t["time_s"], t["s_cm"], t["x_cm"], t["y_cm"])]
    (tmp_path / "flat.csv").write_text("\n".join(["time_s,s_cm,x_cm,y_cm", *rows]) + "\n")
    said = hagfish(tmp_path, "midlines", "flat.csv", "--out", "p.csv", "--times", 48)
    assert "doubtful: " in said and "midlines cross themselves" in said and "one camera does not show which strand" in said and "hand of a knot" in said
    assert "hagfish run" not in said


def test_errors_are_drawn(film, tmp_path):
    write_rows(tmp_path / "f.csv", np.array([0.0, 1.0]), *bent(np.array([0.0, 1.0]), lambda t: 2.0))
    hagfish(tmp_path, "midlines", "f.csv", "--out", "p.csv", "--png", "p.png")
    assert (tmp_path / "p.png").read_bytes().startswith(b"\x89PNG")


def test_what_cannot_be_put_right_is_doubtful_or_fails(tmp_path):
    time = np.arange(61) / 20
    s, points = bent(time, lambda t: 2 * t, points=41)
    moved = points.copy()
    moved[30:] += (5, 5)  # the camera
    write_rows(tmp_path / "jump.csv", time, s, moved)
    said = hagfish(tmp_path, "midlines", "jump.csv", "--out", "j.csv", "--free-head")
    assert "doubtful: " in said and "the whole body jumps" in said and "(1.5 s)" in said
    late = points.copy()
    late[20:30] = points[19] + NOISE * np.random.default_rng(1).standard_normal(late[20:30].shape)  # one picture, clicked again
    write_rows(tmp_path / "late.csv", time, s, late)
    assert "the body changes more than" in (said := hagfish(tmp_path, "midlines", "late.csv", "--out", "l.csv")) and "(1.5 s)" in said
    tight_s, tight = bent(time, lambda t: 30, points=101)  # more than the joints near the head can
    write_rows(tmp_path / "tight.csv", time, tight_s, tight)
    assert "times as much as the animal's joints can" in hagfish(tmp_path, "midlines", "tight.csv", "--out", "t.csv")
    walk = points + 4 * np.random.default_rng(1).standard_normal((61, 1, 2))  # no head is still
    write_rows(tmp_path / "walk.csv", time, s, walk)
    before = sorted(tmp_path.rglob("*"))
    said = hagfish(tmp_path, "midlines", "walk.csv", "--out", "w.csv", code=3)
    assert "failed: " in said and "look at: " in said
    assert sorted(tmp_path.rglob("*")) == before


PARTS = 12  # of the body, as trackers number them
PIXELS = 30  # a cm


def tracked():
    """An arc that grows, as a tracker's camera sees it: 20 frames a second, pixels, y down; frames x parts x 2."""
    time = np.arange(41) / 20
    _, points = bent(time, lambda t: 2 * t, points=PARTS)
    return time, PIXELS * (points * (1, -1) + (5, 40))


def is_the_arc(folder, *arguments):
    said, p = bends(folder, *arguments, "--fps", 20)
    assert "fitted: " in said and "y runs down" in said
    np.testing.assert_allclose(p["bend_z (rad/L)"], 2 * p["time (s)"], atol=0.06)
    return said


@pytest.mark.parametrize("several", [False, True])
def test_deeplabcut_is_read_as_it_is(tmp_path, several):
    time, points = tracked()
    individuals = ["eel", "hag"] if several else ["hag"]
    columns = [(who, f"part {k}", coord) for who in individuals for k in range(PARTS) for coord in ("x", "y", "likelihood")]
    heading = [["scorer"] + ["DLC_resnet50"] * len(columns)] + ([["individuals", *(c[0] for c in columns)]] if several else [])
    heading += [["bodyparts", *(c[1] for c in columns)], ["coords", *(c[2] for c in columns)]]
    rows = []
    for f in range(len(time)):
        cells = []
        for who in individuals:
            for k in range(PARTS):
                wrong = who == "eel" or (f + k) % 9 == 0
                cells += ["3.5", "4.5", "0.02"] if wrong else [f"{points[f, k, 0]:.4f}", f"{points[f, k, 1]:.4f}", "0.99"]
        rows.append([str(f), *cells])
    (tmp_path / "dlc.csv").write_text("\n".join(",".join(row) for row in heading + rows) + "\n")
    who = ["--individual", "hag"] if several else []
    assert "DeepLabCut" in is_the_arc(tmp_path, "dlc.csv", *who)
    is_the_arc(tmp_path, "dlc.csv", *who, "--scale", PIXELS)
    refused(tmp_path, "midlines", "dlc.csv", "--out", "q.csv", *who, parts=("dlc.csv", "--fps"))
    if several:
        refused(tmp_path, "midlines", "dlc.csv", "--out", "q.csv", "--fps", 20, parts=("eel, hag", "--individual"))


def test_sleap_is_read_as_it_is(tmp_path):
    time, points = tracked()
    with h5py.File(tmp_path / "sleap.h5", "w") as h5:  # as SLEAP 1.3 exports: individuals x 2 x nodes x frames
        tracks = np.full((2, 2, PARTS, len(time)), np.nan)
        tracks[1] = points.transpose(2, 1, 0)
        tracks[1, :, 3, ::4] = np.nan
        scores = np.ones((2, PARTS, len(time)))
        tracks[1, :, 7, 5:9], scores[1, 7, 5:9] = 1, 0.1
        h5["tracks"], h5["point_scores"] = tracks, scores
        h5["track_names"] = np.array([b"track_0", b"track_1"])
        h5["node_names"] = np.array([f"n{k}".encode() for k in range(PARTS)])
    assert "SLEAP" in is_the_arc(tmp_path, "sleap.h5", "--individual", "track_1")
    refused(tmp_path, "midlines", "sleap.h5", "--out", "q.csv", "--fps", 20, parts=("track_0, track_1",))
    with h5py.File(tmp_path / "other.h5", "w") as h5:
        h5["a"] = 1
    refused(tmp_path, "midlines", "other.h5", "--out", "q.csv", "--fps", 20, parts=("other.h5", "tracks"))


def test_ethovision_is_read_as_it_is(tmp_path):
    """Semicolons, decimal commas, UTF-16, 36 lines of heading, a dash for what is missing."""
    time, points = tracked()
    cm = points / PIXELS * (1, -1)
    names = ["Trial time", "Recording time", *(f"{axis} p{k}" for k in range(PARTS) for axis in "XY"), "Result 1"]
    lines = ['"Number of header lines:";"6"', '"Experiment";"Hagfish"', '"Trial name";"Trial 1"', '""', ";".join(f'"{name}"' for name in names),
             ";".join(['"s"', '"s"'] + ['"cm"'] * 2 * PARTS + ['""'])]
    for f, t in enumerate(time):
        cells = [f"{t:.3f}", f"{t:.3f}"] + [f"{v:.5f}" if (f + k // 2) % 9 else "-" for k, v in enumerate(cm[f].ravel())] + ["1"]
        lines.append(";".join(cell.replace(".", ",") if cell != "-" else '"-"' for cell in cells))
    (tmp_path / "ev.txt").write_bytes(b"\xff\xfe" + ("\r\n".join(lines) + "\r\n").encode("utf-16-le"))
    said, p = bends(tmp_path, "ev.txt")
    assert "EthoVision" in said and "fitted: " in said
    np.testing.assert_allclose(p["bend_z (rad/L)"], 2 * p["time (s)"], atol=0.06)


def test_the_hand_of_a_knot_is_said(film):
    """y the wrong way makes the mirror image of a knot: midlines and against say which hand they see."""
    said = hagfish(film, "midlines", "film.csv", "--out", "down.csv", "--y-down", "--times", 48)
    assert "3_1, left-handed" in said
    assert "check the direction of y" in hagfish(film, "against", "a.h5", "film.csv", "--y-down")
    assert "check the direction of y" not in hagfish(film, "against", "a.h5", "film.csv")
