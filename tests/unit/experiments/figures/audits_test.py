"""Findings of an audit, and the slides that are read with them."""

import numpy as np
import pytest

import audits
import slides
import summary
import tables
from conftest import KNOT, SPEED
from hagfish_log import LogError

FINDINGS = [["a.h5", "status", "complete", "complete", "", "yes"], ["a.h5", "knot held", "1", "1", "", "yes"],
            ["a.h5", "penetration", "0.002", "0.0015", "cm", "no"]]


@pytest.fixture
def check(tmp_path):
    path = tmp_path / "KIND_scene_2.check.csv"
    tables.write_csv(path, audits.COLUMNS, FINDINGS)
    return path


def test_what_failed_and_its_bound(check):
    found = audits.read_findings(check)
    assert audits.unmet(found) == ["penetration"]
    assert audits.bound_on(found, "penetration") == 0.0015
    with pytest.raises(LogError, match="no bound on girth"):
        audits.bound_on(found, "girth")


def test_findings_on_two_logs_are_not_those_on_one(tmp_path):
    tables.write_csv(tmp_path / "c.csv", audits.COLUMNS, [*FINDINGS, ["b.h5", *FINDINGS[0][1:]]])
    with pytest.raises(LogError, match="of several logs"):
        audits.read_findings(tmp_path / "c.csv")


def test_the_summary_names_what_is_not_met(log, check):
    page = summary.requirements(log(), audits.read_findings(check))
    assert "| status | complete | complete | yes |" in page
    assert "| penetration | 0.002 cm | 0.0015 | **no** |" in page
    assert "| median time of a QP, every step | 1 ms | 4 | yes |" in page


def test_a_slide_as_commanded_and_as_measured(content, check):
    content.write(check.parent / "KIND_scene_2.h5")
    (slide,) = slides.read_slides(check.parent, "KIND")
    assert (slide.knot, slide.commanded, slide.allowed) == ("3_1", 2.0, 0.0015)
    assert slide.speed == pytest.approx(SPEED, rel=1e-9)  # the knot outruns its command
    assert slide.travel == pytest.approx(6, rel=1e-9)
    assert (slide.force, slide.peak, slide.capped, slide.slack, slide.met) == (200, 200, 0, 0, 1)
    assert slide.held and not slide.failure
    np.testing.assert_allclose(slide.tail_end - slide.head_end, KNOT, rtol=1e-12)


def test_a_slide_at_its_cap_that_ends_in_failure(content, check):
    content.data["steps/thigmotaxis_lambda"][160:465] = 1000.0  # half of 610 sliding steps
    content.data["steps/eq6"][160:465] = 0
    content.attributes["status"] = "failed: tunnelled at step 7"
    content.write(check.parent / "KIND_scene_2.h5")
    (slide,) = slides.read_slides(check.parent, "KIND")
    assert (slide.capped, slide.met, slide.failure) == (0.5, 0.5, "tunnelled")


def test_a_kind_of_run_that_is_not_there(tmp_path):
    with pytest.raises(LogError, match="no run KIND"):
        slides.read_slides(tmp_path, "KIND")
