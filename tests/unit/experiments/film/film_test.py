"""`hagfish midlines` and `against`: a run's midlines, with the noise of digitising, give back its knot and shapes."""

import h5py
import numpy as np
import pytest

import films
from program import hagfish, logged, outcome, refused, table

NOISE = 0.1  # cm, on each coordinate of each point
OF_NOISE = NOISE * np.sqrt(3)  # distance, rms
WITHIN = 0.3  # cm, rms, of the program's shapes from the true midlines
LENGTH = films.LENGTH  # cm, of the animal
FITTED = ["--times", 48]  # enough for a knot


def write_film(path, time, s, points, unit="cm", column="s", kept=lambda f, i: True):
    """Points, frames x along the body x 2 or 3. `column`: s, or point, for their numbers."""
    axes = "xyz"[:points.shape[2]]
    names = ["time_s", f"s_{unit}" if column == "s" else column, *(f"{axis}_{unit}" for axis in axes)]
    rows = [",".join(f"{value:.6g}" for value in (t, s[i] if column == "s" else i + 1, *points[f, i]))
            for f, t in enumerate(time) for i in range(len(s)) if kept(f, i)]
    path.write_text("\n".join([",".join(names), *rows]) + "\n")


def points_of(t, frames):
    return np.stack([t[f"{axis}_cm"] for axis in "xyz"], axis=1).reshape(frames, -1, 3)


@pytest.fixture(scope="module")
def film(tmp_path_factory):
    """A living animal's run, and a film of it while it ties its knot, by a camera that stands somewhere else."""
    folder = tmp_path_factory.mktemp("film")
    logged(folder, "living_overhand")
    hagfish(folder, "export", "a.h5", "--out", "a")
    t, knot = table(folder / "a/midline.csv"), table(folder / "a/knot.csv")
    tied = slice(0, int((knot["phase"] == "form").sum()), 2)
    time, points = knot["time_s"][tied], points_of(t, len(knot["frame"]))[tied]
    s = t["s_cm"][:points.shape[1]]
    angle = 0.7
    turn = np.array([[np.cos(angle), -np.sin(angle), 0], [np.sin(angle), np.cos(angle), 0], [0, 0, 1]])
    seen = (points + NOISE * np.random.default_rng(1).standard_normal(points.shape)) @ turn.T
    write_film(folder / "true.csv", time, s, points)
    write_film(folder / "film.csv", time, s, seen + [5, -3, 2])
    write_film(folder / "flat.csv", time, s, (seen + [5, -3, 2])[:, :, :2])
    write_film(folder / "pixels.csv", time, 80 * s, 80 * seen, unit="px")
    return folder


@pytest.fixture(scope="module")
def fitted(film):
    """What `midlines` says of the film; its program is p.csv."""
    return hagfish(film, "midlines", "film.csv", "--out", "p.csv", *FITTED)


def rms_of(text):
    return float(text.split(" cm from ")[0].split(": ")[-1])


def test_a_run_is_on_its_own_film(film):
    assert rms_of(hagfish(film, "against", "a.h5", "true.csv", "--as-is")) < 1e-4  # six digits of some 40 cm
    before = set(film.iterdir())
    said = hagfish(film, "against", "a.h5", "film.csv", "--csv", "off.csv", "--png", "off.png")
    assert {path.name for path in set(film.iterdir()) - before} == {"off.csv", "off.png"}
    assert rms_of(said) == pytest.approx(OF_NOISE, rel=0.03)  # nothing but the noise
    assert films.rms(table(film / "off.csv")["distance_cm"]) == pytest.approx(rms_of(said), rel=0.01)
    assert rms_of(hagfish(film, "against", "a.h5", "film.csv", "--as-is")) > 1
    said = hagfish(film, "against", "a.h5", "pixels.csv", "--scale", 80, "--y-up")
    assert rms_of(said) == pytest.approx(OF_NOISE, rel=0.03)


