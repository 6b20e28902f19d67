"""The program (HAGFISH_PROGRAM) from Python, and runs of it that tests share."""

import fcntl
import functools
import hashlib
import os
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import h5py
import numpy as np
import pandas

ROOT = Path(__file__).resolve().parents[2]
HAGFISH = Path(os.environ.get("HAGFISH_PROGRAM", ROOT / "build/release/experiments/hagfish"))
RUNS = Path(os.environ.get("HAGFISH_TEST_RUNS", f"{tempfile.gettempdir()}/hagfish_runs_{os.getuid()}"))
# AddressSanitizer stops where HDF5 itself fails, takes memory without bound, and must be loaded before other libraries.
SANITIZED = HAGFISH.exists() and b"__asan_init" in HAGFISH.read_bytes()
OLD = 3600  # s after which runs of another program may go: no tests of it are at work any more
CLOCKS = ("wall_time", "qp_time")  # datasets that no run repeats


def outcome(folder: Path, *arguments: object, **options: object) -> subprocess.CompletedProcess[str]:
    """Runs the program in `folder`, however it ends."""
    return subprocess.run([HAGFISH, *map(str, arguments)], cwd=folder, text=True,
                          **{"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, **options})


def hagfish(folder: Path, *arguments: object, code: int = 0) -> str:
    """Runs the program in `folder`; it must end with `code`. Returns all that it said."""
    done = outcome(folder, *arguments)
    assert done.returncode == code, done.stdout + done.stderr
    return done.stdout + done.stderr


def script(path: str, *arguments: object, folder: Path | None = None) -> subprocess.CompletedProcess[str]:
    """Runs a script of experiments/, with the modules that scripts share."""
    modules = os.environ | {"PYTHONPATH": f"{ROOT}/experiments/drawing:{ROOT}/experiments/results"}
    command = [sys.executable, "-B", ROOT / "experiments" / path, *map(str, arguments)]
    return subprocess.run(command, cwd=folder, env=modules, capture_output=True, text=True)


def refused(folder: Path, *arguments: object, parts: tuple[str, ...] = ()) -> None:
    """Bad input: exit 2, one line that holds every part, nothing left behind."""
    before = sorted(folder.rglob("*"))
    text = hagfish(folder, *arguments, code=2)
    assert text.count("\n") == 1, text
    for part in parts:
        assert part in text, text
    assert sorted(folder.rglob("*")) == before


@functools.cache
def runs_of_this_program() -> Path:
    own = RUNS / hashlib.sha256(HAGFISH.read_bytes()).hexdigest()[:16]
    own.mkdir(parents=True, exist_ok=True)
    own.touch()
    for other in RUNS.iterdir():
        if time.time() - other.stat().st_mtime > OLD:
            shutil.rmtree(other, ignore_errors=True)
    return own


def sets(*settings: str) -> list[str]:
    """Settings as options."""
    return [word for setting in settings for word in ("--set", setting)]


def logged(folder: Path, *arguments: object, out: str = "a.h5") -> Path:
    """The log of `hagfish run` as folder/out. Who asks for the same run, in whichever process, gets a copy of one."""
    words = [str(word) for word in arguments]
    if any((folder / word).is_file() for word in words):  # a scene of the test's own, which nobody shares
        hagfish(folder, "run", *words, "--quiet", "--force", "--out", out)
        return folder / out
    kept = runs_of_this_program() / f"{hashlib.sha256(repr(words).encode()).hexdigest()[:16]}.h5"
    with kept.with_suffix(".lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)  # who comes second waits
        if not kept.exists():
            made = kept.with_suffix(".made")
            hagfish(folder, "run", *words, "--quiet", "--force", "--out", made)
            made.rename(kept)
    return Path(shutil.copyfile(kept, folder / out))


def series(file: h5py.File) -> dict[str, h5py.Dataset]:
    """Datasets of numbers by name, but for those that a clock wrote."""
    found = {}
    file.visititems(lambda name, node: found.__setitem__(name, node) if isinstance(node, h5py.Dataset) else None)
    return {name: node for name, node in found.items() if node.dtype.kind in "fiu" and not name.endswith(CLOCKS)}


def different(a: Path, b: Path, least: int = 50) -> list[str]:
    """Series of numbers that two logs do not have alike, to the last bit, or that one lacks."""
    with h5py.File(a) as first, h5py.File(b) as second:
        x, y = series(first), series(second)
        assert len(x) > least
        same = {name for name in x.keys() & y.keys() if np.array_equal(x[name], y[name], equal_nan=True)}
    return sorted((x.keys() | y.keys()) - same)


def phases(file: h5py.File) -> list[str]:
    """The phase of each frame by its name."""
    kind = file["trajectory/phase"]
    words = {value: word for word, value in h5py.check_enum_dtype(kind.dtype).items()}
    return [words[int(value)] for value in kind]


def table(path: Path) -> dict[str, np.ndarray]:
    """A CSV by its columns: numbers, with nan where a field is empty, or words."""
    read = pandas.read_csv(path, keep_default_na=False, na_values=[""])
    return {name: column.fillna("").to_numpy(str) if column.dtype == object else column.to_numpy(float) for name, column in read.items()}
