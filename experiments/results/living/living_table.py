"""The table of the page on living animals: written from the study's runs.

Usage: living_table.py RUNS OUT_FOLDER.
"""

from __future__ import annotations

from pathlib import Path

import living
import plots
import tables
from hagfish_log import HagfishLog
from script import run_script


def short(value: float) -> str:
    return f"{value:.1e}".replace("e+0", "e")


def main(folder: Path, out: Path) -> None:
    of = lambda kind: [living.read_run(folder, f"{kind}_{scene}", knot) for scene, knot in plots.SCENES.items()]
    starts = lambda head: [living.read_starts(folder, head, scene) for scene in plots.SCENES]
    held, free = of("held"), of("free")
    animals = [[living.read_run(folder, name, knot) for name in living.names_of(folder, "animal", scene)]
               for scene, knot in plots.SCENES.items()]
    programs = [HagfishLog(folder / f"held_{scene}.h5").scene()["script"]["curvature"] for scene in plots.SCENES]
    slid = lambda run: f"{run.travel:.1f}; {run.share:.0f}; {100 * run.met:.0f}"
    off = lambda runs: [f"{one.off}; {living.np.nanmin(one.shares):.0f}" for one in runs]
    tables.write_table(out, "living", ["h = 5 ms, `active-set`", *plots.SCENES.values()], [
        ["clamped: way of the knot's head end, cm; share of a slide by both ends, %; steps that meet Eq. 6, %", *map(slid, held)],
        ["free, no plate: the same", *map(slid, free)],
        ["deepest penetration at any step, release included, cm",
         *(f"{max(a.penetration, b.penetration):.4f}" for a, b in zip(held, free))],
        ["λ/h of the first and last contact while sliding, clamped, median, dyn", *(short(run.force) for run in held)],
        ["largest torque of a hinge, forming; sliding, dyn cm",
         *(f"{short(run.torque['form'])}; {short(run.torque['slide'])}" for run in held)],
        ["values of the program: stations x times", *(f"{len(each['stations'])} x {len(each['times'])}" for each in programs)],
        ["of 20 starts with 3 degrees (3_1: 5) of noise on every hinge, clamped: tied, kept and off; least share, %",
         *off(starts("held"))],
        ["free: the same", *off(starts("free"))],
        ["of 10 other animals, clamped: tied, kept and off", *(str(sum(run.outcome == "off" for run in each)) for each in animals)],
        ["of these: least share, %", *("{:.0f}".format(min(run.share for run in each if run.outcome == "off")) for each in animals)],
        ["of these that slide: sliding steps that meet Eq. 6, %: median, least",
         *("{:.0f}, {:.0f}".format(*(100 * pick([run.met for run in each if run.outcome == "off" and living.np.isfinite(run.met)])
                                     for pick in (living.np.median, min))) for each in animals)]])


if __name__ == "__main__":
    run_script(__doc__, ["RUNS", "OUT_FOLDER"], main)