def test_a_film_gives_back_knot_and_midlines(film, fitted):
    assert "20 stations x 48 times" in fitted and "three dimensions" in fitted
    residual = float(fitted.split("fitted: ")[1].split(" cm")[0])
    assert residual == pytest.approx(OF_NOISE, rel=0.1)  # the film's noise, and hardly more
    # What it says is to be run has muscles that follow the program: the run ties the knot and is where the animal was.
    assert "knot at the film's end: overhand, 3_1, right-handed" in fitted and "as the film does" in fitted
    assert "torques are about in proportion to the rigidity EI" in fitted and "no property of the animal" in fitted
    (run,) = [line for line in fitted.splitlines() if line.startswith("hagfish run")]
    hagfish(film, *run.split()[1:], "--quiet")
    knot = h5py.File(film / "mine.h5")["knot/determinant"]
    assert knot[0] == 1 and knot[-1] == 3
    assert rms_of(hagfish(film, "against", "mine.h5", "true.csv")) < WITHIN


def test_bands_of_nine_tenths_hold_nine_tenths(film):
    """Bends of a knot change most where the knot is, and hardly elsewhere: bands must tell the two."""
    hagfish(film, "midlines", "film.csv", "--out", "bands.csv", "--stations", 25)
    fit = films.Program(film / "bands.csv")
    with h5py.File(film / "a.h5") as h5:
        time, centres = h5["trajectory/time"][()], h5["trajectory/position"][()]
    at = lambda values: np.interp(fit.time, time, values)
    true = np.apply_along_axis(at, 0, centres)
    way = films.ways_between(true, free=False)
    by = lambda roll: films.at_stations(films.joints_along(way, roll), fit.station)
    same = films.rolled_to(fit, by, free=False)
    assert 0.85 <= films.in_band(fit, same) <= 0.95


def test_a_flat_film_makes_a_flat_program(tmp_path):
    s, time = np.linspace(0, 30, 40), np.linspace(0, 2, 21)
    k = 1e-6 + 0.05 * time[:, None]  # an arc of a growing curvature
    write_film(tmp_path / "flat.csv", time, s, np.stack([np.sin(k * s) / k, (1 - np.cos(k * s)) / k], axis=2))
    said = hagfish(tmp_path, "midlines", "flat.csv", "--out", "p.csv", "--stations", 5, "--times", 5, "--png", "p.png")
    assert "two dimensions" in said and "neither which strand is on top" in said
    assert "hagfish run" not in said and not (tmp_path / "p.toml").exists()
    p = table(tmp_path / "p.csv")
    # An arc of 30 cm at 0.05 t /cm, of an animal of any length: 1.5 t rad per length, all along it.
    inner = (p["station (L)"] > 0.1) & (p["station (L)"] < 0.9)
    total = np.hypot(p["bend_y (rad/L)"], p["bend_z (rad/L)"])
    np.testing.assert_allclose(total[inner], 1.5 * p["time (s)"][inner], atol=0.02)
    assert (tmp_path / "p.png").read_bytes().startswith(b"\x89PNG")
    # Of its first half no point is missing.
    half = hagfish(tmp_path, "midlines", "flat.csv", "--out", "half.csv", "--until", 1, "--times", 5)
    assert "fitted: " in half and "from 100 % of" in half


