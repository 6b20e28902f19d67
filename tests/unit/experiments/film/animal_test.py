"""`hagfish animal`: a film of a body that is let go gives back the animal that it was made with."""

import h5py
import numpy as np
import pytest

from program import hagfish, outcome, refused, sets

STIFFNESS, DAMPING, DRAG = 2e5, 3e3, 9.434  # of the specimen and of Table 1's scene
FACTOR = {"stiffness EI": 0.5, "damping": 0.7, "drag": 1.6}
SCENE = ["--scene", "table1", "--set", "model.passive=specimen", "--animal-length", 42.4]
NOISE = 0.05  # cm


def film_of(folder, name, bend, flat=False):
    """A film of the animal of FACTOR that begins bent by `bend`, rad/cm: held by the head, or free and seen by one camera (flat)."""
    (folder / f"{name}.toml").write_text(f"""base = "table1"
title = "let go"
clamp_head = {str(not flat).lower()}
[model]
passive = "specimen"
[drag]
normal = {DRAG * FACTOR["drag"]}
tangential = {DRAG / 4 * FACTOR["drag"]}
[script]
kind = "none"
[wall]
present = false
[time]
step = 0.001
rule = "midpoint"
duration = 2.0
frame_interval = 0.04
[start]
bend = [[0, 0, 0, {bend}], [0.5, 0, {0 if flat else bend / 2}, {bend / 2}], [1, 0, 0, {bend}]]
""")
    values = {"bending_stiffness": STIFFNESS * FACTOR["stiffness EI"], "bending_damping": DAMPING * FACTOR["damping"]}
    # Nothing is tied, which is exit code 3.
    outcome(folder, "run", f"{name}.toml", "--out", f"{name}.h5", "--qp", "active-set", "--log", "frames",
            *sets(*(f"specimen.passive.{key}={[value] * 4}" for key, value in values.items())))
    with h5py.File(folder / f"{name}.h5") as log:
        time, place = log["trajectory/time"][:], log["trajectory/position"][:, ::6]
    s = (np.arange(100)[::6] + 0.5) / 100 * 42.4
    seen = place + NOISE * np.random.default_rng(1).standard_normal(place.shape)
    axes = "xy" if flat else "xyz"
    rows = [",".join(f"{value:.6g}" for value in (t, a, *point[:len(axes)])) for t, points in zip(time, seen) for a, point in zip(s, points)]
    (folder / f"{name}.csv").write_text("\n".join([",".join(["time_s", "s_cm", *(f"{axis}_cm" for axis in axes)]), *rows]) + "\n")


@pytest.fixture(scope="module")
def films(tmp_path_factory):
    folder = tmp_path_factory.mktemp("animal")
    film_of(folder, "letgo", 0.06)
    film_of(folder, "free", 0.06, flat=True)
    film_of(folder, "still", 0.0)
    return folder


@pytest.mark.parametrize("film, options", [("letgo.csv", []), ("free.csv", ["--free-head"])])
def test_a_body_let_go_tells_its_animal(films, film, options):
    said = hagfish(films, "animal", film, *options, *SCENE)
    for trait, true in FACTOR.items():
        line = next(line for line in said.splitlines() if line.startswith(f"{trait}: "))
        words = line.replace(",", "").split()
        low, high = float(words[words.index("to") - 1]), float(words[words.index("to") + 1])
        assert low <= true <= high, line
        assert high / low < 2, line


def test_an_animal_of_another_length_is_named(films):
    assert "its animal has 50 cm, that of table1 42.4 cm" in outcome(films, "animal", "still.csv", *SCENE[:-1], 50, "--until", 0.5).stdout


def test_a_body_that_does_not_move_tells_nothing(films):
    said = outcome(films, "animal", "still.csv", *SCENE).stdout
    assert said.count("the film does not tell") == 3


@pytest.mark.parametrize("scene, why", [("hole_overhand", "obstacles"), ("robot_overhand", "gravity")])
def test_scenes_with_other_forces_are_refused(films, scene, why):
    refused(films, "animal", "letgo.csv", "--scene", scene, parts=("letgo.csv", why))
