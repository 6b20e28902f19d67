"""The page of the Table 1 run says what the program does: run, audited and held against its table. So is a preset."""

from program import ROOT, hagfish, logged, script


def test_the_page_states_what_the_table_1_run_measures(tmp_path):
    logged(tmp_path, "table1", "--qp", "ipopt")
    hagfish(tmp_path, "check", "a.h5", "--csv", "check.csv")
    page = ROOT / "experiments/results/table1"
    done = script(page / "table1.py", tmp_path / "check.csv", page / "table1.csv", tmp_path)
    assert done.returncode == 0, done.stderr


def test_figures_of_the_preset_for_figures_pass_the_audit(tmp_path):
    logged(tmp_path, "table1", "--preset", "figure")
    hagfish(tmp_path, "check", "a.h5")
