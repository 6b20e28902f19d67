"""The pull of a log: the spline's weights, the rope estimate and forces along a body that is bent by hand."""

from pathlib import Path

import numpy as np
import pytest

import pulls

BODIES = 40


def hairpin() -> np.ndarray:
    """Centres 1 cm apart: out along +x, round a half circle, and back."""
    out = np.stack([np.arange(15.0), np.zeros(15), np.zeros(15)], axis=1)
    radius = 10 / np.pi
    angle = (np.arange(10) + 0.5) / 10 * np.pi - np.pi / 2
    bend = np.stack([14.5 + radius * np.cos(angle), radius + radius * np.sin(angle), np.zeros(10)], axis=1)
    back = np.stack([14.0 - np.arange(15.0), np.full(15, 2 * radius), np.zeros(15)], axis=1)
    return np.concatenate([out, bend, back])


class Log:
    """Three frames of the pull, the last two of which are settled: pushed on at bodies 5 and 34, which lie opposite, and
    held by the head plate at the bight."""

    path = Path("by hand")
    law = "paper"

    def __init__(self) -> None:
        frames = 3
        four = np.tile([0.5e5, 0.25e5, 0.0, 0.0], (frames, 1))
        strand = lambda s: np.tile([s, np.nan], (frames, 1))
        self.datasets = {
            "/trajectory/time": 0.02 * np.arange(frames), "/trajectory/position": np.tile(hairpin(), (frames, 1, 1)),
            "/thigmotaxis/spline_a": strand(5.0), "/thigmotaxis/spline_b": strand(34.0), "/thigmotaxis/lambda": four,
            "/pull/force": np.array([np.nan, 1.5e5, 1.5e5]),
            "/pull/plate": np.array([np.nan, 1.5e5, 1.5e5]), "/pull/torque": np.full(frames, 2e5), "/model/length": np.ones(BODIES),
            "/contacts/frame": np.array([0, 1, 2, 2]), "/contacts/spline_a": np.array([20.0, 19.5, 19.5, 4.0]),
            "/contacts/spline_b": np.array([np.nan, np.nan, np.nan, 35.0]),
            "/contacts/force": np.array([9e5, 1.5e5, 1.5e5, 0.2e5])}

    def __getitem__(self, path: str) -> np.ndarray:
        return self.datasets[path]

    def intervals_in(self, phase: str) -> np.ndarray:
        return np.array([1, 2]) if phase == "pull" else np.array([], dtype=int)

    def scene(self) -> dict[str, dict[str, float]]:
        return {"expect": {"pull_settled": 0.0}, "food": {"cap": {"to": 5e4}}, "controller": {"law": self.law}}


def test_weights_are_those_of_the_spline() -> None:
    rng = np.random.default_rng(1)
    position = rng.normal(size=(9, 3))
    parameter = np.array([0.0, 0.3, 1.0, 4.6, 7.2, 8.0])
    point, slope = pulls.weights(parameter, 9)
    assert point.sum(axis=1) == pytest.approx(1)
    assert slope.sum(axis=1) == pytest.approx(0, abs=1e-14)
    whole = parameter == np.floor(parameter)
    assert point[whole] @ position == pytest.approx(position[parameter[whole].astype(int)])
    step = 1e-6
    inside = np.array([0.3, 4.6, 7.2])
    ahead, behind = (pulls.weights(inside + sign * step, 9)[0] for sign in (1, -1))
    assert (ahead - behind) / (2 * step) == pytest.approx(pulls.weights(inside, 9)[1], abs=1e-8)


def test_a_hairpin_is_a_pulley() -> None:
    pull = pulls.read_pull(Log())
    assert pull.mean == 1.5
    assert pull.rows == pytest.approx(0.75)
    assert pull.estimate == pytest.approx(1.5)  # opposite strands: twice
    assert pull.torque.mean() == 2


def test_rows_of_all_contacts_are_those_of_their_list() -> None:
    log = Log()
    log.law = "all_contacts"
    log.datasets |= {"/eq6/frame": np.array([0, 1, 1, 2, 2]), "/eq6/along": np.array([0, 0, 1, 0, 1]),
                     "/eq6/spline_a": np.full(5, 5.0), "/eq6/spline_b": np.full(5, 34.0), "/eq6/lambda": np.array([9, 0.5, 0.25, 0.5, 0.25]) * 1e5}
    for key in ("/thigmotaxis/spline_a", "/thigmotaxis/spline_b", "/thigmotaxis/lambda"):
        del log.datasets[key]
    assert pulls.read_pull(log).estimate == pytest.approx(1.5)
    assert pulls.read_strand(log).thigmotaxis == pytest.approx(pulls.read_strand(Log()).thigmotaxis)


def test_a_pull_is_shown_by_the_second() -> None:
    time = np.arange(0.0, 2.51, 0.1)
    at, force = pulls.Pull(time, np.floor(time + 1e-9), *[time] * 4, 1).over(1)
    assert (list(at), list(force)) == ([0.5, 1.5], [0, 1])


def test_tension_is_all_that_pulls_behind() -> None:
    strand = pulls.read_strand(Log())
    # What pushes one strand back pushes the other one on: both to the tail.
    assert strand.thigmotaxis.sum() == pytest.approx(1.5)
    assert strand.thigmotaxis[5] == pytest.approx(0.75) and strand.thigmotaxis[34] == pytest.approx(0.75)
    # Without friction what turns the strand does no work where it slips along itself; the middle of the bight is across.
    assert [strand.work[key] for key in ("rows", "contacts", "plate")] == pytest.approx([1.5, 0, 0], abs=1e-6)
    assert strand.tension[0] == pytest.approx(1.5)
    assert strand.tension[8] == pytest.approx(0.75)  # and so is it on the way back, but for the plate
    assert strand.tension[28] == pytest.approx(0.75)
    assert strand.tension[36] == pytest.approx(0)
    assert strand.plate.sum() == pytest.approx(1.5)
    assert strand.contact[4] == strand.contact[35] == pytest.approx(0.1)  # at one of two frames


def test_a_run_that_never_pulled_has_none() -> None:
    log = Log()
    log.intervals_in = lambda phase: np.array([], dtype=int)
    assert np.isnan(pulls.read_pull(log).mean)
    with pytest.raises(pulls.LogError, match="by hand"):
        pulls.read_strand(log)