def test_a_film_has_a_clock_and_an_animal_of_its_own(film, fitted, tmp_path):
    """Started later, of an animal four fifths as long, and saved by Excel, it says the same."""
    t = table(film / "film.csv")
    time, length = np.unique(t["time_s"]), t["s_cm"].max()
    values = np.column_stack([t["time_s"] + 3, *(0.8 * t[f"{name}_cm"] for name in "sxyz")])
    rows = [",".join(f"{value:.9g}" for value in row) for row in values]
    path = tmp_path / "other one.csv"
    path.write_bytes(b"\xef\xbb\xbf" + "\r\n".join(["time_s,s_cm,x_cm,y_cm,z_cm", *rows, "", ""]).encode())
    said = hagfish(film, "midlines", path, "--out", tmp_path / "b.csv", *FITTED)
    a, b = table(film / "p.csv"), table(tmp_path / "b.csv")
    for name in a:
        np.testing.assert_allclose(b[name], a[name], atol=1e-2)
    assert f"animal of {0.8 * length:.3g} cm scaled" in said
    assert "hagfish specimen" in said and "--scene" in said and "--scene" not in fitted
    assert f"hagfish against mine.h5 '{path}' --start 0" in said.splitlines()
    said = hagfish(film, "against", "a.h5", path, "--start", 0, "--csv", tmp_path / "off.csv")
    np.testing.assert_allclose(np.unique(table(tmp_path / "off.csv")["time_s"]), time, atol=1e-6)  # the log's clock
    assert rms_of(said) == pytest.approx(OF_NOISE, rel=0.03)
    assert f"{len(time)} of its {len(time)} midlines" in said
    assert rms_of(hagfish(film, "against", "a.h5", path)) > 1  # the film's clock is taken for the log's


GOOD = "time_s,s_cm,x_cm,y_cm\n" + "".join(f"{t},{s},{s},0\n" for t in (0, 1) for s in range(6))
POINT = "1,3,3,0"  # of GOOD
BAD = {
    "no time": (GOOD.replace("time_s", "t"), "time_s"),
    "no unit": (GOOD.replace("x_cm", "x"), "unit"),
    "pixels": (GOOD.replace("x_cm", "x_px"), "--scale"),
    "no y": (GOOD.replace("y_cm", "w_cm"), "y_cm"),
    "word": (GOOD.replace(POINT, "1,3,three,0"), "three"),
    "time": (GOOD.replace(POINT, ",3,3,0"), "missing"),
    "few": ("time_s,s_cm,x_cm,y_cm\n0,0,0,0\n1,0,0,0\n", "points"),
    "one name twice": (GOOD.replace("y_cm", "x_cm"), "column x_cm: its heading has this name twice"),
    "two units": (GOOD.replace("y_cm", "x_mm"), "columns x_cm and x_mm"),
    "a point twice": ("time_s,X a (cm),Y a (cm),X a (cm),Y a (cm)\n0,1,1,1,1\n", "x a (cm)"),
    "cameras": ("pt1_cam1_X,pt1_cam1_Y\n1,1\n", "xyzpts.csv"),
    "space": ("pt1_X,pt1_Y,pt1_Z\n1,1,1\n", "--unit cm, mm or m"),
    "clock": (GOOD + "".join(f"{t},{s},{s},0\n" for t in (2, 3602) for s in range(6)), "--until 2"),
    "twice": (GOOD.replace("0,2,2,0", "0,1,2,0"), "twice"),
    "one": (GOOD[:GOOD.index("1,0,0,0")], "two times"),
    "empty": ("", "time_s"),
    "semicolons": (GOOD.replace(",", ";").replace("x_cm", "w"), "the 4 that semicolons"),
    "millimetres": (GOOD.replace("x_cm", "x_mm"), "check units and scale"),
    "infinite": (GOOD.replace(POINT, "1,3,inf,0"), "number"),
    "huge": (GOOD.replace(POINT, "1,3,1e300,0"), "at most"),
    "frames": (GOOD.replace("time_s", "frame"), "--fps"),
    "several": ("individual," + GOOD.replace("\n0,", "\na,0,").replace("\n1,", "\nb,1,"), "a, b"),
    "tiny": ("time_s,s_cm,x_cm,y_cm\n" + "".join(f"{t},{s}e-300,{s},0\n" for t in (0, 1) for s in range(6)), "cm long"),
    "one and a half": ("time_s,s_cm,x_cm,y_cm\n" + "".join(f"{t},{s},{1.5 * s},0\n" for t in (0, 1) for s in range(6)),
                       "1.5 times"),
}


@pytest.mark.parametrize("name", BAD)
def test_a_bad_film_is_one_line(tmp_path, name):
    text, part = BAD[name]
    (tmp_path / "bad.csv").write_text(text)
    refused(tmp_path, "midlines", "bad.csv", "--out", "p.csv", parts=("bad.csv", part))


