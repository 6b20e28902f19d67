"""The reflex on few joints and on few numbers: laws in Python that copy at some joints alone, from the wrong neighbour, or now and then.
A row a run, as CSV.

Usage: reflex_laws.py laws|rate|loose OUT.csv, or reflex_laws.py curves DIR; with the Python module as built.

Each knot is tied once; every law begins from there. A joint that does not copy is left to the springs of the body. `curves` leaves
logs of runs in which a joint copies the parabola through its own curvature and its two neighbours', of 100 and 200 bodies.
`loose` cuts off the program that ties the knot: where the knot is first there ("tighten"), seen every half second, or a second
before ("form"). From then on every joint copies, by Δ of the scene or by three times that at the knot's tail end.
"""

import sys
import tomllib
from collections.abc import Callable, Iterator
from pathlib import Path

import hagfish
import numpy as np

import tables

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
KNOTS = {"3_1": "living_overhand", "4_1": "living_figure_eight", "5_1": "living_double_overhand", "5_2": "living_three_twist"}
SETTINGS = {"controller.tighten_time": 0.0, "expect.speed_share": 0.0, "expect.types": []}


class Body:
    """Hinges of a simulation: of each kind their indices from the head on, and all arc lengths, cm."""

    def __init__(self, sim: hagfish.Simulation) -> None:
        names = sim.dof_names[ROOT:]
        kinds = [name.split("_", 1)[1] for name in names]
        self.kinds = {kind: np.flatnonzero([each == kind for each in kinds]) for kind in dict.fromkeys(kinds)}
        self.length = float(tomllib.loads(sim.scene)["specimen"]["length"])
        self.joint = np.array([int(name.split("_", 1)[0].lstrip("j")) for name in names])
        self.arc = self.joint * self.length / sim.bodies
        self.spacing = 2 * self.length / sim.bodies  # of hinges of one kind
        self.share = SHIFT * self.length / self.spacing  # of the way to the hinge behind, that Δ is


Mask = Callable[[hagfish.Simulation, Body], np.ndarray]  # share of the copying that each hinge does
Rest = Callable[[hagfish.Simulation, Body, np.ndarray], np.ndarray]  # of the hinges' angles those that their springs pull to


def law(rest: Rest, phases: tuple[str, ...] = ("tighten", "slide")) -> Callable[..., None]:
    """A reflex that acts in these phases; there are no commands at any time."""
    body: list[Body] = []

    def act(sim: hagfish.Simulation, control: hagfish.Control) -> None:
        control.commands = []
        if sim.phase not in phases:
            return
        if not body:
            body.append(Body(sim))
        angles = sim.q[-(sim.nv - ROOT):] + sim.h * sim.qdot[ROOT:]  # where the step's forces act
        control.rest_shape = np.append(np.zeros(ROOT), rest(sim, body[0], angles))

    return act


def behind(angles: np.ndarray) -> np.ndarray:
    return np.append(angles[1:], 0.0)


def copying(mask: Mask, order: np.random.Generator | None = None, side: float = 0.0) -> Callable[..., None]:
    """`order`: neighbours are shuffled, the same all the time. `side`: muscles of that side alone, 1 or -1, as they pull."""
    source: dict[str, np.ndarray] = {}

    def rest(sim: hagfish.Simulation, body: Body, angles: np.ndarray) -> np.ndarray:
        wanted, share = angles.copy(), mask(sim, body)
        for kind, own in body.kinds.items():
            if kind not in source:
                source[kind] = np.arange(own.size) if order is None else order.permutation(own.size)
            step = (body.share * (behind(angles[own]) - angles[own]))[source[kind]]
            if side and kind != "twist":
                step = side * np.maximum(side * step, 0)
            wanted[own] += share[own] * step
        return wanted

    return law(rest)


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


def everywhere(sim: hagfish.Simulation, body: Body) -> np.ndarray:
    return np.ones_like(body.arc)


def held(rate: float, shape: bool) -> Callable[..., None]:
    """Every joint gets a new command `rate` times a second, and holds it in between: what it adds to its own angle, or, with `shape`, the
    angle that its neighbours had so far behind it as a shape travels in that time."""
    kept: list[np.ndarray] = []
    tick = [-1]

    def rest(sim: hagfish.Simulation, body: Body, angles: np.ndarray) -> np.ndarray:
        now = int(np.floor(sim.time * rate + 1e-6))
        if now != tick[0]:
            tick[0] = now
            command = np.zeros_like(angles)
            shift = RATE_SHIFT / rate if shape else SHIFT * body.length
            for own in body.kinds.values():
                places = np.arange(own.size) + shift / body.spacing
                copied = np.interp(places, np.arange(own.size + 1), np.append(angles[own], 0.0))
                command[own] = copied if shape else copied - angles[own]
            kept[:] = [command]
        return kept[0] if shape else angles + kept[0]

    return law(rest)


