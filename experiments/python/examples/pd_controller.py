"""Ties a knot by a PD controller: torques pull every hinge to the angle that the scene's curvature program asks for.

    PYTHONPATH=build/release/experiments/python python3 experiments/python/examples/pd_controller.py
"""

import numpy as np

import hagfish

STIFFNESS = 4e5  # dyn cm / rad
DAMPING = 1e3  # dyn cm s


def pd(sim: hagfish.Simulation, control: hagfish.Control) -> None:
    """Pulls by its own torques instead of the muscles that would pull to `control.rest_shape`."""
    angles = control.rest_shape  # of the program, and of the body once it is over
    control.rest_shape = None
    assert angles is not None
    # The angles at the step's end, q + h qdot, are not known yet: what they change is a part of the torque's rate, so that
    # the spring is as implicit as the damper, and stable at any stiffness.
    control.torque[6:] = STIFFNESS * (angles[6:] - sim.q[7:]) + sim.stiffness[6:] * angles[6:]
    control.torque_rate[6:] = DAMPING + sim.h * STIFFNESS


sim = hagfish.Simulation("living_overhand", law=pd).run(until="tighten")
print(f"{sim.time:.2f} s: a {sim.knot}, {sim.head_end:.1f} to {sim.tail_end:.1f} cm from the head")
print(f"largest torque {np.abs(sim.forces['active'][6:]).max():.2g} dyn cm")
