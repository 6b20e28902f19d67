"""`hagfish check` names what was changed in a log and does not come again; a killed run comes to the same end."""

import shutil
import signal
import subprocess
import time

import h5py
import numpy as np
import pytest

from program import HAGFISH, SANITIZED, different, hagfish, logged, outcome, sets

# A run of the form alone: nothing else is asked of it.
BRIEF = sets("time.until=form", "time.duration=3", "expect.types=[]", "expect.knot=")


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    folder = tmp_path_factory.mktemp("changes")
    logged(folder, "table1", *BRIEF, out="good.h5")
    assert "comes again to the end, bit by bit" in hagfish(folder, "check", "good.h5")
    assert "\nok   again " not in hagfish(folder, "check", "--fast", "good.h5")
    return folder


def changed(folder, change, *options):
    """Findings of the check of a copy that `change` has been at, of those that fail. A refusal is one, too."""
    shutil.copy(folder / "good.h5", folder / "changed.h5")
    with h5py.File(folder / "changed.h5", "r+") as log:
        change(log)
    done = outcome(folder, "check", *options, "changed.h5")
    assert done.returncode in (0, 1, 2), done
    if done.returncode == 2:
        return {"refused": done.stderr}
    return {line[5:30].strip(): line[30:] for line in done.stdout.splitlines() if line.startswith("FAIL")}


def reworded(name, change):
    return lambda log: log.attrs.__setitem__(name, change(log.attrs[name]))


def later(log):
    log["trajectory/step"][...] += 100
    for path in ("trajectory/time", "steps/time"):
        log[path][...] += 0.5


def below_zero(path):
    return lambda log: log[path].__setitem__(7, -1e-9)


@pytest.mark.parametrize(
    ("change", "told"),
    [
        (reworded("warnings", lambda _: "none"), "attribute warnings is another"),
        (reworded("creator_version", lambda _: "0"), "attribute creator_version is another"),
        (reworded("scene", lambda scene: scene.replace("bending_stiffness = ", "bending_stiffness = 1")), ""),
        (lambda log: log.create_dataset("/trajectory/more", data=np.ones(3)), "/trajectory/more is not of this run"),
        (lambda log: log.pop("/steps/rows"), "/steps/rows"),
        (later, "does not begin where its run does"),
        (below_zero("steps/qp_time"), "/steps/qp_time is below 0"),  # no clock says so
        (below_zero("diagnostics/wall_time"), "/diagnostics/wall_time is below 0"),
    ],
)
def test_what_else_a_run_again_does_not_have_is_named(folder, change, told):
    said = changed(folder, change)
    assert any(told in text for text in said.values()), said


def frames(part):
    """Those that a running log has by now; 0 before there is one, and while it takes its name."""
    try:
        with h5py.File(part) as log:
            return len(log["trajectory/time"])
    except (OSError, KeyError):
        return 0


def test_a_run_that_goes_on_hears_signals_and_leaves_what_there_is(folder):
    """It is in a process of its own, which reads a log."""
    scene = ["table1", "--set", "time.step=0.0001"]
    process = subprocess.Popen([HAGFISH, "run", *scene, "--quiet", "--out", "heard.h5"], cwd=folder)
    part = folder / "heard.h5.part"
    while frames(part) < 100:  # of some 1,000: so many take longer than what is waited for below
        time.sleep(0.01)
    process.kill()
    process.wait()
    left = part.read_bytes()
    again = [HAGFISH, "run", "--resume", "heard.h5"]
    resumed = subprocess.Popen(again, cwd=folder, stderr=subprocess.PIPE, text=True)
    assert "run again from the start" in resumed.stderr.readline()
    time.sleep(0.2)
    resumed.terminate()
    said = resumed.communicate()[1]
    assert resumed.returncode == 1 and "stays as it was" in said and "interrupted" in said, said
    assert part.read_bytes() == left
    part.unlink()


