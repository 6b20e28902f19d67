"""`hagfish specimen`: an animal from what was measured, and a scene in which it ties its knot."""

import re
import tomllib

import h5py
import numpy as np
import pytest

from program import ROOT, hagfish, logged, refused, table

ANIMAL = ["--length", 35, "--mass", 45, "--circumference", "4.6,4.4,4.4,3.2", "--bending", "25,80,50,55", "--twist", 60]


def specimen(folder, *arguments, out="mine"):
    """What `hagfish specimen` says, and the animal that it writes."""
    said = hagfish(folder, "specimen", *arguments, "--out", f"{out}.toml")
    return said, tomllib.loads((folder / f"{out}.toml").read_text())


def toml(name):
    return tomllib.loads((ROOT / "data" / name).read_text())


def along_body(values):
    """Linear between stations and constant outside."""
    return np.interp((np.arange(1000) + 0.5) / 1000, [0.2, 0.4, 0.6, 0.8], values)


def test_it_writes_what_was_measured_and_works_out_the_rest(tmp_path):
    said, mine = specimen(tmp_path, *ANIMAL, "--name", 'a "good" one')
    assert mine["name"] == 'a "good" one'
    assert (mine["length"], mine["mass"], mine["twist_limit_deg"]) == (35, 45, 60)
    assert mine["circumference"] == [4.6, 4.4, 4.4, 3.2] and mine["bending_limit_deg"] == [25, 80, 50, 55]
    assert mine["bending_span"] == pytest.approx(2 * 35 / 100)
    assert mine["station"] == [0.2, 0.4, 0.6, 0.8]
    round_sections = np.mean(along_body(mine["circumference"]) ** 2 / (4 * np.pi) * 35)
    assert f"{45 / round_sections:.3g} g/cm^3" in said and "plausible" in said and "ODD" not in said
    # Muscles: those of the specimen file by the cross-section, where they were measured; the rest as it is.
    other = toml("specimens/pacific_hagfish.toml")
    share = (np.array(mine["circumference"]) / other["circumference"]) ** 2
    for area in ("longitudinal_area", "oblique_area"):
        assert mine["muscle"][area] == pytest.approx(share * other["muscle"][area], rel=5e-3)  # three digits
    for key in ("stress", "radius_share", "oblique_angle_deg"):
        assert mine["muscle"][key] == pytest.approx(other["muscle"][key])


def test_a_flat_animal_has_the_girths_of_circles_of_its_sections_areas(tmp_path):
    height, width = np.array([2.0, 1.8, 1.6, 1.2]), np.array([1.4, 1.0, 0.8, 0.6])
    said, flat = specimen(tmp_path, "--height", ",".join(map(str, height)), "--width", ",".join(map(str, width)))
    assert np.array(flat["circumference"]) ** 2 / (4 * np.pi) == pytest.approx(np.pi / 4 * height * width, rel=1e-5)
    assert "the model is round" in said
    for more in ([], ["--width", "1,1"], ["--width", "1,1,1,1", "--circumference", "4,4,4,4"], ["--width", "1,1,1,0"]):
        refused(tmp_path, "specimen", "--height", "2,2,2,2", *more, "--out", "x.toml", parts=("--width" if "--circumference" not in more else "--circumference",))


def test_what_is_odd_is_said(tmp_path):
    thick = ["--length", 35, "--mass", 450, "--circumference", "14,14", "--station", "0.3,0.7", "--twist", 60]
    said, _ = specimen(tmp_path, *thick, "--bending", "25,95")
    assert "slenderness" in said and said.count("ODD") == 2
    assert "95 degrees at 0.7 L: a joint bends by 85 at most" in said
    for density, odd in ((0.84, 1), (0.86, 0), (1.14, 0), (1.16, 1)):
        said, _ = specimen(tmp_path, "--mass", density * 80 / 0.8707, "--force")
        assert said.count("ODD") == odd


@pytest.mark.parametrize(
    ("option", "value", "parts"),
    [
        ("--length", -3, ("--length",)),
        ("--circumference", "4.6,4.4", ("--circumference", "has 2 values, but there are 4 stations")),
        ("--circumference", "4.6,4.4,4.4,1e308", ("--circumference 1e+308",)),
        ("--bending", "25,80,50,0", ("--bending 0",)),
        ("--bending", "25,80,50,180", ("--bending 180", "below 180")),
        ("--twist", 0, ("--twist",)),
        ("--name", "a\nb", ("--name",)),
        ("--station", "0.2,0.4,0.3,0.8", ("--station 0.3",)),
        ("--knot", "6_1", ("--knot",)),
    ],
)
def test_a_bad_measure_is_one_line(tmp_path, option, value, parts):
    words = [*ANIMAL, option, value]
    if option in ANIMAL:
        words = [*ANIMAL]
        words[words.index(option) + 1] = value
    refused(tmp_path, "specimen", *words, "--out", "x.toml", parts=parts)


