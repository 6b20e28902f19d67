"""A run whose springs act as printed: by the angles at the start of each step, so that Eq. 1 has M and no stiffness in it.

Usage: explicit_springs.py SCENE LOG.h5, with the Python module as built.
"""

import sys
from pathlib import Path

import hagfish


def main(scene: str, log: Path) -> None:
    stiffness = hagfish.Simulation(scene).stiffness[6:]

    def law(sim: hagfish.Simulation, control: hagfish.Control) -> None:
        control.torque[6:] = -stiffness * sim.q[7:]

    without = {"model.bending_stiffness": 0.0, "model.twist_stiffness": 0.0, "controller.law": "own"}
    with hagfish.Simulation(scene, set=without, law=law, log=log, force=True) as run:
        run.run()


if __name__ == "__main__":
    main(sys.argv[1], Path(sys.argv[2]))