def rates() -> dict[str, Callable[..., None]]:
    return {ALL: copying(everywhere)} | {f"{rate} a second, {word} held": held(rate, word == "shape") for word in ("torque", "shape")
                                         for rate in RATES}


def laws() -> dict[str, Callable[..., None]]:
    beyond: Mask = lambda sim, body: 1 - within(0, 1)(sim, body)
    named = {ALL: copying(everywhere)}
    named |= {f"one joint of {count}": copying(every(count)) for count in (2, 3, 5, 10)}
    named |= {"joints of the knot": copying(within(0, 1)), "joints outside the knot": copying(beyond)}
    named |= {f"{word} third of the knot": copying(within(k / 3, (k + 1) / 3)) for k, word in enumerate(("first", "middle", "last"))}
    named |= {"muscles of one side": copying(everywhere, side=1.0)}
    return named | {f"shuffled neighbours {seed}": copying(everywhere, np.random.default_rng(seed)) for seed in range(1, SHUFFLES + 1)}


def parabola(sim: hagfish.Simulation, body: Body, angles: np.ndarray) -> np.ndarray:
    """The curvature behind a joint by a parabola, where the C++ law has a straight line: it smears no shape."""
    wanted = angles.copy()
    for own in body.kinds.values():
        here, next_, third = (np.append(angles[own], [0.0, 0.0])[k:k + own.size] for k in range(3))
        wanted[own] += body.share * (-3 * here + 4 * next_ - third) / 2
    return wanted


def curves(folder: Path) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    for scene in KNOTS.values():
        for bodies in (100, 200):
            with hagfish.Simulation(scene, set=SETTINGS | {"model.bodies": bodies, "time.step": 0.002, "time.until": "slide"}, law=law(parabola),
                                    log=str(folder / f"{scene}-{bodies}.h5")) as sim:
                sim.run()


def growing(growth: float) -> Callable[..., None]:
    def rest(sim: hagfish.Simulation, body: Body, angles: np.ndarray) -> np.ndarray:
        wanted, scale, head, tail = angles.copy(), np.ones_like(body.arc), sim.head_end, sim.tail_end
        if head is not None and tail is not None and tail > head:
            scale = 1 + (growth - 1) * np.clip((body.arc - head) / (tail - head), 0, 1)
        for own in body.kinds.values():
            wanted[own] += scale[own] * body.share * (behind(angles[own]) - angles[own])
        return wanted

    return law(rest, ("form", "tighten", "slide"))


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


def loose() -> Iterator[list[object]]:
    for knot, scene in KNOTS.items():
        for task, cut in zip(("tighten", "form"), cut_off(scene, knot)):
            for growth in GROWTH:
                sim = cut.copy(law=growing(growth))
                spans, types = follow(sim)
                yield [task, knot, hagfish.revision[:12], f"{cut.time:.4g}", growth, f"{sim.time - cut.time:.4g}", " ".join(types),
                       f"{spans[0]:.4g}", f"{min(spans):.4g}"]


def slides(made: Callable[[], dict[str, Callable[..., None]]]) -> Iterator[list[object]]:
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
            yield [knot, "clamped", hagfish.revision[:12], name, f"{start or np.nan:.4g}", f"{head or np.nan:.4g}",
                   f"{sim.time - begin:.4g}", "yes" if held else "no",
                   "yes" if held and sim.phase not in ("tighten", "slide") else "no", sim.slide["name"] if sim.slide else ""]


SLIDES = ["knot", "head", "commit", "law", "head_end_from_cm", "head_end_to_cm", "slide_s", "type_held", "reached_head", "slide"]
TABLES = {"laws": (SLIDES, lambda: slides(laws)), "rate": (SLIDES, lambda: slides(rates)),
          "loose": (["task", "knot", "commit", "begin_s", "growth", "slide_s", "types", "span_from_cm", "span_least_cm"], loose)}


def main(which: str, out: Path) -> None:
    if which == "curves":
        curves(out)
        return
    head, rows = TABLES[which]
    tables.write_csv(out, head, rows())


if __name__ == "__main__":
    main(sys.argv[1], Path(sys.argv[2]))
