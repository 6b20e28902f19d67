"""What slides a stiff knot: tables and figure of study.sh.

Usage: thigmotaxis.py FOLDER. FOLDER is what the study leaves. The figure comes there, and the tables in its folder tables.
"""

from pathlib import Path

import numpy as np

import plots
import tables
from hagfish_log import HagfishLog
from overview import bending
from script import run_script
from sweep_columns import read_cells, read_sweep

LAWS = {("paper", "centreline"): "two contacts", ("paper", "skin"): "two contacts, at the skin",
        ("all_contacts", "skin"): "all contacts, at the skin", ("all_contacts", "centreline"): "all contacts"}
DRAWN = ("two contacts", "all contacts", "reflex")
REFLEX = "reflex"
VARIED = {"meshes": ("model.bodies", "bodies"), "steps": ("time.step", "time step, s"),
          "speeds": ("controller.slide_head.a", "commanded speed, cm/s"), "starts": ("start.seed", "start with noise, number")}
BEFORE, AFTER = 0.5, 1.0  # s of the figure around the slide
STRENGTH = 0.8  # 1/cm, curvature of the darkest colour


def knot_of(scene: str) -> tuple[str, str]:
    """Type and how the head is, by a scene's name."""
    return plots.knot_of(scene), "free" if scene.endswith("_free") else "held"


def law_of(axes: dict[str, str]) -> str:
    return LAWS[axes["controller.law"], axes["controller.eq6_at"]] if "controller.law" in axes else REFLEX


def work_per_cm(log: HagfishLog, way: float) -> tuple[float, float]:
    """Sizes of what the hinges' torques work in the slide, all of them and f_thigmo, for each cm of way, erg/cm."""
    frames = log.intervals_in("slide")
    turned = np.diff(log["/trajectory/q"][:, 7:], axis=0, prepend=np.nan)[frames]
    thigmotaxis = log["/mean/forces/thigmotaxis"][frames, 6:]
    whole = thigmotaxis + log["/mean/forces/active"][frames, 6:]
    return tuple(float(np.abs(torque * turned).sum() / way) for torque in (whole, thigmotaxis))


def capacity(log: HagfishLog) -> float:
    return float(log.scene()["active"]["capacity"])


def law_rows(folder: Path) -> list[list[str]]:
    rows = []
    for cell in (cell for grid in ("laws", "reflex") for cell in read_cells(folder / grid)):
        of, law = cell.figures, law_of(cell.axes)
        first = [*knot_of(cell.axes["scene"]), law]
        if not cell.texts["slide"]:
            rows.append([*first, *["-"] * 3, "never slides", *["-"] * 4])
            continue
        travel = "-" if np.isnan(of["curvature_travel_cm"]) else f"{of['curvature_travel_cm']:.1f} ({of['curvature_correlation']:.2f})"
        all_work, thigmotaxis = work_per_cm(cell.log, of["slide_distance_cm"])
        met = "" if law == REFLEX else f"{of['eq6_percent']:.0f}"
        rows.append([*first, f"{of['slide_distance_cm']:.1f}", f"{of['tail_distance_cm']:.1f} of {of['taper_asks_cm']:.1f}", travel,
                     cell.texts["slide"], met, f"{of['largest_torque_dyn_cm'] / capacity(cell.log):.2f}", f"{all_work:.2g}",
                     f"{thigmotaxis:.2g}"])
    order = [*LAWS.values(), REFLEX]
    return sorted(rows, key=lambda row: (row[0], row[1] == "free", order.index(row[2])))


