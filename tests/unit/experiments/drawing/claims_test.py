"""The paper's three claims, judged on force fields of which the answer is known."""

import numpy as np
import pytest

import claims
from claim_row import MEASURES, judged, outcome_of
from conftest import KNOT, LAST_BODY, SPEED, STEP, STEPS, hinges_of
from hagfish_log import LogError

FORCES = ("forces/thigmotaxis", "mean/forces/thigmotaxis")


def verdicts(s):
    return claims.verdicts(claims.zero_behind(s), claims.larger_near_head(s), claims.smooth_in_space(s))


def test_zero_behind_the_knot(log):
    found = claims.zero_behind(claims.read_sliding(log()))
    assert found["nonzero_beyond_reach_of_rows"] == found["nonzero_behind_tail_end"] == 0
    assert found["values_beyond_reach_of_rows"] > 0
    assert found["steps"] == 60  # the first frame of the slide has no mean of its own


@pytest.mark.parametrize("beyond, agrees", [(2, "agrees"), (3, "disagrees")])
def test_a_row_reaches_two_bodies_and_no_further(content, log, beyond, agrees):
    joint = LAST_BODY + beyond
    dof = 6 + sum(2 if j % 2 else 1 for j in range(1, joint))
    content.data["forces/thigmotaxis"][content.slide[7], dof] = -1e-9
    s = claims.read_sliding(log())
    found = claims.zero_behind(s)
    assert found["nonzero_beyond_reach_of_rows"] == (agrees == "disagrees")
    assert found["nonzero_behind_tail_end"] == 1
    tail_end = 10 - 7 * SPEED * STEP * STEPS + KNOT
    assert found["furthest_nonzero_past_tail_end_cm"] == pytest.approx(joint - tail_end, rel=1e-9)
    assert verdicts(s)[claims.NAMES[0]] == agrees


def test_a_force_without_rows_is_not_zero_behind(content, log):
    content.data["thigmotaxis/body_b"][content.slide[20]] = -1
    assert verdicts(claims.read_sliding(log()))[claims.NAMES[0]] == "disagrees"


@pytest.mark.parametrize("slope, verdict", [(-50.0, "agrees"), (50.0, "disagrees")])
def test_force_that_is_a_line_over_the_way(content, log, slope, verdict):
    place = content.data["knot/head_end"][content.slide]
    size = 1000 + slope * (place - 4)  # dyn cm at 14 hinges
    for name in FORCES:
        content.data[name][content.slide, 6:20] = size[:, None]
    s = claims.read_sliding(log())
    found = claims.larger_near_head(s)["measures"]["sum of magnitudes, dyn cm"]
    assert found["spearman_with_head_end"] == pytest.approx(np.sign(slope), rel=1e-12)
    assert found["fit_slope_per_cm"] == pytest.approx(14 * slope, rel=1e-9)
    assert found["fit_r2"] == pytest.approx(1, rel=1e-9)
    assert verdicts(s)[claims.NAMES[1]] == verdict
    # The way goes from 9.9 to 4 cm; in a third are 20 means, whose mean is that of their middle.
    near, far = (1000 + slope * (middle - 4) for middle in (4.95, 8.95))
    assert found["near_over_far"] == pytest.approx(near / far, rel=1e-3)


def test_what_is_hardly_larger_is_undecided_and_so_are_runs_that_do_not_agree():
    assert [claims.grows(ratio) for ratio in (0.79, 1.0, 1.05, 1.1)] == ["disagrees", "disagrees", "undecided", "agrees"]
    assert claims.over_runs(["disagrees"] * 19 + ["agrees"]) == "disagrees"
    assert claims.over_runs(["disagrees"] * 15 + ["agrees"]) == "undecided"
    assert claims.over_runs([]) == ""


def test_ranks_share_ties_and_a_constant_has_no_correlation():
    assert list(claims.ranks(np.array([3.0, 1.0, 3.0, 2.0]))) == [2.5, 0, 2.5, 1]
    x = np.arange(9.0)
    assert claims.spearman(x, np.exp(x)) == pytest.approx(1, rel=1e-12)
    assert claims.spearman(x, np.ones(9)) == 0
    # 1 - 6 sum d^2 / (n (n^2 - 1)) for ranks without ties, d = 1, 1, 0, ...
    assert claims.spearman(x, np.array([1.0, 0, 2, 3, 4, 5, 6, 7, 8])) == pytest.approx(1 - 6 * 2 / (9 * 80), rel=1e-12)


@pytest.mark.parametrize("waves", [1, 4, 9])
def test_a_cosine_along_the_body_takes_its_own_modes(content, log, waves):
    """A DCT-II row with k half waves: k + 1 Fourier modes, one SVD mode."""
    for kind in claims.KINDS.values():
        own = hinges_of(kind)
        shape = np.cos(np.pi * waves * (2 * np.arange(own.size) + 1) / (2 * own.size))
        in_time = np.where(np.arange(content.slide.size) % 2, 1.0, -1.0)
        content.data["mean/forces/thigmotaxis"][np.ix_(content.slide, own)] = np.outer(in_time, shape)
    s = claims.read_sliding(log())
    for own in claims.smooth_in_space(s)["axes"].values():
        assert own["joints"] == 20
        assert (own["dct_modes_95"], own["dct_modes_99"], own["svd_modes_95"]) == (waves + 1, waves + 1, 1)
        assert own["roughness_in_time"] == pytest.approx(2, rel=1e-12)  # each mean is the last one's opposite
    assert verdicts(s)[claims.NAMES[3]] == ("agrees" if waves + 1 <= 20 / 4 else "disagrees")