@pytest.mark.parametrize(("text", "part"), [(GOOD, "--scale: has no column in px"), (BAD["space"][0], "--scale is for pixels")])
def test_a_scale_that_nothing_would_use_is_refused(tmp_path, text, part):
    (tmp_path / "bad.csv").write_text(text)
    refused(tmp_path, "midlines", "bad.csv", "--scale", 25, "--fps", 30, "--out", "p.csv", parts=("bad.csv", part))


def test_what_a_film_does_not_bear_is_one_line(film, tmp_path):
    (tmp_path / "good.csv").write_text(GOOD)
    midlines = ["midlines", "good.csv", "--out", "p.csv", "--times", 2]
    refused(tmp_path, *midlines, "--until", 0.5, parts=("1 usable midlines up to 0.5 s",))
    refused(tmp_path, *midlines, "--stations", 26, parts=("--stations 26", "at most 25"))
    (film / "late.csv").write_text(GOOD.replace("\n0,", "\n1000,").replace("\n1,", "\n1001,"))
    refused(film, "against", "a.h5", "late.csv", parts=("a.h5", "no time"))
    (film / "huge.csv").write_text(BAD["huge"][0])
    refused(film, "against", "a.h5", "huge.csv", parts=("huge.csv", "at most"))


def bent(time, total, points=21, start=0.0):
    """s, and midlines of a body that is an arc of `total`(t) rad, head still at the origin: frames x points x 2."""
    s = np.linspace(start, LENGTH, points)
    k = np.array([total(t) / LENGTH for t in time])[:, None] + 1e-12
    return s, np.stack([np.sin(k * s) / k, (1 - np.cos(k * s)) / k], axis=2)


def bends(folder, *arguments, code=0):
    """What the program says, and its table."""
    said = hagfish(folder, "midlines", *arguments, "--out", "p.csv", "--force", code=code)
    return said, table(folder / "p.csv")


def arc_of(folder, *arguments, total, atol=0.05):
    """What the program says of a film of an arc of `total`(t) rad, which it finds."""
    said, p = bends(folder, *arguments)
    assert "fitted: " in said, said
    np.testing.assert_allclose(p["bend_z (rad/L)"], total(p["time (s)"]), atol=atol, err_msg=str(arguments[0]))
    return said


@pytest.mark.parametrize("total", [0.0, 2.5, 4.0, -6.0, 8.0])
def test_a_film_that_begins_bent_is_found(tmp_path, total):
    """More than a full turn in a plane crosses itself, of which one camera does not tell enough."""
    time = np.array([0.0, 1.0])
    write_film(tmp_path / "f.csv", time, *bent(time, lambda t: total))
    said, p = bends(tmp_path, "f.csv")
    assert said.count("fitted: " if abs(total) < 2 * np.pi else "doubtful: ") == 1
    np.testing.assert_allclose(p["bend_z (rad/L)"], total, atol=0.05)
    np.testing.assert_array_equal(p["bend_y (rad/L)"], 0)


@pytest.mark.parametrize("start", [0.0, 1.0, 5.0])
def test_a_head_that_is_not_in_the_film_bends_nothing(tmp_path, start):
    time = np.linspace(0, 2, 41)
    write_film(tmp_path / "f.csv", time, *bent(time, lambda t: 3 * t, start=start))
    arc_of(tmp_path, "f.csv", total=lambda t: 3 * t)


def test_gaps_in_time_are_told_and_bridged(tmp_path):
    time = np.linspace(0, 10, 101)
    s, points = bent(time, lambda t: 0.6 * t)
    points = points + NOISE * np.random.default_rng(1).standard_normal(points.shape)
    write_film(tmp_path / "f.csv", time, s, points, kept=lambda f, i: not 3.2 < time[f] < 4.9)
    said, p = bends(tmp_path, "f.csv", "--times", 60)
    assert "no midlines from 3.2 to 4.9 s: filled in between" in said
    np.testing.assert_allclose(p["bend_z (rad/L)"], 0.6 * p["time (s)"], atol=0.15)
    # The film says less there, and so do the standard errors.
    middle = (p["station (L)"] > 0.4) & (p["station (L)"] < 0.6)
    error = lambda a, b: p["bend_z error (rad/L)"][middle & (p["time (s)"] > a) & (p["time (s)"] < b)].mean()
    assert error(3.8, 4.3) > 1.2 * error(1, 2)


