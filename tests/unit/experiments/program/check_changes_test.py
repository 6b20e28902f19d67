"""`hagfish check` names what was changed in a log and what does not come again; a run that was killed comes to the same end."""

from __future__ import annotations

import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import h5py
import numpy as np
import pytest

ROOT = Path(__file__).parents[4]
sys.dont_write_bytecode = True
sys.path.insert(0, str(ROOT / "tests/support"))

from program import HAGFISH, hagfish  # noqa: E402

# A run of the form alone: nothing else is asked of it.
BRIEF = ["--quiet", "--set", "time.until=form", "--set", "time.duration=3", "--set", "expect.types=[]", "--set", "expect.knot="]


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    folder = tmp_path_factory.mktemp("changes")
    hagfish(folder, "run", "table1", *BRIEF, "--out", "good.h5")
    assert "comes again to the end, bit by bit" in hagfish(folder, "check", "good.h5")
    assert "\nok   again " not in hagfish(folder, "check", "--fast", "good.h5")
    return folder


def changed(folder: Path, change, *options: str) -> dict[str, str]:
    """What the check says, by finding, of a copy that `change` has been at; those that fail alone. A refusal is one, too."""
    shutil.copy(folder / "good.h5", folder / "changed.h5")
    with h5py.File(folder / "changed.h5", "r+") as log:
        change(log)
    done = subprocess.run([HAGFISH, "check", *options, "changed.h5"], cwd=folder, capture_output=True, text=True)
    assert done.returncode in (0, 1, 2), done
    if done.returncode == 2:
        return {"refused": done.stderr}
    return {line[5:30].strip(): line[30:] for line in done.stdout.splitlines() if line.startswith("FAIL")}


def falsification(log: h5py.File, random: np.random.Generator):
    """One of a kind that nobody sees, and the name of what it changes."""
    paths: list[str] = []
    log.visititems(lambda name, node: paths.append(name) if isinstance(node, h5py.Dataset) and node.size else None)
    kept = [path for path in sorted(paths) if not path.endswith(("qp_time", "wall_time"))]
    path = kept[random.integers(len(kept))]
    data = log[path]
    kind = random.choice(["value", "value", "exchange", "scale", "unit"])
    if kind == "unit" and "unit" in data.attrs:
        data.attrs["unit"] = "m"
    elif data.dtype.kind == "f":
        values = data[()].ravel()
        some = np.flatnonzero(np.isfinite(values) & (values != 0))
        if kind == "exchange" and len(some) and (values != values[some[0]]).any():
            i = some[random.integers(len(some))]
            j = np.flatnonzero(values != values[i])[0]
            values[[i, j]] = values[[j, i]]
        elif kind == "scale" and len(some):
            values *= 1.5
        else:
            i = some[random.integers(len(some))] if len(some) else 0
            values[i] = np.nextafter(values[i], np.inf) if np.isfinite(values[i]) else 0
        data[...] = values.reshape(data.shape)
    elif data.dtype.kind in "iu":
        values = data[()].ravel()
        values[random.integers(len(values))] ^= 1
        data[...] = values.reshape(data.shape)
    else:
        texts = data.asstr()[()]
        if data.shape:
            texts[random.integers(len(texts))] = "other"
        data[...] = texts if data.shape else texts + " "
    return path


@pytest.mark.parametrize("seed", range(20))
def test_a_falsification_is_named_whoever_is_said_to_have_made_the_log(folder, seed):
    named = []

    def change(log):
        named.append(falsification(log, np.random.default_rng(seed)))
        if seed % 2:
            log.attrs["git_revision"] = "0123abc"

    said = changed(folder, change)
    words = [named[0], named[0].split("/")[-1]]
    assert any(word in text for word in words for text in said.values()), (named, said)


def reworded(name: str, value: str):
    def change(log: h5py.File) -> None:
        log.attrs[name] = value

    return change


@pytest.mark.parametrize(
    ("change", "name"),
    [
        (reworded("warnings", "none"), "attribute warnings is another"),
        (reworded("creator_version", "0"), "attribute creator_version is another"),
        (lambda log: log.create_dataset("/trajectory/more", data=np.ones(3)), "/trajectory/more is not of this run"),
        (lambda log: log.pop("/steps/rows"), "/steps/rows"),
    ],
)
def test_what_is_said_of_a_log_is_compared_too(folder, change, name):
    said = changed(folder, change)
    assert any(name in text for text in said.values()), said


def test_a_log_begins_where_its_run_does(folder):
    def later(log):
        log["trajectory/step"][...] += 100
        for path in ("trajectory/time", "steps/time"):
            log[path][...] += 0.5

    assert "does not begin where its run does" in changed(folder, later)["again"]


@pytest.mark.parametrize("path", ["steps/qp_time", "diagnostics/wall_time"])
def test_no_time_that_a_computer_took_is_below_zero(folder, path):
    def change(log):
        log[path][7] = -1e-9

    assert f"/{path} is below 0" in changed(folder, change)["again"]


