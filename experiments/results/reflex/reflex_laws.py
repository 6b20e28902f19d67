"""The reflex on few joints and on few numbers: laws in Python that copy at some joints alone, from the wrong neighbour, or now and then.
A row a run, as CSV.

Usage: PYTHONPATH=build/release/experiments/python python3 experiments/results/reflex/reflex_laws.py laws|rate|loose OUT.csv
       ... reflex_laws.py curves DIR

Each knot is tied once; every law begins from there. A joint that does not copy is left to the springs of the body. `curves` leaves
logs of runs in which a joint copies the parabola through its own curvature and its two neighbours', of 100 and 200 bodies.
`loose` cuts off the program that ties the knot: where the knot is first there ("tighten"), seen every half second, or a second
before ("form"). From then on every joint copies, by Δ of the scene or by three times that at the knot's tail end.
"""

import csv
import sys
import tomllib
from collections.abc import Callable
from pathlib import Path

import numpy as np

import hagfish

SHIFT = 2.5e-4  # of the body's length, as in data/reflex_overhand.toml
ROOT = 6  # velocities of the root
SHUFFLES = 3
ALL = "all joints"
RATES = (1, 2, 5, 10, 20, 50)  # Hz
RATE_SHIFT = 2.47  # cm: what a shape travels in a second by the law of speed, at the scenes' Δ
MOST = 30.0  # s after the knot is tied
MOST_LOOSE = 8.0  # s after the program is cut off
GROWTH = (1, 3)  # of Δ, from the knot's head end to its tail end
GRID = 0.5  # s, of the times at which the program is cut off
KNOTS = {"3_1": "living_overhand", "4_1": "living_figure_eight", "5_1": "living_double_overhand",
         "5_2": "living_three_twist"}
SETTINGS = {"controller.tighten_time": 0.0, "expect.speed_share": 0.0, "expect.types": []}
Mask = Callable[[hagfish.Simulation, "Body"], np.ndarray]  # share of the copying that each hinge does


class Body:
    """Hinges of a simulation: of each kind their indices from the head on, and all arc lengths, cm."""

    def __init__(self, sim: hagfish.Simulation) -> None:
        names = sim.dof_names[ROOT:]
        kinds = [name.split("_", 1)[1] for name in names]
        self.kinds = {kind: np.flatnonzero([each == kind for each in kinds]) for kind in dict.fromkeys(kinds)}
        self.length = float(tomllib.loads(sim.scene)["specimen"]["length"])
        self.joint = np.array([int(name.split("_", 1)[0].lstrip("j")) for name in names])
        self.arc = self.joint * self.length / sim.bodies


def copied_from(sim: hagfish.Simulation, control: hagfish.Control) -> np.ndarray | None:
    """The hinges' angles where the step's forces act, rad, while a reflex acts; there are no commands at any time."""
    control.commands = []
    if sim.phase not in ("tighten", "slide"):
        return None
    return sim.q[-(sim.nv - ROOT):] + sim.h * sim.qdot[ROOT:]


def law(mask: Mask, order: np.random.Generator | None = None, side: float = 0.0) -> Callable[..., None]:
    """`order`: neighbours are shuffled, the same all the time. `side`: muscles of that side alone, 1 or -1, as they pull."""
    body: list[Body] = []
    source: dict[str, np.ndarray] = {}

    def act(sim: hagfish.Simulation, control: hagfish.Control) -> None:
        angles = copied_from(sim, control)
        if angles is None:
            return
        if not body:
            body.append(Body(sim))
            for kind, own in body[0].kinds.items():
                source[kind] = np.arange(own.size) if order is None else order.permutation(own.size)
        rest = np.zeros(sim.nv)
        rest[ROOT:] = angles
        share = mask(sim, body[0])
        for kind, own in body[0].kinds.items():
            behind = np.append(angles[own][1:], 0.0)
            step = SHIFT * body[0].length / (2 * body[0].length / sim.bodies) * (behind - angles[own])
            step = step[source[kind]]
            if side and kind != "twist":
                step = side * np.maximum(side * step, 0)
            rest[ROOT + own] += share[own] * step
        control.rest_shape = rest

    return act


def within(first: float, last: float) -> Mask:
    """Joints from one share of the knot's length to another; 0 is its head end."""
    def mask(sim: hagfish.Simulation, body: Body) -> np.ndarray:
        if sim.head_end is None or sim.tail_end is None:
            return np.zeros_like(body.arc)
        place = (body.arc - sim.head_end) / (sim.tail_end - sim.head_end)
        return ((place >= first) & (place <= last)).astype(float)
    return mask


