"""The knot slid back to the tail, beside its way to the head at the same commanded speed.

Usage: reverse.py RUNS OUT.csv OUT.png OUT.md (writes a PDF beside).
"""

from __future__ import annotations

from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

from hagfish_log import save_figure
from slides import COLOURS, FORCE_COLUMNS, MEAN, SLACK_COLUMN, Slide, knot_label, read_slides
from study import GREY, run_study, write_csv

DPI = 200
SHOWN = 2.0  # cm/s, the commanded speed of the paths drawn


def paths(axes: plt.Axes, slides: list[Slide]) -> None:
    """Both ends of the knot on its way back."""
    for s in slides:
        if s.commanded == SHOWN and s.time.size:
            axes.plot(s.time, s.tail_end, color=COLOURS[s.knot], lw=1.2, label=knot_label(s.knot))
            axes.plot(s.time, s.head_end, color=COLOURS[s.knot], lw=1.2)
    axes.set(xlabel="time since the turn, s", ylabel="both ends of the knot, cm from the head", ylim=(0, 42.4))
    axes.legend(fontsize=8, frameon=False, loc=(0.5, 0.38))
    axes.set_title(f"(a) back at {SHOWN:g} cm/s, until the tail lets go", loc="left", fontsize=10)


def against_speed(axes: plt.Axes, back: list[Slide], there: list[Slide], what: str) -> None:
    """A measure over commanded speed; the way to the head, always at 2 cm/s, as a square."""
    for knot, colour in COLOURS.items():
        own = [s for s in back if s.knot == knot and getattr(s, what) > 0]
        axes.plot([s.commanded for s in own], [getattr(s, what) for s in own], "-", color=colour, lw=1)
        for s in own:
            axes.plot(s.commanded, getattr(s, what), "o", ms=4.5, color=colour, mfc="white" if s.failure else colour)
        slid = [getattr(s, what) for s in there if s.knot == knot and getattr(s, what) > 0]
        if slid:
            axes.plot(SHOWN, np.median(slid), "s", ms=7, color=colour, mfc="none")
    axes.set(xscale="log", yscale="log", xlabel="commanded speed, cm/s")
    axes.grid(alpha=0.25)


def main(folder: Path, table: Path, out: Path, page: Path) -> None:
    back, there = read_slides(folder, "reverse", "reverse"), read_slides(folder, "reverse", "slide")
    heading = ["knot", "commanded_cm_s", "measured_cm_s", "travel_cm", "seconds", *FORCE_COLUMNS, SLACK_COLUMN, "steps_met",
               "penetration_cm", "knot_held", "failure"]
    seconds = lambda s: float(s.time[-1]) if s.time.size else np.nan
    write_csv(table, heading, [[s.knot, s.commanded, s.speed, s.travel, seconds(s), s.force, s.peak, s.slack, s.met,
                                s.penetration, int(s.held), s.failure] for s in back])

    figure, (left, middle, right) = plt.subplots(1, 3, figsize=(11.5, 3.9), layout="constrained")
    paths(left, back)
    against_speed(middle, back, there, "speed")
    line = np.array([min(s.commanded for s in back), max(s.commanded for s in back)])
    middle.plot(line, line, color=GREY, lw=0.8, ls="--", zorder=0)
    middle.set_ylabel("measured speed of the tail end, cm/s")
    middle.set_title("(b) dashed: as commanded; open: knot lost early", loc="left", fontsize=10)
    against_speed(right, back, there, "force")
    right.set_ylabel(r"sum of the four $\lambda/h$, dyn" + f"\n(median {MEAN})")
    right.set_title("(c) squares: the way to the head", loc="left", fontsize=10)
    save_figure(figure, out, DPI)

    rows = [f"| {s.knot} | {s.commanded:g} | {s.speed:.3g} | {s.travel:.1f} | {seconds(s):.1f} | {s.force:.0f} | {s.peak:.0f} | "
            f"{100 * s.met:.1f} | {s.penetration:.2g} | {s.failure or 'untied at the tail'} |" for s in back]
    page.write_text("\n".join(["# The reverse slide", "",
                               "From the head back to the tail; the way ends near the tail's tip, at the scene's `release_at`, where the knot may go.", "",
                               "| knot | commanded, cm/s | measured, cm/s | tail end moved, cm | time, s | force, median "
                               f"{MEAN}, dyn | largest {MEAN}, dyn | steps that "
                               "meet Eq. 6, % | penetration, cm | run |", "|---" * 10 + "|", *rows, ""]), encoding="utf-8")


if __name__ == "__main__":
    run_study(__doc__, ["OUT.csv", "OUT.png", "OUT.md"], main)
