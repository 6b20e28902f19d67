"""Tables of a world to knot in: out of a hole with knots and without, the skin that knots sweep, and a robot on a floor.

Usage: world.py FOLDER, of experiments/studies/world.sh.
"""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np

import tables
from hagfish_log import HagfishLog
from script import run_script

SETTLED = 4.0  # s, after which a wave runs evenly
LAWS = {"paper": "paper's", "reflex": "reflex"}


def cells(folder: Path) -> list[tuple[dict[str, str], HagfishLog]]:
    """Rows of a sweep with their logs."""
    rows = tables.read_csv(folder / "table.csv", ["cell"])
    return [(row, HagfishLog(folder / "logs" / f"{row['cell']}.h5")) for row in rows]


def knot_and_law(log: HagfishLog) -> tuple[str, str]:
    scene = log.scene()
    return scene["expect"]["knot"], LAWS[scene["controller"]["law"]]


def types(log: HagfishLog) -> np.ndarray:
    """The knot's name at each frame."""
    names = log.named("knot", by="knot_invariants")
    return np.array([names.get(f"det={d},v2={v}", "") for d, v in zip(log["/knot/determinant"], log["/knot/v2"])])


def largest_pull(log: HagfishLog) -> float:
    """Of means over a frame's time, N."""
    pull = log["/pull/force"]
    return float(np.nanmax(pull, initial=0)) / 1e5


def first(time: np.ndarray, where: np.ndarray) -> float:
    return float(time[np.argmax(where)]) if where.any() else np.nan


def number(value: float, digits: int = 3) -> str:
    return "never" if np.isnan(value) else f"{value:.{digits}g}"


def holes(folder: Path) -> None:
    rows = []
    for _, log in cells(folder / "holes"):
        scene, time = log.scene(), log["/trajectory/time"]
        knot, law = knot_and_law(log)
        phase = log.labels("/trajectory/phase")
        plate = next(each for each in scene["obstacle"] if each["name"] == scene["expect"]["out_of"])
        pulls = first(time, phase == "pull")
        out = first(time, (log["/trajectory/q"][:, 0] > plate["point"][0]) & (time > pulls))
        held = bool((types(log)[(time >= pulls) & (time <= out)] == knot).all())
        rows.append([knot, law, f"{scene['food']['strength']:g}", f"{1000 * scene['time']['step']:g}", number(pulls), number(first(time, phase == "release")),
                     number(out), "yes" if held else "no", number(1000 * float(np.max(log["/diagnostics/penetration"])), 2)])
    tables.write_csv(folder / "tables" / "world.csv", ["knot", "law", "held with, N", "step, ms", "pulls from, s", "it gives at, s", "head out at, s",
                                                       "type held until then", "deepest overlap, 1e-3 cm"], rows)


def waves(folder: Path) -> None:
    """A row a wave, of runs that start at other phases of it. The pull is a mean over a frame's time, as that at which food gives."""
    found: dict[tuple[str, ...], list[tuple[np.ndarray, float, float]]] = {}
    for path in sorted((folder / "waves").glob("*.h5")):
        log = HagfishLog(path)
        late = log["/trajectory/time"] > SETTLED
        found.setdefault(tuple(path.stem.split("_")[:3]), []).append(
            (-log["/mean/forces/head"][late, 0] / 1e5, np.abs(log["/mean/forces/active"][late]).max(), log.scene()["food"]["strength"]))
    rows = []
    for wave, runs in found.items():
        pull = np.array([run[0] for run in runs])
        means, peaks, strength = pull.mean(axis=1), pull.max(axis=1), runs[0][2]
        rows.append([*wave, f"{len(runs)}", f"{means.min():.2g} to {means.max():.2g}", f"{peaks.min():.2g} to {peaks.max():.2g}",
                     f"{100 * (pull > strength).mean():.2g}", "no" if (peaks < strength).all() else "yes" if (peaks > strength).all() else "at some phases",
                     f"{max(run[1] for run in runs):.1e}".replace("+0", "")])
    tables.write_csv(folder / "tables" / "world_waves.csv", ["angle, rad", "length, L", "period, s", "phases", "mean pull, N", "largest pull, N",
                                                             "over what holds, % of time", "head comes out", "largest torque, dyn cm"], rows)


