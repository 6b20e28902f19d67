"""What a caller may do wrong, or at a bad time: told in a line, and never a crash."""

import gc
import math
import os
import re
import subprocess
import sys
import threading
import weakref

import hagfish
import pytest

FAST = {"time.step": 0.01}

BEGUN = """
import hagfish, os, sys, threading, time
sim = hagfish.Simulation("table1", set={"time.step": 0.01}, law=%s, log=%s)
"""


def script_ends_well(text, folder):
    done = subprocess.run([sys.executable, "-c", text], cwd=folder, capture_output=True, text=True, timeout=120)
    assert (done.returncode, done.stderr) == (0, ""), done
    return done.stdout


@pytest.mark.parametrize("call", ["sim.step()", "sim.step(sim.control())", "sim.run(until=1.0)", "sim.close()"])
def test_a_law_takes_no_step_of_its_own_simulation(sim, call):
    raised = []

    def law(sim, control):
        with pytest.raises(RuntimeError, match="cannot step it") as error:
            eval(call)
        raised.append(str(error.value))

    own = sim.copy(law=law)
    for _ in range(3):
        own.step()
    assert own.steps == 3 and len(raised) == 3


def test_a_law_may_step_a_copy(sim):
    ahead = []

    def law(sim, control):
        ahead.append(sim.copy(law=lambda s, c: None))
        ahead[-1].step()

    own = sim.copy(law=law)
    own.step()
    own.step()
    assert [other.steps for other in ahead] == [1, 2]


USES = "step run copy close contacts first_contact knot head_end warnings energy momentum forces memory clamped mass_matrix orientation"


@pytest.mark.parametrize("name", USES.split())
def test_another_thread_is_refused_while_it_is_at_work(sim, name):
    inside, leave = threading.Event(), threading.Event()

    def law(sim, control):
        sim.knot  # its own thread reads
        inside.set()
        leave.wait()

    own = sim.copy(law=law)
    worker = threading.Thread(target=own.step)
    worker.start()
    inside.wait()
    try:
        with pytest.raises(RuntimeError, match="another thread is using"):
            getattr(own, name)()
        assert own.steps == 0 and own.time == 0
    finally:
        leave.set()
        worker.join()
    own.step()
    assert own.steps == 2


def test_threads_that_read_it_while_it_runs_end_in_no_crash(tmp_path):
    readers = """
worker = threading.Thread(target=sim.run, args=(6.0,))
worker.start()
refused = 0
while worker.is_alive():
    for name in ("contacts", "knot", "warnings", "energy", "copy"):
        try:
            got = getattr(sim, name)
            got() if name == "copy" else None
        except RuntimeError:
            refused += 1
assert refused > 10 and sim.time >= 6.0
"""
    script_ends_well(BEGUN % ("None", "None") + readers, tmp_path)


LAWS = ["None", *(f"lambda s, c: {work}" for work in ("None", "time.sleep(0.02)", "time.sleep(1000)"))]


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("log", ["None", '"left.h5"'])
def test_python_ends_while_a_daemon_thread_runs(tmp_path, law, log):
    daemon = "threading.Thread(target=sim.run, daemon=True).start()\ntime.sleep(0.3)\n"
    script_ends_well(BEGUN % (law, log) + daemon, tmp_path)


def test_steps_are_taken_while_python_ends(tmp_path):
    before = "import atexit\natexit.register(lambda: print(sim.run(until=0.1).steps))\n"
    assert script_ends_well(before + BEGUN % ("None", "None"), tmp_path) == "10\n"


@pytest.mark.parametrize("kind", ["Simulation", "Control", "Command", "Contact"])
def test_an_object_that_was_never_begun_is_refused(sim, kind):
    made = getattr(hagfish, kind)
    raw = made.__new__(made)
    use = {"Simulation": "q", "Control": "tip", "Command": "effort", "Contact": "gap"}[kind]
    with pytest.raises(TypeError, match="not called"):
        getattr(raw, use)
    with pytest.raises(TypeError):
        sim.step(raw)
    gc.collect()
    del raw


def test_a_simulation_whose_law_holds_it_is_collected():
    class Law:
        def __call__(self, sim, control):
            self.sim = sim

    law = Law()
    sim = hagfish.Simulation("table1", set=FAST, law=law)
    sim.step()
    assert law.sim is sim
    gone = weakref.ref(law)
    del sim, law
    gc.collect()
    assert gone() is None


