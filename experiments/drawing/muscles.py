"""Activations over body and time, which muscles work, and what antagonists do: of a scene with muscles.

Usage: muscles.py LOG.h5 OUT.png (writes a PDF beside).
"""

from dataclasses import dataclass
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import plots
from hagfish_log import HagfishLog, LogError
from script import run_script

PAIRS = (("left", "right"), ("dorsal", "ventral"), ("right_handed", "left_handed"))
# Means over 20 ms still hold what single steps do where a contact becomes the first or last one: peaks are this quantile of all
# muscles and frames.
PEAK = 0.999
SHORT = 0.01


@dataclass
class Effort:
    """Of some frames."""

    lines: float  # quantile PEAK of the activations of lines along the body
    obliques: float  # of oblique families
    mean: float
    antagonists: float
    residual: float  # largest of a hinge, dyn cm
    short: float  # share of frames in which a hinge lacks more than SHORT of the largest torque
    seconds: float


class Muscles:
    """Of one log. `activation` is frames x muscles; the first frame has no means and is 0."""

    def __init__(self, log: HagfishLog) -> None:
        self.log = log
        self.activation = np.nan_to_num(log["/muscle/activation"])
        self.residual = np.nan_to_num(log["/muscle/residual"])
        self.force = log["/model/muscle_force"]
        names = [name.split("_", 1) for name in log.strings("/model/muscle_name")]
        self.joint = np.array([int(joint[1:]) for joint, _ in names])
        self.place = np.array([place for _, place in names])
        self.bends = np.isin(self.place, ("left", "right", "dorsal", "ventral"))
        self.arc = log.joint_arc()[self.joint]
        self.time = log["/trajectory/time"]

    def map(self, bends: bool) -> tuple[np.ndarray, np.ndarray]:
        """Arc length of the joints that bend, or twist, and the largest activation of each one's muscles in each frame."""
        joints = np.unique(self.joint[self.bends == bends])
        most = [self.activation[:, self.joint == joint].max(axis=1) for joint in joints]
        return self.log.joint_arc()[joints], np.stack(most, axis=1)

    def antagonists(self, frames: np.ndarray) -> float:
        """Share of all muscle force that the weaker one of a pair makes."""
        weaker = whole = 0.0
        for a, b in PAIRS:
            forces = [self.activation[frames][:, self.place == place] * self.force[self.place == place] for place in (a, b)]
            weaker += float(np.minimum(*forces).sum())
            whole += float(forces[0].sum() + forces[1].sum())
        return weaker / whole if whole else np.nan

    def torque(self) -> np.ndarray:
        """u + f_thigmo at the hinges, frames x velocities, 0 at the root."""
        torque = np.nan_to_num(self.log["/mean/forces/active"] + self.log["/mean/forces/thigmotaxis"])
        torque[:, :6] = 0
        return torque

    def of(self, frames: np.ndarray) -> Effort:
        if not frames.size:
            raise LogError(f"{self.log.path}: has no frames of that phase")
        a = self.activation[frames]
        short = np.abs(self.residual[frames]).max(axis=1)
        return Effort(lines=float(np.quantile(a[:, self.bends], PEAK)), obliques=float(np.quantile(a[:, ~self.bends], PEAK)),
                      mean=float(a.mean()), antagonists=self.antagonists(frames), residual=float(short.max()),
                      short=float((short > SHORT * np.abs(self.torque()[frames]).max()).mean()),
                      seconds=float(self.time[frames[-1]] - self.time[frames[0] - 1]))

    def pair_off(self, frames: np.ndarray) -> tuple[float, float]:
        """How far one pair of constant arms for each axis, those of the straight body, is from the lines of the bending joints:
        median and largest difference of a joint's largest activation, over the larger of the two, where that is above 0.01."""
        share = float(self.log.scene()["specimen"]["muscle"]["radius_share"])
        index, joint, kind = self.log.hinges()
        torque = np.abs(self.torque()[frames])
        joints, lines = np.unique(self.joint[self.bends]), []
        for one in joints:
            strength = self.force[(self.joint == one) & (self.place == "left")][0] * share * self.log["/model/radius"][one]
            bend = [index[(joint == one) & (kind == axis)][0] for axis in ("bend_y", "bend_z")]
            lines.append(np.minimum(torque[:, bend] / strength, 1).max(axis=1))
        pair, own = np.stack(lines, axis=1), self.map(True)[1][frames]
        size = np.maximum(pair, own)
        off = (np.abs(pair - own) / np.maximum(size, 1e-300))[size > 0.01]
        return (float(np.median(off)), float(off.max())) if off.size else (np.nan, np.nan)


def phases(log: HagfishLog) -> list[tuple[str, float]]:
    names, time = log.labels("/trajectory/phase"), log["/trajectory/time"]
    starts = np.flatnonzero(np.r_[True, names[1:] != names[:-1]])
    return [(names[k], time[k]) for k in starts]


def draw_map(axes: plt.Axes, muscles: Muscles, bends: bool) -> None:
    log = muscles.log
    arc, activation = muscles.map(bends)
    axes.grid(visible=False)
    image = axes.pcolormesh(muscles.time, arc, activation.T, cmap="viridis", vmin=0, vmax=1, shading="nearest", rasterized=True)
    axes.plot(muscles.time, log["/knot/head_end"], color="white", lw=0.9, label="knot, head end")
    axes.plot(muscles.time, log["/knot/tail_end"], color="white", lw=0.9, ls="--", label="knot, tail end")
    axes.set(ylabel="arc length from the head, cm", xlabel="time, s", ylim=(arc[0], arc[-1]))
    legend = axes.legend(loc="lower left", fontsize=7, framealpha=0.35, facecolor="black")
    for text in legend.get_texts():
        text.set_color("white")
    axes.figure.colorbar(image, ax=axes, pad=0.02, fraction=0.05, label="largest activation of a joint's muscles")


def main(path: Path, out: Path) -> None:
    log = HagfishLog(path)
    muscles = Muscles(log)
    figure, panels = plots.panels(3, 1, (8.0, 9.0), ["lines along the body: joints that bend", "oblique families: joints that twist",
                                                     "all muscles"], sharex=True)
    draw_map(panels[0], muscles, bends=True)
    draw_map(panels[1], muscles, bends=False)
    below = panels[2]
    below.plot(muscles.time, muscles.activation.max(axis=1), color=plots.VERMILION, lw=0.8, label="largest activation")
    below.plot(muscles.time, muscles.activation.mean(axis=1), color=plots.BLUE, label="mean activation")
    every = np.array([muscles.antagonists(np.array([f])) for f in range(log.frames)])
    below.plot(muscles.time, every, color=plots.INK, lw=0.8, ls=":", label="antagonists' share of the force")
    below.set(xlabel="time, s", ylabel="share", ylim=(0, 1.3))
    below.legend(loc="center left")
    for axes in panels:
        for _, start in phases(log)[1:]:
            axes.axvline(start, color=plots.GREY if axes is below else "white", lw=0.6, ls="-.")
    least = 0.03 * (muscles.time[-1] - muscles.time[0])
    marks = phases(log) + [("", muscles.time[-1])]
    for (name, start), (_, end) in zip(marks, marks[1:]):
        if end - start > least:
            below.text((start + end) / 2, 1.17, name, ha="center", fontsize=7.5, color=plots.GREY)
    plots.save(figure, out)


if __name__ == "__main__":
    run_script(__doc__, ["LOG.h5", "OUT.png"], main)
