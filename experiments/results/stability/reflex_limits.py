"""How far the reflex goes in each simulator and by each rule: from one tied knot the step, the shift, the delay of the senses and the
stiffness grow until the knot does not slide to the head by both ends any more.

Usage: reflex_limits.py HAGFISH OUT_FOLDER. Its folder reflex keeps the tied knot and one run at a time.
"""

import subprocess
from collections.abc import Callable
from pathlib import Path

import audits
import tables
import tied_knot
from hagfish_log import HagfishLog, LogError
from script import run_script

USUAL = 0.005  # s, the step where others grow
INTERVAL = 0.02  # s, between frames, or a longer step: a slide of a few frames is not judged
METHODS = {"Euler": ("run", "--set", "time.rule=euler"), "midpoint": ("run", "--set", "time.rule=midpoint"),
           "MuJoCo Euler": ("mujoco-run", "--integrator", "euler"), "MuJoCo implicit": ("mujoco-run", "--integrator", "implicit"),
           "MuJoCo RK4": ("mujoco-run", "--integrator", "rk4")}
EXPLICIT = "MuJoCo RK4"  # whose steps are too short for a whole slide: those that it survives for BRIEFLY are told
BRIEFLY = 0.02  # s
all_four = lambda name, value: f"specimen.passive.{name}={[float(value)] * 4}"
GROWS: dict[str, tuple[list[float], Callable[[float], list[str]]]] = {
    "step, ms": ([1, 2, 5, 10, 20, 50, 100], lambda h: [f"time.step={h / 1000:g}"]),
    "Δ, cm": ([0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2], lambda shift: [f"controller.reflex.shift={shift:g}"]),
    "senses late by, s": ([0.1, 0.2, 0.5, 1, 2, 5], lambda delay: [f"controller.reflex.delay={delay:g}"]),
    "muscles B_a, dyn cm²": ([5e5, 1e6, 2e6, 5e6, 1e7, 2e7, 5e7, 1e8], lambda b: [f"active.stiffness={b:g}"]),
    "body EI, dyn cm²": ([2e5, 5e5, 1e6, 2e6, 5e6, 1e7, 1e8], lambda b: [all_four("bending_stiffness", b),
                                                                         all_four("twist_stiffness", 0.65 * b)])}
SHORT = [0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1]  # ms, of EXPLICIT


def run(hagfish: Path, command: tuple[str, ...], scene: str, log: Path, settings: list[str]) -> HagfishLog | None:
    """Nothing where the run failed."""
    kind, *options = command
    step = next((setting.split("=")[1] for setting in settings if setting.startswith("time.step=")), f"{USUAL:g}")
    own = ["--step", step] if kind == "mujoco-run" else ["--set", f"time.step={step}"]
    own += ["--set", f"time.frame_interval={max(INTERVAL, float(step))}"]
    sets = [word for setting in settings if not setting.startswith("time.step=") for word in ("--set", setting)]
    done = subprocess.run([str(hagfish), kind, scene, *options, *own, *sets, "--out", str(log), "--force", "--quiet"], capture_output=True,
                          text=True, check=False)
    if done.returncode == 2:
        raise LogError(done.stderr.strip())
    return HagfishLog(log) if done.returncode == 0 else None


def slides(log: HagfishLog | None) -> bool:
    """The slide, at whose end the run ends, was one of both ends, and over before the scene's time was: the knot was neither lost nor stuck."""
    came = log is not None and log["/trajectory/time"][-1] < log.scene()["time"]["duration"] - 0.5
    return came and audits.meets(audits.audit(log.path), "slide of both ends")


def last(values: list[float], holds: Callable[[float], bool]) -> str:
    """The largest value up to which each one holds."""
    found = "none"
    for value in values:
        if not holds(value):
            return found
        found = tables.short(value, ".0e" if value >= 1e5 else "g")
    return f"all ({found})"


def main(hagfish: Path, out: Path) -> None:
    folder = out / "reflex"
    folder.mkdir(exist_ok=True)
    scene = folder / "tied.toml"
    tied_knot.main(hagfish, scene)
    rows = []
    for what, (values, settings) in GROWS.items():
        cells = [what]
        for name, command in METHODS.items():
            attempt = lambda value, more=(): run(hagfish, command, str(scene), folder / "run.h5", [*settings(value), *more])
            if name != EXPLICIT:
                cells.append(last(values, lambda value: slides(attempt(value))))
            elif what.startswith("step"):
                cells.append(last(SHORT, lambda value: attempt(value, (f"time.duration={BRIEFLY}",)) is not None))
            else:
                cells.append("")
        rows.append(cells)
    tables.write_table(out, "stability_reflex", ["grows", *METHODS], rows)


if __name__ == "__main__":
    run_script(__doc__, ["HAGFISH", "OUT_FOLDER"], main)