def test_points_are_where_their_numbers_say(tmp_path):
    """The last five are missing in every third midline, as rows, empty cells or words; rows may come in any order."""
    time = np.arange(24) / 10
    s, points = bent(time, lambda t: 2.0)
    write_film(tmp_path / "rows.csv", time, s, points, column="point", kept=lambda f, i: f % 3 != 1 or i < 16)
    write_film(tmp_path / "whole.csv", time, s, points, column="point")
    heading, *rows = (tmp_path / "whole.csv").read_text().splitlines()
    number = lambda row: row[:row.index(",", row.index(",") + 1)]  # time and point
    seen = lambda k: k // 21 % 3 != 1 or k % 21 < 16
    lost = lambda missing: [row if seen(k) else f"{number(row)},{missing}" for k, row in enumerate(rows)]
    unsure = [f"{number(row)},3,3,0.1" if k % 7 == 3 else f"{row},0.9" for k, row in enumerate(rows)]
    written = {
        "empty": "\n".join([heading, *lost(",")]),
        "words": "\n".join([heading, *lost("NaN,nan")]),
        "na": "\n".join([heading, *lost("NA,N/A")]),
        # Old line ends, one row twice.
        "any order": "\r".join([heading, *np.random.default_rng(1).permutation(rows), rows[3]]),
        "unsure": "\n".join([heading + ",likelihood", *unsure]),
        "comma": "\n".join([heading, *(row.replace(".", "|") for row in rows)]).replace(",", ";").replace("|", ","),
    }
    for name, text in written.items():
        (tmp_path / f"{name}.csv").write_text(text + text[len(heading)])
    for name in ("rows", "whole", *written):
        arc_of(tmp_path, f"{name}.csv", "--times", 8, total=lambda t: 2)


def test_a_tail_that_is_never_seen_is_not_bent_nor_scaled_in_silence(tmp_path):
    """A film of four fifths: told where it ends, or with missing points listed, it is right; else it is told."""
    time = np.arange(24) / 10
    s, points = bent(time, lambda t: 1 + t)
    write_film(tmp_path / "cut.csv", time, s, points, kept=lambda f, i: i < 17)
    points[:, 17:] = np.nan
    write_film(tmp_path / "listed.csv", time, s, points)
    write_film(tmp_path / "by point.csv", time, s, points, column="point")
    for arguments in (["listed.csv"], ["by point.csv"], ["cut.csv", "--animal-length", LENGTH]):
        said = arc_of(tmp_path, *arguments, total=lambda t: 1 + t)
        assert "scaled" not in said and "tip of the tail" not in said
    write_film(tmp_path / "cut by point.csv", time, s, points, column="point", kept=lambda f, i: i < 17)
    arc_of(tmp_path, "cut by point.csv", "--animal-length", LENGTH, total=lambda t: 1 + t)
    said, _ = bends(tmp_path, "cut by point.csv")
    assert "doubtful: " in said and "the fit makes an animal of 3" in said
    said, _ = bends(tmp_path, "cut.csv")
    assert "animal of 33.9 cm scaled to 42.4 cm" in said and "the last point is taken as the tip of the tail" in said
    short = ["midlines", "by point.csv", "--out", "q.csv", "--animal-length", 30]
    refused(tmp_path, *short, parts=("by point.csv", "span 42.4 cm", "--animal-length"))


