"""The page of the Table 1 run says what the program does: run, audited and held against its table. Presets pass the audit."""

import subprocess
import sys

import pytest

from program import ROOT, hagfish, logged

SCRIPT, PAGE = ROOT / "experiments/figures/table1.py", ROOT / "experiments/results/table1.csv"


def test_the_page_states_what_the_table_1_run_measures(tmp_path):
    logged(tmp_path, "table1", "--qp", "ipopt")
    hagfish(tmp_path, "check", "a.h5", "--csv", "check.csv")
    done = subprocess.run([sys.executable, "-B", SCRIPT, tmp_path / "check.csv", PAGE, tmp_path / "table1.md"],
                          capture_output=True, text=True)
    assert done.returncode == 0, done.stderr


@pytest.mark.parametrize("preset", ["quick", "figure"])
def test_every_preset_passes_the_audit(tmp_path, preset):
    logged(tmp_path, "table1", "--preset", preset)
    hagfish(tmp_path, "check", "a.h5")
