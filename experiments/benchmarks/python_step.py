"""What a step costs in Python beside one of C++: Simulation.step() in a loop against run(), which loops in C++.

    PYTHONPATH=build/release/experiments/python python3 experiments/benchmarks/python_step.py
"""

import time

import hagfish
import numpy as np

STEPS, BATCHES = 2000, 25
# A short animal at rest, whose steps are short beside what is measured.
SET = {
    "model.bodies": 10,
    "script.kind": "none",
    "time.duration": 1e4,
    "knot.interval": 1e4,
    "expect.knot": "",
    "expect.types": [],
}


def nothing(sim: hagfish.Simulation, control: hagfish.Control) -> None:
    pass


def microseconds(steps) -> float:
    begin = time.perf_counter()
    steps()
    return 1e6 * (time.perf_counter() - begin) / STEPS


def main() -> None:
    plain = hagfish.Simulation("table1", set=SET)
    lawful = hagfish.Simulation("table1", set=SET, law=nothing)

    def in_python(sim: hagfish.Simulation):
        step = sim.step
        return lambda: [step() for _ in range(STEPS)]

    # By turns, so that all see the same machine; a median, so that what else runs on it hardly counts.
    ways = {
        "run()": lambda: plain.run(until=plain.time + STEPS * plain.h),
        "step()": in_python(plain),
        "step() with a law that does nothing": in_python(lawful),
    }
    times = np.median([[microseconds(way) for way in ways.values()] for _ in range(BATCHES)], axis=0)
    for way, median in zip(ways, times, strict=True):
        print(f"{way:36} {median:6.2f} us a step, {median - times[0]:+5.2f}")


if __name__ == "__main__":
    main()
