"""A control law of your own: the knot is slid in strokes, with a rest after each, and held by tone in between.

    PYTHONPATH=build/release/experiments/python python3 experiments/python/examples/own_controller.py strokes.h5
"""

import sys

import hagfish

STROKE, REST = 0.5, 0.25  # s


def strokes(sim: hagfish.Simulation, control: hagfish.Control) -> None:
    """Comes with the paper's control, which asks for the slide's speeds at the first and the last contact."""
    if sim.phase == "slide" and sim.time % (STROKE + REST) > STROKE:
        for command in control.commands:
            command.effort = 0.0  # the most force that its two rows may take


with hagfish.Simulation("table1", set={"time.step": 0.005}, law=strokes, log=sys.argv[1], force=True) as sim:
    sim.run(until="tighten")
    start, begin = sim.head_end or 0.0, sim.time
    while sim.phase == "slide":
        sim.run(until=sim.time + STROKE + REST)
        if sim.head_end is not None:
            print(f"{sim.time:6.2f} s: a {sim.knot} {sim.head_end:5.2f} cm from the head")
    print(f"slid {start - (sim.head_end or 0):.2f} cm in {sim.time - begin:.2f} s")
    sim.run()