def test_two_modes_by_their_share_of_the_energy(content, log):
    own = hinges_of("twist")
    basis = [np.cos(np.pi * k * (2 * np.arange(20) + 1) / 40) for k in (1, 7)]
    for share, modes in ((0.04, (2, 8)), (0.06, (8, 8)), (0.009, (2, 2))):
        shape = np.sqrt(1 - share) * basis[0] + np.sqrt(share) * basis[1]
        content.data["mean/forces/thigmotaxis"][np.ix_(content.slide, own)] = shape
        twist = claims.smooth_in_space(claims.read_sliding(log()))["axes"]["X"]
        assert (twist["dct_modes_95"], twist["dct_modes_99"]) == modes


def test_roughness_of_what_is_known():
    rough = lambda x: claims.roughness(np.asarray(x)[:, None], 0)
    assert rough(np.ones(50)) == 0
    assert rough((-1.0) ** np.arange(50)) == pytest.approx(2)
    # Over whole periods of a cosine, 1 - cos of the angle from one value to the next.
    assert rough(np.cos(2 * np.pi * np.arange(401) / 20)) == pytest.approx(1 - np.cos(2 * np.pi / 20), rel=1e-9)
    # White noise: 1, with a standard error of about 1 / sqrt(n).
    assert rough(np.random.default_rng(3).normal(size=40000)) == pytest.approx(1, abs=0.03)


@pytest.mark.parametrize("flicker, verdict", [(0.0, "disagrees"), (0.1, "disagrees"), (0.5, "agrees")])
def test_smooth_in_space_and_noisy_in_time(content, log, flicker, verdict):
    """Half a wave along the body, of roughness 0.0137, that flickers from mean to mean by so much: 2 a^2 / (1 + a^2), less than
    that, up to twice that, or more."""
    for kind in claims.KINDS.values():
        own = hinges_of(kind)
        shape = np.cos(np.pi * (2 * np.arange(own.size) + 1) / (2 * own.size))
        in_time = 1 + flicker * (-1.0) ** np.arange(content.slide.size)
        content.data["mean/forces/thigmotaxis"][np.ix_(content.slide, own)] = np.outer(in_time, shape)
    s = claims.read_sliding(log())
    own = claims.smooth_in_space(s)["axes"]["X"]
    assert own["roughness_in_space"] == pytest.approx(
        20 * np.sin(np.pi / 40)**2 / (10 - np.cos(np.pi / 40)**2), rel=1e-9)
    assert own["roughness_in_time"] == pytest.approx(2 * flicker**2 / (1 + flicker**2), rel=1e-9)
    assert verdicts(s)[claims.NAMES[2]] == verdict


def test_too_short_a_slide_is_refused(content, log):
    content.data["trajectory/phase"][content.slide[claims.LEAST_FRAMES]:] = 3
    with pytest.raises(LogError, match="11 sliding frames"):
        claims.read_sliding(log())


def test_means_are_finite_though_the_first_frame_has_none(log):
    s = claims.read_sliding(log())
    assert np.all(np.isfinite(s.force)) and np.all(np.isfinite(s.lambdas))
    assert s.step_lambdas.shape == (60 * STEPS, 4) and np.all(s.step_lambdas == 50)


def test_what_a_run_came_to(content, log):
    assert outcome_of(log()) == "slid"
    content.data["knot/head_end"][content.slide] += 1  # hops over the last centimetre
    assert outcome_of(log()) == "slid"
    content.data["trajectory/phase"][content.slide[0]:] = 2  # --until slide
    assert outcome_of(log()) == "slid"
    last = content.data["trajectory/time"][-1]
    content.attributes["scene"] = content.attributes["scene"].replace("duration = 3.0", f"duration = {last + 0.02:.2f}")
    assert outcome_of(log()) == "jammed"
    content.attributes["status"] = "failed: tunnelled"
    assert outcome_of(log()) == "stopped"
    content.attributes["status"] = "complete"
    content.data["trajectory/phase"][content.slide[0]:] = 1
    assert outcome_of(log()) == "not tight"
    content.data["trajectory/phase"][:] = 0
    assert outcome_of(log()) == "not tied"


def test_a_slide_that_can_be_judged_has_its_measures_and_verdicts(content, log):
    found = judged(log())
    assert found.keys() == {"outcome", *MEASURES, *claims.NAMES} and found["outcome"] == "slid"
    assert found["slide_cm"] == pytest.approx(5.9) and found["near_over_far"] == pytest.approx(1)
    content.data["trajectory/phase"][content.slide[claims.LEAST_FRAMES]:] = 3
    assert judged(log()) == {"outcome": "hardly slid"}