def every(count: int) -> Mask:
    """One joint of so many of each kind; joints that bend and that twist take turns."""
    return lambda sim, body: (body.joint // 2 % count == 0).astype(float)


def held(rate: float, shape: bool) -> Callable[..., None]:
    """Every joint gets a new command `rate` times a second, and holds it in between: what it adds to its own angle, or, with `shape`, the
    angle that its neighbours had so far behind it as a shape travels in that time."""
    body: list[Body] = []
    kept: list[np.ndarray] = []
    tick = [-1]

    def act(sim: hagfish.Simulation, control: hagfish.Control) -> None:
        angles = copied_from(sim, control)
        if angles is None:
            return
        if not body:
            body.append(Body(sim))
        now = int(np.floor(sim.time * rate + 1e-6))
        if now != tick[0]:
            tick[0] = now
            command = np.zeros(sim.nv - ROOT)
            spacing = 2 * body[0].length / sim.bodies
            shift = RATE_SHIFT / rate if shape else SHIFT * body[0].length
            for own in body[0].kinds.values():
                places = np.arange(own.size) + shift / spacing
                copied = np.interp(places, np.arange(own.size + 1), np.append(angles[own], 0.0))
                command[own] = copied if shape else copied - angles[own]
            kept[:] = [command]
        rest = np.zeros(sim.nv)
        rest[ROOT:] = kept[0] if shape else angles + kept[0]
        control.rest_shape = rest

    return act


def rates() -> dict[str, Callable[..., None]]:
    everywhere: Mask = lambda sim, body: np.ones_like(body.arc)
    return {ALL: law(everywhere)} | {f"{rate} a second, {word}": held(rate, shape) for word,
                                     shape in (("torque held", False), ("shape held", True))
                                     for rate in RATES}


def laws() -> dict[str, Callable[..., None]]:
    everywhere: Mask = lambda sim, body: np.ones_like(body.arc)
    beyond: Mask = lambda sim, body: 1 - within(0, 1)(sim, body)
    named = {ALL: law(everywhere)}
    named |= {f"one joint of {count}": law(every(count)) for count in (2, 3, 5, 10)}
    named |= {"joints of the knot": law(within(0, 1)), "joints outside the knot": law(beyond),
              "first third of the knot": law(within(0, 1 / 3)), "middle third of the knot": law(within(1 / 3, 2 / 3)),
              "last third of the knot": law(within(2 / 3, 1)), "muscles of one side": law(everywhere, side=1.0)}
    return named | {f"shuffled neighbours {seed}": law(everywhere, np.random.default_rng(seed))
                    for seed in range(1, SHUFFLES + 1)}


def parabola(sim: hagfish.Simulation, control: hagfish.Control) -> None:
    """The curvature behind a joint by a parabola, where the C++ law has a straight line: it smears no shape."""
    angles = copied_from(sim, control)
    if angles is None:
        return
    body = Body(sim)
    rest = np.zeros(sim.nv)
    rest[ROOT:] = angles
    shift = SHIFT * body.length / (2 * body.length / sim.bodies)
    for own in body.kinds.values():
        here, next_, third = (np.append(angles[own], [0.0, 0.0])[k:k + own.size] for k in range(3))
        rest[ROOT + own] += shift * (-3 * here + 4 * next_ - third) / 2
    control.rest_shape = rest


def curves(folder: Path) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    for scene in KNOTS.values():
        for bodies in (100, 200):
            with hagfish.Simulation(scene, set=SETTINGS | {"model.bodies": bodies, "time.step": 0.002,
                                                           "time.until": "slide"}, law=parabola,
                                    log=str(folder / f"{scene}-{bodies}.h5")) as sim:
                sim.run()


def growing(growth: float) -> Callable[..., None]:
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
    """Spans of the knot and its types in turn, until it is at the head, the program would be over without a knot, or MOST_LOOSE is over."""
    spans, types, begin = [], [], sim.time
    try:
        while sim.time < begin + MOST_LOOSE and sim.phase not in ("release", "free"):
            sim.step()
            if not types or types[-1] != str(sim.knot):
                types.append(str(sim.knot))
            if sim.head_end is not None and sim.tail_end is not None:
                spans.append(sim.tail_end - sim.head_end)
    except hagfish.StepError as error:
        if error.outcome != "never tied":
            raise
    return spans, types


def loose(out: Path) -> None:
    with out.open("w", newline="", encoding="utf-8") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(["task", "knot", "commit", "begin_s", "growth", "slide_s", "types", "span_from_cm",
                        "span_least_cm"])
        for knot, scene in KNOTS.items():
            for task, cut in zip(("tighten", "form"), cut_off(scene, knot)):
                for growth in GROWTH:
                    sim = cut.copy(law=growing(growth))
                    begin = sim.time
                    spans, types = follow(sim)
                    table.writerow([task, knot, hagfish.revision[:12], f"{begin:.4g}", growth,
                                    f"{sim.time - begin:.4g}", " ".join(types),
                                    f"{spans[0]:.4g}", f"{min(spans):.4g}"])
                    file.flush()


def main(which: str, out: Path) -> None:
    made = {"laws": laws, "rate": rates}[which]
    with out.open("w", newline="", encoding="utf-8") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(["knot", "head", "commit", "law", "head_end_from_cm", "head_end_to_cm", "slide_s", "type_held",
                        "reached_head"])
        for knot, scene in KNOTS.items():
            tied = hagfish.Simulation(scene, set=SETTINGS, law=made()[ALL])
            tied.run(until="form")
            for name, own in made().items():
                sim = tied.copy(law=own)
                start, head, begin, held = None, None, tied.time, True
                try:
                    while sim.phase in ("form", "tighten", "slide") and sim.time < begin + MOST:
                        sim.step()
                        if sim.phase == "slide" and sim.head_end is not None:
                            start, head = (sim.head_end if start is None else start), sim.head_end
                except hagfish.StepError as error:
                    held = error.outcome != "knot lost"
                table.writerow([knot, "clamped", hagfish.revision[:12], name, f"{start or np.nan:.4g}",
                                f"{head or np.nan:.4g}", f"{sim.time - begin:.4g}",
                                "yes" if held else "no",
                                "yes" if held and sim.phase not in ("tighten", "slide") else "no"])
                file.flush()


if __name__ == "__main__":
    kind, place = sys.argv[1], Path(sys.argv[2])
    if kind in ("curves", "loose"):
        {"curves": curves, "loose": loose}[kind](place)
    else:
        main(kind, place)