def test_what_was_not_measured_is_the_papers_animal_scaled(tmp_path):
    paper = toml("specimens/pacific_hagfish.toml")
    said, same = specimen(tmp_path, out="same")
    assert "0.871 g/cm^3 of round cross-sections, water 1: plausible" in said
    for key in ("length", "mass", "circumference", "bending_limit_deg", "twist_limit_deg", "bending_span"):
        assert same[key] == pytest.approx(paper[key], rel=1e-5)
    assert same["passive"]["bending_stiffness"] == pytest.approx(paper["passive"]["bending_stiffness"])
    # The same shape and density; angles stay.
    _, half = specimen(tmp_path, "--length", 21.2, out="half")
    assert half["mass"] == pytest.approx(paper["mass"] / 8, rel=1e-5)
    assert half["circumference"] == pytest.approx([c / 2 for c in paper["circumference"]])
    assert half["bending_limit_deg"] == pytest.approx(paper["bending_limit_deg"], rel=1e-5)


def test_a_thicker_animal_is_thicker_in_all_that_goes_with_the_girth(tmp_path):
    paper = toml("specimens/pacific_hagfish.toml")
    said, thick = specimen(tmp_path, "--thicker", 1.1)
    grows = [("mass", 2, 1e-5), ("bending_limit_deg", -1, 1e-5), ("twist_damping", 4, 1e-3), ("longitudinal_area", 2, 5e-3)]
    for key, power, rounding in grows:
        own, papers = (np.array((animal | animal["passive"] | animal["muscle"])[key]) for animal in (thick, paper))
        np.testing.assert_allclose(own, papers * 1.1**power, rtol=rounding, err_msg=key)
    (line,) = [line for line in said.splitlines() if line.startswith("beside paper's")]
    for part in "length x 1|girth x 1.1|mass x 1.21|limits x 0.909|stiffness x 1.46|torques x 1.33|drag x 1.1".split("|"):
        assert re.search(re.escape(part) + r"\b", line), part
    # Measured values are thickened, too.
    _, twice = specimen(tmp_path, *ANIMAL, "--thicker", 2, out="twice")
    assert (twice["mass"], twice["twist_limit_deg"]) == (180, 30) and twice["circumference"] == [9.2, 8.8, 8.8, 6.4]


KNOTS = {"3_1": ("Overhand knot", 3), "4_1": ("Figure-eight knot", 5), "5_1": ("Double overhand knot", 5),
         "5_2": ("Three-twist knot", 7)}  # with their determinants
FRESH = [("3_1", ANIMAL), ("3_1", ["--thicker", 0.8]), ("3_1", ["--length", 80]), ("4_1", ["--thicker", 1.1]),
         ("5_1", ["--length", 20]), ("5_2", ["--thicker", 1.1])]


def with_scene(folder, *arguments):
    return specimen(folder, *arguments, "--scene-out", "knot.toml", "--name", "mine")[0]


@pytest.mark.parametrize(("knot", "animal"), FRESH, ids=str)
def test_a_fresh_animal_ties_its_knot_and_passes_its_audit(tmp_path, knot, animal):
    assert "may not be tied" not in with_scene(tmp_path, *animal, "--knot", knot)
    log = h5py.File(logged(tmp_path, "knot.toml"))
    title, determinant = KNOTS[knot]
    assert log.attrs["status"] == "complete" and determinant in log["knot/determinant"][()]
    scene = tomllib.loads(log.attrs["scene"])
    assert scene["title"] == f"{title}, tied by mine" and scene["expect"]["knot"] == knot
    length = scene["specimen"]["length"]
    if knot == "3_1":
        assert scene["expect"]["slide_distance"] == pytest.approx(0.05 * length)
    assert scene["time"]["step"] == 0.005 / {35: 2, 20: 4}.get(round(length), 1)
    hagfish(tmp_path, "check", "a.h5")
    hagfish(tmp_path, "export", "a.h5", "--out", "a")
    summary = table(tmp_path / "a/summary.csv")
    assert summary["specimen"][0] == "mine" and summary["length_cm"][0] == pytest.approx(length)


def test_settings_that_go_with_the_girth_are_the_papers_by_it(tmp_path):
    with_scene(tmp_path, *ANIMAL)
    log = h5py.File(logged(tmp_path, "knot.toml", "--set", "muscle.present=true"))
    scene, paper = tomllib.loads(log.attrs["scene"]), toml("table1.toml")
    girth = np.mean(along_body([4.6, 4.4, 4.4, 3.2])) / np.mean(along_body([5.6, 5.5, 5.6, 4.3]))
    keys = """drag.normal constraints.tolerance constraints.stride contact.margin controller.contact_gap
        controller.contact_patch"""
    for section, key in (name.split(".") for name in keys.split()):
        assert scene[section][key] == pytest.approx(girth * paper[section][key], rel=1e-3), key
    assert 0.1 < log["muscle/activation"][1:].max() <= 1  # its muscles can do it
    hagfish(tmp_path, "check", "a.h5")


@pytest.mark.parametrize("knot", ["4_1", "5_2"])
def test_an_animal_too_thick_or_too_thin_for_its_knot_is_told(tmp_path, knot):
    for thicker in (1.2, 0.7):
        said = with_scene(tmp_path, "--thicker", thicker, "--knot", knot, "--force")
        told = f"the animal is {thicker} times as thick for its length as the paper's; 0.8 to 1.1 was tied"
        assert f"{knot} may not be tied: {told}. For a program of its own: hagfish design {knot} --specimen" in said
        ended = hagfish(tmp_path, "run", "knot.toml", "--quiet", "--out", "a.h5", "--force", code=3)
        assert "the script ended with" in ended
    # A longer one of that girth is as slender as the paper's.
    assert "may not be tied" not in with_scene(tmp_path, "--length", 42.4 * 1.2, "--knot", knot, "--force")