def run_rows(folder: Path, most: float) -> list[list[str]]:
    """A row for each change, over all knots: how many runs slide by both ends, and by how much. `most`: the muscles' capacity, dyn cm."""
    rows = []
    for grid, (axis, words) in VARIED.items():
        table = read_sweep(folder / grid / "table.csv")
        shares, torque = table.figures["both_ends_percent"], table.figures["largest_torque_dyn_cm"]
        knots = np.array([" ".join(knot_of(scene)) for scene in table.axes["scene"]])
        by = np.array([f"{value}, {bodies} bodies" for value, bodies in zip(table.axes[axis], table.axes["model.bodies"])]
                      if grid == "steps" else table.axes[axis])
        slid = table.both_ends & (np.array(table.texts["outcome"]) == "ok")
        for value in dict.fromkeys(by) if grid != "starts" else [""]:
            of = by == value if grid != "starts" else np.ones(len(by), dtype=bool)
            failed = [f"{knot} {'' if np.isnan(share) else f'{share:.0f} %'}".strip() for knot,
                      share in zip(knots[of & ~slid], shares[of & ~slid])]
            rows.append([words + (f": {value}" if value else f"s 1 to {len(set(by))}"), f"{slid[of].sum()} of {of.sum()}",
                         f"{np.nanmin(shares[of]):.0f}", f"{np.nanmedian(shares[of]):.0f}",
                         f"{np.nanmin(table.figures['eq6_percent'][of]):.0f}",
                         f"{np.nanmax(torque[of]) / most:.2f}", "; ".join(failed)])
    return rows


def draw(folder: Path, path: Path) -> None:
    """Curvature along the body through the slides: knots by laws."""
    cells = {}
    for cell in (cell for grid in ("laws", "reflex") for cell in read_cells(folder / grid)):
        knot, head = knot_of(cell.axes["scene"])
        if head == "held":
            cells[knot, law_of(cell.axes)] = cell.log
    titles = [f"{plots.KNOTS[knot].label.split()[0]}: {law}" for knot in plots.KNOTS for law in DRAWN]
    figure, panels = plots.panels(len(plots.KNOTS), len(DRAWN), (8.6, 8.4), titles, sharex=True)
    for axes, (knot, law) in zip(panels, [(knot, law) for knot in plots.KNOTS for law in DRAWN]):
        log = cells[knot, law]
        time, slide = log["/trajectory/time"], log.in_phase("slide")
        start, end = time[slide[0]], time[slide[-1]]
        shown = np.flatnonzero((time >= start - BEFORE) & (time <= end + AFTER))
        arc, curvature = bending(log, log["/trajectory/curvature"][shown])
        image = axes.pcolormesh(arc, time[shown] - start, curvature, cmap="Greys", vmin=0, vmax=STRENGTH, shading="nearest",
                                rasterized=True)
        for name, style in (("head", "-"), ("tail", "--")):
            axes.plot(log[f"/knot/{name}_end"][slide], time[slide] - start, style, color=plots.VERMILION, lw=1.4,
                      label=f"{name} end of the knot")
        axes.axhspan(end - start, end - start + AFTER, color=plots.BLUE, alpha=0.12, lw=0)
        axes.set(ylim=(end - start + AFTER, -BEFORE), xlim=(0, float(log["/model/length"].sum())))
        axes.grid(False)
    for axes in panels[:: len(DRAWN)]:
        axes.set_ylabel("time of the slide, s")
    for axes in panels[-len(DRAWN):]:
        axes.set_xlabel("along the body, cm")
    plots.legend_above(figure, panels[0].get_legend_handles_labels()[0], 2, 0.03)
    figure.colorbar(image, ax=list(panels), label="curvature, 1/cm", shrink=0.4, aspect=50, location="right")
    plots.save(figure, path)


def main(folder: Path) -> None:
    tables.write_table(folder, "thigmotaxis", ["knot", "head", "Eq. 6 at", "head end of the knot, cm", "its tail end, of what taper asks, cm",
                                               "curvature travels, cm (correlation)", "the knot", "steps that meet Eq. 6, %", "largest torque, of capacity",
                                               "work, erg/cm", "of it f_thigmo"], law_rows(folder))
    tables.write_table(folder, "thigmotaxis_runs", ["what is changed", "slide by both ends", "least share, %", "median share, %",
                                                    "least steps that meet Eq. 6, %", "largest torque, of capacity", "which do not"],
                       run_rows(folder, capacity(next(read_cells(folder / "laws")).log)))  # one animal
    draw(folder, folder / "thigmotaxis.png")


if __name__ == "__main__":
    run_script(__doc__, ["FOLDER"], main)
