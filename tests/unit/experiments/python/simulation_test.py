"""Runs in Python: the same as the program's, arrays that show the present, errors by the same line."""

import re

import hagfish
import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from program import different, logged

FAST = {"time.step": 0.01}


def test_a_run_is_that_of_the_program(tmp_path, findings):
    with hagfish.Simulation("table1", set={"time.step": 0.005, "wall.neck": "0.07 L"}, log=tmp_path / "a.h5") as sim:
        sim.run(until=2.0)  # in parts of each kind
        sim.run(until=lambda s: s.knot == "3_1")
        sim.run(until="tighten")
        while not sim.finished:
            sim.step()
    logged(tmp_path, "table1", "--set", "time.step=0.005", "--set", "wall.neck=0.07 L", out="b.h5")
    assert different(tmp_path / "a.h5", tmp_path / "b.h5") == []
    with hagfish.Log(tmp_path / "a.h5") as a, hagfish.Log(tmp_path / "b.h5") as b:
        assert a.attribute("scene") == b.attribute("scene")
        assert a.status == b.status == "complete"
    found = findings(tmp_path / "b.h5")
    told = [float(found[name]["value"]) for name in ("slide", "slide of both ends")]
    assert sim.slide["name"] == "slides by both ends"
    by_step = [sim.slide["leading_way"], 100 * sim.slide["share"]]
    assert by_step == pytest.approx(told, rel=5e-3)  # by frame


def test_arrays_are_views_that_show_the_present(tmp_path):
    log = tmp_path / "views.h5"
    with hagfish.Simulation("table1", set=FAST, log=log) as sim:
        q, qdot, position, force = sim.q, sim.qdot, sim.position, sim.forces
        assert [a.shape for a in (q, qdot, position)] == [(sim.nq,), (sim.nv,), (sim.bodies, 3)]
        assert not any(a.flags.owndata or a.flags.writeable for a in (q, qdot, position, *force.values()))
        places = [a.ctypes.data for a in (q, qdot, position, force["active"], force["thigmotaxis"])]
        seen = []
        for _ in range(6):
            seen.append((q.copy(), qdot.copy(), position.copy()))
            sim.step()
            assert_array_equal(sim.q, q)
            now = (sim.q, sim.qdot, sim.position, sim.forces["active"], sim.forces["thigmotaxis"])
            assert [a.ctypes.data for a in now] == places
        seen.append((q.copy(), qdot.copy(), position.copy()))
        tip = sim.forces["tip"].copy()
        with pytest.raises(ValueError, match="read-only"):
            q[0] = 1
    frames = hagfish.Log(log)
    assert_array_equal(frames["trajectory/q"], [s[0] for s in seen[::2]])  # frames are two steps apart, to the end
    assert_array_equal(frames["trajectory/qdot"], [s[1] for s in seen[::2]])
    assert_array_equal(frames["trajectory/position"], [s[2] for s in seen[::2]])
    assert tip.any()


def test_a_view_outlives_the_name_of_its_simulation():
    sim = hagfish.Simulation("table1", set=FAST)
    q = sim.q
    rest = q.copy()
    del sim
    assert_array_equal(q, rest)


def test_the_knot_its_ends_and_contacts(tied):
    assert (tied.phase, tied.knot) == ("slide", "3_1")
    first, last = tied.first_contact.arc_a, tied.last_contact.arc_b  # cm; the ends are means over patches
    assert first < tied.head_end < first + 2 < last - 2 < tied.tail_end < last
    assert len(tied.contacts) > 3
    for contact in tied.contacts:
        a, b = (tied.position[round(s)] for s in (contact.spline_a, contact.spline_b))
        assert (contact.body_a, contact.body_b) == (int(contact.spline_a + 0.5), int(contact.spline_b + 0.5))
        assert (a - b) @ contact.normal > 0.9 * np.linalg.norm(a - b)
        assert np.linalg.norm(contact.tangent_a) == pytest.approx(1)


