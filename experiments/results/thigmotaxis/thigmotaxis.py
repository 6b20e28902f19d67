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
from sweep_columns import Cell, read_cells

LAWS = {"paper": "two contacts", "all_contacts": "all contacts"}
SEEN_AT = {"centreline": "spline", "skin": "skin"}
REFLEX = "reflex"
LIKE_PAPER = "two contacts, tightened"  # for the longest of grids/tightened.toml, as the paper does
DRAWN = (LIKE_PAPER, "two contacts", "all contacts", REFLEX)
VARIED = {"meshes": ("model.bodies", "bodies"), "steps": ("time.step", "time step, s"),
          "speeds": ("controller.slide_head.a", "commanded speed, cm/s"), "starts": ("start.seed", "start with noise, number")}
BEFORE, AFTER = 0.5, 1.0  # s of the figure around the slide
STRENGTH = 0.8  # 1/cm, curvature of the darkest colour


def knot_of(scene: str) -> tuple[str, str]:
    """Type and how the head is, by a scene's name."""
    return plots.knot_of(scene), "free" if scene.endswith("_free") else "held"


Law = tuple[str, str, float]  # at which contacts, where these are seen, and s of tightening


def law_of(axes: dict[str, str]) -> Law:
    if "controller.law" not in axes:
        return REFLEX, "", 0.0
    return LAWS[axes["controller.law"]], SEEN_AT[axes.get("controller.eq6_at", "centreline")], float(axes.get("controller.tighten_time", 0))


def runs_by_law(folder: Path) -> dict[Law, list[Cell]]:
    """The runs of all knots."""
    runs: dict[Law, list[Cell]] = {}
    for grid in ("laws", "tightened", "reflex"):
        for cell in read_cells(folder / grid):
            runs.setdefault(law_of(cell.axes), []).append(cell)
    order = [*LAWS.values(), REFLEX]
    return dict(sorted(runs.items(), key=lambda of: (order.index(of[0][0]), of[0][1] == "skin", of[0][2])))


def compared(runs: dict[Law, list[Cell]]) -> dict[str, list[Cell]]:
    """Of laws at the spline without tightening, and of LIKE_PAPER."""
    longest = max(law for law in runs if law[:2] == ("two contacts", "spline"))
    return {LIKE_PAPER: runs[longest]} | {law: of for (law, at, time), of in runs.items() if time == 0 and at != "skin"}


def work_per_cm(log: HagfishLog, way: float) -> tuple[float, float]:
    """Sizes of what the hinges' torques work in the slide, all of them and f_thigmo, for each cm of way, erg/cm."""
    frames = log.intervals_in("slide")
    turned = np.diff(log["/trajectory/q"][:, 7:], axis=0, prepend=np.nan)[frames]
    thigmotaxis = log["/mean/forces/thigmotaxis"][frames, 6:]
    whole = thigmotaxis + log["/mean/forces/active"][frames, 6:]
    return tuple(float(np.abs(torque * turned).sum() / way) for torque in (whole, thigmotaxis))


def capacity(log: HagfishLog) -> float:
    return float(log.scene()["active"]["capacity"])


def knot_rows(by_law: dict[str, list[Cell]]) -> list[list[str]]:
    rows = []
    for law, cell in [(law, cell) for law, of in by_law.items() for cell in of]:
        of = cell.figures
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
    return sorted(rows, key=lambda row: (row[0], row[1] == "free", list(by_law).index(row[2])))


COUNTED = ["slide by both ends", "least share, %", "median share, %", "least steps that meet Eq. 6, %", "largest torque, of capacity",
           "which do not"]


def counted(cells: list[Cell], most: float) -> list[str]:
    """How many runs slide by both ends, and by how much. `most`: the muscles' capacity, dyn cm."""
    figure = lambda name: np.array([cell.figures[name] for cell in cells])
    shares, met = figure("both_ends_percent"), figure("eq6_percent")
    slid = [cell.outcome == "ok" and cell.both_ends for cell in cells]
    failed = [" ".join([*knot_of(cell.axes["scene"]), "" if np.isnan(share) else f"{share:.0f} %"]).strip()
              for cell, share, well in zip(cells, shares, slid) if not well]
    return [f"{sum(slid)} of {len(slid)}", f"{np.nanmin(shares):.0f}", f"{np.nanmedian(shares):.0f}", f"{np.nanmin(met):.0f}" if met.any() else "",
            f"{np.nanmax(figure('largest_torque_dyn_cm')) / most:.2f}", "; ".join(failed)]


def law_rows(runs: dict[Law, list[Cell]], most: float) -> list[list[str]]:
    return [[law, at, f"{time:g} s" if time else "no", *counted(of, most)] for (law, at, time), of in runs.items()]


def change_rows(folder: Path, most: float) -> list[list[str]]:
    """A row for each change of the runs at all contacts, over all knots."""
    rows = []
    for grid, (axis, words) in VARIED.items():
        cells = list(read_cells(folder / grid))
        if grid == "starts":
            rows.append([f"{words}s 1 to {len({cell.axes[axis] for cell in cells})}", *counted(cells, most)])
            continue
        name = lambda cell: f"{words}: {cell.axes[axis]}" + (f", {cell.axes['model.bodies']} bodies" if grid == "steps" else "")
        for value in dict.fromkeys(map(name, cells)):
            rows.append([value, *counted([cell for cell in cells if name(cell) == value], most)])
    return rows


def draw(by_law: dict[str, list[Cell]], path: Path) -> None:
    """Curvature along the body through the slides: knots by laws."""
    cells = {(knot_of(cell.axes["scene"]), law): cell for law in DRAWN for cell in by_law[law]}
    titles = [f"{plots.KNOTS[knot].label.split()[0]}: {law}" for knot in plots.KNOTS for law in DRAWN]
    figure, panels = plots.panels(len(plots.KNOTS), len(DRAWN), (10.4, 8.4), titles, sharex=True)
    for axes, (knot, law) in zip(panels, [(knot, law) for knot in plots.KNOTS for law in DRAWN]):
        log = cells[(knot, "held"), law].log
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
    runs = runs_by_law(folder)
    by_law = compared(runs)
    most = capacity(by_law[LIKE_PAPER][0].log)  # one animal
    tables.write_table(folder, "thigmotaxis_laws", ["Eq. 6 at", "seen at", "tightened first", *COUNTED], law_rows(runs, most))
    tables.write_table(folder, "thigmotaxis", ["knot", "head", "Eq. 6 at", "head end of the knot, cm", "its tail end, of what taper asks, cm",
                                               "curvature travels, cm (correlation)", "the knot", "steps that meet Eq. 6, %", "largest torque, of capacity",
                                               "work, erg/cm", "of it f_thigmo"], knot_rows(by_law))
    tables.write_table(folder, "thigmotaxis_runs", ["what is changed", *COUNTED], change_rows(folder, most))
    draw(by_law, folder / "thigmotaxis.png")


if __name__ == "__main__":
    run_script(__doc__, ["FOLDER"], main)
