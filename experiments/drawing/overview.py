"""A run at a glance: f_thigmo and curvature along the body, Eq. 6, the head's force and energy over time, with the knot's ends
and the phases. Of any log, as far as it goes.

Usage: overview.py LOG.h5 OUT.png (writes OUT.pdf beside).
"""

from pathlib import Path
from typing import Any

import numpy as np

import plots
from hagfish_log import HagfishLog
from script import run_script

ROWS = {"first contact, $t_a$": "-", "first contact, $t_b$": "--", "last contact, $t_a$": ":", "last contact, $t_b$": "-."}
ENERGIES = {"kinetic_energy": "kinetic", "elastic_energy": "elastic", "work_tip": "work of the script", "work_active": "work of muscles",
            "work_thigmotaxis": "work of f_thigmo", "dissipated": "dissipated"}
LARGE = 99  # percentile of what is before the release, at which colours saturate
PEAK, TALL = 99, 3  # percentile of a panel's lines, and how many times as much is cut off: the knot's release would hide all else
PHASE_WIDTH = 0.07  # of the time shown: what the name of a phase takes


def bending(log: HagfishLog, vectors: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Arc length of the joints that bend, cm, and the size of the bending part of vectors at each: frames x joints."""
    _, joint, kind = log.hinges()
    joints = joint[kind == "bend_y"]
    return log.joint_arc()[joints], np.nan_to_num(np.hypot(vectors[:, joints, 1], vectors[:, joints, 2]))


def draw_map(axes: Any, log: HagfishLog, arc: np.ndarray, values: np.ndarray, unit: str) -> None:
    time, held = log["/trajectory/time"], values[~np.isin(log.labels("/trajectory/phase"), ("release", "free"))]
    large = held[held > 0]
    image = axes.imshow(values.T, aspect="auto", origin="lower", cmap="viridis", vmin=0,
                        vmax=np.percentile(large, LARGE) if large.size else 1,
                        extent=(time[0], time[-1], arc[0], arc[-1]), interpolation="nearest")
    for end, style in (("head", "-"), ("tail", "--")):
        axes.plot(time, log[f"/knot/{end}_end"], style, color="white", lw=1, label=f"knot, {end} end")
    axes.grid(visible=False)
    axes.set(ylabel="cm from the head", ylim=(0, log["/model/length"].sum()))
    axes.legend(loc="lower left", facecolor="#404040", labelcolor="white")
    axes.figure.colorbar(image, ax=axes, label=unit, pad=0.01, extend="max")


def mark_phases(panels: Any, log: HagfishLog) -> None:
    """A line where each phase begins, named in the first panel, which is dark."""
    phase, time = log.labels("/trajectory/phase"), log["/trajectory/time"]
    starts = np.flatnonzero(np.r_[True, phase[1:] != phase[:-1]])
    width, last, line = PHASE_WIDTH * (time[-1] - time[0]), -np.inf, 0
    for at in starts:
        for axes in panels:
            axes.axvline(time[at], color=plots.GREY, lw=0.7, zorder=0.5)
        late = time[at] > time[-1] - width
        place = time[-1] - width if late else time[at]
        line = line + 1 if place < last + width else 0  # below the name that it would run into
        panels[0].annotate(phase[at], (time[-1] if late else place, 1), xycoords=("data", "axes fraction"),
                           xytext=(-2 if late else 3, -3 - 9 * line), textcoords="offset points", ha="right" if late else "left", va="top",
                           fontsize=7, color="white")
        last = place


def draw_lines(axes: Any, time: np.ndarray, lines: dict[str, np.ndarray], label: str, columns: int = 3) -> None:
    colours = (plots.BLUE, plots.VERMILION, plots.INK, plots.PURPLE, plots.ORANGE, plots.GREY)
    for (name, values), colour, style in zip(lines.items(), colours, ("-", "--", ":", "-.", (0, (6, 1, 1, 1, 1, 1)), (0, (1, 3)))):
        axes.plot(time, values, color=colour, ls=style, label=name)
    axes.set_ylabel(label)
    axes.margins(y=0.15)
    known = np.concatenate(list(lines.values()))
    known = known[np.isfinite(known)]
    most = np.percentile(np.abs(known), PEAK) if known.size else 0
    if 0 < TALL * most < np.abs(known).max(initial=0) and label != "erg":
        axes.set_ylim(-TALL * most if known.min() < 0 else -0.1 * most, TALL * most)
        axes.set_title(f"{axes.get_title('left')}; peaks are cut off")
    axes.legend(loc="upper left", ncol=columns)


def main(path: Path, out: Path) -> None:
    log = HagfishLog(path)
    time = log["/trajectory/time"]
    scene = log.scene()
    animal, length = scene["specimen"].get("name", "the animal"), log["/model/length"].sum()
    figure, panels = plots.panels(5, 1, (8.5, 11), [
        "bending moment of $f_\\mathrm{thigmo}$, means from frame to frame", "curvature",
        "Eq. 6: speed along each tangent, means from frame to frame",
        "force that clamps the head, and that of the head plate, means", "energy, and work so far"], sharex=True)
    arc, force = bending(log, log.moments("thigmotaxis"))
    draw_map(panels[0], log, arc, force, "dyn cm")
    draw_map(panels[1], log, *bending(log, log["/trajectory/curvature"]), "rad/cm")
    draw_lines(panels[2], time, dict(zip(ROWS, log["/mean/thigmotaxis/speed"].T)), "cm/s", columns=1)  # there are none while the knot forms
    draw_lines(panels[3], time, {"clamp": np.linalg.norm(log["/mean/forces/head"][:, :3], axis=1), "plate": log["/mean/forces/wall"][:, 0]},
               "dyn")
    terms = {name: log[f"/diagnostics/{key}"] for key, name in ENERGIES.items()}
    draw_lines(panels[4], time, {name: values for name, values in terms.items() if np.any(values != 0)}, "erg")
    panels[4].set_xlabel("time, s")
    mark_phases(panels, log)
    figure.suptitle(f"{scene['title']}: {animal}, {length:.4g} cm", fontsize=10, x=0.01, ha="left")
    plots.save(figure, out)


if __name__ == "__main__":
    run_script(__doc__, ["LOG.h5", "OUT.png"], main)
