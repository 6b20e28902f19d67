"""The reflex where a knot is not yet drawn tight, and where it is not yet tied: does it tighten, does it form? A row a run, as CSV.

Usage: PYTHONPATH=build/release/experiments/python python3 experiments/results/reflex/reflex_loose.py OUT.csv

The program that ties the knot is cut off: where the knot is first there ("tighten"), seen every half second, or a second before ("form"). From then on
every joint copies, by Δ of the scene or by three times that at the knot's tail end.
"""

from __future__ import annotations

import csv
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np

import hagfish
from reflex_laws import KNOTS, ROOT, SETTINGS, SHIFT, Body

GROWTH = (1, 3)  # of Δ, from the knot's head end to its tail end
GRID = 0.5  # s, of the times at which the program is cut off
MOST = 8.0  # s


def law(growth: float) -> Callable[..., None]:
    body: list[Body] = []

    def act(sim: hagfish.Simulation, control: hagfish.Control) -> None:
        control.commands = []
        if not body:
            body.append(Body(sim))
        angles = sim.q[-(sim.nv - ROOT):] + sim.h * sim.qdot[ROOT:]
        rest = np.zeros(sim.nv)
        rest[ROOT:] = angles
        arc, head, tail = body[0].arc, sim.head_end, sim.tail_end
        scale = np.ones(arc.size)
        if head is not None and tail is not None and tail > head:
            scale = 1 + (growth - 1) * np.clip((arc - head) / (tail - head), 0, 1)
        shift = SHIFT * body[0].length / (2 * body[0].length / sim.bodies)
        for own in body[0].kinds.values():
            rest[ROOT + own] += scale[own] * shift * (np.append(angles[own][1:], 0.0) - angles[own])
        control.rest_shape = rest

    return act


def program(sim: hagfish.Simulation, control: hagfish.Control) -> None:
    """As the scene has it."""


def cut_off(scene: str, knot: str) -> tuple[hagfish.Simulation, hagfish.Simulation]:
    """The run just after the knot is tied, and just before."""
    sim = hagfish.Simulation(scene, set=SETTINGS | {"guard.action": "warn"}, law=program)
    kept: list[hagfish.Simulation] = []
    while str(sim.knot) != knot:
        kept.append(sim.copy(law=program))
        sim.run(until=sim.time + GRID)
    return sim, kept[-2]


def follow(sim: hagfish.Simulation) -> tuple[list[float], list[str]]:
    """Spans of the knot and its types in turn, until it is at the head, the program would be over without a knot, or MOST is over."""
    spans, types, begin = [], [], sim.time
    try:
        while sim.time < begin + MOST and sim.phase not in ("release", "free"):
            sim.step()
            if not types or types[-1] != str(sim.knot):
                types.append(str(sim.knot))
            if sim.head_end is not None and sim.tail_end is not None:
                spans.append(sim.tail_end - sim.head_end)
    except hagfish.StepError as error:
        if error.outcome != "never tied":
            raise
    return spans, types


def main(out: Path) -> None:
    with out.open("w", newline="", encoding="utf-8") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(["task", "knot", "commit", "begin_s", "growth", "slide_s", "types", "span_from_cm", "span_least_cm"])
        for knot, scene in KNOTS.items():
            for task, cut in zip(("tighten", "form"), cut_off(scene, knot)):
                for growth in GROWTH:
                    sim = cut.copy(law=law(growth))
                    begin = sim.time
                    spans, types = follow(sim)
                    table.writerow([task, knot, hagfish.revision[:12], f"{begin:.4g}", growth, f"{sim.time - begin:.4g}", " ".join(types),
                                    f"{spans[0]:.4g}", f"{min(spans):.4g}"])
                    file.flush()


if __name__ == "__main__":
    main(Path(sys.argv[1]))