@pytest.mark.parametrize("name", ["SIGUSR1", "SIGUSR2", "SIGXCPU"])
def test_a_run_that_a_scheduler_ends_keeps_its_last_state(tmp_path, name):
    command = [HAGFISH, "run", "table1", "--set", "time.step=0.0001", "--quiet", "--out", "ended.h5"]
    for resumed in (False, True):  # that is in a process below the one which hears the signal
        process = subprocess.Popen(command, cwd=tmp_path, stderr=subprocess.PIPE, text=True)
        if resumed:
            assert "run again from the start" in process.stderr.readline()
        while not resumed and not (tmp_path / "ended.h5.part").exists():
            time.sleep(0.001)
        time.sleep(1)  # of a run of some ten seconds
        process.send_signal(getattr(signal, name))
        said = process.communicate()[1]
        assert process.returncode == 1 and "interrupted" in said, said
        command = [HAGFISH, "run", "--resume", "ended.h5"]
        if not resumed:
            with h5py.File(tmp_path / "ended.h5") as log:
                assert "interrupted" in str(log.attrs["status"]) and len(log["trajectory/time"]) > 1


def test_a_run_that_claims_to_be_whole_is(folder):
    """Cut after half of it, all that is left is right, and its scene goes on."""
    logged(folder, "table1", *BRIEF, "--set", "time.duration=2.5", out="cut.h5")
    with h5py.File(folder / "good.h5") as good, h5py.File(folder / "cut.h5", "r+") as log:
        log.attrs["scene"] = good.attrs["scene"]
    assert "its scene is not over where the log ends" in outcome(folder, "check", "cut.h5").stdout


def test_a_body_that_is_elsewhere_for_one_frame_is_found(tmp_path):
    """All of a free body is moved, so that nothing but its way tells."""
    logged(tmp_path, "living_overhand_free", *BRIEF, out="good.h5")
    hagfish(tmp_path, "check", "good.h5")

    def move(log: h5py.File) -> None:
        log["/trajectory/q"][20, 1] += 0.1
        position = log["/trajectory/position"][20]
        position.reshape(-1, 3)[:, 1] += 0.1
        log["/trajectory/position"][20] = position

    assert "motion" in changed(tmp_path, move, "--fast")


@pytest.mark.parametrize("seed", range(3))
def test_a_run_that_was_killed_is_readable_and_comes_to_the_same_end(folder, seed):
    scene = ["table1", "--set", "time.duration=6"]
    whole = logged(folder, *scene, out="whole.h5")
    process = subprocess.Popen([HAGFISH, "run", *scene, "--quiet", "--out", "killed.h5"], cwd=folder)
    part, log = folder / "killed.h5.part", folder / "killed.h5"
    while process.poll() is None and not part.exists():
        time.sleep(0.001)
    time.sleep(float(np.random.default_rng(seed).uniform(0, 0.6)))
    process.kill()
    process.wait()
    if part.exists():
        with h5py.File(part) as left:
            assert left.attrs["status"] == "running" and len(left["trajectory/time"]) > 0
        hagfish(folder, "run", "--quiet", "--resume", "killed.h5")
        assert list(folder.glob("killed*")) == [log]
    assert different(whole, log) == []
    for file in folder.glob("killed*"):
        file.unlink()


@pytest.mark.skipif(SANITIZED, reason="ends where HDF5 itself fails")
def test_a_file_on_which_hdf5_crashes_is_one_line(folder):
    """HDF5 1.10 copies a text as long as its heap says to where there is room for as much as its attribute says."""
    good = (folder / "good.h5").read_bytes()
    with h5py.File(folder / "good.h5") as log:
        words = log.attrs["scene"].encode()
    at = good.index(words)
    for length in (10**5, 10**6, 10**9):
        (folder / "bad.h5").write_bytes(good[: at - 8] + length.to_bytes(8, "little") + good[at:])
        done = outcome(folder, "info", "bad.h5")
        assert done.returncode in (0, 2), done
        assert done.returncode == 0 or "bad.h5" in done.stderr.splitlines()[-1], done


def test_a_law_without_eq_6_is_not_asked_for_it(tmp_path):
    """The scene asks for the paper's share; the reflex has no rows of Eq. 6."""
    logged(tmp_path, "reflex_overhand", "--set", "expect.speed_share=0.95")
    said = hagfish(tmp_path, "check", "a.h5")
    assert not [line for line in said.splitlines() if line[5:30].strip() == "Eq. 6"], said
