"""Through a slit narrower than the body: tables and figure of study.sh, closed forms beside what is measured.

Usage: slit.py FOLDER. FOLDER is what the study leaves. The tables come in its folder tables.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path

import numpy as np

import plots
import tables
from hagfish_log import HagfishLog
from script import run_script
from slit_scene import AT, POLE, THICKEST
from slit_wave import WALL

SWIMMER, SWAM = 31.5, "17.5"  # cm, cm/s: a hagfish, Long et al. 2002
SWUM = ("0.7_0.6_0.5", "0.7_0.6_0.333")  # waves in open water
SHARES, STIFFNESSES = ("0.9", "0.8", "0.7", "0.6", "0.5"), ("6e4", "1e5", "3e5")
PART = (0.3, 0.55)  # of the body, whose passage counts: as thick all along to 2 %
RELAXATION, SPEED = 0.015, 3.0  # s, cm/s: slit.toml
WATER = 2.358 * 42.4 * SPEED  # dyn: drag along the body, table1.toml
LOOKS = dict(zip(STIFFNESSES, (plots.Look("6 kPa", plots.BLUE, "o"), plots.Look("10 kPa", plots.INK, "s"),
                               plots.Look("30 kPa", plots.ORANGE, "^"))))


@dataclass
class Passage:
    """Of the middle of the body, medians over frames."""

    radius: float  # cm
    normal: float  # force of a pole, dyn
    pull: float  # dyn
    overlap: float  # cm


def passage(path: Path) -> Passage:
    log = HagfishLog(path)
    names = log.strings("/model/obstacle_name")
    x, arc = log["/trajectory/position"][:, :, 0], log["/model/arc"]
    at = np.array([np.interp(AT["slit"], row, arc) for row in x]) / (arc[-1] + arc[0])
    through = (at > PART[0]) & (at < PART[1]) & (x[:, 0] < AT["slit"])
    left = log["/contacts/obstacle"] == names.index("left pole")
    normal = np.bincount(log["/contacts/frame"][left], log["/contacts/force"][left], minlength=log.frames)
    radius = np.interp(at * (arc[-1] + arc[0]), arc, log["/model/radius"])
    median = lambda values: float(np.median(values[through]))
    return Passage(median(radius), median(normal), median(log["/forces/tip"][:, 0]), median(log["/flesh/overlap"].max(axis=1)))


def passed(path: Path, share: float) -> str:
    """When the whole body has come through the slit, s, or what happens."""
    log = HagfishLog(path)
    for time, centre in zip(log["/trajectory/time"], log["/trajectory/position"]):
        x, y = centre[:, 0] - WALL, centre[:, 1]
        if (x < 0).all():
            return f"{time:.1f}"
        crossing = np.flatnonzero(x[:-1] * x[1:] < 0)
        at = y[crossing] + (y[crossing + 1] - y[crossing]) * x[crossing] / (x[crossing] - x[crossing + 1])
        if crossing.size == 0 and time > 0:
            return "leaves it backwards"
        if (np.abs(at) > share * THICKEST / 2 + POLE).any():
            return "goes round the poles"
    return "stays in it"


def swims(path: Path, period: float) -> float:
    """Speed of the body's middle over the last whole periods of the second half of a run, cm/s."""
    log = HagfishLog(path)
    time, middle = log["/trajectory/time"], log["/trajectory/position"].mean(axis=1)
    lasts = period * int(time[-1] / 2 / period)
    first, last = (np.array([np.interp(at, time, row) for row in middle.T]) for at in (time[-1] - lasts, time[-1]))
    return float(np.linalg.norm(last - first)) / lasts


def closed_form(stiffness: float, width: float, radius: float) -> tuple[float, float]:
    """Normal forces of one pole, summed, on a body that lies still; the pull of one that comes by in water; dyn."""
    half = width / 2 + POLE
    most = math.sqrt((radius + POLE) ** 2 - half**2)
    x = np.linspace(-most, most, 20001)
    distance = np.hypot(half, x)
    overlap = radius + POLE - distance
    moving = np.maximum(0, overlap - RELAXATION * SPEED * x / distance)
    return (stiffness * float(np.trapz(overlap, x)),
            WATER - 2 * stiffness * float(np.trapz(moving * x / distance, x)))


def area(share: float) -> float:
    """Of a stadium of this width, whose girth is that of a circle, over the circle's."""
    return 1 - (1 - share) ** 2


