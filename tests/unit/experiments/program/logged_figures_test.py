"""Datasets of a log by name, against other datasets and formulas of this file: an exchanged column is another number here, though a run
made again would have it exchanged, too."""

from __future__ import annotations

import sys
from pathlib import Path

import h5py
import numpy as np
import pytest

sys.dont_write_bytecode = True
sys.path.insert(0, str(Path(__file__).parents[4] / "tests/support"))

from program import hagfish, table  # noqa: E402

FORM, SLIDE, PULL = 0, 2, 6  # of /trajectory/phase
ROOT = 6  # velocities


@pytest.fixture(scope="module")
def log(tmp_path_factory):
    folder = tmp_path_factory.mktemp("figures")
    hagfish(folder, "run", "pull_overhand", "--quiet", "--set", "time.step=0.005", "--set", "time.frame_interval=0.02", "--set", "food.average=0.02",
            "--set", "food.hold=1", "--set", "knot.votes=5", "--out", "a.h5")
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
    wanted = {"force": -head[:, 0], "plate": wall[:, 0], "torque": torque, "advantage_rows": divided(-head[:, 0], rows.sum(axis=1)),
              "advantage_torque": divided(-head[:, 0], torque)}
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
    works = {name: log[f"/diagnostics/{name}"][()] for name in ("work_tip", "work_active", "work_thigmotaxis", "work_head", "dissipated", "impact_loss")}
    form = log["/trajectory/phase"][()] == FORM
    assert not works["work_active"].any()  # a towed body has no muscles
    assert np.ptp(works["work_tip"][form]) > 0 and not np.ptp(works["work_tip"][~form][1:])  # the tip is pulled while the knot forms
    assert not works["work_thigmotaxis"][form].any() and works["work_thigmotaxis"][-1] > 0
    assert (np.diff(works["dissipated"]) >= 0).all() and works["dissipated"][-1] > works["impact_loss"][-1] > 0


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
    hagfish(tmp_path, "run", "living_overhand_free", "--quiet", "--set", "time.duration=3", "--set", "expect.types=[]", "--out", "b.h5")
    with h5py.File(tmp_path / "b.h5") as file:
        q, rest, torque = (file[path][50:-1] for path in ("/trajectory/q", "/trajectory/q_ref", "/forces/active"))
    assert not rest[:, :ROOT].any() and not torque[:, :ROOT].any()
    assert np.corrcoef(rest[:, ROOT:].ravel(), q[:, ROOT + 1:].ravel())[0, 1] > 0.9  # which the body follows


def turned(axis: np.ndarray, angle: np.ndarray, vector: np.ndarray) -> np.ndarray:
    """Vectors turned about unit axes (Rodrigues)."""
    along = (axis * vector).sum(axis=-1, keepdims=True) * axis
    return along + np.cos(angle)[..., None] * (vector - along) + np.sin(angle)[..., None] * np.cross(axis, vector)


def frames_along(q: np.ndarray, names: list[str]) -> tuple[np.ndarray, dict[int, np.ndarray]]:
    """Axes of each body in world (bodies x 3 x 3, rows X, Y, Z), and of each hinge; both up to the root's turn."""
    body, bodies, hinges = np.eye(3), [np.eye(3)], {}
    for dof, name in enumerate(names[ROOT:], ROOT):
        joint = int(name[1:3])
        if joint == len(bodies):
            bodies.append(body)
        axis = bodies[joint][{"twist": 0, "bend_y": 1, "bend_z": 2}[name[4:]]]
        hinges[dof] = axis
        body = turned(axis, np.full(3, q[dof + 1]), bodies[joint])
        bodies[joint] = body
    return np.array(bodies), hinges


@pytest.mark.parametrize("rule", ["euler", "midpoint"])
def test_moments_have_the_torques_of_hinges_as_their_parts(tmp_path, rule):
    hagfish(tmp_path, "run", "living_overhand", "--quiet", "--set", "time.step=0.01", "--set", "time.frame_interval=0.01", "--set", "knot.votes=5",
            "--set", f"time.rule={rule}", "--set", "expect.types=[]", "--out", "a.h5")
    seen = set()
    with h5py.File(tmp_path / "a.h5") as log:
        names, q = list(log["/model/dof_name"].asstr()[()]), log["/trajectory/q"][()]
        count = len(log["/model/length"])
        acts = lambda kind: np.flatnonzero(np.nan_to_num(log[f"/mean/forces/{kind}"][:, ROOT:]).any(axis=1))
        for frame in [*acts("thigmotaxis")[::67], *acts("wall")]:
            where = q[frame - 1].copy()  # a frame's mean is of the step before it
            bodies = frames_along(where, names)[0]
            bend = log["/trajectory/curvature"][frame - 1] * [[2 * log["/model/length"][0]]]  # of joints amidst others
            cosine = 1 + 2 * np.cos(np.linalg.norm(bend, axis=1))
            trace = np.einsum("jkx,jkx->j", bodies[:-1], bodies[1:])
            np.testing.assert_allclose(cosine[3:count - 3], trace[2:count - 4], atol=1e-6)
            if rule == "midpoint":  # whose equations hold in the middle of the step
                where[ROOT + 1:] += 0.005 * log["/midway/moved"][frame - 1, ROOT:]
            bodies, hinges = frames_along(where, names)
            halfway = [np.linalg.svd(before.T + behind.T) for before, behind in zip(bodies, bodies[1:])]
            axes = np.concatenate([np.eye(3)[None], [u @ v for u, _, v in halfway]])  # the rotation nearest to the mean, to world
            for kind in ("thigmotaxis", "contact", "limit", "wall", "active"):
                moment = np.einsum("jkx,jx->jk", axes, log[f"/mean/moments/{kind}"][frame])
                torque = log[f"/mean/forces/{kind}"][frame]
                own = np.array([hinges[dof] @ moment[int(names[dof][1:3])] for dof in range(ROOT, len(names))])
                np.testing.assert_allclose(own, torque[ROOT:], rtol=0, atol=3e-6 * np.abs(moment).max(), err_msg=f"{kind}, {frame}")
                seen |= {kind} if moment.any() else set()
    assert seen >= {"thigmotaxis", "contact", "limit", "active"} | ({"wall"} if rule == "euler" else set())
