"""What muscles tell by knot: while the animal ties, slides and pulls, from noisy starts moved by activations, and in stiffer bodies.

Usage: muscle_study.py RUNS.
"""

from pathlib import Path

import numpy as np

import plots
import tables
from hagfish_log import HagfishLog, LogError
from muscles import Effort, Muscles
from script import run_script
from sweep_columns import read_cells


def sliding(log: HagfishLog) -> np.ndarray:
    frames = log.intervals_in("slide")
    if not frames.size:
        raise LogError(f"{log.path}: has no slide of the knot")
    return frames


def work(log: HagfishLog, frames: np.ndarray) -> float:
    """Of u and f_thigmo between the first and the last frame, erg."""
    total = log["/diagnostics/work_active"] + log["/diagnostics/work_thigmotaxis"]
    return float(total[frames[-1]] - total[frames[0] - 1])


def way(log: HagfishLog) -> float:
    """Of the knot's head end while it slides, cm to the head."""
    frames = log.in_phase("slide")
    end = log["/knot/head_end"][frames]
    return float(end[0] - end[-1])


def rows_of(name: str, efforts: list[Effort]) -> list[list[str]]:
    return [[f"{name}: peak activation of lines; of obliques", *(f"{e.lines:.2f}; {e.obliques:.2f}" for e in efforts)],
            [f"{name}: mean activation", *(f"{e.mean:.3f}" for e in efforts)],
            [f"{name}: antagonists' share of the force, %", *(f"{100 * e.antagonists:.1f}" for e in efforts)],
            [f"{name}: frames in which a muscle is too weak, %", *(f"{100 * e.short:.0f}" for e in efforts)]]


def by_knot(folder: Path) -> None:
    every = [Muscles(cell.log) for cell in read_cells(folder / "ties")]
    tied, pulled = every[:len(plots.SCENES)], every[len(plots.SCENES):]
    slides = [sliding(m.log) for m in tied]
    slid = [m.of(frames) for m, frames in zip(tied, slides)]
    rows = rows_of("tying", [m.of(m.log.intervals_in("form")) for m in tied])
    rows += rows_of("sliding", slid)
    rows += rows_of("pulling", [m.of(m.log.intervals_in("pull")) for m in pulled])
    rows += [["sliding: mean activation times time, s for each cm",
              *(f"{e.mean * e.seconds / way(m.log):.3f}" for m, e in zip(tied, slid))],
             ["sliding: work of muscles, erg for each cm", *(f"{work(m.log, f) / way(m.log):.2g}" for m, f in zip(tied, slides))],
             ["sliding: one pair of constant arms instead, off by: median; largest, %",
              *("{:.0f}; {:.0f}".format(*(100 * off for off in m.pair_off(f))) for m, f in zip(tied, slides))]]
    tables.write_table(folder, "muscles", ["", *plots.SCENES.values()], rows)


def forward(folder: Path) -> None:
    rows = []
    for grid, axis in (("forward", "scene"), ("start", "start.seed"), ("lag", "muscle.activation_time")):
        for cell in read_cells(folder / grid):
            log, name = cell.log, f"{grid}_{cell.axes[axis].removeprefix('living_')}"
            frames = log.in_phase("slide")
            if not frames.size:
                rows.append([name, "never slides", "", "", "", ""])
                continue
            held = np.flatnonzero(np.isin(log.labels("/trajectory/phase"), ("tighten", "slide")))
            time = log["/trajectory/time"][frames]
            does = cell.texts["slide"] if len(set(log.knots(held))) == 1 else "is lost"
            rows.append([name, does, f"{way(log):.2f}", f"{cell.figures['both_ends_percent']:.0f}",
                         f"{way(log) / (time[-1] - time[0]):.2f}", f"{np.quantile(log['/muscle/driven'][frames], 0.999):.2f}"])
    tables.write_table(folder, "muscles_forward", ["on activations", "the knot", "way of the head end, cm",
                                                   "share of a slide by both ends, %", "cm/s", "peak activation"], rows)


def stiffness(folder: Path) -> None:
    figure, panels = plots.panels(1, 2, (8.5, 3.4), ["peak activation while tying and sliding", "frames in which a muscle is too weak"])
    rows: dict[float, list[str]] = {}
    found: dict[str, dict[float, HagfishLog]] = {}
    for cell in (*read_cells(folder / "ties"), *read_cells(folder / "stiffness")):
        value = cell.axes.get("specimen.passive.bending_stiffness", "[2e5")  # as the specimen has it
        found.setdefault(cell.axes["scene"], {})[float(value.strip("[]").split(",")[0])] = cell.log
    for scene, knot in plots.SCENES.items():
        points = []
        for value, log in sorted(found[f"living_{scene}"].items()):
            muscles = Muscles(log)
            frames = np.flatnonzero(np.isin(log.labels("/trajectory/phase"), ("form", "tighten", "slide")))[1:]
            effort = muscles.of(frames)
            tied = log.in_phase("slide").size > 0
            points.append((value / 1e5, max(effort.lines, effort.obliques), 100 * effort.short, tied))
            rows.setdefault(value, []).append(f"{points[-1][1]:.2f}; {points[-1][2]:.0f}" + ("" if tied else "; not tied"))
        for axes, column in zip(panels, (1, 2)):
            x, y = [p[0] for p in points], [p[column] for p in points]
            axes.plot(x, y, label=plots.KNOTS[knot].label, **plots.KNOTS[knot].style)
            if loose := [(p[0], p[column]) for p in points if not p[3]]:
                axes.plot(*zip(*loose), "x", ms=10, color=plots.VERMILION, ls="none", label="does not tie")
    for axes, name in zip(panels, ("activation", "% of frames")):
        axes.set_xscale("log")
        plots.plain_ticks(axes.xaxis, (0.4, 1, 2, 3, 4, 6, 8))
        axes.set(xlabel="flexural rigidity EI, $10^5$ dyn cm²\n(muscles' stiffness: 5, and 2.5 EI above EI = 2)", ylabel=name)
    panels[0].legend()
    plots.save(figure, folder / "muscles_stiffness.png")
    tables.write_table(folder, "muscles_stiffness", ["EI, dyn cm²: peak activation; frames in which a muscle is too weak, %",
                                                     *plots.SCENES.values()],
                       [[tables.short(value, ".0e"), *cells] for value, cells in sorted(rows.items())])


def main(folder: Path) -> None:
    for table in (by_knot, forward, stiffness):
        table(folder)


if __name__ == "__main__":
    run_script(__doc__, ["RUNS"], main)
