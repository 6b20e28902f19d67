"""`hagfish check` names what was changed since a log ended, what does not come again, and checkpoints that are gone."""

from __future__ import annotations

import os
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
    said = hagfish(folder, "check", "--again", "good.h5")
    # One run is enough: it makes all checkpoints.
    assert "comes again bit by bit" in said and not [line for line in said.splitlines() if line[5:].startswith("checkpoints ")], said
    return folder


def changed(folder: Path, change, *options: str) -> dict[str, str]:
    """What the check says, by finding, of a copy that `change` has been at; those that fail alone."""
    shutil.copy(folder / "good.h5", folder / "changed.h5")
    with h5py.File(folder / "changed.h5", "r+") as log:
        change(log)
    text = subprocess.run([HAGFISH, "check", *options, "changed.h5"], cwd=folder, capture_output=True, text=True).stdout
    return {line[5:30].strip(): line[30:] for line in text.splitlines() if line.startswith("FAIL")}


def added(path: str, place: tuple | int, by: float):
    def change(log: h5py.File) -> None:
        log[path][place] = log[path][place] + by

    return change


def reworded(path: str, name: str, value: str):
    def change(log: h5py.File) -> None:
        (log[path] if path != "/" else log).attrs[name] = value

    return change


@pytest.mark.parametrize(
    ("change", "name"),
    [
        (added("/steps/qp_time", 7, 1e-9), "/steps/qp_time is changed"),
        (added("/trajectory/q", (3, 20), 1e-15), "/trajectory/q is changed"),
        (added("/checkpoints/data", 900, 1), "/checkpoints/data is changed"),
        (reworded("/", "warnings", "none"), "/: attribute warnings is changed"),
        (reworded("/", "command", "hagfish run"), "/: attribute command is changed"),
        (lambda log: log.create_dataset("/trajectory/more", data=np.ones(3)), "/trajectory/more is new"),
        (reworded("/", "creator_version", "0"), "/: attribute creator_version is changed"),
    ],
)
def test_the_seal_names_what_was_changed(folder, change, name):
    said = changed(folder, change)
    assert name in said.get("seal", ""), said


def test_a_seal_that_was_taken_out_is_missed(folder):
    assert "taken out" in changed(folder, lambda log: log.pop("seal"))["seal"]


def test_words_of_another_kind_are_refused(folder):
    for attribute, value in (("unit", "m"), ("description", "something else")):
        shutil.copy(folder / "good.h5", folder / "words.h5")
        with h5py.File(folder / "words.h5", "r+") as log:
            log["/knot/head_end"].attrs[attribute] = value
        assert f"/knot/head_end has another {attribute}" in hagfish(folder, "check", "words.h5", code=2)


def sealed_anew(change):
    """A change by one who knows how to do without the seal: it is taken out, so other findings must tell."""

    def all_of_it(log: h5py.File) -> None:
        change(log)
        log.pop("seal")

    return all_of_it


def test_a_run_comes_again_but_for_what_was_changed(folder):
    said = changed(folder, sealed_anew(added("/steps/kkt", 501, 1e-17)), "--again")
    assert "/steps/kkt, step 501" in said["again"]
    said = changed(folder, sealed_anew(added("/mean/forces/net", (10, 9), 1e-12)), "--again")
    assert "/mean/forces/net, row 10" in said["again"]


@pytest.mark.parametrize(("options", "finding"), [((), "checkpoints"), (("--again",), "again")])
def test_all_that_a_checkpoint_holds_is_compared(folder, options, finding):
    with h5py.File(folder / "good.h5") as log:
        end = log["/checkpoints/end"][0]
    # The last bytes before the log's own part are those of the ledgers; the first of the means come behind them.
    for place in (int(0.3 * end), int(0.9 * end)):
        said = changed(folder, sealed_anew(added("/checkpoints/data", place, 1)), *options)
        if said:
            assert finding in said, place
        else:  # it is no checkpoint any more
            assert "/checkpoints" in hagfish(folder, "check", "changed.h5", code=2), place


def test_a_checkpoint_that_is_gone_is_named(folder):
    def drop_the_first(log: h5py.File) -> None:
        steps, ends, data = log["/checkpoints/step"], log["/checkpoints/end"], log["/checkpoints/data"]
        first = int(ends[0])
        kept, step, end = data[first:], steps[1:], ends[1:] - first
        for set_, values in ((steps, step), (ends, end), (data, kept)):
            set_.resize(values.shape)
            set_[:] = values
        log.pop("seal")

    assert "none before step 200, 1 s" in changed(folder, drop_the_first)["checkpoints"]


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
        log.attrs["git_revision"] = "another"  # as if no checkpoint could come again
        log.pop("seal")

    assert "motion" in changed(tmp_path, move)


def test_a_run_that_was_killed_is_sealed_when_it_ends(folder):
    process = subprocess.Popen([HAGFISH, "run", "table1", "--quiet", "--out", "killed.h5", "--step-limit", "60"], cwd=folder)
    part = folder / "killed.h5.part"
    while process.poll() is None and not part.exists():
        time.sleep(0.01)
    time.sleep(0.15)
    process.send_signal(signal.SIGKILL)
    process.wait()
    if not part.exists():
        pytest.skip("the run was over before it was killed")
    with h5py.File(part) as log:
        assert "seal" not in log
    hagfish(folder, "run", "--quiet", "--resume", "killed.h5")
    said = hagfish(folder, "check", "killed.h5")
    assert "as the log's end left them" in said
    os.remove(folder / "killed.h5")


def test_a_law_without_eq_6_is_not_asked_for_it(tmp_path):
    """The scene asks for the paper's share; the reflex has no rows of Eq. 6."""
    hagfish(tmp_path, "run", "reflex_overhand", "--quiet", "--set", "expect.speed_share=0.95", "--out", "a.h5")
    said = hagfish(tmp_path, "check", "a.h5")
    assert not [line for line in said.splitlines() if line[5:30].strip() == "Eq. 6"], said
