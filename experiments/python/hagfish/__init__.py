"""Hagfish that tie themselves into knots, simulated: runs, control laws of your own, and logs.

    import hagfish
    sim = hagfish.Simulation("table1", set={"time.step": 0.005})
    sim.run(until="form")
    print(sim.knot, sim.time)
"""

from ._core import (
    Command,
    Contact,
    Control,
    FileError,
    InputError,
    Simulation,
    StepError,
    __version__,
    laws,
    revision,
    scenes,
)
from .design import Design, design
from .log import Log
from .sweep import sweep

__all__ = [
    "Command",
    "Contact",
    "Control",
    "Design",
    "FileError",
    "InputError",
    "Log",
    "Simulation",
    "StepError",
    "__version__",
    "design",
    "laws",
    "revision",
    "scenes",
    "sweep",
]
