"""Commanded against measured speed of a sliding knot, with the force, the slack of Eq. 6 and the penetration that come of
it. Usage: speeds.py RUNS OUT.csv OUT.png OUT.md (writes a PDF beside).
"""

from __future__ import annotations

from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

from hagfish_log import save_figure
from slides import COLOURS, FORCE_COLUMNS, MEAN, SLACK_COLUMN, Slide, knot_label, of_knot, read_slides
from study import GREY, run_study, write_csv

DPI = 200
WITHIN = 0.1  # a speed counts as met when measured to this share


def panel(axes: plt.Axes, slides: list[Slide], values: list[float], ylabel: str) -> None:
    """One measure over commanded speed, a line for each knot; open where the knot was lost or stayed on."""
    for knot, colour in COLOURS.items():
        own = [(s, v) for s, v in zip(slides, values) if s.knot == knot and np.isfinite(v)]
        axes.plot([s.commanded for s, _ in own], [v for _, v in own], "-", color=colour, lw=1)
        for good in (True, False):
            some = [(s.commanded, v) for s, v in own if (not s.failure) == good]
            axes.plot(*(zip(*some) if some else ([], [])), "o", color=colour, ms=4.5, mfc=colour if good else "white",
                      label=knot_label(knot) if good else None)
    axes.set(xscale="log", yscale="log", xlabel="commanded speed, cm/s")
    axes.set_ylabel(ylabel)
    axes.grid(alpha=0.25, which="major")


def draw(slides: list[Slide], out: Path) -> None:
    figure, grid = plt.subplots(2, 2, figsize=(8.2, 6.6), layout="constrained")
    (speed, force), (slack, deep) = grid
    panel(speed, slides, [s.speed for s in slides], "measured speed, cm/s")
    line = np.array([min(s.commanded for s in slides), max(s.commanded for s in slides)])
    speed.plot(line, line, color=GREY, lw=0.8, ls="--", zorder=0)
    speed.text(2 * line[0], 1.3 * line[0], "as commanded", color=GREY, fontsize=8)
    panel(force, slides, [s.force for s in slides], r"sum of the four $\lambda/h$, dyn" + f"\n(median {MEAN})")
    panel(slack, slides, [max(1 - s.met, 1e-4) if np.isfinite(s.met) else np.nan for s in slides],
          "share of steps that fall short of Eq. 6\n(drawn at $10^{-4}$ where none does)")
    panel(deep, slides, [s.penetration for s in slides], "deepest penetration, cm")
    allowed = min(s.allowed for s in slides)
    deep.axhline(allowed, color=GREY, lw=0.8, ls="--", zorder=0)
    deep.text(line[0], allowed * 0.9, "strictest bound of the scenes", color=GREY, fontsize=8, va="top")
    speed.legend(fontsize=8, frameon=False, title="open: knot lost, or run failed", title_fontsize=7)
    for axes, letter in zip(grid.flat, "abcd"):
        axes.set_title(f"({letter})", loc="left", fontsize=10)
    save_figure(figure, out, DPI)


def limits(slides: list[Slide]) -> list[str]:
    """For each knot the fastest command that is met, and why faster ones are not; what it does unasked."""
    lines = ["- Eq. 6 bounds speeds from below. Left almost alone, the bent body's springs slide the knot by themselves: at "
             + ", ".join(f"{s.speed:.2g}" for s in slides if s.commanded == slides[0].commanded)
             + f" cm/s ({', '.join(COLOURS)}) where {slides[0].commanded:g} are commanded."]
    for knot in COLOURS:
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
    slides = read_slides(folder, "speed")
    heading = ["knot", "commanded_cm_s", "measured_cm_s", "travel_cm", *FORCE_COLUMNS, "rows_at_cap", SLACK_COLUMN,
               "steps_met", "penetration_cm", "knot_held", "failure"]
    write_csv(table, heading, [[s.knot, s.commanded, s.speed, s.travel, s.force, s.peak, s.capped, s.slack, s.met,
                                s.penetration, int(s.held), s.failure] for s in slides])
    draw(slides, out)
    rows = [f"| {s.knot} | {s.commanded:g} | {s.speed:.3g} | {s.force:.0f} | {s.peak:.0f} | {100 * s.met:.1f} | "
            f"{round(s.slack, 9):.2g} | {100 * s.capped:.0f} | {s.penetration:.2g} | {s.failure or 'complete'} |" for s in slides]
    page.write_text("\n".join(["# How fast a knot slides", "", *limits(slides), "",
                               "| knot | commanded, cm/s | measured, cm/s | force, median "
                               f"{MEAN}, dyn | largest {MEAN}, dyn | steps that meet Eq. 6, % | slack, median {MEAN}, "
                               "cm/s | rows at the cap, % | penetration, cm | run |", "|---" * 10 + "|", *rows, ""]),
                    encoding="utf-8")


if __name__ == "__main__":
    run_study(__doc__, ["OUT.csv", "OUT.png", "OUT.md"], main)
