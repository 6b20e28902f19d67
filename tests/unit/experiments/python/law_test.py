"""Control laws in Python: what they ask for is what is done, logged and audited."""

import re

import hagfish
import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from program import different

FAST = {"time.step": 0.01}


def test_the_papers_control_unchanged_is_the_papers_run(tmp_path):
    for name, law in (("paper", None), ("own", lambda sim, control: None)):
        with hagfish.Simulation("table1", set=FAST, law=law, log=tmp_path / f"{name}.h5") as sim:
            sim.run()
    added = different(tmp_path / "paper.h5", tmp_path / "own.h5")
    assert {name.split("/")[0] for name in added} == {"control", "eq6", "steps"}
    of_steps = {name for name in added if name.startswith("steps")}
    assert of_steps == {"steps/thigmotaxis_others", "steps/thigmotaxis_others_slack"}


def test_everything_that_a_law_asks_for_is_logged_and_audited(tmp_path, verdicts):
    amplitude = np.random.default_rng(7).normal(0, 50, 149)  # dyn cm; the springs have some hundreds
    asked = []

    def law(sim, control):
        if sim.phase == "form":
            return
        torque = np.zeros(sim.nv)
        torque[6:] = amplitude * np.sin(3 * sim.time)
        control.torque = torque
        control.torque_rate[6:] = 3.0  # dyn cm s
        control.tip = (20, -30, 40)
        control.tip_rate = 5.0
        ends = [(c.contact.body_a, c.contact.body_b) for c in control.commands]
        for contact in sim.contacts:
            if contact.gap < 0.02 and (contact.body_a, contact.body_b) not in ends:
                control.commands.append(hagfish.Command(contact, 0.7, 0.3, effort=0.5))
        asked.append((torque, len(control.commands), sim.time))

    log = tmp_path / "all.h5"
    with hagfish.Simulation("table1", set={**FAST, "active.stiffness": 1.0}, law=law, log=log) as sim:
        sim.run(until=lambda s: s.phase == "slide" and s.time > 12.5)
        felt = sim.qdot.copy()
        torque = sim.forces["active"]
        assert_allclose(torque[6:], (asked[-1][0] - 3.0 * felt)[6:], rtol=0, atol=1e-9)
        assert_array_equal(torque[:6], 0)
    # Not run to its end, so that it has not slid.
    assert verdicts(log) <= {"status", "slide", "slide of both ends", "unknot at end", "knot through time", "Eq. 6"}
    frames = hagfish.Log(log)
    rows = np.bincount(frames["eq6/frame"], minlength=len(frames.time))
    assert rows.max() > 4 and set(frames["eq6/end"]) == {0, 1, 2}
    others = frames["eq6/end"] == 2
    assert_allclose(frames["eq6/cap"][others], 2500)
    assert set(frames["eq6/command"][others]) == {0.7, 0.3}
    time = frames["trajectory/time"][-2]  # the last one is the state at the end
    assert rows[-2] == 2 * min(asked, key=lambda step: abs(step[2] - time))[1]


def test_a_rest_shape_bends_the_animal(tmp_path, verdicts):
    stiff = {"stiffness": 1e5, "capacity": 1e6, "tone_time": 0.1, "relax_time": 1}
    settings = {**FAST, "time.duration": 2, "clamp_head": False, "wall.present": False, "script.kind": "none"}
    settings |= {f"active.{key}": value for key, value in stiff.items()}
    wanted = 0.05  # rad

    def bend(sim, control):
        shape = np.zeros(sim.nv)
        shape[6:] = [wanted if name.endswith("bend_y") else 0 for name in sim.dof_names[6:]]
        control.clear()
        control.clamp_head = False
        control.rest_shape = shape

    log = tmp_path / "bend.h5"
    with hagfish.Simulation("table1", set=settings, law=bend, log=log) as sim:
        sim.run()
        bends = [k for k, name in enumerate(sim.dof_names) if name.endswith("bend_y")]
        middle = sim.q[np.array(bends[10:-10]) + 1]
    assert_allclose(middle, wanted, atol=0.02)  # not at rest yet
    untied = {"knot held", "hand", "slide", "slide of both ends", "knot through time", "unknot at end", "Eq. 6"}
    assert verdicts(log) <= untied


def test_a_control_given_to_a_step_is_what_is_done(sim):
    control = sim.control()
    control.torque[10] = 50
    control.tip = (0, 100, 0)
    sim.step(control)
    assert sim.forces["active"][10] == 50
    assert sim.moments["active"].shape == (100, 3) and np.abs(sim.moments["active"]).max() == pytest.approx(50)
    assert_array_equal(sim.forces["tip"], (0, 100, 0))
    assert sim.forces["head"].any()
    control.clamp_head = False
    sim.step(control)
    assert not sim.forces["head"].any()
    sim.step()  # by the scene again
    assert sim.forces["active"][10] == 0
    assert sim.forces["tip"][1] != 100


def test_a_log_that_expects_the_papers_law_takes_no_other_control(tmp_path):
    with hagfish.Simulation("table1", set=FAST, log=tmp_path / "paper.h5") as sim:
        with pytest.raises(ValueError, match="controller.law"):
            sim.step(sim.control())
        sim.step()
    own = {**FAST, "controller.law": "own"}
    with hagfish.Simulation("table1", set=own, log=tmp_path / "own.h5") as sim:
        sim.step(sim.control())
        with pytest.raises(ValueError, match='controller.law = "own"'):
            sim.step()


def twice(control):
    control.commands += control.commands


