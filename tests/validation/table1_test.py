"""The page of the Table 1 run says what the program does: run, audited and held against its table. So is a preset."""

import subprocess
import sys

from program import ROOT, hagfish, logged

SCRIPT, PAGE = ROOT / "experiments/figures/table1.py", ROOT / "experiments/results/table1.csv"


def test_the_page_states_what_the_table_1_run_measures(tmp_path):
    logged(tmp_path, "table1", "--qp", "ipopt")
    hagfish(tmp_path, "check", "a.h5", "--csv", "check.csv")
    done = subprocess.run([sys.executable, "-B", SCRIPT, tmp_path / "check.csv", PAGE, tmp_path / "table1.md"],
                          capture_output=True, text=True)
    assert done.returncode == 0, done.stderr


def test_figures_of_the_preset_for_figures_pass_the_audit(tmp_path):
    logged(tmp_path, "table1", "--preset", "figure")
    hagfish(tmp_path, "check", "a.h5")
