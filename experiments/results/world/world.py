"""Tables of a world to knot in: out of a hole with knots and without, the skin that knots sweep, and a robot on a floor.

Usage: world.py FOLDER, of study.sh, of what taken.py kept of its logs.
"""

from pathlib import Path
from typing import Any

import numpy as np

import tables
from script import run_script
from taken import taken, taken_of_sweep
from world_logs import LAWS


def number(value: float, digits: int = 3) -> str:
    return "never" if np.isnan(value) else f"{value:.{digits}g}"


def knot_and_law(run: dict[str, Any]) -> tuple[str, str]:
    return run["knot"], LAWS[run["law"]]


def overlap(run: dict[str, Any]) -> str:
    return number(1000 * run["penetration"], 2)


def holes(folder: Path) -> None:
    rows = [[*knot_and_law(run), f"{run['strength']:g}", f"{1000 * run['step']:g}", number(run["pulls"]), number(run["gives"]),
             number(run["out"]),
             "yes" if run["held"] else "no", overlap(run)] for run in taken(folder / "holes" / "logs")]
    tables.write_table(folder, "world", ["knot", "law", "held with, N", "step, ms", "pulls from, s", "it gives at, s", "head out at, s",
                                         "type held until then", "deepest overlap, 1e-3 cm"], rows)


def waves(folder: Path) -> None:
    """A row a wave, of runs that start at other phases of it."""
    rows = []
    for wave, runs in tables.grouped(taken(folder / "wave_runs" / "logs"), lambda run: tuple(run["wave"])).items():
        means, peaks, over = (np.array([run[name] for run in runs]) for name in ("mean", "peak", "over"))
        strength = runs[0]["strength"]
        rows.append([*wave, f"{len(runs)}", f"{means.min():.2g} to {means.max():.2g}", f"{peaks.min():.2g} to {peaks.max():.2g}",
                     f"{100 * over.mean():.2g}", "no" if (peaks < strength).all() else "yes" if (peaks > strength).all() else "at some phases",
                     f"{max(run['torque'] for run in runs):.1e}".replace("+0", "")])
    tables.write_table(folder, "world_waves", ["angle, rad", "length, L", "period, s", "phases", "mean pull, N", "largest pull, N",
                                               "over what holds, % of time", "head comes out", "largest torque, dyn cm"],
                       rows)


def hole_map(folder: Path) -> None:
    """A row a change, a column a knot and law: the median of its starts, their least and most; "not tied" counts as no pull."""
    changed = lambda run: (f"hole {run['width']:.2g} cm, {run['plate']}; girth {run['girth']:.2g} cm; "
                           f"muscles {run['stiffness']:.1e} dyn cm^2").replace("e+0", "e")
    runs = [*taken(folder / "hole_map" / "logs"), *taken(folder / "hole_widths" / "logs")]
    columns = list(tables.grouped(runs, knot_and_law))
    cells = tables.grouped(runs, lambda run: (changed(run), knot_and_law(run)))
    pulls = lambda change, key: [run["pull"] for run in cells.get((change, key), [])]
    tables.write_table(folder, "world_map", ["changed", *(f"{knot}, {law}" for knot, law in columns)],
                       [[change, *(pulled(pulls(change, key)) for key in columns)] for change in tables.grouped(runs, changed)])


def pulled(starts: list[float]) -> str:
    return "not tied" if not any(starts) else f"{np.median(starts):.2f} ({min(starts):.2f} to {max(starts):.2f})"


def chance(folder: Path) -> None:
    """Pulls of the map's first row from other starts."""
    rows = []
    for (knot, law), of in tables.grouped(taken(folder / "hole_chance" / "logs"), knot_and_law).items():
        tied = [run["pull"] for run in of if run["pull"] > 0]
        rows.append([knot, law, f"{len(tied)} of {len(of)}", *(f"{value:.2f}" for value in (min(tied), np.median(tied), max(tied)))])
    tables.write_table(folder, "world_chance", ["knot", "law", "tied", "lowest, N", "median, N", "highest, N"], rows)


def skin(folder: Path) -> None:
    rows = []
    for run in taken(folder / "skin" / "logs"):
        s, area, swept = np.array(run["s"]), np.array(run["area"]), ~np.isnan(run["since"])
        reached = s[swept.any(axis=0)]
        between = (s >= reached.min()) & (s <= reached.max())
        share = lambda part: number(100 * area[part].sum() / area.sum())
        beyond = np.broadcast_to(~between, swept.shape)
        rows.append([*knot_and_law(run), "to the head and back" if run["back"] else "to the head", number(area[swept].sum()), share(swept),
                     number(area[~swept].sum()), share(~swept), number(reached.min(), 2), number(s.max() - reached.max(), 2), share(beyond),
                     share(~beyond & ~swept)])
    tables.write_table(folder, "world_skin",
                       ["knot", "law", "slides", "swept, cm^2", "swept, %", "never, cm^2", "never, %", "never: head, cm", "never: tail, cm",
                        "never: these two, %", "never: sides between them, %"], rows)


def became(slide: str, off: bool) -> str:
    """`slide` as `hagfish sweep` names it; a released knot is gone (`off`) where the run comes to the phase free."""
    return "it never ties" if not slide else f"it ties; the knot {slide}, and comes off" if off else "it ties, and loses the knot"


def robot(folder: Path) -> None:
    rows = [[f"{run['mass']:.3g}", f"{run['weight']:.2g}", f"{run['drag']:g}", f"{run['capacity']:g}", f"{run['stiffness']:g}",
             became(run["slide"], run["off"]),
             *("" if np.isnan(run[name]) else f"{run[name]:.3g}" for name in ("way", "share")), f"{run['torque']:.2g}", overlap(run)]
             for run in taken_of_sweep(folder / "robot")]
    tables.write_table(folder, "world_robot", ["mass, kg", "weight left, of all of it", "drag across, kg/(s m)",
                                               "torque bound, N m", "stiffness of a joint, N m/rad", "what became of it",
                                               "way of the head end, cm", "share of a slide by both ends, %",
                                               "largest torque, N m", "deepest overlap, 1e-3 cm"], rows)


def main(folder: Path) -> None:
    for table in (holes, waves, hole_map, chance, skin, robot):
        table(folder)


if __name__ == "__main__":
    run_script(__doc__, ["FOLDER"], main)