def test_copies_go_on_independently_and_alike(tied):
    before = tied.q.copy()
    one, two = tied.copy(), tied.copy()
    one.run(until=tied.time + 0.1)
    assert_array_equal(tied.q, before)
    two.run(until=tied.time + 0.1)
    assert_array_equal(one.q, two.q)


def test_the_energy_ledger_closes(tied):
    e = tied.energy
    works = sum(value for name, value in e.items() if name.startswith("work_"))
    held, lost = e["kinetic"] + e["elastic"] + e["gravity"], e["dissipated"] + e["impact_loss"]
    assert abs(held + lost - works - e["integrator_error"]) < 1e-9 * e["dissipated"]


def test_bad_input_is_told_in_the_programs_line(tmp_path, refusal):
    for key, value in (("time.step", -1), ("time.stp", 0.01), ("controller.law", "mine")):
        with pytest.raises(hagfish.InputError) as raised:
            hagfish.Simulation("table1", set={key: value})
        assert str(raised.value) == refusal(tmp_path, "run", "table1", "--set", f"{key}={value}", "--out", "none.h5")
    assert {"paper", "muscles", "own"} < hagfish.laws.keys()
    assert all(f'"{law}"' in str(raised.value) and about for law, about in hagfish.laws.items())
    with pytest.raises(hagfish.InputError) as raised:
        hagfish.Simulation("tabel1")
    assert str(raised.value) == refusal(tmp_path, "run", "tabel1")
    log = tmp_path / "there.h5"
    log.write_text("not to be replaced")
    with pytest.raises(hagfish.FileError) as raised:
        hagfish.Simulation("table1", log=log)
    assert str(raised.value) == refusal(tmp_path, "run", "table1", "--out", log)
    with pytest.raises(ValueError, match="until = knot: form"):
        hagfish.Simulation("table1").run(until="knot")


def test_settings_are_sequences_of_any_kind_to_the_last_bit(tied):
    assert tied.q[20] != float(f"{tied.q[20]:.15g}") or tied.q[21] != float(f"{tied.q[21]:.15g}")
    again = hagfish.Simulation("table1", set={"start.q": tied.q, "start.qdot": tuple(tied.qdot)})
    assert_array_equal(again.q[7:], tied.q[7:])
    assert_array_equal(again.qdot, tied.qdot)
    bend = np.array([[0, 0.1, 0.5, -1], [1, 0.1, 0.3, 2]])
    kinds = {"start.bend": list(bend), "clamp_head": np.bool_(False), "model.bodies": np.int64(40)}
    plain = {"start.bend": bend.tolist(), "clamp_head": False, "model.bodies": 40}
    kinds |= {"time.step": np.float32(0.005), "title": np.str_('a "b"'), "expect.types": (("0_1", 0, 1.5),)}
    plain |= {"time.step": 0.005, "title": 'a "b"', "expect.types": [["0_1", 0, 1.5]]}
    assert hagfish.Simulation("table1", set=kinds).scene == hagfish.Simulation("table1", set=plain).scene


@pytest.mark.parametrize("value", [None, 1j, b"1", {"step": 1}, [[None]], {1, 2}, np.array([1j])])
def test_settings_of_no_kind_that_a_scene_has_are_refused_in_a_line(value):
    with pytest.raises(hagfish.InputError, match="^set: time.step = .*: must be a number, [^\n]*$"):
        hagfish.Simulation("table1", set={"time.step": value})


def moved(q, v, h):
    """q moved by v for the time h, to first order; its rotation is of the body."""
    (w, x, y, z), (a, b, c) = q[3:7], v[3:6]
    turn = np.array([-x * a - y * b - z * c, w * a + y * c - z * b, w * b + z * a - x * c, w * c + x * b - y * a])
    return q + h * np.concatenate([v[:3], turn / 2, v[6:]])