def test_a_head_that_is_never_seen_is_told(tmp_path):
    time = np.arange(24) / 10
    s, points = bent(time, lambda t: 1 + t, start=LENGTH / 4)
    write_film(tmp_path / "f.csv", time, s, points, column="point")
    said, _ = bends(tmp_path, "f.csv")
    for part in ("the first point is taken as the tip of the head", "doubtful: ", "though the head is taken as clamped",
                 "the fit makes an animal of 3"):
        assert part in said
    for known in ([], ["--animal-length", LENGTH]):
        said = arc_of(tmp_path, "f.csv", "--first-point", LENGTH / 4, *known, total=lambda t: 1 + t)
        assert "tip of the head" not in said


def test_points_from_the_tail_are_the_first_suspicion(tmp_path):
    time = np.arange(24) / 10
    s, points = bent(time, lambda t: 1 + t)
    write_film(tmp_path / "f.csv", time, s, points[:, ::-1], column="point")
    said = outcome(tmp_path, "midlines", "f.csv", "--out", "p.csv").stdout
    assert said.split("look at: ")[1].startswith("first, the order of the points")


def test_points_that_are_not_even_are_placed_by_their_distances(tmp_path):
    time = np.arange(24) / 10
    s, points = bent(time, lambda t: 1 + t, points=41)
    chosen = [0, 1, 3, 4, 5, 8, 12, 15, 20, 28, 33, 36, 39, 40]
    write_film(tmp_path / "f.csv", time, s[chosen], points[:, chosen], column="point")
    arc_of(tmp_path, "f.csv", total=lambda t: 1 + t, atol=0.1)


def test_what_no_body_can_do_is_taken_out_and_told(tmp_path):
    """Each fault alone, on an arc that grows, with a millimetre of noise, which is all that the program is off by."""
    time = np.arange(91) / 30
    s, true = bent(time, lambda t: 2 * t, points=41)
    random = np.random.default_rng(2)
    noisy = true + NOISE * random.standard_normal(true.shape)

    def film(name, change):
        points = noisy.copy()
        change(points)
        write_film(tmp_path / f"{name}.csv", time, s, points)
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
    said = film("none", lambda points: None)
    assert not [word for word in ("left out", "taken as missing", "turned round", "filled in") if word in said]


def test_one_exchanged_midline_turns_no_others(tmp_path):
    """Each alone, of an animal that is still for long and then faster and faster."""
    time = np.arange(40) / 10
    s, points = bent(time, lambda t: 1 + max(t - 2.5, 0) ** 2)
    points = points + 0.01 * np.random.default_rng(1).standard_normal(points.shape)
    for f in (0, 10, 25, 31, 39):
        exchanged = points.copy()
        exchanged[f] = points[f, ::-1]
        write_film(tmp_path / "f.csv", time, s, exchanged)
        said = hagfish(tmp_path, "midlines", "f.csv", "--out", "p.csv", "--times", 12, "--force")
        assert f"head and tail are exchanged in 1 midlines ({time[f]:.4g} s)" in said, said


def test_one_camera_does_not_tell_a_knot(film, tmp_path):
    """Its midlines cross themselves."""
    said = hagfish(film, "midlines", "flat.csv", "--out", tmp_path / "p.csv", *FITTED)
    for part in ("doubtful: ", "midlines cross themselves", "one camera does not show which strand", "hand of a knot"):
        assert part in said
    assert "hagfish run" not in said


def test_what_cannot_be_put_right_is_doubtful_or_fails(tmp_path):
    time = np.arange(61) / 20
    s, points = bent(time, lambda t: 2 * t, points=41)
    moved = points.copy()
    moved[30:] += (5, 5)  # the camera
    write_film(tmp_path / "jump.csv", time, s, moved)
    said = hagfish(tmp_path, "midlines", "jump.csv", "--out", "j.csv", "--free-head")
    assert "doubtful: " in said and "the whole body jumps" in said and "(1.5 s)" in said
    late = points.copy()
    # One picture, clicked again.
    late[20:30] = points[19] + NOISE * np.random.default_rng(1).standard_normal(late[20:30].shape)
    write_film(tmp_path / "late.csv", time, s, late)
    said = hagfish(tmp_path, "midlines", "late.csv", "--out", "l.csv")
    assert "the body changes more than" in said and "(1.5 s)" in said
    tight_s, tight = bent(time, lambda t: 30, points=101)  # more than the joints near the head can
    write_film(tmp_path / "tight.csv", time, tight_s, tight)
    assert "times as much as the animal's joints can" in hagfish(tmp_path, "midlines", "tight.csv", "--out", "t.csv")
    walk = points + 4 * np.random.default_rng(1).standard_normal((61, 1, 2))  # no head is still
    write_film(tmp_path / "walk.csv", time, s, walk)
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
    said = arc_of(folder, *arguments, "--fps", 20, total=lambda t: 2 * t, atol=0.06)
    assert "y runs down" in said
    return said


