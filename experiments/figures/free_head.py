"""Tightening and sliding with the head free (no clamp, no plate), beside the same with the head held.

Usage: free_head.py SWEEPS OUT.csv OUT.png OUT.md (writes a PDF beside), where SWEEPS holds held, free and forming.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

import plots
import tables
from hagfish_log import HagfishLog
from script import run_script
from slides import FORCE_COLUMNS, MEAN, SLACK_COLUMN, draw_over_speed, log_of, read_slides

SHOWN = 2.0  # cm/s, the commanded speed of the paths drawn
HELD = {"ls": ":", "ms": 3.5, "alpha": 0.7}


def head_path(path: Path) -> tuple[np.ndarray, np.ndarray]:
    """How far the head is from where it was held, cm, from tightening until the knot is off."""
    log = HagfishLog(path)
    frames = np.concatenate([log.in_phase(phase) for phase in ("tighten", "slide", "release")])
    head = log["/trajectory/q"][:, :3]
    time = log["/trajectory/time"][frames]
    return time - (time[0] if time.size else 0), np.linalg.norm(head[frames], axis=1)


def main(folder: Path, table: Path, out: Path, page: Path) -> None:
    sets = {name: read_slides(folder / name) for name in ("held", "free")}
    forming = read_slides(folder / "forming")
    all_slides = [(head, s) for head, slides in sets.items() for s in slides]
    tables.write_csv(table, ["head", "knot", "commanded_cm_s", "measured_cm_s", "travel_cm", *FORCE_COLUMNS, SLACK_COLUMN,
                             "steps_met", "penetration_cm", "knot_held", "failure"],
                     [[head, s.knot, s.commanded, s.speed, s.travel, s.force, s.peak, s.slack, s.met, s.penetration, int(s.held),
                       s.failure] for head, s in all_slides])

    figure, (paths, speed, force) = plots.panels(1, 3, (11.5, 3.9), [f"free at {SHOWN:g} cm/s, until the knot is off",
                                                                     "speed (open: knot lost)", "force"])
    for s in sets["free"]:
        if s.commanded == SHOWN:
            look, (time, away) = plots.KNOTS[s.knot], head_path(log_of(folder / "free", s.name))
            paths.plot(time, away, label=look.label, markevery=[-1], **look.style)
    paths.set(xlabel="time since the head is free, s", ylabel="head from where it was held, cm")
    paths.legend(loc="upper left")
    for axes, what in ((speed, "speed"), (force, "force")):
        draw_over_speed(axes, sets["held"], lambda s: getattr(s, what), **HELD)
        draw_over_speed(axes, sets["free"], lambda s: getattr(s, what))
    plots.draw_diagonal(speed, [s.commanded for s in sets["free"]])
    speed.set_ylabel("measured speed of the knot's head end, cm/s")
    force.set_ylabel(r"sum of the four $\lambda/h$, dyn" + f"\n(median {MEAN})")
    grey = {"color": plots.GREY, "marker": "o"}
    force.legend(handles=[*force.plot([], [], label="head free", **grey),
                          *force.plot([], [], label="head held", **(grey | HELD))], loc="upper left")
    plots.save(figure, out)

    tables.write_page(page, [
        "# A free head", "", "Forming with a free head too:", "", *(f"- {s.knot}: {s.failure or 'tied all the same'}" for s in forming),
        "", *tables.of_page(
            page.parent, "free_head", ["head", "knot", "commanded, cm/s", "measured, cm/s", "travel, cm", f"force, median {MEAN}, dyn",
             f"largest {MEAN}, dyn", "steps that meet Eq. 6, %", "penetration, cm", "run"],
            [[head, s.knot, f"{s.commanded:g}", f"{s.speed:.3g}", f"{s.travel:.1f}", f"{s.force:.0f}", f"{s.peak:.0f}",
              f"{100 * s.met:.1f}", f"{s.penetration:.2g}", s.failure or "complete"] for head, s in all_slides])])


if __name__ == "__main__":
    run_script(__doc__, ["SWEEPS", "OUT.csv", "OUT.png", "OUT.md"], main)
