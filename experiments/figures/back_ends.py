"""QPs of the Table 1 run: error in velocity and KKT residual against the time of a solve, over back ends and
tolerances, from zero and from warm starts.

Usage: back_ends.py RUNS OUT.csv OUT.png (writes a PDF beside), with RUNS/qps.csv of `hagfish qp`.
"""

from __future__ import annotations

import csv
import shutil
from pathlib import Path
from typing import Any

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

from hagfish_log import LogError, save_figure
from study import run_study

DPI = 200
BACK_ENDS = {"active-set": ("active-set", "#882255", "*"), "ipopt": ("Ipopt, crossed over to a vertex", "#332288", "s"),
             "ipopt-unpolished": ("Ipopt's own point", "#44aa99", "o")}
MEASURES = {"error_norm_relative": "worst error of the velocity,\nH norm, relative", "kkt": "worst scaled KKT residual"}
STARTS = {"cold": "from zero", "warm": "from a warm start"}


def read_table(folder: Path) -> list[dict[str, str]]:
    file = folder / "qps.csv"
    with file.open(newline="", encoding="utf-8") as text:
        rows = list(csv.DictReader(text))
    wanted = {"back_end", "tolerance", "start", "qps", "median_s", "p99_s", "failures", *MEASURES}
    missing = wanted - set(rows[0] if rows else ())
    if missing:
        raise LogError(f"{file}: without column {sorted(missing)[0]}")
    return rows


def draw(axes: Any, rows: list[dict[str, str]], measure: str) -> None:
    for name, (label, colour, marker) in BACK_ENDS.items():
        own = [row for row in rows if row["back_end"] == name]
        time = [1e6 * float(row["median_s"]) for row in own]
        slow = [1e6 * float(row["p99_s"]) for row in own]
        error = [float(row[measure]) for row in own]
        axes.hlines(error, time, slow, color=colour, lw=0.8, alpha=0.5)
        axes.loglog(time, error, marker + "-", color=colour, ms=12 if marker == "*" else 5, lw=0.9, label=label)
        if name == "ipopt-unpolished":
            for row, x, y in zip(own, time, error):
                axes.annotate(row["tolerance"], (x, y), (-5, -2), textcoords="offset points", ha="right", fontsize=7,
                              color=colour)
    axes.set_ylabel(MEASURES[measure])
    axes.grid(which="major", color="#e5e5e5", lw=0.6)


def main(folder: Path, out: Path, png: Path) -> None:
    rows = read_table(folder)
    shutil.copyfile(folder / "qps.csv", out)
    figure, all_axes = plt.subplots(2, 2, figsize=(9, 6.6), layout="constrained", sharex=True, sharey="row")
    for line, measure in zip(all_axes, MEASURES):
        for axes, (start, words) in zip(line, STARTS.items()):
            draw(axes, [row for row in rows if row["start"] == start], measure)
            if measure == next(iter(MEASURES)):
                axes.set_title(f"{rows[0]['qps']} QPs, {words}", loc="left", fontsize=10)
            else:
                axes.set_xlabel("time of a solve, µs: median, to 99 %")
    for line in all_axes:
        line[1].set_ylabel("")
    all_axes[0, 0].legend(fontsize=8, loc="center left")
    save_figure(figure, png, DPI)


if __name__ == "__main__":
    run_study(__doc__, ["OUT.csv", "OUT.png"], main)
