"""Commanded against measured speed of a sliding knot, with the force, the slack of Eq. 6 and the penetration that come of
it. Usage: speeds.py SWEEP OUT.csv OUT.png OUT.md (writes a PDF beside).
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

import plots
import tables
from script import run_script
from slides import FORCE_COLUMNS, MEAN, SLACK_COLUMN, Slide, draw_over_speed, of_knot, read_slides

LEAST_SHARE = 1e-4  # of steps, where a logarithmic axis ends
WITHIN = 0.1  # a speed counts as met when measured to this share


def draw(slides: list[Slide], out: Path) -> None:
    figure, panels = plots.panels(2, 2, (8.2, 6.6), ["speed (open: knot lost, or run failed)", "force", "shortfall of Eq. 6",
                                                     "penetration"])
    speed, force, slack, deep = panels
    draw_over_speed(speed, slides, lambda s: s.speed)
    plots.draw_diagonal(speed, [s.commanded for s in slides])
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


def limits(slides: list[Slide]) -> list[str]:
    """For each knot the fastest command that is met, and why faster ones are not; what it does unasked."""
    lines = ["- Eq. 6 bounds speeds from below. Left almost alone, the bent body's springs slide the knot by themselves: at "
             + ", ".join(f"{s.speed:.2g}" for s in slides if s.commanded == slides[0].commanded)
             + f" cm/s ({', '.join(plots.KNOTS)}) where {slides[0].commanded:g} are commanded."]
    for knot in plots.KNOTS:
        own = of_knot(slides, knot)
        if not own:
            continue
        good = [s for s in own if not s.failure and s.speed >= (1 - WITHIN) * s.commanded]
        best = max((s.commanded for s in good), default=np.nan)
        clean = max((s.commanded for s in own if not s.failure and s.penetration <= s.allowed), default=np.nan)
        beyond = [s for s in own if s.commanded > best]
        why = "; ".join(f"{s.commanded:g}: {s.failure or f'{s.speed:.3g} cm/s, {100 * s.capped:.0f} % of rows at the cap'}"
                        for s in beyond)
        lines.append(f"- {knot}: follows its command to {100 * WITHIN:.0f} % up to {best:g} cm/s and stays within "
                     f"{own[0].allowed:g} cm of penetration up to {clean:g} cm/s. Beyond: {why or 'not tried'}.")
    return lines


def main(folder: Path, table: Path, out: Path, page: Path) -> None:
    slides = read_slides(folder)
    heading = ["knot", "commanded_cm_s", "measured_cm_s", "travel_cm", *FORCE_COLUMNS, "rows_at_cap", SLACK_COLUMN,
               "steps_met", "penetration_cm", "knot_held", "failure"]
    tables.write_csv(table, heading, [[s.knot, s.commanded, s.speed, s.travel, s.force, s.peak, s.capped, s.slack, s.met,
                                       s.penetration, int(s.held), s.failure] for s in slides])
    draw(slides, out)
    tables.write_page(page, ["# How fast a knot slides", "", *limits(slides), "", *tables.of_page(
        page.parent, "speeds", ["knot", "commanded, cm/s", "measured, cm/s", f"force, median {MEAN}, dyn", f"largest {MEAN}, dyn",
         "steps that meet Eq. 6, %", f"slack, median {MEAN}, cm/s", "rows at the cap, %", "penetration, cm", "run"],
        [[s.knot, f"{s.commanded:g}", f"{s.speed:.3g}", f"{s.force:.0f}", f"{s.peak:.0f}", f"{100 * s.met:.1f}",
          f"{round(s.slack, 9):.2g}", f"{100 * s.capped:.0f}", f"{s.penetration:.2g}", s.failure or "complete"]
         for s in slides])])


if __name__ == "__main__":
    run_script(__doc__, ["SWEEP", "OUT.csv", "OUT.png", "OUT.md"], main)
