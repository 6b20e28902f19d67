"""`hagfish sweep` and what reads its tables: parts, gathered, are the table of one process, byte for byte."""

from __future__ import annotations

import sys
from pathlib import Path

ROOT = Path(__file__).parents[4]
sys.dont_write_bytecode = True
sys.path[:0] = [str(ROOT / "tests/support"), str(ROOT / "experiments/drawing")]

import gather  # noqa: E402
from program import hagfish  # noqa: E402
from sweep_columns import read_sweep  # noqa: E402

GRID = """
scene = "table1"
set = ["time.step=0.02", "time.duration=0.4", "start.noise_deg=0.1"]
seeds = 3
[[axis]]
"model.limit_scale" = [0.9, 1.1]
[[axis]]
"title" = ["a", "b, c"]
"""


def test_parts_gathered_are_the_whole_byte_for_byte(tmp_path):
    (tmp_path / "grid.toml").write_text(GRID)
    hagfish(tmp_path, "sweep", "grid.toml", "--out", "whole", "--quiet")
    for part in (2, 3, 1):
        hagfish(tmp_path, "sweep", "grid.toml", "--out", "parts", "--part", f"{part}/3", "--quiet")
    gather.main(tmp_path / "parts")
    assert (tmp_path / "parts/table.csv").read_bytes() == (tmp_path / "whole/table.csv").read_bytes()
    table = read_sweep(tmp_path / "whole/table.csv")
    assert table.axes["title"] == 2 * (3 * ["a"] + 3 * ["b, c"])
    assert len(set(table.figures["work_tip_erg"])) > 1
    assert set(table.figures["duration_s"]) == {0.4}  # to the end of the last step, which is no frame