def test_mass_jacobian_and_orientation_are_those_of_the_motion(tied):
    assert tied.qdot @ tied.mass_matrix() @ tied.qdot / 2 == pytest.approx(tied.energy["kinetic"], rel=1e-9)
    along = tied.orientation[:, :, 0] * tied.lengths[:, None] / 2  # to each body's next joint
    assert_allclose((tied.position + along)[:-1], (tied.position - along)[1:], atol=1e-9)
    body, point, h = 60, np.array([0.1, -0.2, 0.3]), 1e-5
    v = np.random.default_rng(3).normal(size=tied.nv)
    sim, places = tied.copy(), []
    for step in (-h, h):
        sim.set_state(moved(tied.q, v, step), tied.qdot)
        places.append(sim.position[body] + sim.orientation[body] @ point)
    assert_allclose(tied.jacobian(body, point) @ v, (places[1] - places[0]) / (2 * h), rtol=1e-6)
    assert_allclose(tied.jacobian(body) @ tied.qdot, tied.velocity[body], rtol=1e-9)
    with pytest.raises(IndexError, match="body = 100: must be from 0 to 99"):
        tied.jacobian(100)


def test_what_a_law_works_against_is_what_logs_have(tmp_path):
    with hagfish.Simulation("living_overhand", log=tmp_path / "model.h5") as sim:
        sim.run(until=1.0)
    log = hagfish.Log(tmp_path / "model.h5")
    assert_array_equal(sim.limits.T, [log["model/limit_lower"], log["model/limit_upper"]])
    assert_array_equal(sim.lengths, log["model/length"])
    assert_array_equal(sim.radii, log["model/radius"])
    assert sim.stiffness[6:] @ sim.q[7:] ** 2 / 2 == pytest.approx(sim.energy["elastic"], rel=1e-9)
    assert (sim.damping[6:] > 0).all() and not sim.damping[:6].any()


def test_a_state_that_is_set_is_gone_on_from(tied):
    q, qdot = tied.q.copy(), tied.qdot.copy()
    near, far = tied.copy(), tied.copy()
    far.run(until=tied.time + 0.1)
    for sim in (near, far):
        view = sim.q
        sim.set_state(q, list(qdot))
        assert_allclose(view, q, rtol=1e-15, atol=0)
        control = sim.control()
        control.clamp_head = False
        sim.step(control)
    assert_array_equal(near.q, far.q)  # whatever the solver had before
    assert far.steps > near.steps
    assert abs(far.energy["dissipated"]) < tied.energy["dissipated"]
    for bad, told in (([1.0], "q has shape (1,)"), (q * np.nan, "not finite"), (q * 0, "quaternion")):
        with pytest.raises(ValueError, match=re.escape(told)):
            far.set_state(bad, qdot)


def test_a_run_with_a_log_is_not_put_elsewhere_and_a_closed_one_takes_no_step(tmp_path):
    sim = hagfish.Simulation("table1", set=FAST, log=tmp_path / "put.h5")
    with pytest.raises(ValueError, match="a run with a log"):
        sim.set_state(sim.q, sim.qdot)
    sim.close()
    plain = hagfish.Simulation("table1", set=FAST)
    plain.close()
    plain.close()
    for closed in (sim, plain):
        for step in (closed.step, closed.run):
            with pytest.raises(ValueError, match="the simulation is closed"):
                step()
        closed.copy().step()
    assert repr(plain) == '<hagfish.Simulation "Overhand knot of a Pacific hagfish (Table 1)": form, t = 0 s>'


def test_a_step_that_cannot_be_taken_leaves_the_run_as_it_was(tmp_path):
    sim = hagfish.Simulation("table1", set={**FAST, "guard.speed": 1.0}, log=tmp_path / "fast.h5")
    with pytest.raises(hagfish.StepError, match="guard.speed = 1 cm/s") as raised:
        sim.run()
    assert raised.value.outcome == "speed"
    steps, q = sim.steps, sim.q.copy()
    with pytest.raises(hagfish.StepError):
        sim.step()
    assert sim.steps == steps
    assert_array_equal(sim.q, q)
    sim.close()
    with hagfish.Log(tmp_path / "fast.h5") as log:
        assert log.status.startswith("failed: body ") and f"at step {steps} (t = " in log.status
    with pytest.raises(ValueError, match="closed"):
        sim.step()
