"""A run whose log others read all the time goes to its end and is the run that nobody watched."""

import subprocess
import time

import h5py
import numpy as np

from program import HAGFISH, different, hagfish, logged

RUN = ["table1", "--qp", "ipopt", "--set", "time.duration=16"]  # some seconds, with a save in each


def test_a_watched_run_is_the_unwatched_one(tmp_path):
    alone = logged(tmp_path, *RUN, out="alone.h5")
    command = [HAGFISH, "run", *RUN, "--quiet", "--out", "seen.h5"]
    run = subprocess.Popen(command, cwd=tmp_path, stderr=subprocess.PIPE, text=True)
    part = tmp_path / "seen.h5.part"
    held, frames = [], []
    while run.poll() is None:
        try:
            log = h5py.File(part)
        except (FileNotFoundError, OSError) as error:
            assert not isinstance(error, BlockingIOError), error
            time.sleep(0.01)
            continue
        held.append((log, log["trajectory/q"][()]))  # it stays open
        frames.append(log["trajectory/time"].shape[0])
        if len(held) % 3 == 0:
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
    assert different(alone, tmp_path / "seen.h5") == []
    assert sorted(path.name for path in tmp_path.iterdir()) == ["alone.h5", "seen.h5", "seen.html"]