def hole_map(folder: Path) -> None:
    """A row a change, a column a knot and law: the median of its starts, their least and most; "not tied" counts as no pull."""
    found: dict[str, dict[tuple[str, str], list[float]]] = {}
    for _, log in [*cells(folder / "hole_map"), *cells(folder / "hole_widths")]:
        scene = log.scene()
        rim = next(each for each in scene["obstacle"] if each["kind"] == "strand")
        points = np.array(rim["points"])  # evenly round the hole
        width = 2 * (np.linalg.norm(points - points.mean(axis=0), axis=1).mean() - rim["radius"])
        plate = "plane" if rim["name"] == "rim" else "rings"
        changed = (f"hole {width:.2g} cm, {plate}; girth {max(log['/model/radius']) * 2 * np.pi:.2g} cm; "
                   f"muscles {scene['active']['stiffness']:.1e} dyn cm^2").replace("e+0", "e")
        found.setdefault(changed, {}).setdefault(knot_and_law(log), []).append(largest_pull(log))
    columns = list(dict.fromkeys(key for cell in found.values() for key in cell))
    tables.write_csv(folder / "tables" / "world_map.csv", ["changed", *(f"{knot}, {law}" for knot, law in columns)],
                     [[changed, *(pulled(cell.get(key, [])) for key in columns)] for changed, cell in found.items()])


def pulled(starts: list[float]) -> str:
    return "not tied" if not any(starts) else f"{np.median(starts):.2f} ({min(starts):.2f} to {max(starts):.2f})"


def chance(folder: Path) -> None:
    """Pulls of the map's first row from other starts."""
    pulls: dict[tuple[str, str], list[float]] = {}
    for _, log in cells(folder / "hole_chance"):
        pulls.setdefault(knot_and_law(log), []).append(largest_pull(log))
    rows = []
    for (knot, law), of in pulls.items():
        tied = [pull for pull in of if pull > 0]
        rows.append([knot, law, f"{len(tied)} of {len(of)}", *(f"{value:.2f}" for value in (min(tied), np.median(tied), max(tied)))])
    tables.write_csv(folder / "tables" / "world_chance.csv", ["knot", "law", "tied", "lowest, N", "median, N", "highest, N"], rows)


def skin(folder: Path) -> None:
    rows = []
    for row, log in cells(folder / "skin"):
        knot, law = knot_and_law(log)
        with (folder / "skin" / "logs" / row["cell"] / "skin.csv").open(encoding="utf-8") as file:
            cell = list(csv.DictReader(file))
        s, area = (np.array([float(one[name]) for one in cell]) for name in ("s_cm", "area_cm2"))
        swept = np.array([one["since_s"] != "" for one in cell])
        back = log.scene()["controller"]["leave_by"] == "tail"
        ends = (s[swept].min(), s[swept].max()) if swept.any() else (np.nan, np.nan)
        between = (s >= ends[0]) & (s <= ends[1])
        rows.append([knot, law, "to the head and back" if back else "to the head", row["outcome"], number(area[swept].sum()),
                     number(100 * area[swept].sum() / area.sum()), number(ends[0], 2), number(s.max() - ends[1], 2),
                     number(100 * area[swept & between].sum() / area[between].sum())])
    tables.write_csv(folder / "tables" / "world_skin.csv",
                     ["knot", "law", "slides", "outcome", "swept, cm^2", "of all skin, %", "never: head, cm", "never: tail, cm", "between these, %"], rows)


def robot(folder: Path) -> None:
    rows = []
    for row, log in cells(folder / "robot"):
        scene, time = log.scene(), log["/trajectory/time"]
        phase = log.labels("/trajectory/phase")
        slide = log.in_phase("slide")
        way = float(log["/knot/head_end"][slide[0]] - log["/knot/head_end"][slide[-1]]) if slide.size else np.nan
        # A released knot is gone where the run comes to the phase free.
        became = ("it never tied" if not slide.size else "it tied, slid and came off" if (phase == "free").any() else "it tied, and lost the knot")
        rows.append([f"{abs(scene['gravity'][2]) / 981:.2g}", "held" if scene["clamp_head"] else "free", f"{scene['active']['capacity'] / 1e7:g}",
                     f"{scene['active']['stiffness'] / 4e7:g}", became, "" if np.isnan(way) else f"{way:.3g}",
                     f"{np.nanmax(np.abs(log['/mean/forces/active'][:, 6:])) / 1e7:.2g}", number(1000 * float(np.max(log["/diagnostics/penetration"])), 2)])
    tables.write_csv(folder / "tables" / "world_robot.csv", ["weight, of all of it", "head", "torque bound, N m", "stiffness of a joint, N m/rad", "what became of it",
                                                             "slide, cm", "largest torque, N m", "deepest overlap, 1e-3 cm"], rows)


def main(folder: Path) -> None:
    (folder / "tables").mkdir(exist_ok=True)
    holes(folder)
    waves(folder)
    hole_map(folder)
    chance(folder)
    skin(folder)
    robot(folder)


if __name__ == "__main__":
    run_script(__doc__, ["FOLDER"], main)
