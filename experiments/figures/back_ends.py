"""QPs of the Table 1 run: error in velocity and KKT residual against the time of a solve, over back ends and
tolerances, from zero and from warm starts.

Usage: back_ends.py RUNS OUT.csv OUT.png (writes a PDF beside), with RUNS/qps.csv of `hagfish qp`.
"""

from __future__ import annotations

import shutil
from pathlib import Path
from typing import Any

import plots
import tables
from script import run_script

BACK_ENDS = {"active-set": plots.Look("active-set", plots.INK, "*"),
             "ipopt": plots.Look("Ipopt, crossed over to a vertex", plots.BLUE, "s"),
             "ipopt-unpolished": plots.Look("Ipopt's own point", plots.ORANGE, "o")}
MEASURES = {"error_norm_relative": "worst error of the velocity,\nH norm, relative", "kkt": "worst scaled KKT residual"}
STARTS = {"cold": "from zero", "warm": "from a warm start"}


def read_table(folder: Path) -> list[dict[str, str]]:
    return tables.read_csv(folder / "qps.csv", ("back_end", "tolerance", "start", "qps", "median_s", "p99_s", "failures", *MEASURES))


def draw(axes: Any, rows: list[dict[str, str]], measure: str) -> None:
    for name, look in BACK_ENDS.items():
        own = [row for row in rows if row["back_end"] == name]
        time = [1e6 * float(row["median_s"]) for row in own]
        slow = [1e6 * float(row["p99_s"]) for row in own]
        error = [float(row[measure]) for row in own]
        axes.hlines(error, time, slow, color=look.colour, lw=0.8, alpha=0.5)
        axes.loglog(time, error, **look.style, ms=12 if look.marker == "*" else 5, lw=0.9,
                    label=look.label + (", by tolerance" if name == "ipopt-unpolished" else ""))
        if name == "ipopt-unpolished":
            # The loosest stand close to each other: one goes up, the next down.
            for up, row, x, y in zip((5, -7, 0, 0, 0), own, time, error):
                axes.annotate(f"{float(row['tolerance']):.0e}", (x, y), (-6, up - 2), textcoords="offset points", ha="right",
                              fontsize=7)
    axes.set_ylabel(MEASURES[measure])


def main(folder: Path, out: Path, png: Path) -> None:
    rows = read_table(folder)
    shutil.copyfile(folder / "qps.csv", out)
    kinds = [(measure, start) for measure in MEASURES for start in STARTS]
    figure, panels = plots.panels(2, 2, (9, 6.6), [f"{rows[0]['qps']} QPs, {STARTS[start]}" for _, start in kinds],
                                  sharex=True, sharey="row")
    for axes, (measure, start) in zip(panels, kinds):
        draw(axes, [row for row in rows if row["start"] == start], measure)
        axes.label_outer()
    for axes in panels[2:]:
        axes.set_xlabel("time of a solve, µs: median, to 99 %")
    panels[0].legend(loc="center left")
    plots.save(figure, png)


if __name__ == "__main__":
    run_script(__doc__, ["RUNS", "OUT.csv", "OUT.png"], main)
