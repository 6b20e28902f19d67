"""Tightening and sliding with the head free (no clamp, no plate), beside the same with the head held.

Usage: free_head.py SWEEPS, where SWEEPS holds held, free and forming.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

import plots
import tables
from hagfish_log import HagfishLog
from script import run_script
from slides import MEAN, draw_over_speed, log_of, read_slides

SHOWN = 2.0  # cm/s, the commanded speed of the paths drawn
HELD = {"ls": ":", "ms": 3.5, "alpha": 0.7}


def head_path(path: Path) -> tuple[np.ndarray, np.ndarray]:
    """How far the head is from where it was held, cm, from tightening until the knot is off."""
    log = HagfishLog(path)
    frames = np.concatenate([log.in_phase(phase) for phase in ("tighten", "slide", "release")])
    head = log["/trajectory/q"][:, :3]
    time = log["/trajectory/time"][frames]
    return time - (time[0] if time.size else 0), np.linalg.norm(head[frames], axis=1)


def main(folder: Path) -> None:
    sets = {name: read_slides(folder / name) for name in ("held", "free")}
    print("Forming with a free head too:", *(f"{s.knot}: {s.failure or 'tied'}" for s in read_slides(folder / "forming")), sep="\n")
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
    plots.save(figure, folder / "free_head.png")

    head = ["head", "knot", "commanded, cm/s", "measured, cm/s", "travel, cm", f"force, median {MEAN}, dyn", f"largest {MEAN}, dyn",
            "steps that meet Eq. 6, %", "penetration, cm", "run"]
    tables.write_table(folder, "free_head", head, [
        [name, s.knot, f"{s.commanded:g}", f"{s.speed:.3g}", f"{s.travel:.1f}", f"{s.force:.0f}", f"{s.peak:.0f}",
         f"{100 * s.met:.1f}", f"{s.penetration:.2g}", s.failure or "complete"] for name, slides in sets.items() for s in slides])


if __name__ == "__main__":
    run_script(__doc__, ["SWEEPS"], main)