def pulled(folder: Path) -> None:
    """Forces by the slit's width and the flesh's stiffness, beside the closed forms."""
    rows = []
    figure, (normals, pulls) = plots.panels(1, 2, (plots.WIDTH, 2.9), ["force of one side of the slit", "pull through the slit"])
    dense = np.linspace(0.48, 0.98, 60)
    for stiffness in STIFFNESSES:
        look, measured = LOOKS[stiffness], []
        for share in SHARES:
            seen = passage(folder / "runs" / f"pulled_{stiffness}_{share}.h5")
            normal, pull = closed_form(float(stiffness), float(share) * THICKEST, seen.radius)
            measured.append((float(share), seen, normal, pull))
            rows.append([f"{float(share):g}", f"{float(share) * THICKEST:.2f}", f"{float(stiffness) / 1e4:g}", f"{seen.normal * 1e-5:.4f}",
                         f"{normal * 1e-5:.4f}", f"{100 * (seen.normal / normal - 1):.1f}", f"{seen.pull * 1e-5:.4f}", f"{pull * 1e-5:.4f}",
                         f"{seen.overlap:.2f}", f"{area(float(share)):.2f}"])
        radius = float(np.median([seen.radius for _, seen, _, _ in measured]))
        lines = np.array([closed_form(float(stiffness), share * THICKEST, radius) for share in dense]) * 1e-5
        for axes, column, of in ((normals, 0, "normal"), (pulls, 1, "pull")):
            axes.plot(dense, lines[:, column], color=look.colour, linewidth=0.9)
            axes.plot([share for share, *_ in measured], [getattr(seen, of) * 1e-5 for _, seen, _, _ in measured], look.marker,
                      color=look.colour, label=look.label)
    for axes, name in ((normals, "force, N"), (pulls, "pull, N")):
        axes.set(xlabel="width of the slit over the body's", ylabel=name, ylim=(0, None))
        axes.axvline(0.58, color=plots.GREY, linestyle="--", linewidth=0.9)
    normals.annotate("all blood gone", (0.585, 0.9 * normals.get_ylim()[1]), fontsize=7, color=plots.GREY)
    pulls.legend(title="k' (lines: closed forms)")
    plots.save(figure, folder / "slit.png")
    tables.write_table(folder, "slit", [
        "width over the body's", "width, cm", "k', kPa", "force of one side, N", "closed form, N", "off, %", "pull at 3 cm/s, N",
        "closed form of the pull, N", "overlap, cm", "area of a section left"], rows)


def meshes(folder: Path) -> None:
    rows = []
    for name, change in (("pulled_1e5", "100 bodies, 2 ms"), ("bodies_200", "200 bodies, 2 ms"), ("step_5", "100 bodies, 5 ms")):
        for share in ("0.9", "0.7", "0.5"):
            seen = passage(folder / "runs" / f"{name}_{share}.h5")
            rows.append([change, f"{float(share):g}", f"{seen.normal * 1e-5:.4f}", f"{seen.pull * 1e-5:.4f}"])
    tables.write_table(folder, "slit_meshes", ["run", "width over the body's", "force of one side, N", "pull at 3 cm/s, N"], rows)


def knotted(folder: Path) -> None:
    rows = []
    for share in ("1.2", *SHARES):
        log = HagfishLog(folder / "runs" / f"knot_1e5_{share}.h5")
        phases = log.labels("/trajectory/phase")
        pull = log["/pull/force"]
        begun = bool(np.isfinite(pull).any())
        out = phases[-1] == "free" or log["/trajectory/position"][-1, 0, 0] > 2.0
        rows.append([f"{float(share):g}", f"{float(share) * THICKEST:.2f}", "yes" if begun else "no",
                     f"{np.nanmax(pull) * 1e-5:.2f}" if begun else "-", "yes" if out else "no", f"{log.scene()['food']['strength']:g}"])
    tables.write_table(folder, "slit_knot", [
        "width over the body's", "width, cm", "knot reaches the slit", "largest pull, N", "head comes out", "held up to, N"], rows)


def waves(folder: Path) -> None:
    rows = []
    for wave in ("0.5_1_1", "0.7_0.6_0.5"):
        for share in ("1.2", "0.9", "0.8", "0.7"):
            angle, length, period = wave.split("_")
            rows.append([angle, length, period, share, passed(folder / "runs" / f"wave_{wave}_{share}.h5", float(share))])
    tables.write_table(folder, "slit_wave", [
        "angle of the wave, rad", "its length over the body's", "its period, s", "width over the body's", "through after, s"], rows)


def swimming(folder: Path) -> None:
    rows = []
    for name in SWUM:
        angle, length, period = name.split("_")
        speed, wave = swims(folder / "runs" / f"swim_{name}.h5", float(period)), float(length) * SWIMMER / float(period)
        rows.append([angle, length, period, f"{speed:.1f}", f"{speed / wave:.2f}", SWAM])
    tables.write_table(folder, "slit_swim", [
        "angle of the wave, rad", "its length over the body's", "its period, s", "speed, cm/s", "speed over the wave's",
        "a hagfish of the same length, cm/s"], rows)


def main(folder: Path) -> None:
    for part in (pulled, meshes, knotted, waves, swimming):
        part(folder)


if __name__ == "__main__":
    run_script(__doc__, ["FOLDER"], main)
