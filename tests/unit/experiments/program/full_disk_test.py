"""Full disks and quotas at ten sizes: a command works, or says in one line which file it could not write, with exit 1, and leaves
nothing half-written. A limit on a file's size stands for the disk, as it needs no rights; what needs a small disk is left out without."""

from __future__ import annotations

import os
import resource
import subprocess
import sys
from contextlib import contextmanager
from pathlib import Path

import pytest

sys.dont_write_bytecode = True
sys.path.insert(0, str(Path(__file__).parents[3] / "support"))

from program import HAGFISH, hagfish  # noqa: E402

SIZES = [0, 1, 4, 16, 48, 64, 128, 160, 400, 1600]  # kB
COMMANDS = {
    "export": ["export", "a.h5", "--out", "out/tables"],
    "view": ["view", "a.h5", "--out", "out/a.html"],
    "mjcf": ["mjcf", "table1", "--out", "out/mjcf"],
    "program": ["program", "a.h5", "--out", "out/program.csv"],
    "check": ["check", "a.h5", "--csv", "out/check.csv"],
    "picture": ["picture", "a.h5", "--out", "out/a.png"],
    "movie": ["movie", "a.h5", "--out", "out/a.mp4", "--size", "320x180"],
    "figures": ["figures", "a.h5", "--out", "out/figures"],
}


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    """A log, and what each command makes of it: exit code and sizes."""
    folder = tmp_path_factory.mktemp("disk")
    hagfish(folder, "run", "table1", "--preset", "quick", "--quiet", "--set", "time.duration=0.5", "--out", "a.h5")
    return folder


def outcome(folder, command, **options):
    return subprocess.run([HAGFISH, *command], cwd=folder, capture_output=True, text=True, **options)


def made(folder):
    return {path.relative_to(folder): path.read_bytes() for path in sorted(folder.rglob("*")) if path.is_file()}


def judge(whole, command, folder, done):
    """All files are those of a disk with room, or there is a line that names a file that could not be written."""
    files = made(folder)
    for path, content in files.items():
        assert not {".part", ".lock", ".next", ".ffmpeg"} & set(path.suffixes), (path, done)
        assert path.suffix not in (".png", ".mp4", ".html", ".csv", ".xml", ".md", ".txt") or content == full(whole, command)[path], (path, done)
    if done.returncode == 1 and set(files) != set(full(whole, command)):
        last = done.stderr.strip().splitlines()[-1]
        assert len(done.stderr.strip().splitlines()) == 1, done
        assert "/" in last and last.startswith(("hagfish: ", "of_log.py: ")), done
    else:
        assert set(files) == set(full(whole, command)), done


KNOWN: dict[str, dict[Path, bytes]] = {}


def full(whole, command):
    name = command[0]
    if name not in KNOWN:
        (whole / "out").mkdir(exist_ok=True)
        outcome(whole, command)
        KNOWN[name] = made(whole / "out")
        assert KNOWN[name]
        subprocess.run(["rm", "-r", "out"], cwd=whole, check=True)
        (whole / "out").mkdir()
    return KNOWN[name]


def quota(size):
    return lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (1024 * size, 1024 * size))


@pytest.mark.parametrize("name", ["export", "view", "mjcf", "program"])
def test_a_quota(whole, name):
    command = COMMANDS[name]
    full(whole, command)
    for size in SIZES:
        done = outcome(whole, command, preexec_fn=quota(size))
        assert done.returncode in (0, 1), (size, done)
        judge(whole, command, whole / "out", done)
        subprocess.run(["rm", "-r", "out"], cwd=whole, check=True)
        (whole / "out").mkdir()


def test_a_log_is_read_whatever_may_be_written(whole):
    for command in (["info", "a.h5"], ["check", "--fast", "a.h5"]):
        done, free = outcome(whole, command, preexec_fn=quota(0)), outcome(whole, command)
        assert (done.returncode, done.stdout, done.stderr) == (free.returncode, free.stdout, free.stderr) and free.stdout


def test_a_check_says_that_there_is_no_room_for_the_second_run(whole):
    done = outcome(whole, ["check", "a.h5"], preexec_fn=quota(0))
    assert done.returncode == 1 and "cannot be run again: " in done.stdout and "(--fast leaves it out)" in done.stdout, done


def test_a_log_that_memory_does_not_hold_is_one_line(whole):
    free = outcome(whole, ["info", "a.h5"]).stdout
    told = []
    for size in range(56, 130, 4):  # MB; below these the program itself does not start
        done = outcome(whole, ["info", "a.h5"], preexec_fn=lambda size=size: resource.setrlimit(resource.RLIMIT_AS, (10**6 * size, 10**6 * size)))
        if done.returncode == 0:
            assert done.stdout == free, size
        elif done.stderr.startswith("hagfish: a.h5: "):
            told.append(done.stderr)
            assert done.stderr.count("\n") == 1 and "memory" in done.stderr, done
    assert told


@contextmanager
def small_disk(at: Path, size: int):
    done = subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={size}k", "tmpfs", at], capture_output=True)
    if done.returncode != 0:
        pytest.skip("a small disk needs the rights to mount one")
    try:
        yield
    finally:
        subprocess.run(["umount", at], check=True)


@pytest.mark.parametrize("name", ["export", "view", "mjcf", "program", "check", "picture", "movie", "figures"])
def test_a_full_disk(whole, name):
    command = COMMANDS[name]
    full(whole, command)
    sizes = SIZES if name not in ("movie", "figures") else SIZES[1::3]
    for size in sizes[1:]:  # 0 kB is no bound
        with small_disk(whole / "out", size):
            done = outcome(whole, command)
            assert done.returncode in (0, 1), (size, done)
            judge(whole, command, whole / "out", done)


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="no /dev/full")
def test_words_that_do_not_arrive_are_told(whole):
    with open("/dev/full", "w") as full_device:
        for command in (["info", "a.h5"], ["check", "a.h5"], ["scenes"]):
            done = subprocess.run([HAGFISH, *command], cwd=whole, stdout=full_device, stderr=subprocess.PIPE, text=True)
            # By what finds it first: the line, or the end of the program.
            told = ["hagfish: standard output cannot be written\n", "hagfish: cannot write to file: No space left on device\n"]
            assert done.returncode == 1 and done.stderr in told, (command, done.stderr)
