"""The page of the Table 1 run says what the program does: run, audited and held against its table. So is a preset."""

import os
import subprocess
import sys

from program import ROOT, hagfish, logged

PAGE = ROOT / "experiments/results/table1"


def test_the_page_states_what_the_table_1_run_measures(tmp_path):
    logged(tmp_path, "table1", "--qp", "ipopt")
    hagfish(tmp_path, "check", "a.h5", "--csv", "check.csv")
    modules = os.environ | {"PYTHONPATH": f"{ROOT}/experiments/drawing:{ROOT}/experiments/results"}
    command = [sys.executable, "-B", PAGE / "table1.py", tmp_path / "check.csv", PAGE / "table1.csv", tmp_path]
    done = subprocess.run(command, env=modules, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr


def test_figures_of_the_preset_for_figures_pass_the_audit(tmp_path):
    logged(tmp_path, "table1", "--preset", "figure")
    hagfish(tmp_path, "check", "a.h5")
