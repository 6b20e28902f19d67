"""Datasets of a log by name, against other datasets and formulas of this file: an exchanged column is another number
here, though a run made again would have it exchanged, too."""

import h5py
import numpy as np
import pytest

from animal import axes_along
from program import logged, sets

FORM, SLIDE, PULL = 0, 2, 6  # of /trajectory/phase
ROOT = 6  # velocities


@pytest.fixture(scope="module")
def log(tmp_path_factory):
    settings = sets("time.step=0.005", "time.frame_interval=0.02", "food.average=0.02", "food.hold=1", "knot.votes=5")
    folder = tmp_path_factory.mktemp("figures")
    logged(folder, "pull_overhand", *settings)
    with h5py.File(folder / "a.h5") as file:
        yield file


def test_pull_is_of_the_means(log):
    head, wall, rows = (log[f"/mean/{name}"][()] for name in ("forces/head", "forces/wall", "thigmotaxis/lambda"))
    torque = np.abs((log["/mean/forces/active"][()] + log["/mean/forces/thigmotaxis"][()])[:, ROOT:]).max(axis=1)
    phase = log["/trajectory/phase"][()]
    pulls = np.append(False, (phase[:-1] == PULL) & (phase[1:] == PULL))
    bears = pulls & (wall[:, 0] > 0)
    assert bears.sum() > 20
    divided = lambda a, b: np.divide(a, b, out=np.full(len(a), np.nan), where=b > 0)
    pull = -head[:, 0]
    wanted = {"force": pull, "plate": wall[:, 0], "torque": torque, "advantage_rows": divided(pull, rows.sum(axis=1)),
              "advantage_torque": divided(pull, torque)}
    for name, values in wanted.items():
        np.testing.assert_allclose(log[f"/pull/{name}"][pulls], values[pulls], rtol=1e-12, err_msg=name)
        assert np.isnan(log[f"/pull/{name}"][~pulls]).all(), name
    point = np.column_stack([-wall[bears, 5], wall[bears, 4]]) / wall[bears, :1]
    np.testing.assert_allclose(log["/pull/bearing"][bears], point, rtol=1e-12)


def test_energy_and_momentum_are_those_of_the_motion(log):
    time, place, mass = log["/trajectory/time"][()], log["/trajectory/position"][()], log["/model/mass"][()]
    velocity = (place[2:] - place[:-2]) / (time[2:] - time[:-2])[:, None, None]
    likeness = lambda name, own: np.corrcoef(log[f"/diagnostics/{name}"][1:-1].ravel(), own.ravel())[0, 1]
    assert likeness("kinetic_energy", 0.5 * (mass * (velocity**2).sum(axis=2)).sum(axis=1)) > 0.9
    assert likeness("momentum", np.einsum("b,fbk->fk", mass, velocity)) > 0.9
    arm = place[1:-1] - (np.einsum("b,fbk->fk", mass, place[1:-1]) / mass.sum())[:, None]
    assert likeness("angular_momentum", np.einsum("b,fbk->fk", mass, np.cross(arm, velocity))) > 0.9
    assert likeness("elastic_energy", (log["/trajectory/q"][1:-1, ROOT + 1:] ** 2).sum(axis=1)) > 0.9
    assert not log["/diagnostics/gravity_energy"][()].any()


def test_works_are_of_what_acts(log):
    tip, active, thigmotaxis = (log[f"/diagnostics/work_{name}"][()] for name in ("tip", "active", "thigmotaxis"))
    dissipated, impacts = (log[f"/diagnostics/{name}"][()] for name in ("dissipated", "impact_loss"))
    form = log["/trajectory/phase"][()] == FORM
    assert not active.any()  # a towed body has no muscles
    assert np.ptp(tip[form]) > 0 and not np.ptp(tip[~form][1:])  # the tip is pulled while the knot forms
    assert not thigmotaxis[form].any() and thigmotaxis[-1] > 0
    assert (np.diff(dissipated) >= 0).all() and dissipated[-1] > impacts[-1] > 0


def test_worst_figures_are_of_the_steps_since_the_frame_before(log):
    step = log["/trajectory/step"][()]
    for name in ("penetration", "limit_violation"):
        of_steps, of_frames = log[f"/steps/{name}"][()], log[f"/diagnostics/{name}"][()]
        own = [of_steps[a + 1:b + 1].max() for a, b in zip(step[:-2], step[1:-1])]
        np.testing.assert_array_equal(of_frames[1:-1], own, err_msg=name)


