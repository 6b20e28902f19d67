"""Learns the four speeds of Eq. 6, at the first and the last contact, by random search: far at little effort.

    PYTHONPATH=build/release/experiments/python python3 experiments/python/examples/learn_speeds.py --tries 60
"""

import argparse

import numpy as np
from numpy.typing import NDArray

import hagfish

SECONDS = 1.5  # of each try
EFFORT = 5e-3  # cm that 1 dyn cm s of effort costs: |f_thigmo| averaged along the body, over time
LARGEST = 5.0  # cm/s
SHARE = 0.01  # of what was worked and of the momentum that passed, that the time steps may have made themselves


class Gait:
    """A law that slides at four speeds, cm/s, and notes its effort."""

    def __init__(self, speeds: NDArray[np.float64]) -> None:
        self.speeds = speeds
        self.effort = 0.0  # dyn cm s

    def __call__(self, sim: hagfish.Simulation, control: hagfish.Control) -> None:
        for command, (a, b) in zip(control.commands, self.speeds.reshape(2, 2), strict=True):
            command.a, command.b = float(a), float(b)
        self.effort += sim.h * np.abs(sim.forces["thigmotaxis"][6:]).mean()


def made_by_steps(before: hagfish.Simulation, after: hagfish.Simulation) -> float:
    """Energy and momentum that the time steps made, as shares: a search finds whatever is rewarded, errors too."""

    def grew(name: str) -> NDArray[np.float64]:
        return after.momentum[name] - before.momentum[name]

    worked = sum(after.energy[k] - before.energy[k] for k in after.energy if k.startswith("work_"))
    energy = (after.energy["integrator_error"] - before.energy["integrator_error"]) / abs(worked)
    if after.clamped:
        return float(energy)  # what holds the head takes the momentum
    momentum = np.linalg.norm(grew("integrator") + grew("given_back"), axis=1)
    return float(max(energy, *(momentum / np.linalg.norm(grew("drag"), axis=1))))


def score(tied: hagfish.Simulation, speeds: NDArray[np.float64]) -> tuple[float, float]:
    """What a gait comes to from where the knot is tied, and how far it slides; both in cm."""
    gait = Gait(speeds)
    sim = tied.copy(law=gait)
    try:
        sim.run(until=tied.time + SECONDS)
    except hagfish.StepError:  # the knot was lost
        return -np.inf, 0.0
    if sim.phase != "slide":  # it was slid all the way, or came off
        return -np.inf, 0.0
    if made_by_steps(tied, sim) > SHARE:
        return -np.inf, 0.0
    slid = (tied.head_end or 0.0) - (sim.head_end or 0.0)
    return slid - EFFORT * gait.effort, slid


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--tries", type=int, default=60)
    tries = parser.parse_args().tries
    random = np.random.default_rng(1)
    tied = hagfish.Simulation("table1", set={"time.step": 0.005}).run(until="tighten")
    best = np.full(4, 2.0)  # as the paper's
    most, slid = score(tied, best)
    print(f"{'start':>5}: {most:5.2f} cm, slid {slid:.2f} cm at {best.round(2)} cm/s")
    for k in range(1, tries + 1):
        speeds = np.clip(best + random.normal(0, 0.5, 4), 0, LARGEST)
        reached, slid = score(tied, speeds)
        if reached > most:
            most, best = reached, speeds
            print(f"{k:5}: {most:5.2f} cm, slid {slid:.2f} cm at {best.round(2)} cm/s")


if __name__ == "__main__":
    main()
