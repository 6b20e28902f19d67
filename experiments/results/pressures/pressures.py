"""What contacts of a knot press with: table and figure of study.sh.

Usage: pressures.py FOLDER. FOLDER is what the study leaves. The table comes in its folder tables.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

import plots
import tables
from hagfish_log import HagfishLog
from script import run_script

STIFFNESSES = ("6e4", "1e5", "3e5")
KPA = 1e-4  # of dyn/cm²


def lens(stiffness: float, radius: float) -> tuple[np.ndarray, np.ndarray]:
    """Forces (dyn) with which two like tubes press that cross, and the pressures (dyn/cm²) of flesh in the middle."""
    overlap = np.linspace(0, radius, 2001)
    force = stiffness * 4 / 3 * overlap * np.sqrt(2 * (2 * radius - overlap) * overlap)
    return force, stiffness * np.sqrt(overlap / (4 * radius))


def main(folder: Path) -> None:
    rows = []
    figure, axes = plots.panels(1, 2, (plots.WIDTH, 2.9), ["largest pressure, frame by frame", "largest at any frame, by place"])
    for scene, knot in plots.SCENES.items():
        look = plots.KNOTS[knot]
        hard = HagfishLog(folder / "runs" / f"{scene}_0.h5")
        own = np.isin(hard["/contacts/frame"], hard.in_phase("slide")) & (hard["/contacts/spline_b"] >= 0)
        forces = hard["/contacts/force"][own]
        radius = float(np.median(hard["/model/radius"]))
        for stiffness in STIFFNESSES:
            soft = HagfishLog(folder / "runs" / f"{scene}_{stiffness}.h5")
            frames = soft.in_phase("slide")
            force, pressure = lens(float(stiffness), radius)
            as_hard = np.interp(forces, force, pressure) * KPA
            beyond = 100 * float((forces > force[-1]).mean()) if forces.size else 0
            row = [knot, f"{float(stiffness) / 1e4:g}", "yes" if frames.size else "no"]
            if frames.size:
                pressed = soft["/flesh/pressure"][frames] * KPA
                touched = pressed[pressed > 0]
                row += [f"{soft['/flesh/overlap'][frames].max():.2f}", f"{np.median(touched):.1f}", f"{np.percentile(touched, 95):.1f}", f"{touched.max():.1f}"]
                if stiffness == "1e5":
                    time = soft["/trajectory/time"][frames]
                    axes[0].plot(time - time[0], pressed.max(axis=1), color=look.colour, label=look.label)
                    axes[1].plot(soft["/model/arc"], pressed.max(axis=0), color=look.colour, label=look.label)
            else:
                row += ["-"] * 4
            rows.append([*row, f"{np.median(forces) * 1e-5:.3f}", f"{forces.max() * 1e-5:.2f}", f"{np.median(as_hard):.1f}",
                         f"{as_hard.max():.1f}", f"{beyond:.0f}"])
    for one, name in zip(axes, ("time of the slide, s", "arc length from the head, cm")):
        one.set(xlabel=name, ylabel="pressure, kPa", ylim=(0, None))
    plots.legend_above(figure, axes[0].lines, 4, 0.1)
    plots.save(figure, folder / "pressures.png")
    tables.write_table(folder, "pressures", [
        "knot", "k', kPa", "tied and held", "largest overlap, cm", "pressure, median, kPa", "pressure, 95 %, kPa", "pressure, largest, kPa",
        "hard: force of a contact, median, N", "hard: largest, N", "of a lens with k': median, kPa", "of a lens with k': largest, kPa",
        "hard contacts with more force than a lens has at half the width, %"], rows)


if __name__ == "__main__":
    run_script(__doc__, ["FOLDER"], main)