@pytest.mark.parametrize(
    ("change", "told"),
    [
        (lambda control: control.torque.__setitem__(2, 1), "torque acts on the root"),
        (lambda control: control.torque.__setitem__(20, np.nan), "not finite"),
        (lambda control: setattr(control, "torque", np.zeros(3)), "torque has shape (3,), but shape (155,) is wanted"),
        (lambda control: control.torque_rate.__setitem__(30, -1), "rate is negative"),
        (twice, "two commands of Eq. 6 are at one end of the knot"),
        (lambda control: setattr(control.commands[0], "effort", -1), "effort -1 must be finite"),
    ],
)
def test_a_control_that_is_none_is_refused_in_a_line(tied, change, told):
    sim = tied.copy(law=lambda sim, control: change(control))
    with pytest.raises(ValueError, match=re.escape(told)):
        sim.step()
    assert sim.steps == tied.steps
    assert_array_equal(sim.q, tied.q)


@pytest.mark.parametrize("value", [None, 1j, "1"])
def test_arrays_of_what_are_no_real_numbers_are_refused(sim, value):
    control = sim.control()
    for owner, name in ((control, "torque"), (control, "torque_rate"), (control, "rest_shape"), (control, "tip"), (sim, "memory")):
        with pytest.raises(TypeError, match=f"{name} must be real numbers, not list of dtype"):
            setattr(owner, name, [value] * 3)
    for value in (np.zeros((155, 1)), 3.0):
        with pytest.raises(ValueError, match=re.escape(f"torque has shape {np.shape(value)}, but shape (155,)")):
            control.torque = value
    masked = np.ma.masked_equal(np.arange(155), 7)  # numbers wherever it is taken for an array
    with pytest.raises(TypeError, match="torque is a masked array: give one without a mask, as by filled()"):
        control.torque = masked
    with pytest.raises(TypeError, match="set: controller.slide_head is a masked array"):
        hagfish.Simulation("table1", set={"controller.slide_head": np.ma.masked_equal([5.0, 7.0], 7)})
    view, control.torque = control.torque, np.arange(155, dtype="f4")
    assert_array_equal(view, np.arange(155))


def test_a_laws_memory_is_as_it_was_where_a_step_fails(tied):
    def law(sim, control):
        sim.memory = np.append(sim.memory, 1.0)
        if len(sim.memory) == 3:
            control.torque[0] = 1

    sim = tied.copy(law=law)
    sim.step()
    sim.step()
    with pytest.raises(ValueError):
        sim.step()
    assert_array_equal(sim.memory, [1, 1])


def test_the_program_refuses_a_law_that_it_does_not_have(tmp_path, refusal):
    own = {**FAST, "controller.law": "own"}
    log = tmp_path / "own.h5"
    with hagfish.Simulation("table1", set=own, log=log) as sim:
        for _ in range(5):
            sim.step(sim.control())
    (tmp_path / "own.toml").write_text(sim.scene)
    needs = 'controller.law = "own": only a C++ or Python program that sets a control law can run this scene'
    assert refusal(tmp_path, "run", "own.toml", "--out", "x.h5") == needs
    again = "own.h5: cannot be run again: the law is the run's own"
    assert refusal(tmp_path, "run", "--resume", "own.h5") == again
    assert refusal(tmp_path, "branch", "own.h5", "--out", "x.h5") == again
    assert not (tmp_path / "x.h5").exists()


class Strong:
    """A law that turns one hinge, and notes that it was asked."""

    made = 0

    def __init__(self):
        Strong.made += 1
        self.asked = 0

    def __call__(self, sim, control):
        self.asked += 1
        control.torque[9] = 100.0


def test_a_sweep_runs_a_law_of_its_own_for_each_cell():
    values = {"time.step": [0.01, 0.005], "drag.normal": [9.434, 0.0]}
    arguments = dict(law=Strong, until=0.1, figures=lambda s: {"turned": float(s.q[10])})
    rows = hagfish.sweep("table1", values, **arguments)
    assert Strong.made == 4
    cells = [(row["time.step"], row["drag.normal"]) for row in rows]
    assert cells == [(0.01, 9.434), (0.01, 0.0), (0.005, 9.434), (0.005, 0.0)]
    assert all(row["outcome"] == "ok" and row["time"] == pytest.approx(0.1) for row in rows)
    assert all(row["turned"] > 0 for row in rows) and rows[0]["turned"] != rows[1]["turned"]
    assert hagfish.sweep("table1", values, **arguments, processes=2) == rows
    (refused,) = hagfish.sweep("table1", {"model.bodies": [1]})
    assert refused["outcome"] == "refused" and "model.bodies" in refused["message"]


def test_a_copy_goes_on_with_other_settings(tied):
    free = tied.copy(set={"clamp_head": False, "wall.present": False, "time.step": 0.005, "time.frame_interval": 0.01})
    assert free.h == 0.005 and free.time == tied.time
    free.step()
    assert free.scene != tied.scene and not free.clamped
    assert_array_equal(free.momentum["outside"][0], tied.momentum["outside"][0])  # no clamp, no plate
    with pytest.raises(hagfish.InputError, match="time.stop"):
        tied.copy(set={"time.stop": 1})


def test_an_explicit_torque_that_blows_up_is_told_what_cures_it():
    def stiff(sim, control):
        control.torque[6:] = 1e7 * (0.3 - sim.q[7:]) - 1e6 * sim.qdot[6:]

    sim = hagfish.Simulation("table1", set={**FAST, "guard.speed": 100.0}, law=stiff)
    with pytest.raises(hagfish.StepError, match="give damping as torque_rate, and a pull to angles as rest_shape"):
        sim.run(until=1.0)
