"""README says of the Table 1 run what the program does: run anew, audited, and compared with the table between the markers."""

import os
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parents[2]


def test_readme_states_what_the_table_1_run_measures(tmp_path):
    program, log, check = os.environ["HAGFISH_PROGRAM"], tmp_path / "table1.h5", tmp_path / "check.csv"
    subprocess.run([program, "run", "table1", "--qp", "ipopt", "--out", log, "--quiet"], check=True)
    subprocess.run([program, "check", log, "--csv", check], check=True, stdout=subprocess.DEVNULL)
    done = subprocess.run([sys.executable, "-B", ROOT / "experiments/figures/readme.py", check, ROOT / "README.md",
                           tmp_path / "readme.md"], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
