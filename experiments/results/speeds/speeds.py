"""Commanded against measured speed of a sliding knot, with the force, the slack of Eq. 6 and the penetration that come of
it. Usage: speeds.py SWEEP.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

import plots
import tables
from script import run_script
from slides import MEAN, Slide, read_slides

LEAST_SHARE = 1e-4  # of steps, where a logarithmic axis ends


def draw_over_speed(axes: Any, slides: list[Slide], measure: Callable[[Slide], float], **style: Any) -> None:
    """A measure over commanded speed, a line for each knot; open where the knot was lost or the run failed. What is not
    above 0, which logarithmic axes lack, is left out."""
    for knot, look in plots.KNOTS.items():
        own = [s for s in slides if s.knot == knot and measure(s) > 0]
        axes.plot([s.commanded for s in own], [measure(s) for s in own], label=look.label, **(look.style | style))
        lost = [s for s in own if s.failure]
        axes.plot([s.commanded for s in lost], [measure(s) for s in lost], **(look.style | style | {"ls": "", "mfc": "white"}))
    axes.set(xscale="log", yscale="log", xlabel="commanded speed, cm/s")
    plots.plain_ticks(axes.xaxis, sorted({s.commanded for s in slides}))


def draw(slides: list[Slide], out: Path) -> None:
    figure, panels = plots.panels(2, 2, (8.2, 6.6), ["speed (open: knot lost, or run failed)", "force", "shortfall of Eq. 6",
                                                     "penetration"])
    speed, force, slack, deep = panels
    draw_over_speed(speed, slides, lambda s: s.speed)
    ends = [min(s.commanded for s in slides), max(s.commanded for s in slides)]
    speed.plot(ends, ends, color=plots.GREY, lw=0.8, ls="--", zorder=0, label="as commanded")
    speed.set_ylabel("measured speed, cm/s")
    speed.legend(loc="upper left")
    draw_over_speed(force, slides, lambda s: s.force)
    force.set_ylabel(r"sum of the four $\lambda/h$, dyn" + f"\n(median {MEAN})")
    draw_over_speed(slack, slides, lambda s: max(1 - s.met, LEAST_SHARE) if np.isfinite(s.met) else np.nan)
    slack.set_ylabel("share of steps that fall short of Eq. 6\n(drawn at $10^{-4}$ where none does)")
    draw_over_speed(deep, slides, lambda s: s.penetration)
    deep.set_ylabel("deepest penetration, cm")
    allowed = min(s.allowed for s in slides)
    deep.axhline(allowed, color=plots.GREY, lw=0.8, ls="--", zorder=0)
    deep.text(0.02, allowed * 0.9, "strictest bound of the scenes", color=plots.GREY, fontsize=8, va="top",
              transform=deep.get_yaxis_transform())
    plots.save(figure, out)


def main(folder: Path) -> None:
    slides = read_slides(folder)
    draw(slides, folder / "speeds.png")
    head = ["knot", "commanded, cm/s", "measured, cm/s", f"force, median {MEAN}, dyn", f"largest {MEAN}, dyn",
            "steps that meet Eq. 6, %", f"slack, median {MEAN}, cm/s", "rows at the cap, %", "penetration, cm", "run"]
    tables.write_table(folder, "speeds", head, [
        [s.knot, f"{s.commanded:g}", f"{s.speed:.3g}", f"{s.force:.0f}", f"{s.peak:.0f}", f"{100 * s.met:.1f}",
         f"{round(s.slack, 9):.2g}", f"{100 * s.capped:.0f}", f"{s.penetration:.2g}", s.failure or "complete"] for s in slides])


if __name__ == "__main__":
    run_script(__doc__, ["SWEEP"], main)
