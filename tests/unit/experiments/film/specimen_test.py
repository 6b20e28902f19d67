"""`hagfish specimen`: an animal from what was measured, and a scene in which it ties its knot."""

from __future__ import annotations

import tomllib

import h5py
import numpy as np
import pytest

from program import ROOT, hagfish, logged, refused, table

DATA = ROOT / "data"
ANIMAL = ["--length", 35, "--mass", 45, "--circumference", "4.6,4.4,4.4,3.2", "--bending", "25,80,50,55", "--twist", 60]


def test_it_writes_what_was_measured_and_works_out_the_rest(tmp_path):
    said = hagfish(tmp_path, "specimen", *ANIMAL, "--out", "mine.toml", "--name", 'a "good" one')
    with (tmp_path / "mine.toml").open("rb") as file:
        mine = tomllib.load(file)
    assert mine["name"] == 'a "good" one'
    assert (mine["length"], mine["mass"], mine["twist_limit_deg"]) == (35, 45, 60)
    assert mine["circumference"] == [4.6, 4.4, 4.4, 3.2] and mine["bending_limit_deg"] == [25, 80, 50, 55]
    assert mine["bending_span"] == pytest.approx(2 * 35 / 100)
    # Round cross-sections, linear between stations and constant outside.
    s = (np.arange(1000) + 0.5) / 1000
    around = np.interp(s, mine["station"], mine["circumference"])
    assert f"{45 / np.mean(around ** 2 / (4 * np.pi) * 35):.3g} g/cm^3" in said
    assert "plausible" in said and "ODD" not in said
    # Muscles: those of the specimen file by the cross-section, where they were measured; the rest as it is.
    with (DATA / "specimens/pacific_hagfish.toml").open("rb") as file:
        other = tomllib.load(file)
    share = (np.array(mine["circumference"]) / other["circumference"]) ** 2
    for area in ("longitudinal_area", "oblique_area"):
        assert mine["muscle"][area] == pytest.approx(share * other["muscle"][area], rel=5e-3)  # three digits
    for key in ("stress", "radius_share", "oblique_angle_deg"):
        assert mine["muscle"][key] == pytest.approx(other["muscle"][key])


def test_what_is_odd_is_said(tmp_path):
    said = hagfish(tmp_path, "specimen", "--length", 35, "--mass", 450, "--circumference", "14,14", "--bending", "25,95",
                   "--station", "0.3,0.7", "--twist", 60, "--out", "odd.toml")
    assert "slenderness" in said and said.count("ODD") == 2
    assert "95 degrees at 0.7 L: a joint bends by 85 at most" in said
    for density, odd in ((0.84, 1), (0.86, 0), (1.14, 0), (1.16, 1)):
        said = hagfish(tmp_path, "specimen", "--mass", density * 80 / 0.8707, "--out", "any.toml", "--force")
        assert said.count("ODD") == odd


def test_bad_measures_are_one_line(tmp_path):
    at = lambda k, value: [*ANIMAL[:k], value, *ANIMAL[k + 1:], "--out", "x.toml"]
    refused(tmp_path, "specimen", *at(1, -3), parts=("--length",))
    refused(tmp_path, "specimen", *at(5, "4.6,4.4"), parts=("--circumference", "has 2 values, but there are 4 stations"))
    refused(tmp_path, "specimen", *at(7, "25,80,50,0"), parts=("--bending 0",))
    # What the reader of specimen files would refuse.
    refused(tmp_path, "specimen", *at(7, "25,80,50,180"), parts=("--bending 180", "below 180"))
    refused(tmp_path, "specimen", *at(5, "4.6,4.4,4.4,1e308"), parts=("--circumference 1e+308",))
    refused(tmp_path, "specimen", *at(9, 0), parts=("--twist",))
    refused(tmp_path, "specimen", *ANIMAL, "--name", "a\nb", "--out", "x.toml", parts=("--name",))
    refused(tmp_path, "specimen", *ANIMAL, "--station", "0.2,0.4,0.3,0.8", "--out", "x.toml", parts=("--station 0.3",))
    refused(tmp_path, "specimen", *ANIMAL, "--out", "/no/folder/x.toml", parts=("/no/folder/x.toml",))


def test_what_was_not_measured_is_the_papers_animal_scaled(tmp_path):
    with (DATA / "specimens/pacific_hagfish.toml").open("rb") as file:
        paper = tomllib.load(file)
    assert "0.871 g/cm^3 of round cross-sections, water 1: plausible" in hagfish(tmp_path, "specimen", "--out", "same.toml")
    hagfish(tmp_path, "specimen", "--length", 21.2, "--out", "half.toml")
    said = hagfish(tmp_path, "specimen", "--thicker", 1.1, "--out", "thick.toml")
    same, half, thick = (tomllib.loads((tmp_path / f"{name}.toml").read_text()) for name in ("same", "half", "thick"))
    for key in ("length", "mass", "circumference", "bending_limit_deg", "twist_limit_deg", "bending_span"):
        assert same[key] == pytest.approx(paper[key], rel=1e-5)
    assert same["passive"]["bending_stiffness"] == pytest.approx(paper["passive"]["bending_stiffness"])
    # The same shape and density; angles stay.
    assert half["mass"] == pytest.approx(paper["mass"] / 8, rel=1e-5)
    assert half["circumference"] == pytest.approx([c / 2 for c in paper["circumference"]])
    assert half["bending_limit_deg"] == pytest.approx(paper["bending_limit_deg"], rel=1e-5)
    # Thicker: all that goes with the girth, in the file and in a line.
    assert thick["mass"] == pytest.approx(1.21 * paper["mass"], rel=1e-5)
    assert thick["bending_limit_deg"] == pytest.approx([limit / 1.1 for limit in paper["bending_limit_deg"]], rel=1e-5)
    assert thick["passive"]["twist_damping"] == pytest.approx([1.1 ** 4 * each for each in paper["passive"]["twist_damping"]], rel=1e-3)
    assert thick["muscle"]["longitudinal_area"] == pytest.approx([1.21 * each for each in paper["muscle"]["longitudinal_area"]], rel=5e-3)
    line = next(line for line in said.splitlines() if line.startswith("beside paper's"))
    for part in ("length x 1,", "girth x 1.1,", "mass x 1.21,", "limits x 0.909 at", "stiffness x 1.46,", "torques x 1.33,", "drag x 1.1"):
        assert part in line
    # Measured values are thickened, too.
    hagfish(tmp_path, "specimen", *ANIMAL, "--thicker", 2, "--out", "twice.toml")
    twice = tomllib.loads((tmp_path / "twice.toml").read_text())
    assert (twice["mass"], twice["twist_limit_deg"]) == (180, 30) and twice["circumference"] == [9.2, 8.8, 8.8, 6.4]


