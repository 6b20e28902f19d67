import os
import subprocess
from pathlib import Path

import h5py
import numpy as np
import pytest


@pytest.fixture(scope="session")
def program():
    """Calls the program; gives its exit code and what it wrote on standard error."""

    def call(*arguments):
        done = subprocess.run([os.environ["HAGFISH_PROGRAM"], *map(str, arguments)], capture_output=True, text=True)
        return done.returncode, done.stderr.strip()

    return call


@pytest.fixture(scope="session")
def verdicts(program):
    """Criteria of `hagfish check` that a log does not meet."""

    def of(log: Path):
        table = log.with_suffix(".csv")
        program("check", log, "--csv", table, "--force")
        rows = [line.split(",") for line in table.read_text().splitlines()]
        name, met = rows[0].index("criterion"), rows[0].index("met")
        return {row[name] for row in rows[1:] if row[met] != "yes"}

    return of


@pytest.fixture(scope="session")
def differences():
    """Numeric datasets, but for wall times, that differ in two logs, or that one lacks."""

    def between(a: Path, b: Path):
        def series(file):
            found = {}
            file.visititems(lambda name, node: found.__setitem__(name, node) if isinstance(node, h5py.Dataset) else None)
            kept = {name: node for name, node in found.items() if node.dtype.kind in "fiu"}
            return {
                name: node[()]
                for name, node in kept.items()
                if name.split("/")[-1] not in ("wall_time", "qp_time")
            }

        with h5py.File(a) as first, h5py.File(b) as second:
            x, y = series(first), series(second)
        same = {name for name in x.keys() & y.keys() if np.array_equal(x[name], y[name], equal_nan=True)}
        assert len(same) > 50 or len(x) > 50
        return sorted((x.keys() | y.keys()) - same)

    return between