def test_what_a_law_raises_is_a_line_of_the_status(tmp_path):
    def law(sim, control):
        raise ValueError("red \x1b[31m and\nmore")

    with pytest.raises(ValueError, match="red"):
        with hagfish.Simulation("table1", set=FAST, law=law, log=tmp_path / "raised.h5") as sim:
            sim.step()
    with hagfish.Log(tmp_path / "raised.h5") as log:
        assert log.status == "failed: ValueError: red \\x1b[31m and more at step 0 (t = 0.0000 s, form)"


@pytest.mark.parametrize("end", [0.05, 0.055, 0.0549, 0.1, 1.2345678, 0.57, 1.15])
def test_a_run_until_a_time_gets_there(sim, end):
    calls = 0
    while sim.time < end:
        before = sim.steps
        sim.run(until=end)
        assert sim.steps > before
        calls += 1
    assert calls <= 2
    assert sim.time - end < sim.h * (1 + 1e-6)
    steps = sim.steps
    assert sim.run(until=end).steps == steps


@pytest.mark.parametrize(
    "arguments, error, text",
    [
        ({"scene": 3}, TypeError, "scene = 3: a built-in scene"),
        ({"scene": ""}, ValueError, "scene = ''"),
        ({"log": ""}, ValueError, "log = '': a file to write"),
        ({"log": 2.5}, TypeError, "log = 2.5: a file to write"),
        ({"set": 3}, TypeError, "set = 3: a dict"),
        ({"qp": 3}, TypeError, "qp = 3: the name of a QP back end"),
        ({"law": 3}, TypeError, "law = 3: what is called"),
        ({"qp": "Ipopt"}, ValueError, "unknown QP back end 'Ipopt' (there are: ipopt, active-set)"),
    ],
)
def test_wrong_arguments_are_told_in_a_line(arguments, error, text):
    with pytest.raises(error, match="^" + re.escape(text)):
        hagfish.Simulation(**arguments)


def test_wrong_arguments_of_calls_are_told_in_a_line(sim):
    for until in ([1], {}, True):
        with pytest.raises(TypeError, match=re.escape(f"until = {until}: a time (s)")):
            sim.run(until=until)
    with pytest.raises(ValueError, match="until = nan"):
        sim.run(until=math.nan)
    with pytest.raises(TypeError, match="control = 3: a Control or None"):
        sim.step(3)
    with pytest.raises(TypeError, match="law = 3"):
        sim.copy(law=3)
    with pytest.raises(TypeError, match="set = 3"):
        sim.copy(set=3)

    def law(sim, control):
        control.commands.append(3)

    with pytest.raises(TypeError, match="control.commands has 3, but each must be a Command"):
        sim.copy(law=law).step()
    assert sim.steps == 0


def test_settings_that_do_nothing_are_refused(sim):
    with pytest.raises(hagfish.InputError, match="start.seed: has no effect here: .*start.noise_deg is 0"):
        hagfish.Simulation("table1", set={**FAST, "start.seed": 3})
    with pytest.raises(hagfish.InputError, match="start.noise_deg: has no effect here: the branch begins where"):
        sim.copy(set={"start.noise_deg": 1})
    # A law of one's own drives muscles.
    hagfish.Simulation("table1", set={"muscle.activation_time": 0.1}, law=lambda s, c: None)


def test_a_control_of_another_animal_is_refused(sim):
    small = hagfish.Simulation("table1", set={**FAST, "model.bodies": 40})
    with pytest.raises(ValueError, match="velocities, but the animal has"):
        small.step(sim.control())
    small.step()


@pytest.mark.parametrize("child", ["sim.step()", "sim.close()", "del sim", "sim.run(until=1.0)"])
def test_a_forked_child_leaves_its_parents_log(tmp_path, child):
    fork = f"""
sim.run(until=0.5)
pid = os.fork()
if pid == 0:
    try:
        {child}
    except hagfish.FileError as error:
        assert "only the process that began this log" in str(error), error
    sys.exit(0)
assert os.waitpid(pid, 0)[1] == 0
assert os.path.exists("parent.h5.lock") and os.path.exists("parent.h5.part")
sim.run(until=1.0)
sim.close()
"""
    script_ends_well(BEGUN % ("None", '"parent.h5"') + fork, tmp_path)
    assert sorted(os.listdir(tmp_path)) == ["parent.h5"]
    with hagfish.Log(tmp_path / "parent.h5") as log:
        assert log.status == "failed: closed at step 100"
