"""How slides are compared at equal places, and how turns add up, by hand."""

import numpy as np

import forces


def test_moments_of_a_slower_slide_are_the_same_at_equal_places():
    fast, slow = np.array([9.0, 7.0, 5.0]), np.array([10.0, 9.0, 9.0, 8.0, 7.0, 6.0, 5.0])
    one, other = (forces.Slide(4, 1, 1, place[:, None] * [1, 2], place) for place in (fast, slow))
    found = forces.differences(one, other)
    assert found["place"] < 1e-12 < 5 < found["time"]
    assert np.isclose(found["mean"], 100 * (1 - 7 / slow.mean())) and found["way"] == 0


def test_a_comparison_names_knots_that_do_not_slide_by_both_ends():
    slides = {(run, "towed", knot): forces.Slide(1, 1, 1, np.zeros(1), np.zeros(1), run + knot != "a5_2") for run in "ab" for knot in forces.plots.KNOTS}
    assert [forces.named(slides, pairs, "towed") for pairs in ([("b", "a")], [("b", "b")])] == ["towed (5_2: not by both ends)", "towed"]


def test_turns_err_by_the_first_order_and_joint_by_joint_by_the_second():
    first, second = ([forces.turns_off(bodies, in_turn) for bodies in (50, 100)] for in_turn in (False, True))
    assert np.isclose(first[0] / first[1], 2, rtol=0.05) and np.isclose(second[0] / second[1], 4, rtol=0.05)
    h = forces.LENGTH / 100
    assert np.isclose(forces.inside(100), 5 / 24 * h**2 / forces.RADIUS, rtol=0.01)
