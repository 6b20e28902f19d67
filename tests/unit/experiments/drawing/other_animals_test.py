"""The study's other animals are within what is said of them."""

import numpy as np
import pytest

import animals


def test_other_animals_are_what_is_said_of_them():
    own = animals.tomllib.loads((animals.DATA / "specimens/pacific_hagfish.toml").read_text())
    for seed in range(animals.FIRST_SEED, animals.FIRST_SEED + 10):
        drawn = animals.settings(seed)
        length = drawn["specimen.length"]
        scale = length / own["length"]
        assert 25 <= length <= 60 and 60 <= drawn["model.bodies"] <= 200
        for key, by in (("circumference", scale), ("bending_limit_deg", 1)):
            assert all(0.8 <= a / (by * b) <= 1.2 for a, b in zip(drawn[f"specimen.{key}"], own[key], strict=True))
        # Mass by volume: the density is the measured animal's, as thin slices give it.
        assert drawn["specimen.mass"] / sliced(drawn["specimen.circumference"], own["station"], length) == pytest.approx(
            own["mass"] / sliced(own["circumference"], own["station"], own["length"]), rel=1e-4)


def test_a_specimen_file_has_the_animals_own_figures(capsys):
    animals.specimen_file(3)
    file = animals.tomllib.loads(capsys.readouterr().out)
    common = animals.tomllib.loads((animals.DATA / "specimens/pacific_hagfish.toml").read_text())
    for key, value in animals.settings(animals.FIRST_SEED + 2).items():
        table, _, name = key.partition(".")
        if table == "specimen":
            place, _, last = name.rpartition(".")
            assert (file[place] if place else file)[last] == value
    assert file.keys() == common.keys() and file["passive"].keys() == common["passive"].keys()
    assert file["station"] == common["station"] and file["muscle"] == common["muscle"]


def test_slender_animals_are_longer_and_no_thicker(capsys):
    own, longer = animals.settings(animals.FIRST_SEED), animals.settings(animals.FIRST_SEED, animals.SLENDER)
    grow = {"specimen.length", "specimen.mass"}
    for key in own:
        assert longer[key] == (pytest.approx(1.5 * own[key]) if key in grow else own[key])
    animals.slender_file()
    file = animals.tomllib.loads(capsys.readouterr().out)
    common = animals.tomllib.loads((animals.DATA / "specimens/pacific_hagfish.toml").read_text())
    assert file["length"] == 1.5 * common["length"] and file["mass"] == 1.5 * common["mass"]
    assert {key for key in common if file[key] != common[key]} == {"name", "length", "mass"}


def sliced(circumference, station, length):
    place = (np.arange(2000) + 0.5) / 2000
    return float((np.interp(place, station, circumference) ** 2).mean()) * length
