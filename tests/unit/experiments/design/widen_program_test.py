"""Strands of a program are pushed apart, by a sum whose gradient is the true one."""

import numpy as np
import pytest

import widen_program as widening

COUNT = 40


@pytest.fixture
def body():
    """40 bodies of 1 cm, 0.8 cm thick, on joints as the animal's."""
    names = [f"root_{k}" for k in range(6)]
    for b in range(1, COUNT):
        names += [f"j{b:02}_bend_y", f"j{b:02}_bend_z"] if b % 2 else [f"j{b:02}_twist"]
    limits = np.array([np.inf] * 6 + [0.01 if name.endswith("twist") else 1.2 for name in names[6:]])
    return widening.Body({"/model/length": np.ones(COUNT), "/model/radius": np.full(COUNT, 0.4),
                          "/model/dof_name": [name.encode() for name in names],
                          "/model/limit_lower": -limits, "/model/limit_upper": limits})


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
