"""Strands of a program are pushed apart, by a sum whose gradient is the true one."""

import numpy as np
import pytest

import widen_program as widening

COUNT = 40


class Log(dict):
    """40 bodies of 1 cm, 0.8 cm thick, on joints as the animal's."""

    def __init__(self):
        hinges = [(b, kind) for b in range(1, COUNT) for kind in (("bend_y", "bend_z") if b % 2 else ("twist",))]
        self.joint, self.kind = (np.array(each) for each in zip(*hinges))
        limits = np.append([np.inf] * 6, np.where(self.kind == "twist", 0.01, 1.2))
        super().__init__({"/model/length": np.ones(COUNT), "/model/radius": np.full(COUNT, 0.4),
                          "/model/limit_lower": -limits, "/model/limit_upper": limits})

    def hinges(self):
        return 6 + np.arange(self.joint.size), self.joint, self.kind


@pytest.fixture
def body():
    return widening.Body(Log())


@pytest.fixture
def overlap(body):
    """The body bends more and more until it is a flat coil, which overlaps itself."""
    times, stations = np.linspace(0, 6, 4), np.linspace(0, 1, 6)
    program = np.zeros((4, 6, 3))
    program[:, :, 1] = times[:, None] * np.linspace(1.5, 2.5, 6)
    program[:, :, 0] = 0.05 * times[:, None]
    program[:, :, 2] = 0.02
    return widening.Overlap(body, times, stations, program, [[36, 5.5]])


def test_the_gradient_is_that_of_differences(overlap):
    overlap.thicker = 2.5
    x = overlap.program.ravel() + np.random.default_rng(1).normal(size=overlap.program.size) * 0.3
    _, gradient, deepest = overlap(x)
    assert deepest > 0.3
    for k in np.argsort(-np.abs(gradient))[::9]:
        step = np.zeros_like(x)
        step[k] = 1e-5
        difference = (overlap(x + step)[0] - overlap(x - step)[0]) / 2e-5
        assert difference == pytest.approx(gradient[k], rel=1e-5, abs=1e-5 * np.abs(gradient).max())


def test_strands_come_apart_within_the_limits(overlap):
    overlap.thicker = 1.12
    before = overlap(overlap.program.ravel())[2]
    values = widening.widen(overlap, 1.12).ravel()
    assert before > 0.2
    assert overlap(values)[2] < widening.ENOUGH
    assert (np.abs(overlap.angles(values)) <= 1.02 * overlap.limit).all()
