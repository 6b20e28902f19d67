"""The README's table of living animals goes red when it ages, and its other animals are within what is said of them."""

import sys
from pathlib import Path

import numpy as np
import pytest

import living_table
from hagfish_log import LogError

sys.path.insert(0, str(Path(__file__).parents[4] / "experiments/studies"))
import animals  # noqa: E402

ROW = "| largest torque of a hinge, forming; sliding, dyn cm | 1.5e5; 1.4e5 | 20 |"


@pytest.mark.parametrize("row", [ROW, ROW.replace("1.5e5", "1.45e5")])
def test_what_another_machine_rounds(row):
    assert living_table.same(ROW, row)


@pytest.mark.parametrize("row", [ROW.replace("1.5e5", "1.7e5"), ROW.replace("20", "18"), ROW.replace("sliding", "tied"),
                                 ROW.replace("1.5e5", "1.5e6"), ROW + " 3 |"])
def test_what_has_aged(row):
    assert not living_table.same(ROW, row)


def test_rows_that_differ_are_named(tmp_path, monkeypatch, capsys):
    page, out = tmp_path / "README.md", tmp_path / "out.md"
    page.write_text("\n".join(["a", living_table.BEGIN, "| a |", "| 4 |", living_table.END]))
    monkeypatch.setattr(living_table, "table", lambda folder: ["| a |", "| 4 |", ""])
    living_table.main(tmp_path, page, out)
    monkeypatch.setattr(living_table, "table", lambda folder: ["| a |", "| 5 |", ""])
    with pytest.raises(SystemExit) as stopped:
        living_table.main(tmp_path, page, out)
    assert stopped.value.code == 1
    assert "'| 4 |' where the runs have '| 5 |'" in capsys.readouterr().err
    page.write_text("a")
    with pytest.raises(LogError, match="does not have the lines"):
        living_table.main(tmp_path, page, out)


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


def sliced(circumference, station, length):
    place = (np.arange(2000) + 0.5) / 2000
    return float((np.interp(place, station, circumference) ** 2).mean()) * length
