"""`hagfish figures`: all figures of a log, and what it says of one that has less to show."""

import re

import h5py
import numpy as np

from program import hagfish, logged

ALL = "report.md overview.png figure7.png figure8.png claims.png claims.json claims.txt summary.md check.csv".split()


def test_all_figures_of_a_run(tmp_path):
    logged(tmp_path, "living_overhand", "--preset", "quick")
    said = hagfish(tmp_path, "figures", "a.h5")
    sizes = {path.name: path.stat().st_size for path in (tmp_path / "a_figures").iterdir()}
    assert "left out" not in said and min(sizes[name] for name in ALL) > 100
    assert "42.4" in (tmp_path / "a_figures/summary.md").read_text()
    report = (tmp_path / "a_figures/report.md").read_text()
    lines = dict(re.findall(r"^- (.+?): (.+)$", report, re.MULTILINE))
    assert "![The run](figure7.png)" in report and "\nOverhand knot, tied by the animal itself\nanimal: " in said
    assert 8 <= report.count("\n- ") <= 10 and lines["knot"] == "overhand, 3_1" and lines["trust it"].startswith("yes")
    with h5py.File(tmp_path / "a.h5") as log:
        time, phase = log["trajectory/time"][()], log["trajectory/phase"][()]
        moment = np.linalg.norm(log["mean/moments/active"][()] + log["mean/moments/thigmotaxis"][()], axis=2).max(axis=1) / 1e5
        begin = {name: int(np.argmax(phase == number)) for name, number in (("slide", 2), ("release", 3), ("free", 4))}
        unknotted = log["knot/determinant"][()] != 3
        tied = np.flatnonzero(unknotted[:begin["slide"]])[-1] + 1
    assert lines["tied"].startswith(f"at {time[tied]:.2f} s") and lines["off"] == f"at {time[begin['free']]:.2f} s"
    largest = [np.nanmax(moment[a + 1:b + 1]) for a, b in ((0, begin["slide"]), (begin["slide"], begin["release"]))]
    assert lines["torques of a joint"] == "up to {:.3g} N cm tying, {:.3g} N cm sliding".format(*largest)
    assert not re.search("KKT|residual", report)
    checks = (tmp_path / "a_figures/check.csv").read_text().splitlines()[1:]
    assert lines["trust it"].startswith(f"yes, it meets all {len(checks)} checks")


def test_a_run_that_never_slid_has_the_rest(tmp_path):
    logged(tmp_path, "table1", "--preset", "quick", "--set", "time.duration=1", out="a.log")  # whatever it is called
    said = hagfish(tmp_path, "figures", "a.log", "--out", "some/\x1b[31mred")
    assert "figure8.png: left out: " in said and said.count("left out") == 1
    assert "tied: no knot is held in this log" in said and "trust it: no" in said and "knot held" in said
    assert "some/\\x1b[31mred/overview.png" in said and "\x1b" not in said
    assert {path.name for path in (tmp_path / "some/\x1b[31mred").glob("*.png")} == {"overview.png", "figure7.png"}