@pytest.mark.parametrize("several", [False, True])
def test_deeplabcut_is_read_as_it_is(tmp_path, several):
    time, points = tracked()
    individuals = ["eel", "hag"] if several else ["hag"]
    names = [(who, f"part {k}") for who in individuals for k in range(PARTS)]
    words = lambda first, each: [first, *(word for name in names for word in each(*name))]
    heading = [words("scorer", lambda *_: ["DLC_resnet50"] * 3), words("individuals", lambda who, _: [who] * 3),
               words("bodyparts", lambda _, part: [part] * 3), words("coords", lambda *_: ["x", "y", "likelihood"])]
    if not several:
        del heading[1]
    rows = []
    for f in range(len(time)):
        cells = [str(f)]
        for k, (who, _) in enumerate(names):
            wrong = who == "eel" or (f + k) % 9 == 0
            cells += ["3.5", "4.5", "0.02"] if wrong else [*(f"{value:.4f}" for value in points[f, k % PARTS]), "0.99"]
        rows.append(cells)
    (tmp_path / "dlc.csv").write_text("\n".join(",".join(row) for row in heading + rows) + "\n")
    who = ["--individual", "hag"] if several else []
    assert "DeepLabCut" in is_the_arc(tmp_path, "dlc.csv", *who)
    is_the_arc(tmp_path, "dlc.csv", *who, "--scale", PIXELS)
    refused(tmp_path, "midlines", "dlc.csv", "--out", "q.csv", *who, parts=("dlc.csv", "--fps"))
    (tmp_path / "twice.csv").write_text((tmp_path / "dlc.csv").read_text().replace("part 3", "part 2"))
    refused(tmp_path, "midlines", "twice.csv", "--out", "q.csv", *who, "--fps", 20, parts=("bodypart part 2", "twice"))
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
    with h5py.File(tmp_path / "sleap.h5") as old, h5py.File(tmp_path / "frames first.h5", "w") as h5:
        h5["tracks"], h5["track_names"] = old["tracks"][()].transpose(3, 0, 2, 1), old["track_names"][()]
        h5["point_scores"] = old["point_scores"][()].transpose(2, 0, 1)
        h5["tracks"].attrs["dims"] = '["frame", "track", "node", "xy"]'
        h5["point_scores"].attrs["dims"] = '["frame", "track", "node"]'
    is_the_arc(tmp_path, "frames first.h5", "--individual", "track_1")
    with h5py.File(tmp_path / "frames first.h5", "a") as h5:
        h5["track_names"][...] = b"track_1"
        del h5["tracks"].attrs["dims"]
    twice = ["midlines", "frames first.h5", "--out", "q.csv", "--fps", 20, "--individual", "track_1"]
    refused(tmp_path, *twice, parts=("frames first.h5", "dims"))
    with h5py.File(tmp_path / "frames first.h5", "a") as h5:
        h5["tracks"].attrs["dims"] = '["frame", "track", "node", "xy"]'
    refused(tmp_path, *twice, parts=("two animals of the name track_1",))
    with h5py.File(tmp_path / "other.h5", "w") as h5:
        h5["a"] = 1
    refused(tmp_path, "midlines", "other.h5", "--out", "q.csv", "--fps", 20, parts=("other.h5", "tracks"))


