"""The knot slid back to the tail, beside its way to the head at the same commanded speed.

Usage: reverse.py SWEEP.
"""

from __future__ import annotations

from pathlib import Path

from typing import Any

import numpy as np

import plots
import tables
from script import run_script
from slides import MEAN, Slide, draw_over_speed, of_knot, read_slides

SHOWN = 2.0  # cm/s, the commanded speed of the paths drawn


def draw_paths(axes: Any, slides: list[Slide]) -> None:
    """Both ends of the knot on its way back."""
    for s in slides:
        if s.commanded == SHOWN and s.time.size:
            look = plots.KNOTS[s.knot]
            for end in (s.tail_end, s.head_end):
                axes.plot(s.time, end, color=look.colour)
                axes.plot(s.time[-1], end[-1], **look.style)
    axes.set(xlabel="time since the turn, s", ylabel="both ends of the knot, cm from the head", ylim=(0, 42.4))


def compare(axes: Any, back: list[Slide], there: list[Slide], what: str) -> None:
    """A measure over commanded speed; that of the way to the head, always at 2 cm/s, as a star."""
    draw_over_speed(axes, back, lambda s: getattr(s, what))
    for knot, look in plots.KNOTS.items():
        slid = [getattr(s, what) for s in of_knot(there, knot) if getattr(s, what) > 0]
        if slid:
            axes.plot(SHOWN, np.median(slid), "*", ms=11, mec="white", mew=0.6, color=look.colour)
    axes.plot([], [], "*", ms=10, color=plots.GREY, label="the way to the head")


def main(folder: Path) -> None:
    back, there = read_slides(folder, "reverse"), read_slides(folder, "slide")
    seconds = lambda s: float(s.time[-1]) if s.time.size else np.nan
    figure, (paths, speed, force) = plots.panels(1, 3, (11.5, 3.9), [f"back at {SHOWN:g} cm/s, until the tail lets go",
                                                                     "speed (open: knot lost early)", "force"])
    draw_paths(paths, back)
    compare(speed, back, there, "speed")
    plots.draw_diagonal(speed, [s.commanded for s in back])
    speed.set_ylabel("measured speed of the tail end, cm/s")
    compare(force, back, there, "force")
    force.set_ylabel(r"sum of the four $\lambda/h$, dyn" + f"\n(median {MEAN})")
    speed.legend(loc="upper left")
    plots.save(figure, folder / "reverse.png")

    head = ["knot", "commanded, cm/s", "measured, cm/s", "tail end moved, cm", "time, s", f"force, median {MEAN}, dyn",
            f"largest {MEAN}, dyn", "steps that meet Eq. 6, %", "penetration, cm", "run"]
    tables.write_table(folder, "reverse", head, [
        [s.knot, f"{s.commanded:g}", f"{s.speed:.3g}", f"{s.travel:.1f}", f"{seconds(s):.1f}", f"{s.force:.0f}", f"{s.peak:.0f}",
         f"{100 * s.met:.1f}", f"{s.penetration:.2g}", s.failure or "untied at the tail"] for s in back])


if __name__ == "__main__":
    run_script(__doc__, ["SWEEP"], main)
