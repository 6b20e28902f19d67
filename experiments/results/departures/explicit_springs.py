"""A run whose springs act as printed: by the angles at the start of each step, so that Eq. 1 has M and no stiffness in it.

Usage: explicit_springs.py SCENE LOG.h5, with the Python module as built.
"""

import sys
import tomllib
from pathlib import Path

import h5py
import hagfish
import numpy as np


def stiffness_of(log: Path) -> np.ndarray:
    """Of each hinge, dyn cm: the scene's over the length of body from joint to joint of the hinge's kind."""
    with h5py.File(log) as file:
        model = tomllib.loads(file.attrs["scene"])["model"]
        names, length = file["/model/dof_name"].asstr()[6:], file["/model/length"][()]
    joint, count = np.array([int(name[1:].split("_")[0]) for name in names]), length.size
    span = length[0] * (np.where(joint + 2 < count, joint + 1, count) - np.where(joint > 2, joint - 1, 0))
    return np.array([model["twist_stiffness" if name.endswith("twist") else "bending_stiffness"] for name in names]) / span


def main(scene: str, log: Path) -> None:
    with hagfish.Simulation(scene, set={"time.duration": 0.02, "expect.types": []}, log=log, force=True) as short:
        short.run()
    stiffness = stiffness_of(log)

    def law(sim: hagfish.Simulation, control: hagfish.Control) -> None:
        control.torque[6:] = -stiffness * sim.q[7:]

    without = {"model.bending_stiffness": 0.0, "model.twist_stiffness": 0.0, "controller.law": "own"}
    with hagfish.Simulation(scene, set=without, law=law, log=log, force=True) as run:
        run.run()


if __name__ == "__main__":
    main(sys.argv[1], Path(sys.argv[2]))
