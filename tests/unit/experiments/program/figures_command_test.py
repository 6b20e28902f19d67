"""`hagfish figures`: all figures of a log, and what it says of one that has less to show."""

from __future__ import annotations

import sys
from pathlib import Path

sys.dont_write_bytecode = True
sys.path.insert(0, str(Path(__file__).parents[3] / "support"))

from program import hagfish, refused  # noqa: E402

ALL = {"overview.png", "figure7.png", "figure8.png", "claims.png", "claims.json", "claims.txt", "summary.md", "check.csv"}


def test_all_figures_of_a_run(tmp_path):
    hagfish(tmp_path, "run", "living_overhand", "--preset", "quick", "--quiet", "--out", "a.h5")
    said = hagfish(tmp_path, "figures", "a.h5")
    names = {path.name for path in (tmp_path / "a_figures").iterdir()}
    assert ALL <= names and "left out" not in said
    for name in ALL:
        assert (tmp_path / "a_figures" / name).stat().st_size > 100, name
    assert "42.4" in (tmp_path / "a_figures/summary.md").read_text()


def test_a_run_that_never_slid_has_the_rest(tmp_path):
    hagfish(tmp_path, "run", "table1", "--preset", "quick", "--quiet", "--set", "time.duration=1", "--out", "a.h5")
    said = hagfish(tmp_path, "figures", "a.h5", "--out", "some/where")
    assert "figure8.png: left out: " in said and said.count("left out") == 1
    assert {path.name for path in (tmp_path / "some/where").glob("*.png")} == {"overview.png", "figure7.png"}
    (tmp_path / "a.h5").rename(tmp_path / "a.log")  # whatever it is called
    said = hagfish(tmp_path, "figures", "a.log", "--out", "\x1b[31mred")
    assert "figure8.png: left out: " in said and "\\x1b[31mred/overview.png" in said and "\x1b" not in said


def test_bad_input_is_one_line(tmp_path):
    refused(tmp_path, "figures", "none.h5", parts=("none.h5", "no such file"))
    (tmp_path / "text.h5").write_text("no log")
    refused(tmp_path, "figures", "text.h5", parts=("text.h5",))
