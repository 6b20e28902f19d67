"""The pull of every knot, and what it depends on: of a table of runs.

Usage: leverage_picture.py leverage_runs.csv leverage_time.csv OUT.png (writes a PDF beside).
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

import plots
from script import run_script
from tables import read_csv

HEAD = ["kind", "body", "knot", "value", "seed", "outcome", "cap_N", "pull_N", "plate_N", "rows_N", "torque_mean_N_cm",
        "torque_largest_N_cm", "estimate_N",
        "deepest_overlap_cm", "too_deep"]
TIME_HEAD = ["body", "knot", "second", "pull_N"]
SWEEPS = {"cap": "largest force of a row, times the scene's", "speed": "commanded speed, cm/s", "stiffness": "flexural rigidity, dyn cm²",
          "girth": "girth, times the animal's", "capacity": "capacity of a hinge's muscles, dyn cm", "step": "time step, s",
          "bodies": "number of bodies"}
# What the starts have, by body.
BASE = {"cap": {"table1": 1.0, "living": 1.0}, "girth": {"table1": 1.0, "living": 1.0}, "stiffness": {"living": 2e5}}
MESH = ("step", "bodies")  # changes that should change nothing
TOOTH_MUSCLE = 16.0  # N, clavatus of the tooth plate: Clark & Summers 2007, J. Exp. Biol. 210:3897
CAPACITY = 2.7  # N cm, a guess: data/living_overhand.toml
BESIDE = 0.012  # of a panel's width: knots at one value

Runs = list[dict[str, str]]


def chosen(runs: Runs, body: str, knot: str, kind: str, deep: bool = False) -> Runs:
    """Of those that pulled; with `deep` also those whose strands are too deep in each other."""
    return [run for run in runs if run["pull_N"] and (deep or run["too_deep"] != "yes")
            and (run["body"], run["knot"], run["kind"]) == (body, knot, kind)]


def pulls(runs: Runs) -> np.ndarray:
    return np.array([float(run["pull_N"]) for run in runs])


def style(run: dict[str, str]) -> dict[str, object]:
    look = plots.KNOTS[run["knot"]]
    return {"color": look.colour, "marker": "x" if run["too_deep"] == "yes" else look.marker, "ls": "", "ms": 4.5,
            "mfc": look.colour if run["body"] == "living" else "white"}


def draw_starts(axes: plots.plt.Axes, runs: Runs, body: str, knot: str, at: float) -> None:
    """The mean of the starts, their standard deviation, and what other steps and body counts make of it."""
    starts, look = pulls(chosen(runs, body, knot, "start")), plots.KNOTS[knot]
    if not starts.size:
        return
    mean, fill = starts.mean(), look.colour if body == "living" else "white"
    mesh = np.r_[mean, *(pulls(chosen(runs, body, knot, kind)) for kind in MESH)]
    axes.plot([at, at], [mesh.min(), mesh.max()], color=look.colour, lw=0.7, zorder=1)
    axes.errorbar(at, mean, starts.std(ddof=1) if starts.size > 1 else 0, color=look.colour, marker=look.marker, ms=5.5, mfc=fill,
                  elinewidth=2.2, capsize=3)


def draw_sweep(axes: plots.plt.Axes, runs: Runs, kind: str, log: bool = True) -> None:
    """Single runs are points; the starts have bars."""
    values = [float(run["value"]) for run in runs if run["kind"] == kind] + list(BASE[kind].values())
    wide = np.log(max(values) / min(values)) if log else max(values) - min(values)
    for k, knot in enumerate(plots.KNOTS):
        by = BESIDE * (k - 1.5) * wide
        moved = lambda value, by=by: value * np.exp(by) if log else value + by
        for body, base in BASE[kind].items():
            for run in chosen(runs, body, knot, kind, deep=kind == "cap"):
                axes.plot(moved(float(run["value"])), float(run["pull_N"]), **style(run))
            draw_starts(axes, runs, body, knot, moved(base))


def draw(runs: Runs, seconds: Runs, out: Path) -> None:
    figure, axes = plots.panels(2, 3, (11, 7.4), [
        "the harder it slides, the harder it pulls", "what that asks of a joint", "against a frictionless rope",
        "stiffness of the body", "girth", "force over time"])
    draw_sweep(axes[0], runs, "cap")
    axes[0].axhline(TOOTH_MUSCLE, color=plots.GREY, ls=":", lw=1)
    axes[0].text(0.22, TOOTH_MUSCLE * 1.1, "tooth muscle, 16 N", fontsize=7, color=plots.GREY, va="bottom")
    axes[0].set(xscale="log", yscale="log", xlim=(0.2, 30), ylim=(0.01, 40), ylabel="pull, N", xlabel=SWEEPS["cap"])
    for run in runs:
        if run["pull_N"] and run["too_deep"] != "yes":
            for panel, across in ((axes[1], "torque_mean_N_cm"), (axes[2], "estimate_N")):
                panel.plot(float(run[across]), float(run["pull_N"]), **style(run) | {"ms": 3.5})
    axes[1].axvline(CAPACITY, color=plots.GREY, ls="--", lw=0.8)
    axes[1].text(CAPACITY, 0.018, " a guess at\n the capacity", fontsize=7, color=plots.GREY)
    axes[1].set(xscale="log", yscale="log", xlabel="largest torque of a joint, N cm", ylabel="pull, N", ylim=(0.015, None))
    ends = [0.02, 4]
    axes[2].plot(ends, ends, color=plots.GREY, lw=0.8, ls="--")
    axes[2].text(1.6, 2.2, "rope", fontsize=7, color=plots.GREY, rotation=45)
    axes[2].set(xscale="log", yscale="log", xlabel="estimate, sum of λ (1 - cos θ) / h, N", ylabel="pull, N", ylim=(0.015, None))
    draw_sweep(axes[3], runs, "stiffness")
    axes[3].set(xscale="log", xlabel=SWEEPS["stiffness"], ylabel="pull, N", ylim=(0, None))
    draw_sweep(axes[4], runs, "girth", log=False)
    axes[4].set(xlabel=SWEEPS["girth"], ylabel="pull, N", ylim=(0, None), xticks=[0.8, 1, 1.2])
    for body in ("table1", "living"):
        for knot, look in plots.KNOTS.items():
            there = [row for row in seconds if (row["body"], row["knot"]) == (body, knot)]
            axes[5].plot([float(row["second"]) for row in there], pulls(there), color=look.colour, ls="-" if body == "living" else ":")
    axes[5].set(xlabel="since the pull counts as settled, s", ylabel="pull, N", ylim=(0, None))
    handles = [axes[0].plot([], [], label=look.label, ls="", **look.style)[0] for look in plots.KNOTS.values()]
    handles += [axes[0].plot([], [], color=plots.INK, marker=marker, mfc=fill, ls="", label=label)[0]
                for marker, fill, label in (("o", plots.INK, "living body"), ("o", "white", "Table 1 body"),
                                            ("x", plots.INK, "overlaps too deep, in (a) alone"))]
    handles.append(axes[0].errorbar([], [], [], color=plots.INK, elinewidth=2.2, capsize=3, ls="", label="starts: standard deviation"))
    handles += axes[0].plot([], [], color=plots.INK, lw=0.7, label="other steps and numbers of bodies")
    handles += axes[0].plot([], [], color=plots.INK, ls=":", label="Table 1 body over time")
    plots.legend_above(figure, handles, 5, 0.075)
    plots.save(figure, out)


if __name__ == "__main__":
    run_script(__doc__, ["leverage_runs.csv", "leverage_time.csv", "OUT.png"],
               lambda table, seconds, out: draw(read_csv(table, HEAD), read_csv(seconds, TIME_HEAD), out))
