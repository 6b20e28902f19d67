"""Means, slides and runs of the studies: what was commanded, and what came of it."""

import dataclasses

import numpy as np
import pytest

import accuracy
import audits
import choices
import means
import reverse
import slides
import speeds
from conftest import SPEED, STEP, STEPS
from hagfish_log import LogError
from sweep_columns import FIGURES, TEXTS
from tables import read_table, write_csv

INTERVAL = STEP * STEPS


def test_means_over_whole_windows(content, log):
    force = content.data["mean/forces/thigmotaxis"]
    force[:, 6] = np.arange(len(force))  # one hinge, more each interval
    found = means.read_means(log(), window=3 * INTERVAL)
    first = content.slide[1]
    assert list(found.force[:2, 0]) == [first + 1, first + 4]
    assert (found.start[0], found.end[0], len(found.end)) == (content.slide[0], first + 2, 20)
    assert np.all(found.total == 200)  # four multipliers of 50 dyn


def test_a_window_of_no_whole_number_of_frames_is_refused(log):
    with pytest.raises(LogError, match="do not make windows of 0.03 s"):
        means.read_means(log(), window=0.03)


def test_a_phase_that_never_came_has_no_means(log):
    none = means.read_means(log(), "reverse")
    assert none.total.size == 0 and np.isnan(means.effort_per_cm(log(), none))


def test_effort_is_force_over_time_per_way(content, log):
    """14 hinges of 100 dyn cm at a body of 41, two bodies to a hinge of each kind, at 5 cm/s."""
    own = means.read_means(log())
    assert means.effort(own) == pytest.approx(2 / 41 * 1400 * INTERVAL, rel=1e-12)
    assert means.effort_per_cm(log(), own) == pytest.approx(2 / 41 * 1400 / SPEED, rel=1e-9)
    assert means.effort_per_cm(log(), own, "tail") == pytest.approx(means.effort_per_cm(log(), own), rel=1e-9)


@pytest.mark.parametrize("changes, verdict", [
    ({}, "keep: the same motion to the last bit"), ({"cpu": 0.8}, "change: saves time"), ({"cpu": 1.2}, "keep: else it takes longer"),
    ({"failure": "the knot stayed on"}, "keep: else the knot stayed on"), ({"unmet": ["Eq. 6"]}, "keep: else the audit fails (Eq. 6)"),
    ({"penetration": 3.0}, "keep: else strands overlap more"), ({"penetration": 0.3}, "change: strands overlap less"),
    ({"force": 1.2}, "keep: else the sliding force is another"),
    ({"force": 0.94, "cpu": 2}, "keep: else the sliding force is another, and it takes longer"), ({"force": 1.01}, "keep: no difference that counts")])
def test_a_choice_is_kept_or_changed_for_what_it_does(changes, verdict):
    as_is = choices.Run("choice_as_is", cpu=1, failure="", unmet=[], penetration=1, slide=9, force=1)
    assert choices.verdict_of(dataclasses.replace(as_is, **changes), as_is) == verdict


def test_pareto_front():
    assert list(accuracy.pareto(np.array([3.0, 1, 2, 4]), np.array([1.0, 5, 6, 1]))) == [1, 0]


@pytest.mark.parametrize("status, words", [
    ("failed: body 7 is 0.31 cm past its limit at step 12 (t = 0.1 s)", "a body went past its limit"),
    ("failed: the script ended with a knot (overhand, 3_1), tied since 8.60 s, but expect.knot = 4_1 at step 6505", "the script ended with a knot (overhand, 3_1)"),
    ("complete", "")])
def test_why_a_run_failed(content, log, status, words):
    content.attributes["status"] = status
    assert slides.failure_of(log(), []) == words


def test_a_complete_run_may_have_failed(content, log):
    assert slides.failure_of(log(), ["knot held"]) == "the knot was lost early"
    content.data["trajectory/phase"][content.slide] = 1
    assert slides.failure_of(log(), []) == "the knot never slid"
    content.data["trajectory/phase"][:] = 0
    assert slides.failure_of(log(), []) == "the knot was never ready to tighten"


@pytest.fixture
def sweep(content, tmp_path):
    """A sweep of one run that fails the bound on penetration."""
    def write(unmet="penetration"):
        write_csv(tmp_path / "table.csv", ["cell", *TEXTS, *FIGURES], [[0, "ok", unmet, "", "3_1", "only grows", *[1.0] * len(FIGURES)]])
        (tmp_path / "logs").mkdir()
        content.write(tmp_path / "logs/0.h5")
        return slides.read_slides(tmp_path)
    return write


def test_a_slide_as_commanded_and_as_measured(sweep):
    (slide,) = sweep()
    assert (slide.knot, slide.commanded, slide.allowed) == ("3_1", 2.0, 0.0015)
    assert slide.speed == pytest.approx(SPEED, rel=1e-9)  # the knot outruns its command
    assert slide.travel == pytest.approx(6, rel=1e-9)
    assert slide.follows == pytest.approx(6, rel=1e-9) and slide.kind == "only grows"
    assert (slide.force, slide.peak, slide.capped, slide.slack, slide.met) == (200, 200, 0, 0, 1)
    assert not slide.failure and slide.seconds == pytest.approx(60 * STEP * STEPS)


def test_a_slide_of_a_knot_that_was_lost(sweep):
    (slide,) = sweep("knot held; unknot at end")
    assert slide.failure == "the knot was lost early"


def test_a_slide_at_its_cap_that_ends_in_failure(content, sweep):
    content.data["steps/thigmotaxis_lambda"][160:465] = 1000.0  # half of 610 sliding steps
    content.data["steps/eq6"][160:465] = 0
    content.attributes["status"] = "failed: tunnelled at step 7"
    (slide,) = sweep()
    assert (slide.capped, slide.met, slide.failure) == (0.5, 0.5, "tunnelled")


def test_pages_of_slides_have_their_tables(content, sweep, tmp_path, monkeypatch):
    content.attributes["scene"] = content.attributes["scene"].replace("[expect]", "[controller.reverse_head]\na = 3.0\n[expect]")
    sweep()
    speeds.main(tmp_path)
    (row,) = read_table(tmp_path / "tables/speeds.csv").rows
    assert row == ["3_1", "2", "5", "only grows", "200", "200", "100.0", "0", "0", "0", "complete"]
    assert not speeds.good(dict(zip(speeds.HEAD, row))) and speeds.good(dict(zip(speeds.HEAD, row)) | {speeds.SLIDE: speeds.BOTH_ENDS})
    shares = [audits.Finding(f"{way} of both ends", value, "70", "%", True) for way, value in (("slide", "93.1"), ("reverse", "42.1"))]
    monkeypatch.setattr(audits, "audit", lambda path: shares)
    reverse.main(tmp_path)  # of a run that never turned
    (row,) = read_table(tmp_path / "tables/reverse.csv").rows
    assert (*row[:3], row[5], row[-1]) == ("3_1", "3", "nan", "42", "untied at the tail")
