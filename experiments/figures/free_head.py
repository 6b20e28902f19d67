"""Tightening and sliding with the head free (no clamp, no plate), beside the same with the head held.

Usage: free_head.py RUNS OUT.csv OUT.png OUT.md (writes a PDF beside).
"""

from __future__ import annotations

from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

from hagfish_log import HagfishLog, save_figure
from slides import COLOURS, FORCE_COLUMNS, MEAN, SLACK_COLUMN, Slide, knot_label, read_slides
from study import GREY, run_study, write_csv

DPI = 200
SHOWN = 2.0  # cm/s, the commanded speed of the paths drawn


def head_path(folder: Path, name: str) -> tuple[np.ndarray, np.ndarray]:
    """How far the head is from where it was held, cm, from tightening until the knot is off."""
    log = HagfishLog(folder / f"{name}.h5")
    frames = np.concatenate([log.in_phase(phase) for phase in ("tighten", "slide", "release")])
    head = log["/trajectory/q"][:, :3]
    time = log["/trajectory/time"][frames]
    return time - (time[0] if time.size else 0), np.linalg.norm(head[frames], axis=1)


def compare(axes: plt.Axes, sets: list[tuple[list[Slide], str]], what: str) -> None:
    for slides, marker in sets:
        for knot, colour in COLOURS.items():
            own = [s for s in slides if s.knot == knot and getattr(s, what) > 0]
            axes.plot([s.commanded for s in own], [getattr(s, what) for s in own], marker=marker[0], ls=marker[1:],
                      color=colour, lw=1, ms=5, mfc="none" if marker[0] == "s" else colour)
            lost = [s for s in own if s.failure]
            axes.plot([s.commanded for s in lost], [getattr(s, what) for s in lost], "x", color="black", ms=9)
    axes.set(xscale="log", yscale="log", xlabel="commanded speed, cm/s")
    axes.grid(alpha=0.25)


def main(folder: Path, table: Path, out: Path, page: Path) -> None:
    sets = {"held": read_slides(folder, "held"), "free": read_slides(folder, "free")}
    forming = read_slides(folder, "forming")
    heading = ["head", "knot", "commanded_cm_s", "measured_cm_s", "travel_cm", *FORCE_COLUMNS, SLACK_COLUMN, "steps_met",
               "penetration_cm", "knot_held", "failure"]
    write_csv(table, heading, [[head, s.knot, s.commanded, s.speed, s.travel, s.force, s.peak, s.slack, s.met, s.penetration,
                                int(s.held), s.failure] for head, slides in sets.items() for s in slides])

    figure, (left, middle, right) = plt.subplots(1, 3, figsize=(11.5, 3.9), layout="constrained")
    for s in sets["free"]:
        if s.commanded == SHOWN:
            left.plot(*head_path(folder, s.name), color=COLOURS[s.knot], lw=1.3, label=knot_label(s.knot))
    left.set(xlabel="time since the head is free, s", ylabel="head from where it was held, cm")
    left.legend(fontsize=8, frameon=False)
    left.grid(alpha=0.25)
    left.set_title(f"(a) free at {SHOWN:g} cm/s, until the knot is off", loc="left", fontsize=10)
    compare(middle, [(sets["held"], "s:"), (sets["free"], "o-")], "speed")
    line = np.array([min(s.commanded for s in sets["free"]), max(s.commanded for s in sets["free"])])
    middle.plot(line, line, color=GREY, lw=0.8, ls="--", zorder=0)
    middle.set_ylabel("measured speed of the knot's head end, cm/s")
    middle.set_title("(b) discs: free; squares: held; dashed: as commanded", loc="left", fontsize=9)
    compare(right, [(sets["held"], "s:"), (sets["free"], "o-")], "force")
    right.set_ylabel(r"sum of the four $\lambda/h$, dyn" + f"\n(median {MEAN})")
    right.set_title("(c) crossed: the knot was lost", loc="left", fontsize=10)
    save_figure(figure, out, DPI)

    rows = [f"| {head} | {s.knot} | {s.commanded:g} | {s.speed:.3g} | {s.travel:.1f} | {s.force:.0f} | {s.peak:.0f} | "
            f"{100 * s.met:.1f} | {s.penetration:.2g} | {s.failure or 'complete'} |" for head, slides in sets.items() for s in slides]
    towed = [f"- {s.knot}: {s.failure or 'tied all the same'}" for s in forming]
    page.write_text("\n".join(["# A free head", "", "Forming with a free head too:", "", *towed, "",
                               "| head | knot | commanded, cm/s | measured, cm/s | travel, cm | force, median "
                               f"{MEAN}, dyn | largest {MEAN}, dyn | steps that meet "
                               "Eq. 6, % | penetration, cm | run |", "|---" * 10 + "|", *rows, ""]), encoding="utf-8")


if __name__ == "__main__":
    run_study(__doc__, ["OUT.csv", "OUT.png", "OUT.md"], main)
