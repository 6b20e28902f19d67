"""The pull of every knot, and what it depends on: of a table of runs.

Usage: leverage_picture.py leverage_runs.csv leverage_time.csv OUT.png (writes a PDF beside).
"""

from pathlib import Path

import numpy as np

import plots
from script import run_script
from tables import read_csv

HEAD = ["kind", "body", "knot", "value", "seed", "outcome", "cap_N", "pull_N", "plate_N", "rows_N", "torque_mean_N_cm",
        "torque_largest_N_cm", "estimate_N", "deepest_overlap_cm", "too_deep"]
TIME_HEAD = ["body", "knot", "second", "pull_N"]
SWEEPS = {"cap": "largest force of a row, times the scene's", "speed": "commanded speed, cm/s", "stiffness": "flexural rigidity, dyn cm²",
          "girth": "girth, times the animal's", "capacity": "capacity of a hinge's muscles, dyn cm", "step": "time step, s",
          "bodies": "number of bodies"}
BODIES = ("living", "table1")
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
    return {"color": look.colour, "marker": "x" if run["too_deep"] == "yes" else look.marker, "ls": "", "ms": 4,
            "mfc": look.colour if run["body"] == "living" else "white"}


def draw_starts(axes: plots.plt.Axes, runs: Runs, body: str, knot: str, at: float) -> None:
    """The mean of the starts, their standard deviation, and what other steps and body counts make of it."""
    starts, look = pulls(chosen(runs, body, knot, "start")), plots.KNOTS[knot]
    if not starts.size:
        return
    mean, fill = starts.mean(), look.colour if body == "living" else "white"
    mesh = np.r_[mean, *(pulls(chosen(runs, body, knot, kind)) for kind in MESH)]
    axes.plot([at, at], [mesh.min(), mesh.max()], color=look.colour, lw=0.7, zorder=1)
    axes.errorbar(at, mean, starts.std(ddof=1) if starts.size > 1 else 0, color=look.colour, marker=look.marker, ms=5, mfc=fill,
                  elinewidth=2.2, capsize=3)


def draw_caps(axes: plots.plt.Axes, runs: Runs) -> None:
    """Single runs are points; the starts have bars."""
    values = [float(run["value"]) for run in runs if run["kind"] == "cap"] + [1.0]
    for k, knot in enumerate(plots.KNOTS):
        aside = np.exp(BESIDE * (k - 1.5) * np.log(max(values) / min(values)))
        for body in BODIES:
            for run in chosen(runs, body, knot, "cap", deep=True):
                axes.plot(aside * float(run["value"]), float(run["pull_N"]), **style(run))
            draw_starts(axes, runs, body, knot, aside)


def draw_seconds(axes: plots.plt.Axes, runs: Runs, seconds: Runs, body: str) -> None:
    """The mean of each second; crosses where strands are too deep in each other."""
    for knot in plots.KNOTS:
        there = [row for row in seconds if (row["body"], row["knot"]) == (body, knot)]
        deep = not chosen(runs, body, knot, "plain")  # of which the seconds are
        look = style({"body": body, "knot": knot, "too_deep": "yes" if deep else "no"})
        axes.plot([float(row["second"]) for row in there], pulls(there), **look | {"ls": ":" if deep else "-"})
    axes.set(xlabel="since the pull counts as settled, s", ylabel="pull, N", xlim=(0, None), ylim=(0, None))


def draw(runs: Runs, seconds: Runs, out: Path) -> None:
    figure, axes = plots.plt.subplot_mosaic([[[["A", "B", "C"]]], [[["D", "E"]]]], figsize=(plots.WIDTH, 5.6), layout="constrained")
    caps, torques, rope, *over_time = axes.values()
    plots.name_panels(axes.values(), ["by the force of a row", "what that asks of a joint", "against a rope",
                                      "over time, living body", "over time, Table 1 body"])
    draw_caps(caps, runs)
    caps.axhline(TOOTH_MUSCLE, color=plots.GREY, ls=":", lw=1)
    caps.text(0.22, TOOTH_MUSCLE * 1.1, f"tooth muscle, {TOOTH_MUSCLE:g} N", fontsize=7, color=plots.GREY, va="bottom")
    caps.set(xlim=(0.2, 15), ylim=(0.01, 40), xlabel="largest force of a row,\ntimes the scene's")
    for run in runs:
        if run["pull_N"] and run["too_deep"] != "yes":
            for panel, across in ((torques, "torque_mean_N_cm"), (rope, "estimate_N")):
                panel.plot(float(run[across]), float(run["pull_N"]), **style(run) | {"ms": 3})
    torques.axvline(CAPACITY, color=plots.GREY, ls="--", lw=0.8)
    torques.text(CAPACITY, 0.012, "a guess at \nthe capacity ", fontsize=7, color=plots.GREY, ha="right")
    torques.set(xlim=(0.03, 40), ylim=(0.01, 40), xlabel="largest torque of a joint,\nN cm")
    ends = [0.02, 30]
    rope.plot(ends, ends, color=plots.GREY, lw=0.8, ls="--", zorder=0)
    rope.set(xlim=(0.015, 40), ylim=(0.01, 40), xlabel="frictionless rope:\nΣ F (1 - cos θ), N")
    for panel in (caps, torques, rope):
        panel.set(xscale="log", yscale="log")
        plots.plain_ticks(panel.yaxis, [0.01, 0.1, 1, 10])
        plots.plain_ticks(panel.xaxis, [0.1, 1, 10] if panel is not caps else [0.25, 0.5, 1, 2, 4, 10])
    caps.set_ylabel("pull, N")
    for panel, body in zip(over_time, BODIES):
        draw_seconds(panel, runs, seconds, body)
    handles = [caps.plot([], [], label=look.label, ls="", **look.style)[0] for look in plots.KNOTS.values()]
    handles += [caps.plot([], [], color=plots.INK, marker=marker, mfc=fill, ls="", label=label)[0]
                for marker, fill, label in (("o", plots.INK, "living body"), ("o", "white", "Table 1 body"),
                                            ("x", plots.INK, "overlaps too deep"))]
    handles.append(caps.errorbar([], [], [], color=plots.INK, elinewidth=2.2, capsize=3, ls="", label="starts: deviation"))
    handles += caps.plot([], [], color=plots.INK, lw=0.7, label="other steps, meshes")
    plots.legend_above(figure, handles, 5, 0.08, columnspacing=1, handlelength=1.5)
    plots.save(figure, out)


if __name__ == "__main__":
    run_script(__doc__, ["leverage_runs.csv", "leverage_time.csv", "OUT.png"],
               lambda table, seconds, out: draw(read_csv(table, HEAD), read_csv(seconds, TIME_HEAD), out))
