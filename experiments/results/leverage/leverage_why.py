"""Why a knot pulls harder than it pushes: the pulley, and tension, contacts and thigmotaxis along the body of pulling animals.

Usage: leverage_why.py SWEEP OUT.png (writes a PDF beside).
"""

from pathlib import Path

import numpy as np

import plots
from hagfish_log import HagfishLog
from pulls import Strand, read_pull, read_strand, settled
from script import run_script
from sweep_columns import read_cells

SHOWN = ("pull_overhand", "pull_figure_eight", "pull_living_figure_eight")


def draw_pulley(axes: plots.plt.Axes) -> None:
    """One loop, two strands in opposite directions: each row pushes one strand back and the other one on."""
    turn = np.linspace(-np.pi / 2, np.pi / 2, 60)
    x = np.concatenate([[0], 3 + np.cos(turn), [0.6]])
    y = np.concatenate([[-1], np.sin(turn), [1]])
    axes.plot(x, y, color=plots.BLUE, lw=7, solid_capstyle="round", alpha=0.35)
    axes.add_patch(plots.plt.Circle((3, 0), 0.72, color=plots.GREY, alpha=0.5))
    axes.plot([-0.25, -0.25], [-0.55, 1.5], color=plots.INK, lw=3)
    arrow = lambda start, end, colour: axes.annotate("", end, start, arrowprops={"arrowstyle": "-|>", "color": colour, "lw": 1.6})
    arrow((0.1, -1), (-1.1, -1), plots.INK)
    arrow((1.5, -0.92), (2.3, -0.92), plots.VERMILION)
    arrow((1.9, 0.92), (1.1, 0.92), plots.VERMILION)
    axes.text(-1.1, -0.8, "food holds: P = 2 λ/h", fontsize=8)
    axes.text(1.35, -0.65, "+ λ/h", color=plots.VERMILION, fontsize=8)
    axes.text(1.15, 0.5, "- λ/h", color=plots.VERMILION, fontsize=8)
    axes.text(2.68, -0.08, "post", fontsize=7.5)
    axes.text(4.15, 0, "tension λ/h", fontsize=8)
    axes.text(-0.1, 1.6, "head plate: holds the post, another loop of the knot", fontsize=7.5)
    axes.text(0.0, -1.75, "strands crossing at θ: P = Σ λ (1 - cos θ)/h", fontsize=8)
    axes.set(xlim=(-1.3, 5.6), ylim=(-2, 2), aspect="equal")
    axes.axis("off")


def draw_strand(axes: plots.plt.Axes, strand: Strand, log: HagfishLog) -> None:
    pull = read_pull(log)
    axes.bar(strand.arc, strand.contact, width=0.4, color=plots.GREY, alpha=0.45, label="contact, each body")
    axes.bar(strand.arc, strand.plate, width=0.4, color=plots.BLUE, alpha=0.6, label="head plate, each body")
    axes.bar(strand.arc, strand.thigmotaxis, width=0.4, color=plots.VERMILION, label="thigmotaxis along the body, to the tail")
    axes.plot(strand.arc, strand.tension, color=plots.INK, label="tension")
    axes.axhline(pull.mean, color=plots.INK, ls=":", lw=0.8, label="pull at the food")
    axes.annotate(f"{pull.mean:.2f} N", (42, pull.mean), (0, -3), textcoords="offset points", fontsize=8, ha="right", va="top")
    frames = settled(log)
    for end, label in (("head", "ends of the knot"), ("tail", None)):
        axes.axvline(float(np.nanmean(log[f"/knot/{end}_end"][frames])), color=plots.ORANGE, ls="--", lw=0.8, label=label)
    axes.set(xlabel="arc from the head, cm", ylabel="force, N", xlim=(0, 42.4))


def main(folder: Path, out: Path) -> None:
    figure, axes = plots.panels(2, 2, (10.5, 7), [
        "a loop is a pulley", "$3_1$, Table 1 body", "$4_1$, Table 1 body", "$4_1$, living body"])
    draw_pulley(axes[0])
    logs = {cell.axes["scene"]: cell.log for cell in read_cells(folder) if cell.axes["mirror"] == "false"}
    for panel, log in zip(axes[1:], map(logs.get, SHOWN), strict=True):
        draw_strand(panel, read_strand(log), log)
    plots.legend_above(figure, axes[1].get_legend_handles_labels()[0], 3, 0.07)
    plots.save(figure, out)


if __name__ == "__main__":
    run_script(__doc__, ["SWEEP", "OUT.png"], main)