def test_points_in_space_keep_their_hand(film, tmp_path):
    """As DLTdv, Anipose, DeepLabCut, and SLEAP with sleap-anipose write them, in units of their own: none is turned."""
    t = table(film / "film.csv")
    time = np.unique(t["time_s"])
    points = points_of(t, len(time))[::3, ::6]
    nodes = points.shape[1]

    def write(name, unit, names, rows, head=()):
        numbers = [",".join(f"{value:.5g}" for value in row) for row in np.column_stack([*rows, points.reshape(len(points), -1) * unit])]
        (tmp_path / name).write_text("\n".join([*head, ",".join(names), *numbers]) + "\n")

    frames = [np.arange(len(points))]
    each = [f"p{k}" for k in range(nodes) for _ in range(3)]
    write("dltdv.csv", 0.01, [f"pt{k + 1}_{axis}" for k in range(nodes) for axis in "XYZ"], [])
    write("anipose.csv", 10, ["fnum", *(f"n{k}_{axis}" for k in range(nodes) for axis in "xyz")], frames)
    write("dlc.csv", 10, ["coords", *"xyz" * nodes], frames,
          [",".join(["scorer", *["net"] * 3 * nodes]), ",".join(["bodyparts", *each])])
    for name, attribute in [("sleap.h5", ("dims", '["frame", "track", "node", "xyz"]')),
                            ("anipose.h5", ("Description", "Shape: (n_frames, n_tracks, n_nodes, 3). Camera views used: ['a', 'b']"))]:
        with h5py.File(tmp_path / name, "w") as h5:
            h5["tracks"] = points[:, None]
            h5["tracks"].attrs[attribute[0]] = attribute[1]
    fps = (len(points) - 1) / (time[::3][-1] - time[0])
    for name, unit in [("dltdv.csv", "m"), ("anipose.csv", "mm"), ("dlc.csv", "mm"), ("sleap.h5", "cm"), ("anipose.h5", "cm")]:
        said = hagfish(tmp_path, "against", film / "a.h5", name, "--fps", fps, "--unit", unit, "--animal-length", LENGTH)
        assert rms_of(said) < WITHIN and "runs down" not in said and "direction of y" not in said, name
        refused(tmp_path, "midlines", name, "--fps", fps, "--out", "q.csv", parts=(name, "--unit cm, mm or m"))


def test_ethovision_is_read_as_it_is(tmp_path):
    """Semicolons, decimal commas, UTF-16, 36 lines of heading, a dash for what is missing."""
    time, points = tracked()
    cm = points / PIXELS * (1, -1)
    names = ["Trial time", "Recording time", *(f"{axis} p{k}" for k in range(PARTS) for axis in "XY"), "Result 1"]
    quoted = lambda words: ";".join(f'"{word}"' for word in words)
    lines = ['"Number of header lines:";"6"', '"Experiment";"Hagfish"', '"Trial name";"Trial 1"', '""', quoted(names),
             quoted(["s", "s", *["cm"] * 2 * PARTS, ""])]
    for f, t in enumerate(time):
        cells = [f"{v:.5f}".replace(".", ",") if (f + k // 2) % 9 else '"-"' for k, v in enumerate(cm[f].ravel())]
        lines.append(";".join([f"{t:.3f}".replace(".", ",")] * 2 + cells + ["1"]))
    (tmp_path / "ev.txt").write_bytes(b"\xff\xfe" + ("\r\n".join(lines) + "\r\n").encode("utf-16-le"))
    assert "EthoVision" in arc_of(tmp_path, "ev.txt", total=lambda t: 2 * t, atol=0.06)


def test_the_hand_of_a_knot_is_said(film):
    """y the wrong way makes the mirror image of a knot: midlines and against say which hand they see."""
    assert "3_1, left-handed" in hagfish(film, "midlines", "film.csv", "--out", "down.csv", "--y-down", *FITTED)
    assert "check the direction of y" in hagfish(film, "against", "a.h5", "film.csv", "--y-down")
    assert "check the direction of y" not in hagfish(film, "against", "a.h5", "film.csv")