@pytest.mark.parametrize("knot, title", [("3_1", "Overhand knot"), ("4_1", "Figure-eight knot"), ("5_1", "Double overhand knot"), ("5_2", "Three-twist knot")])
def test_its_scene_is_of_its_knot_and_animal(tmp_path, knot, title):
    hagfish(tmp_path, "specimen", *ANIMAL, "--knot", knot, "--out", "mine.toml", "--scene-out", "knot.toml", "--name", "mine")
    hagfish(tmp_path, "run", "knot.toml", "--set", "time.duration=0.01", "--quiet", "--out", "a.h5")
    scene = tomllib.loads(h5py.File(tmp_path / "a.h5").attrs["scene"])
    assert scene["title"] == f"{title}, tied by mine" and scene["expect"]["knot"] == knot
    with (DATA / "table1.toml").open("rb") as file:
        paper = tomllib.load(file)
    girth = np.mean(np.interp((np.arange(1000) + 0.5) / 1000, [0.2, 0.4, 0.6, 0.8], [4.6, 4.4, 4.4, 3.2]))
    papers = np.mean(np.interp((np.arange(1000) + 0.5) / 1000, [0.2, 0.4, 0.6, 0.8], [5.6, 5.5, 5.6, 4.3]))
    for table, key in (("drag", "normal"), ("constraints", "tolerance"), ("constraints", "stride"), ("contact", "margin"), ("controller", "contact_gap"),
                       ("controller", "contact_patch")):
        assert scene[table][key] == pytest.approx(girth / papers * paper[table][key], rel=1e-3), key
    refused(tmp_path, "specimen", "--knot", "6_1", "--out", "x.toml", parts=("--knot",))


FRESH = [("3_1", ANIMAL), ("3_1", ["--thicker", 0.9]), ("3_1", ["--length", 80]), ("4_1", ["--thicker", 1.1]),
         ("5_1", ["--length", 20]), ("5_2", ["--thicker", 1.1])]


@pytest.mark.parametrize("knot, animal", FRESH, ids=str)
def test_a_fresh_animal_ties_its_knot_and_passes_its_audit(tmp_path, knot, animal):
    said = hagfish(tmp_path, "specimen", *animal, "--knot", knot, "--out", "mine.toml", "--scene-out", "knot.toml", "--name", "mine")
    assert "may not be tied" not in said
    hagfish(tmp_path, "run", "knot.toml", "--quiet", "--out", "a.h5")
    log = h5py.File(tmp_path / "a.h5")
    assert log.attrs["status"] == "complete" and {"3_1": 3, "4_1": 5, "5_1": 5, "5_2": 7}[knot] in log["knot/determinant"][()]
    scene = tomllib.loads(log.attrs["scene"])
    if knot == "3_1":
        assert scene["expect"]["slide_distance"] == pytest.approx(0.05 * scene["specimen"]["length"])
    assert scene["time"]["step"] == 0.005 / {35: 2, 20: 4}.get(round(scene["specimen"]["length"]), 1)
    hagfish(tmp_path, "check", "a.h5")
    hagfish(tmp_path, "export", "a.h5", "--out", "a")
    summary = table(tmp_path / "a/summary.csv")
    assert summary["specimen"][0] == "mine" and summary["length_cm"][0] == pytest.approx(scene["specimen"]["length"])


@pytest.mark.parametrize("knot", ["4_1", "5_2"])
def test_an_animal_too_thick_for_its_knot_is_told(tmp_path, knot):
    said = hagfish(tmp_path, "specimen", "--thicker", 1.2, "--knot", knot, "--out", "mine.toml", "--scene-out", "knot.toml", "--name", "mine")
    assert f"{knot} may not be tied: the animal is 1.2 times as thick for its length as the paper's; up to 1.1 was tied" in said
    done = hagfish(tmp_path, "run", "knot.toml", "--quiet", "--out", "a.h5", code=3)
    assert "the script ended with" in done
    # A longer one of that girth is as slender as the paper's.
    said = hagfish(tmp_path, "specimen", "--length", 42.4 * 1.2, "--knot", knot, "--out", "b.toml", "--scene-out", "long.toml")
    assert "may not be tied" not in said


def test_it_has_muscles(tmp_path):
    hagfish(tmp_path, "specimen", *ANIMAL, "--out", "mine.toml", "--scene-out", "knot.toml")
    hagfish(tmp_path, "run", "knot.toml", "--set", "muscle.present=true", "--quiet", "--out", "a.h5")
    activation = h5py.File(tmp_path / "a.h5")["muscle/activation"][1:]
    assert 0.1 < activation.max() <= 1
    hagfish(tmp_path, "check", "a.h5")
