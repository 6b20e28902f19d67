"""Full disks and quotas of several sizes: a command works, or says in one line which file it could not write, with exit
1, and leaves nothing half-written. A limit on a file's size stands for the disk where there are no rights to mount one."""

import ctypes
import os
import resource
import shutil
import subprocess
from contextlib import contextmanager
from pathlib import Path

import pytest

from program import SANITIZED, logged, outcome

COMMANDS = {
    "export": ["export", "a.h5", "--out", "out/tables"],
    "view": ["view", "a.h5", "--out", "out/a.html"],
    "mjcf": ["mjcf", "table1", "--out", "out/mjcf"],
    "program": ["program", "a.h5", "--out", "out/program.csv"],
    "check": ["check", "a.h5", "--csv", "out/check.csv"],
    "picture": ["picture", "a.h5", "--out", "out/a.png"],
    "movie": ["movie", "a.h5", "--out", "out/a.mp4", "--size", "320x180"],
    "figures": ["figures", "a.h5", "--out", "out/figures"],
    "sweep": ["sweep", "grid.toml", "--quiet", "--out", "out/sweep"],
    "run": ["run", "table1", "--set", "time.duration=0.1", "--quiet", "--out", "out/b.h5"],
}
REPEATED = (".png", ".mp4", ".html", ".csv", ".xml", ".md", ".txt")  # files that are the same each time


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    folder = tmp_path_factory.mktemp("disk")
    logged(folder, "table1", "--preset", "quick", "--set", "time.duration=0.5")
    (folder / "grid.toml").write_text('scene = "table1"\nset = ["time.duration=0.1"]\n[[axis]]\n"drag.normal" = [1, 2]\n')
    return folder


def emptied(out):
    shutil.rmtree(out, ignore_errors=True)
    out.mkdir()
    return out


def made(out):
    return {path.relative_to(out): path.read_bytes() for path in out.rglob("*") if path.is_file()}


def judge(done, files, full):
    """All files are those of a disk with room, or one line names one that could not be written."""
    assert done.returncode in (0, 1), done
    for path, content in files.items():
        assert not {".part", ".lock", ".next", ".ffmpeg"} & set(path.suffixes), (path, done)
        assert path.suffix not in REPEATED or content == full[path], (path, done)
    if set(files) != set(full):
        (line,) = done.stderr.strip().splitlines()
        assert done.returncode == 1 and "/" in line and line.startswith(("hagfish: ", "of_log.py: ")), done


def limit(what, size):
    return lambda: resource.setrlimit(what, (size, size))


@contextmanager
def small_disk(at: Path, size: int):
    done = subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={size}k", "tmpfs", at], capture_output=True)
    if done.returncode != 0:
        pytest.skip("a small disk needs the rights to mount one")
    try:
        yield
    finally:
        subprocess.run(["umount", at], check=True)


@pytest.mark.parametrize("name", ["export", "view", "mjcf", "program"])
def test_a_quota(folder, name):
    out = emptied(folder / "out")
    outcome(folder, *COMMANDS[name])
    full = made(out)
    for size in (0, 1, 4, 16, 48, 64, 128, 160, 400, 1600):  # kB
        emptied(out)
        done = outcome(folder, *COMMANDS[name], preexec_fn=limit(resource.RLIMIT_FSIZE, 1024 * size))
        judge(done, made(out), full)


@pytest.mark.parametrize("name", ["export", "check", "picture", "movie", "figures", "run", "sweep"])
def test_a_full_disk(folder, name):
    out = emptied(folder / "out")
    outcome(folder, *COMMANDS[name])
    full = made(out)
    emptied(out)
    sizes = {"figures": (64,), "run": (64,), "sweep": (1,)}  # kB; 0 is no bound
    for size in sizes.get(name, (1, 4, 64, 400)):
        with small_disk(out, size):
            judge(outcome(folder, *COMMANDS[name]), made(out), full)


def test_a_log_is_read_whatever_may_be_written(folder):
    none = limit(resource.RLIMIT_FSIZE, 0)
    for command in (["info", "a.h5"], ["check", "--fast", "a.h5"]):
        done, free = outcome(folder, *command, preexec_fn=none), outcome(folder, *command)
        assert free.stdout and (done.returncode, done.stderr) == (free.returncode, free.stderr)
        assert done.stdout == free.stdout
    done = outcome(folder, "check", "a.h5", preexec_fn=none)
    assert done.returncode == 1
    assert "cannot be run again: " in done.stdout and "(--fast leaves it out)" in done.stdout


@pytest.mark.skipif(SANITIZED, reason="takes memory without bound")
def test_a_log_that_memory_does_not_hold_is_one_line(folder):
    free, told = outcome(folder, "info", "a.h5").stdout, 0
    for size in range(44, 130):  # MB; below some of these the program itself does not start
        done = outcome(folder, "info", "a.h5", preexec_fn=limit(resource.RLIMIT_AS, 10**6 * size))
        if done.returncode == 0:
            assert done.stdout == free, size
        elif done.stderr.startswith("hagfish: a.h5: "):
            told += 1
            assert done.stderr.count("\n") == 1 and "memory" in done.stderr, done
    assert told


def test_a_small_stack_grows_or_is_told(folder):
    def stack(hard):
        ctypes.CDLL(None).prctl(24, 24)  # drops CAP_SYS_RESOURCE, by which the superuser may raise the limit
        resource.setrlimit(resource.RLIMIT_STACK, (64 << 10, hard))

    free = outcome(folder, "check", "a.h5")
    assert outcome(folder, "check", "a.h5", preexec_fn=lambda: stack(8 << 20)).stdout == free.stdout != ""
    told = outcome(folder, "check", "a.h5", preexec_fn=lambda: stack(64 << 10))
    line = "hagfish: the stack is too small, and may not grow: 2 MB are needed (ulimit -s 2048)\n"
    assert (told.returncode, told.stdout, told.stderr) == (1, "", line)


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="no /dev/full")
def test_words_that_do_not_arrive_are_told(folder):
    # By what finds it first: the line, or the end of the program.
    told = ["hagfish: standard output cannot be written\n", "hagfish: cannot write to file: No space left on device\n"]
    with open("/dev/full", "w") as full_device:
        for command in (["info", "a.h5"], ["check", "a.h5"], ["scenes"]):
            done = outcome(folder, *command, stdout=full_device)
            assert done.returncode == 1 and done.stderr in told, (command, done.stderr)
