"""The tables of the page on how sure figures are: slides in short, and each scene's figures over each cause.

Usage: sure_page.py FOLDER. FOLDER has a folder of `hagfish sure` for each scene of SCENES; leaves tables/sure.csv and sure_slides.csv there.
"""

from pathlib import Path

import numpy as np

import plots
import sure
import tables
from script import run_script

SCENES = ["table1", *(f"{kind}_{knot}" for kind in ("living", "reflex") for knot in plots.SCENES)]
SHOWN = {"slide_distance_cm": "head end of the knot, cm", "sliding_force_dyn": "sliding force, dyn",
         "largest_thigmotaxis_dyn_cm": "largest f_thigmo, dyn cm",
         "largest_active_dyn_cm": "largest torque of muscles, dyn cm", "work_active_erg": "work of muscles, erg",
         "work_thigmotaxis_erg": "work of f_thigmo, erg"}


def interval(spread: sure.Spread) -> str:
    if np.isnan(spread.least):
        return "-"
    ends = tables.short(spread.least), tables.short(spread.most)
    return ends[0] if ends[0] == ends[1] else " to ".join(ends)


def rows(scene: str, found: sure.Sure) -> list[list[str]]:
    counted = f"{int(found.counted.sum())} of {len(found.causes)}"
    return [[f"{scene}: {SHOWN[name]}", tables.short(values[0]), *map(interval, found.spreads(values)), counted]
            for name, values in found.of_the_animal() if name in SHOWN]


def main(folder: Path) -> None:
    found = {scene: sure.read(folder / scene) for scene in SCENES}
    kinds = next(iter(found.values())).kinds
    tables.write_table(folder, "sure", ["scene and figure", "as it is", *kinds, "chance, step, bodies", "all", "runs that count"],
                       [row for scene, of in found.items() for row in rows(scene, of)])
    tables.write_table(folder, "sure_slides", ["", "as it is", "over chance, steps, bodies", "over all causes", "runs that count"],
                       [row[:2] + row[-3:] for scene, of in found.items() for row in rows(scene, of)[:1]])


if __name__ == "__main__":
    run_script(__doc__, ["FOLDER"], main)
