"""The page on a run: what counts as met, which phase a step is of, whether energies add up."""

from collections import Counter

import numpy as np
import pytest

import audits
import summary
import tables
from conftest import FRAMES, STEPS
from hagfish_log import LogError


def test_every_step_has_the_phase_of_the_frame_before_it(content, log):
    phases = summary.step_phases(log())
    assert len(phases) == len(content.data["steps/eq6"])
    first = FRAMES["form"] * STEPS
    assert (phases[first - 1], phases[first]) == ("form", "tighten")
    assert (phases == "slide").sum() == FRAMES["slide"] * STEPS


def test_steps_count_from_the_first_of_the_log(content, log):
    content.data["trajectory/step"] += 1234  # of a run that starts later
    assert (summary.step_phases(log()) == "slide").sum() == FRAMES["slide"] * STEPS


def test_slack_within_the_tolerance_is_met(content, log):
    slide = slice(16 * STEPS, 77 * STEPS)
    slack = content.data["steps/thigmotaxis_slack"]
    slack[slide, 0] = 1.9e-6  # of 2 cm/s
    slack[slide, 1] = 2.1e-6
    slack[slide, 2] = np.nan
    slack[slide, 3] = np.tile([0.0, 1.0], 61 * STEPS // 2)
    np.testing.assert_array_equal(summary.rows_met(log(), "slide"), [1, 0, np.nan, 0.5])


def test_the_ledger_s_last_line_is_what_is_left_over(content, log):
    grow = np.linspace(0, 1, len(content.data["trajectory/time"]))
    content.data["diagnostics/work_tip"] = 100 * grow
    content.data["diagnostics/dissipated"] = 64 * grow
    content.data["diagnostics/kinetic_energy"] = 5 + 32 * grow  # what was there at first does not count
    content.data["diagnostics/elastic_energy"] = 4 * grow
    left_over = lambda: [float(cell) for cell in summary.ledger(log())[-2].split("|")[2:4]]  # at the end, largest
    assert left_over() == pytest.approx([0, 0], abs=1e-13)  # rounding of 100 erg
    content.data["diagnostics/elastic_energy"] = 3 * grow
    assert left_over() == pytest.approx([-1, 1], rel=1e-9)


def test_knot_types_by_their_invariants(content, log):
    content.data["knot/determinant"][:3], content.data["knot/v2"][:3] = (5, 5, 9), (-1, 3, -2)
    assert Counter(log().knots(np.arange(5))) == {"4_1": 1, "5_1": 1, "det=9,v2=-2": 1, "0_1": 2}


def test_a_setting_in_degrees_or_radians(log):
    assert summary.setting(log(), "specimen", "twist_limit") == 48
    with pytest.raises(LogError, match="no specimen.girth"):
        summary.setting(log(), "specimen", "girth")


def test_a_page_of_a_whole_run_and_of_one_that_never_tied(content, log, tmp_path):
    check, page = tmp_path / "check.csv", tmp_path / "s.md"
    tables.write_csv(check, audits.COLUMNS, [["log.h5", "status", "complete", "complete", "", "yes"]])
    summary.main(log().path, check, page)
    assert "| slide | 0.32 to 1.54 | 1.22 | 3_1 (61) | 10.00 to 4.00 | 28.00 to 22.00 |" in page.read_text()
    content.data["trajectory/phase"][:] = 0
    summary.main(log().path, check, page)
    assert "| slide | not reached |" in page.read_text()


def test_only_the_paper_s_animal_is_held_against_the_paper(content, log):
    assert summary.table_one(log())[0] == "## the animal"
    assert not any("42.4" in line or "Paper" in line for line in summary.table_one(log()))
    scene = content.attributes["scene"]
    content.attributes["scene"] = scene.replace("length = 41.0", 'name = "mine"\nlength = 35.0')
    assert summary.table_one(log())[0] == "## mine"
    content.attributes["scene"] = scene.replace("length = 41.0", "length = 42.4")
    assert summary.table_one(log())[0] == "## Table 1"
    assert any("| Paper |" in line for line in summary.table_one(log()))
