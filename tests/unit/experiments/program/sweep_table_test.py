"""`hagfish sweep` and what reads its tables: threads and gathered parts make one table, byte for byte."""

import gather
from program import hagfish
from sweep_columns import read_sweep

GRID = """
scene = "table1"
set = ["time.step=0.02", "time.duration=0.4", "start.noise_deg=0.1"]
seeds = 3
[[axis]]
"model.limit_scale" = [0.9, 1.1]
[[axis]]
"title" = ["a", "b, c"]
"""


def test_threads_and_gathered_parts_make_the_same_table(tmp_path):
    (tmp_path / "grid.toml").write_text(GRID)
    for threads in (1, 4):
        hagfish(tmp_path, "sweep", "grid.toml", "--out", f"by{threads}", "--threads", threads, "--quiet")
    for part in (2, 3, 1):
        hagfish(tmp_path, "sweep", "grid.toml", "--out", "parts", "--part", f"{part}/3", "--quiet")
    gather.main(tmp_path / "parts")
    assert len({(tmp_path / folder / "table.csv").read_bytes() for folder in ("by1", "by4", "parts")}) == 1
    table = read_sweep(tmp_path / "by1/table.csv")
    assert table.axes["title"] == 2 * (3 * ["a"] + 3 * ["b, c"])
    assert len(set(table.figures["work_tip_erg"])) > 1
    assert set(table.figures["duration_s"]) == {0.4}  # to the end of the last step, which is no frame
    assert len((tmp_path / "by1/times.csv").read_text().splitlines()) == 1 + 12
