"""Commanded against measured speed of a sliding knot, with the force, the slack of Eq. 6 and the penetration that come of
it. Usage: speeds.py SWEEP.
"""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import plots
import tables
from script import run_script
from slides import MEAN, read_slides
from sweep_columns import BOTH_ENDS

HEAD = ["knot", "commanded, cm/s", "head end, cm/s", "its slide", f"force, median {MEAN}, dyn", f"largest {MEAN}, dyn", "steps that meet Eq. 6, %",
        f"slack, median {MEAN}, cm/s", "rows at the cap, %", "penetration, cm", "run"]
COMMANDED, MEASURED, SLIDE, FORCE, MET, DEEP, RUN = (HEAD[k] for k in (1, 2, 3, 4, 6, 9, 10))


def good(row: dict[str, str]) -> bool:
    return row[RUN] == "complete" and row[SLIDE] == BOTH_ENDS


def draw_over_speed(axes: Any, rows: list[dict[str, str]], measure: Callable[[dict[str, str]], float]) -> None:
    """A measure over commanded speed, a line for each knot; open where it did not slide by both ends, was lost, or the run failed."""
    for knot, look in plots.KNOTS.items():
        for style, own in (({}, rows), ({"mfc": "white", "ls": ""}, [row for row in rows if not good(row)])):
            of = [row for row in own if row["knot"] == knot]
            axes.plot([float(row[COMMANDED]) for row in of], [measure(row) for row in of], **(look.style | style))
    axes.set(xscale="log", xlabel="commanded speed, cm/s")
    plots.plain_ticks(axes.xaxis, [0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50])


def draw(rows: list[dict[str, str]], allowed: float, out: Path) -> None:
    """`allowed`: the least penetration that a scene bounds, cm."""
    figure, panels = plots.panels(2, 2, (plots.WIDTH, 6), ["speed", "force", "steps that fall short of Eq. 6", "penetration"])
    speed, force, short, deep = panels
    draw_over_speed(speed, rows, lambda row: float(row[MEASURED]))
    ends = [0.1, 50]
    speed.plot(ends, ends, color=plots.GREY, lw=0.8, ls="--", zorder=0)
    speed.text(0.22, 0.11, "as commanded", color=plots.GREY, fontsize=8)
    draw_over_speed(force, rows, lambda row: float(row[FORCE]))
    draw_over_speed(short, rows, lambda row: 100 - float(row[MET]))
    draw_over_speed(deep, rows, lambda row: 1e4 * float(row[DEEP]))
    deep.axhline(1e4 * allowed, color=plots.GREY, lw=0.8, ls="--", zorder=0)
    deep.text(0.1, 1.02e4 * allowed, "strictest bound of the scenes", color=plots.GREY, fontsize=8, va="bottom")
    for axes, label, top in ((short, "share, %", None), (deep, "deepest, µm", 1.15e4 * allowed)):
        axes.set(ylabel=label, ylim=(0, top))
    for axes, label, ticks in ((speed, "measured speed, cm/s", [0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50]),
                               (force, "sum of all $\\lambda/h$, dyn", [50, 100, 200, 500, 1000, 2000, 5000, 10000, 20000])):
        axes.set(ylabel=label, yscale="log")
        plots.plain_ticks(axes.yaxis, ticks)
    handles = plots.knot_handles(speed)
    if not all(map(good, rows)):
        handles += speed.plot([], [], color=plots.INK, marker="o", mfc="white", ls="", label="no slide by both ends, or knot lost")
    plots.legend_above(figure, handles, 3, 0.08)
    plots.save(figure, out)


def main(folder: Path) -> None:
    slides = read_slides(folder)
    tables.write_table(folder, "speeds", HEAD, [
        [s.knot, f"{s.commanded:g}", f"{s.speed:.3g}", s.kind or "-", f"{s.force:.0f}", f"{s.peak:.0f}", f"{100 * s.met:.1f}",
         f"{round(s.slack, 9):.2g}", f"{100 * s.capped:.0f}", f"{s.penetration:.2g}", s.failure or "complete"] for s in slides])
    draw(tables.read_csv(folder / "tables/speeds.csv", HEAD), min(s.allowed for s in slides), folder / "speeds.png")


if __name__ == "__main__":
    run_script(__doc__, ["SWEEP"], main)
