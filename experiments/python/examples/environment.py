"""An environment for reinforcement learning, with reset and step as in Gymnasium: slide a knot to the head at little effort.

    PYTHONPATH=build/release/experiments/python python3 experiments/python/examples/environment.py
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray

import hagfish

Array = NDArray[np.float64]


class SlideEnv:
    """Action (4,): speeds of Eq. 6 at the knot's first and last contact, cm/s. Observation (nq + nv,): q and qdot."""

    def __init__(self) -> None:
        self.tied = hagfish.Simulation("table1", set={"time.step": 0.005}).run(until="tighten")

    def reset(self, seed: int | None = None) -> tuple[Array, dict[str, Any]]:
        self.sim, self.action = self.tied.copy(law=self.law), np.zeros(4)
        noise = np.random.default_rng(seed).normal(0, 1e-2, self.sim.nv - 6)  # rad/s
        self.sim.set_state(self.sim.q, self.sim.qdot + np.append(np.zeros(6), noise))
        return self.observation(), {}

    def step(self, action: Array) -> tuple[Array, float, bool, bool, dict[str, Any]]:
        self.action, before = action, self.sim.head_end
        try:
            self.sim.run(until=self.sim.time + 0.1)
        except hagfish.StepError as error:
            return self.observation(), -10.0, True, False, {"outcome": error.outcome}
        slid = (before or 0.0) - (self.sim.head_end or 0.0)  # cm
        effort = float(np.abs(self.sim.forces["thigmotaxis"][6:]).mean())  # dyn cm
        return self.observation(), slid - 1e-4 * effort, self.sim.phase != "slide", self.sim.finished, {}

    def law(self, sim: hagfish.Simulation, control: hagfish.Control) -> None:
        for command, (a, b) in zip(control.commands, self.action.reshape(2, 2)):
            command.a, command.b = float(a), float(b)

    def observation(self) -> Array:
        return np.concatenate([self.sim.q, self.sim.qdot])


if __name__ == "__main__":
    env = SlideEnv()
    for episode, speed in enumerate((1.0, 2.0)):
        observation, total = env.reset(seed=episode)[0], 0.0
        for steps in range(1, 41):
            observation, reward, terminated, truncated, info = env.step(np.full(4, speed))
            total += reward
            if terminated or truncated:
                break
        print(f"{speed} cm/s: return {total:.2f} in {steps} steps; {env.sim}")
