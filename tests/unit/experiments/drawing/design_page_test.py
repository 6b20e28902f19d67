"""Tables of found programs say what the table of all searches says."""

import numpy as np
import pytest

import design
from conftest import RESULTS
from tables import read_csv, read_table

HEAD = "cell,outcome,unmet,message\n"
PAGE = RESULTS / "design"


def test_each_row_names_a_revision_of_the_heading():
    named = read_table(PAGE / "design.csv").notes[0].removeprefix("Measured at ").split(" on ")[0].split(", ")
    assert sorted({row["revision"] for row in read_csv(PAGE / "design.csv", ["revision"])}) == named


def test_an_animal_is_served_by_a_run_that_ends_and_meets_all(tmp_path):
    for law, rows in (("eq6", ["ok,,", "ok,Eq. 6,", "never tied,,why"]), ("reflex", ["ok,,", "ok,,", "capped,slide,why"])):
        (tmp_path / f"unseen_{law}").mkdir()
        (tmp_path / f"unseen_{law}/table.csv").write_text(HEAD + "".join(f"{cell},{row}\n" for cell, row in enumerate(rows)))
    assert design.served(tmp_path, "eq6") == "1"
    assert design.served(tmp_path, "reflex") == "2"
    assert design.served(tmp_path / "none", "eq6") == ""


def test_a_search_without_a_result_has_its_counts_and_the_time_of_its_last_report(tmp_path):
    for name, lines in (("tries", 3), ("candidates", 2)):
        (tmp_path / f"{name}.csv").write_text("7,a\n" * lines)
    (tmp_path / "times.csv").write_text("10.0,15.5\n20.0,30.5\n")
    assert design.without_result(tmp_path) == {"found": "no", "tries": "3", "tied_in_soft_body": "2", "cpu_s": "30.5", "wall_s": "20.0"}


class Log(dict):
    """Two bodies, of 3 and 1 cm, in frames before, during and after a slide."""

    def __init__(self, phases):
        super().__init__({"/model/length": np.array([3.0, 1.0]), "/model/radius": np.array([0.5, 0.3]),
                          "/knot/head_end": np.array([0.5, 1.0, 0.2]), "/knot/tail_end": np.array([np.nan, 3.25, 3.0])})
        self.phases = np.array(phases)

    def in_phase(self, name):
        return np.flatnonzero(self.phases == name)


def test_the_body_in_the_knot_is_that_between_its_ends_as_it_starts_to_slide():
    row = design.of_log(Log(["slide", "slide", "slide"]))
    assert float(row["length_cm"]) == 4 and float(row["body_in_knot_cm"]) == 2.25
    assert float(row["body_in_knot_diameters"]) == pytest.approx(2.25 / 0.9)
    assert design.of_log(Log(["script", "script", "script"])) == {"length_cm": "4", "body_in_knot_cm": "", "body_in_knot_diameters": ""}

