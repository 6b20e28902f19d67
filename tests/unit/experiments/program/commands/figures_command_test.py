"""`hagfish figures`: all figures of a log, and what it says of one that has less to show."""

from program import hagfish, logged

ALL = "overview.png figure7.png figure8.png claims.png claims.json claims.txt summary.md check.csv".split()


def test_all_figures_of_a_run(tmp_path):
    logged(tmp_path, "living_overhand", "--preset", "quick")
    said = hagfish(tmp_path, "figures", "a.h5")
    sizes = {path.name: path.stat().st_size for path in (tmp_path / "a_figures").iterdir()}
    assert "left out" not in said and min(sizes[name] for name in ALL) > 100
    assert "42.4" in (tmp_path / "a_figures/summary.md").read_text()


def test_a_run_that_never_slid_has_the_rest(tmp_path):
    logged(tmp_path, "table1", "--preset", "quick", "--set", "time.duration=1", out="a.log")  # whatever it is called
    said = hagfish(tmp_path, "figures", "a.log", "--out", "some/\x1b[31mred")
    assert "figure8.png: left out: " in said and said.count("left out") == 1
    assert "some/\\x1b[31mred/overview.png" in said and "\x1b" not in said
    assert {path.name for path in (tmp_path / "some/\x1b[31mred").glob("*.png")} == {"overview.png", "figure7.png"}
