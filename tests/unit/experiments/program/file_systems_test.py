"""File systems without hard links or locks (USB sticks, network shares): commands write their files all the same."""

import os
import subprocess

import pytest

from program import SANITIZED, outcome

LACKS = """#include <errno.h>
int link(const char* from, const char* to) { (void)from; (void)to; errno = EPERM; return -1; }
int flock(int file, int how) { (void)file; (void)how; errno = ENOLCK; return -1; }
"""


@pytest.fixture(scope="module")
def poor(tmp_path_factory):
    """An environment in which the system refuses links and locks."""
    folder = tmp_path_factory.mktemp("poor")
    (folder / "lacks.c").write_text(LACKS)
    subprocess.run(["cc", "-shared", "-fPIC", "-o", folder / "lacks.so", folder / "lacks.c"], check=True)
    return {**os.environ, "LD_PRELOAD": str(folder / "lacks.so")}


@pytest.mark.skipif(SANITIZED, reason="must be loaded before other libraries")
def test_a_run_and_its_tables_are_written_without_links_and_locks(poor, tmp_path):
    run = ["run", "table1", "--quiet", "--set", "time.duration=0.2", "--out", "a.h5"]
    tables, check = ["export", "a.h5", "--out", "tables"], ["check", "a.h5", "--csv", "check.csv"]
    for command in (run, [*run, "--force"], tables, check):
        done = outcome(tmp_path, *command, env=poor)
        assert done.returncode == 0 or command[0] == "check", done
        assert "cannot be" not in done.stderr, done
    assert (tmp_path / "check.csv").exists() and (tmp_path / "tables/summary.csv").exists()
    done = outcome(tmp_path, *run, env=poor)
    assert done.returncode == 2 and "already exists" in done.stderr, done
    assert not [path for path in tmp_path.iterdir() if path.suffix in (".lock", ".part", ".next")]