def test_the_knot_is_a_trefoil_with_its_head_end_first(log):
    slides = log["/trajectory/phase"][()] == SLIDE
    assert (log["/knot/determinant"][slides] == 3).all() and (log["/knot/v2"][slides] == 1).all()
    assert (log["/knot/agreement"][slides] > 0.5).all() and (log["/knot/agreement"][slides] <= 1).all()
    assert (log["/knot/head_end"][()] < log["/knot/tail_end"][()])[slides].all()


def test_spline_places_name_their_bodies(log):
    for end in "ab":
        place, body = log[f"/thigmotaxis/spline_{end}"][()], log[f"/thigmotaxis/body_{end}"][()]
        there = body >= 0
        assert there.any() and (np.abs(place - body)[there] <= 0.5 + 1e-9).all()
    assert not log["/forces/tip"][log["/trajectory/phase"][()] == PULL].any()


def test_muscles_hold_on_to_nothing_and_the_body_follows_the_rest_shape(tmp_path):
    log = logged(tmp_path, "living_overhand_free", *sets("time.duration=3", "expect.types=[]"))
    with h5py.File(log) as file:
        q, rest, torque = (file[path][50:-1] for path in ("/trajectory/q", "/trajectory/q_ref", "/forces/active"))
    assert not rest[:, :ROOT].any() and not torque[:, :ROOT].any()
    assert np.corrcoef(rest[:, ROOT:].ravel(), q[:, ROOT + 1:].ravel())[0, 1] > 0.9  # which the body follows


@pytest.mark.parametrize("rule", ["euler", "midpoint"])
def test_moments_have_the_torques_of_hinges_as_their_parts(tmp_path, rule):
    h = 0.01 if rule == "euler" else 0.005  # s; at 10 ms some starts of the midpoint rule are too fast as the knot comes off
    each_step = sets(f"time.step={h}", f"time.frame_interval={h}")
    settings = [*each_step, *sets("knot.votes=5", f"time.rule={rule}", "expect.types=[]")]
    seen = set()
    with h5py.File(logged(tmp_path, "living_overhand", *settings)) as log:
        names, q = list(log["/model/dof_name"].asstr()[ROOT:]), log["/trajectory/q"][()]
        joint, length = [int(name[1:3]) for name in names], log["/model/length"][()]
        acts = lambda kind: np.flatnonzero(np.nan_to_num(log[f"/mean/forces/{kind}"][:, ROOT:]).any(axis=1))
        for frame in [*acts("thigmotaxis")[::67], *acts("wall")]:
            angles = q[frame - 1, ROOT + 1:]  # a frame's mean is of the step before it
            bodies, _ = axes_along(angles, names)
            bend = log["/trajectory/curvature"][frame - 1] * 2 * length[0]  # of joints amidst others
            trace = np.einsum("jkx,jkx->j", bodies[:-1], bodies[1:])
            np.testing.assert_allclose((1 + 2 * np.cos(np.linalg.norm(bend, axis=1)))[3:-3], trace[2:-3], atol=1e-6)
            if rule == "midpoint":  # whose equations hold in the middle of the step
                angles = angles + 0.5 * h * log["/midway/moved"][frame - 1, ROOT:]
            bodies, hinges = axes_along(angles, names)
            halfway = [np.linalg.svd(before.T + behind.T) for before, behind in zip(bodies, bodies[1:])]
            axes = np.concatenate([np.eye(3)[None], [u @ v for u, _, v in halfway]])  # the rotation nearest to the mean
            for kind in ("thigmotaxis", "contact", "limit", "wall", "active"):
                moment = np.einsum("jkx,jx->jk", axes, log[f"/mean/moments/{kind}"][frame])
                torque, most = log[f"/mean/forces/{kind}"][frame, ROOT:], np.abs(moment).max()
                own = (hinges * moment[joint]).sum(axis=1)
                np.testing.assert_allclose(own, torque, rtol=0, atol=3e-6 * most, err_msg=f"{kind}, {frame}")
                seen |= {kind} if most else set()
    assert seen >= {"thigmotaxis", "contact", "limit", "active"} | ({"wall"} if rule == "euler" else set())
