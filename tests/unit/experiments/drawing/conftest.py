"""A log of a run that never was, with forces and paths that the tests know: `log()` writes it and opens it."""

import sys
from collections.abc import Callable
from itertools import count
from pathlib import Path

import h5py
import numpy as np
import pytest

sys.dont_write_bytecode = True
EXPERIMENTS = Path(__file__).resolve().parents[4] / "experiments"
RESULTS = EXPERIMENTS / "results"
sys.path[:0] = map(str, [EXPERIMENTS / "drawing", RESULTS, *RESULTS.glob("*/")])

from hagfish_log import HagfishLog  # noqa: E402

BODIES, LENGTH = 41, 41.0  # 1 cm each
STEP, STEPS = 0.002, 10  # s, steps from frame to frame
PHASES = {"form": 0, "tighten": 1, "slide": 2, "release": 3, "free": 4, "reverse": 5, "pull": 6}
SOLVES = {"linear": 0, "kkt": 1, "qp": 2}
FRAMES = {"form": 6, "tighten": 10, "slide": 61, "release": 5, "free": 5}  # of each phase
SPEED = 5.0  # cm/s, of the knot's head end while it slides: 6 cm in 60 intervals
KNOT = 18.0  # cm of body in the knot
LAST_BODY = 30  # of any row of Eq. 6 while sliding
SCENE = """
[time]
step = 0.002
frame_interval = 0.02
duration = 3.0
rule = "euler"
[model]
bodies = 41
[constraints]
activation = "speculative"
[specimen]
length = 41.0
mass = 80.0
station = [0.2, 0.8]
circumference = [5.6, 4.3]
bending_limit_deg = [21.0, 51.0]
twist_limit_deg = 48.0
[controller]
cap = 1000.0
release_at = 4.0
[controller.tighten_head]
a = 0.0
b = 0.0
[controller.tighten_tail]
a = 0.5
b = 2.0
[controller.slide_head]
a = 2.0
b = 2.0
[controller.slide_tail]
a = 2.0
b = 2.0
[expect]
knot = "3_1"
penetration = 0.0015
"""


def dof_names() -> list[str]:
    """As the simulator names them: odd joints bend about Y and Z, in turn which of them first, even ones twist."""
    names = [f"root_{name}" for name in ("x", "y", "z", "rot_x", "rot_y", "rot_z")]
    for joint in range(1, BODIES):
        names += [f"j{joint:02d}_{kind}" for kind in (["twist"], ["bend_z", "bend_y"], ["twist"], ["bend_y", "bend_z"])[joint % 4]]
    return names


def hinges_of(kind: str) -> np.ndarray:
    """Indices in qvel."""
    return np.array([i for i, name in enumerate(dof_names()) if name.endswith(kind)])


TEXTS = {"model/dof_name": dof_names(),
         "enumerations/phase": ["form", "tighten", "slide", "pull", "reverse", "release", "free"],
         "enumerations/force": ["tip", "active", "thigmotaxis", "contact", "limit", "head", "wall"],
         "enumerations/loss": ["dissipated", "impact_loss"],
         "enumerations/knot": ["0_1", "3_1", "4_1", "5_1"],
         "enumerations/knot_invariants": ["det=1,v2=0", "det=3,v2=1", "det=5,v2=-1", "det=5,v2=3"]}