def test_a_run_that_goes_on_hears_signals_and_leaves_what_there_is(folder):
    """It is in a process of its own, which reads a log."""
    process = subprocess.Popen([HAGFISH, "run", "table1", "--quiet", "--set", "time.step=0.0001", "--out", "heard.h5"], cwd=folder)
    part = folder / "heard.h5.part"
    time.sleep(1.5)  # of a run of some ten seconds
    process.kill()
    process.wait()
    left = part.read_bytes()
    resumed = subprocess.Popen([HAGFISH, "run", "--resume", "heard.h5"], cwd=folder, stderr=subprocess.PIPE, text=True)
    assert "run again from the start" in resumed.stderr.readline()
    time.sleep(0.2)
    resumed.send_signal(signal.SIGTERM)
    said = resumed.communicate()[1]
    assert resumed.returncode == 1 and "stays as it was" in said and "interrupted" in said, said
    assert part.read_bytes() == left
    part.unlink()


def test_a_scene_that_is_not_the_runs_makes_another_one(folder):
    def change(log):
        log.attrs["scene"] = log.attrs["scene"].replace("bending_stiffness = ", "bending_stiffness = 1")
        log.attrs["git_revision"] = "0123abc"

    assert changed(folder, change)


def test_a_run_that_claims_to_be_whole_is(folder):
    """Cut after half of it, all that is left is right, and its scene goes on."""
    part = folder / "cut.h5"
    hagfish(folder, "run", "table1", *BRIEF, "--set", "time.duration=2.5", "--out", "short.h5", "--force")
    shutil.copy(folder / "short.h5", part)
    with h5py.File(folder / "good.h5") as good, h5py.File(part, "r+") as log:
        log.attrs["scene"] = good.attrs["scene"]
    said = subprocess.run([HAGFISH, "check", "cut.h5"], cwd=folder, capture_output=True, text=True).stdout
    assert "its scene is not over where the log ends" in said


def test_a_body_that_is_elsewhere_for_one_frame_is_found(tmp_path):
    """All of a free body is moved, so that nothing but its way tells."""
    (tmp_path / "free.toml").write_text('base = "living_overhand_free"\n')
    hagfish(tmp_path, "run", "free.toml", *BRIEF, "--out", "good.h5")
    hagfish(tmp_path, "check", "good.h5")

    def move(log: h5py.File) -> None:
        log["/trajectory/q"][20, 1] += 0.1
        position = log["/trajectory/position"][20]
        position.reshape(-1, 3)[:, 1] += 0.1
        log["/trajectory/position"][20] = position

    assert "motion" in changed(tmp_path, move, "--fast")


@pytest.mark.parametrize("seed", range(6))
def test_a_run_that_was_killed_is_readable_and_comes_to_the_same_end(folder, seed):
    scene = ["table1", "--set", "time.duration=6", "--quiet"]
    whole = folder / "whole.h5"
    if not whole.exists():
        hagfish(folder, "run", *scene, "--out", "whole.h5")
    process = subprocess.Popen([HAGFISH, "run", *scene, "--out", "killed.h5"], cwd=folder)
    part, log = folder / "killed.h5.part", folder / "killed.h5"
    while process.poll() is None and not part.exists():
        time.sleep(0.001)
    time.sleep(float(np.random.default_rng(seed).uniform(0, 0.6)))
    process.send_signal(signal.SIGKILL)
    process.wait()
    if part.exists():
        with h5py.File(part) as left:
            assert left.attrs["status"] == "running" and len(left["trajectory/time"]) > 0
        hagfish(folder, "run", "--quiet", "--resume", "killed.h5")
    with h5py.File(whole) as a, h5py.File(log) as b:
        for path in ("trajectory/q", "trajectory/qdot", "mean/forces/net", "steps/kkt", "diagnostics/work_tip"):
            np.testing.assert_array_equal(a[path][()], b[path][()], err_msg=path)
    log.unlink()
    assert not list(folder.glob("killed*"))


def test_a_file_on_which_hdf5_crashes_is_one_line(folder):
    """HDF5 1.10 copies a text of whatever length its heap says to where there is room for as much as its attribute says."""
    good = (folder / "good.h5").read_bytes()
    with h5py.File(folder / "good.h5") as log:
        words = log.attrs["scene"].encode()
    at = good.index(words)
    for length in (10**5, 10**6, 10**9):
        (folder / "bad.h5").write_bytes(good[: at - 8] + length.to_bytes(8, "little") + good[at:])
        done = subprocess.run([HAGFISH, "info", "bad.h5"], cwd=folder, capture_output=True, text=True)
        assert done.returncode in (0, 2), done
        assert done.returncode == 0 or "bad.h5" in done.stderr.splitlines()[-1], done


def test_a_law_without_eq_6_is_not_asked_for_it(tmp_path):
    """The scene asks for the paper's share; the reflex has no rows of Eq. 6."""
    hagfish(tmp_path, "run", "reflex_overhand", "--quiet", "--set", "expect.speed_share=0.95", "--out", "a.h5")
    said = hagfish(tmp_path, "check", "a.h5")
    assert not [line for line in said.splitlines() if line[5:30].strip() == "Eq. 6"], said
