"""README says of the Table 1 run what the program does: run anew, audited, and compared with the table between the markers.
Presets pass the audit, as experiments/README.md says."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]


def test_readme_states_what_the_table_1_run_measures(tmp_path):
    program, log, check = os.environ["HAGFISH_PROGRAM"], tmp_path / "table1.h5", tmp_path / "check.csv"
    subprocess.run([program, "run", "table1", "--qp", "ipopt", "--out", log, "--quiet"], check=True)
    subprocess.run([program, "check", log, "--csv", check], check=True, stdout=subprocess.DEVNULL)
    done = subprocess.run([sys.executable, "-B", ROOT / "experiments/figures/readme.py", check, ROOT / "README.md",
                           tmp_path / "readme.md"], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr


@pytest.mark.parametrize("preset", ["quick", "default"])
def test_every_preset_passes_the_audit(tmp_path, preset):
    program, log = os.environ["HAGFISH_PROGRAM"], tmp_path / "table1.h5"
    subprocess.run([program, "run", "table1", "--preset", preset, "--out", log, "--quiet"], check=True)
    done = subprocess.run([program, "check", log], capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
