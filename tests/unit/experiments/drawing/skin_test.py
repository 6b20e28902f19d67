"""The place of a knot and what it wiped, on a made-up log: a strand that lies on another."""

import numpy as np
import pytest

import skin

BODIES, LENGTH, RADIUS = 100, 40.0, 0.5


class FoldedLog:
    """A straight strand that turns back and lies beside itself from 5 cm on, 2 `RADIUS` and a hundredth of a cm away."""

    def __init__(self):
        arc = (np.arange(BODIES) + 0.5) * LENGTH / BODIES
        turn = 20.0
        x = np.where(arc < turn, arc, 2 * turn - arc)
        y = np.where(arc < turn, 0.0, 2 * RADIUS + 0.01) + np.where(x < 5, 1.0 * (arc > turn), 0.0)
        self.data = {"/trajectory/position": np.stack([x, y, np.zeros(BODIES)], axis=1)[None], "/model/length": np.full(BODIES, LENGTH / BODIES),
                     "/model/radius": np.full(BODIES, RADIUS)}

    def __getitem__(self, path):
        return self.data[path]

    def scene(self):
        return {"contact": {"least_arc": 2.0}}


def test_the_place_of_a_knot_is_where_skin_first_touches_skin():
    assert skin.knot_place(FoldedLog(), np.array([0]))[0] == pytest.approx(5.0, abs=LENGTH / BODIES)


def test_a_place_passes_an_arc_between_frames():
    time, place = np.array([0.0, 1.0, 2.0]), np.array([10.0, 8.0, 4.0])
    assert skin.passed(time, place, 9.0) == pytest.approx(0.5)
    assert skin.passed(time, place, 5.0) == pytest.approx(1.75)
    assert np.isnan(skin.passed(time, place, 1.0))
    assert np.isnan(skin.passed(time, place, 11.0))
