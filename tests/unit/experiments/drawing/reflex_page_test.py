"""What a law asks of the muscles to slide the knot."""

import numpy as np
import pytest

import conftest
import reflex_runs


def test_torque_beyond_the_springs_is_a_mean_as_they_are(content, log, monkeypatch):
    """A body that unbends evenly, whose muscles do what its springs do and a little more."""
    stiff, more, apart = 2e5, 7.0, 2 * conftest.LENGTH / conftest.BODIES
    content.attributes["scene"] += f"[specimen.passive]\nbending_stiffness = [{stiff}]\ntwist_stiffness = [{stiff}]\n"
    angles = np.linspace(0.3, 0.1, len(content.data["trajectory/time"]))[:, None] * np.ones(len(conftest.dof_names()) + 1)
    spring = angles[:, 1:] * stiff / apart
    content.data["trajectory/q"] = angles
    content.data["mean/forces/active"] = np.vstack([spring[:1], (spring[1:] + spring[:-1]) / 2]) + more
    content.data["mean/moments/active"] = np.zeros((len(angles), conftest.BODIES, 3))
    content.data["mean/moments/thigmotaxis"] = np.zeros((len(angles), conftest.BODIES, 3))
    assert reflex_runs.asked_torques(log(), np.array([5, 20])) == pytest.approx(more)