class Content:
    """Datasets by path and root attributes, to be changed before the log is written."""

    def __init__(self) -> None:
        phases = [name for name, count in FRAMES.items() for _ in range(count)]
        n, steps, dofs = len(phases), (len(phases) - 1) * STEPS, len(dof_names())
        phase = np.array([PHASES[name] for name in phases])
        self.slide = np.flatnonzero(phase == PHASES["slide"])
        head_end = np.full(n, np.nan)
        head_end[FRAMES["form"]:] = 10.0
        head_end[self.slide] = 10.0 - SPEED * STEP * STEPS * np.arange(self.slide.size)
        head_end[self.slide[-1] + 1:self.slide[-1] + 1 + FRAMES["release"]] = 4.0
        head_end[n - FRAMES["free"]:] = np.nan
        knotted = np.isfinite(head_end)
        ruled = np.isin(phase, [PHASES["tighten"], PHASES["slide"]])
        force = np.zeros((n, dofs))
        force[self.slide, 6:20] = 100.0  # joints 1 to 9, well before LAST_BODY
        rows = lambda value, where: np.where(np.repeat(where[:, None], 4, axis=1), value, np.nan)
        step_ruled = np.repeat(ruled[:-1], STEPS)
        first_nan = lambda values: np.concatenate([np.full_like(values[:1], np.nan), values[1:]])
        self.attributes = {"format": "hagfish-log", "format_version": 1, "status": "complete", "scene": SCENE, "qp": "active-set",
                           "command": "hagfish run table1 --qp active-set"}
        self.attributes |= dict.fromkeys(("created", "creator", "creator_version", "git_revision", "libraries", "compiler", "cpu"), "-")
        self.data: dict[str, np.ndarray] = {
            "model/length": np.full(BODIES, LENGTH / BODIES), "model/mass": np.full(BODIES, 80 / BODIES),
            "model/radius": np.full(BODIES, 0.8), "model/limit_upper": np.full(dofs, 0.3),
            "trajectory/step": STEPS * np.arange(n), "trajectory/time": STEP * STEPS * np.arange(n), "trajectory/phase": phase,
            "knot/head_end": head_end, "knot/tail_end": head_end + KNOT, "knot/determinant": np.where(knotted, 3, 1),
            "knot/v2": np.where(knotted, 1, 0),
            "thigmotaxis/body_b": np.where(ruled[:, None], [LAST_BODY - 10, LAST_BODY], -1),
            "forces/thigmotaxis": force, "mean/forces/thigmotaxis": first_nan(force),
            "mean/thigmotaxis/lambda": first_nan(np.where(ruled[:, None], 50.0, 0.0) * np.ones(4)),
            "mean/thigmotaxis/sum": first_nan(np.where(ruled, 200.0, 0.0)),
            "mean/thigmotaxis/slack": first_nan(rows(0.0, ruled)), "mean/thigmotaxis/speed": first_nan(rows(2.0, ruled)),
            "steps/thigmotaxis_lambda": np.where(step_ruled[:, None], 50.0, 0.0) * np.ones(4),
            "steps/thigmotaxis_slack": rows(0.0, step_ruled), "steps/eq6": np.where(step_ruled, 1, -1),
            "steps/kkt": np.full(steps, 1e-13), "steps/penetration": np.zeros(steps), "steps/qp_time": np.full(steps, 1e-3),
            "steps/solve": np.where(step_ruled, 2, 0)}
        self.data["diagnostics/solve"] = np.zeros(n, dtype=int)
        for name in ("contacts", "rows", "active", "iterations", "qp_time", "wall_time", "penetration", "limit_violation", "head_drift", "kinetic_energy", "elastic_energy", "gravity_energy",
                     *TEXTS["enumerations/loss"], "integrator_error", *(f"work_{name}" for name in TEXTS["enumerations/force"])):
            self.data[f"diagnostics/{name}"] = np.zeros(n)

    def moments(self) -> np.ndarray:
        """Moments at joints whose parts about the axes of the hinges are /mean/forces/thigmotaxis."""
        force = self.data["mean/forces/thigmotaxis"]
        moments = np.zeros((len(force), BODIES, 3))
        for axis, kind in enumerate(("twist", "bend_y", "bend_z")):
            own = hinges_of(kind)
            moments[:, [int(dof_names()[i][1:3]) for i in own], axis] = force[:, own]
        return moments

    def write(self, path: Path) -> Path:
        enums = {"trajectory/phase": PHASES, "steps/solve": SOLVES, "diagnostics/solve": SOLVES}
        with h5py.File(path, "w") as file:
            file.attrs.update(self.attributes)
            for name, values in ({"mean/moments/thigmotaxis": self.moments()} | self.data).items():
                kind = h5py.enum_dtype(enums[name], basetype="u1") if name in enums else values.dtype
                file.create_dataset(name, data=values, dtype=kind)
            for name, words in TEXTS.items():
                file.create_dataset(name, data=words, dtype=h5py.string_dtype())
        return path


@pytest.fixture
def content() -> Content:
    return Content()


@pytest.fixture
def log(content: Content, tmp_path: Path) -> Callable[[], HagfishLog]:
    names = (tmp_path / f"log{i}.h5" for i in count())  # HDF5 writes no file that is open
    return lambda: HagfishLog(content.write(next(names)))
