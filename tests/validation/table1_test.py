"""The page of the Table 1 run says what the program does: run anew, audited, and compared with its table. Presets pass the audit."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PAGE = ROOT / "experiments/results/table1"


def test_the_page_states_what_the_table_1_run_measures(tmp_path):
    program, log, check = os.environ["HAGFISH_PROGRAM"], tmp_path / "table1.h5", tmp_path / "check.csv"
    subprocess.run([program, "run", "table1", "--qp", "ipopt", "--out", log, "--quiet"], check=True)
    subprocess.run([program, "check", log, "--csv", check], check=True, stdout=subprocess.DEVNULL)
    modules = os.environ | {"PYTHONPATH": f"{ROOT}/experiments/drawing:{ROOT}/experiments/results"}
    done = subprocess.run([sys.executable, "-B", PAGE / "table1.py", check, PAGE / "table1.csv", tmp_path],
                          env=modules, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr


@pytest.mark.parametrize("preset", ["quick", "figure"])
def test_every_preset_passes_the_audit(tmp_path, preset):
    program, log = os.environ["HAGFISH_PROGRAM"], tmp_path / "table1.h5"
    subprocess.run([program, "run", "table1", "--preset", preset, "--out", log, "--quiet"], check=True)
    done = subprocess.run([program, "check", log], capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
