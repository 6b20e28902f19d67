"""A run whose log others read all the time goes to its end and is the run that nobody watched."""

from __future__ import annotations

import subprocess
import sys
import time
from pathlib import Path

import h5py
import numpy as np

sys.dont_write_bytecode = True
sys.path.insert(0, str(Path(__file__).parents[3] / "support"))

from program import HAGFISH, hagfish  # noqa: E402

RUN = ["run", "table1", "--quiet", "--qp", "ipopt", "--set", "time.duration=16", "--out"]  # some seconds, with a save in each
CLOCKS = ("wall_time", "qp_time")


def numbers(file: Path) -> dict[str, np.ndarray]:
    found = {}

    def take(name, node):
        if isinstance(node, h5py.Dataset) and node.dtype.kind in "fiu":
            if name.split("/")[-1] not in CLOCKS:
                found[name] = node[()]

    with h5py.File(file) as log:
        log.visititems(take)
    return found


def test_a_watched_run_is_the_unwatched_one(tmp_path):
    hagfish(tmp_path, *RUN, "alone.h5")
    run = subprocess.Popen([HAGFISH, *RUN, "seen.h5"], cwd=tmp_path, stderr=subprocess.PIPE, text=True)
    part = tmp_path / "seen.h5.part"
    held, frames, looks = [], [], 0
    while run.poll() is None:
        try:
            log = h5py.File(part)
        except (FileNotFoundError, OSError) as error:
            assert not isinstance(error, BlockingIOError), error
            time.sleep(0.01)
            continue
        held.append((log, log["trajectory/q"][()]))  # it stays open
        frames.append(log["trajectory/time"].shape[0])
        looks += 1
        if looks % 3 == 0:
            try:
                hagfish(tmp_path, "info", "seen.h5.part")
                hagfish(tmp_path, "view", "seen.h5.part", "--out", "seen.html", "--force")
            except AssertionError:
                if part.exists():  # else the run has ended meanwhile
                    raise
        time.sleep(0.2)
    assert (run.returncode, run.stderr.read()) == (0, "")
    assert len(set(frames)) > 2 and frames == sorted(frames)
    for log, q in held:
        np.testing.assert_array_equal(log["trajectory/q"][()], q)  # what was opened has not changed
        log.close()
    a, b = numbers(tmp_path / "alone.h5"), numbers(tmp_path / "seen.h5")
    assert len(a) > 50 and a.keys() == b.keys()
    for name in a:
        np.testing.assert_array_equal(a[name], b[name], err_msg=name)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["alone.h5", "seen.h5", "seen.html"]
