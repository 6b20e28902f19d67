"""What the parts of a step cost, from `hagfish_benchmarks`: ratios to MuJoCo as the page's tables.

Usage: benchmarks.py BENCHMARKS.json ANY_PROCESSOR.json LIVE.csv OUT_FOLDER.
ANY_PROCESSOR.json is of the build without AVX, LIVE.csv the table of steps in WebAssembly of the page `live`.
"""

import json
from pathlib import Path
from typing import Any

import tables
from script import run_script

# Steps between restarts from the knotted state.
RESTARTS = (10, 100)
# MuJoCo's accelerations may be this far from its own converged ones, as a share of what constraints change them by.
CONVERGED = 0.01
Times = dict[tuple[str, str], dict[int, float]]
# By restart and bodies: the setting of MuJoCo's solver with the quickest step of those that converge, and its residual.
Quickest = dict[int, dict[int, tuple[str, float]]]


def medians(benchmarks: list[dict[str, Any]]) -> tuple[Times, Quickest]:
    """CPU time, microseconds, by (simulator, part) and body count. MuJoCo's knotted step is its quickest that converges."""
    times: Times = {}
    quickest: Quickest = {restart: {} for restart in RESTARTS}
    for entry in benchmarks:
        if entry.get("aggregate_name") != "median":
            continue
        simulator, part, number = entry["run_name"].split("/")
        bodies, time = int(number), entry["cpu_time"]
        name, _, restart = part.rpartition(":")
        times.setdefault((simulator, part), {})[bodies] = time
        if simulator == "mujoco" and name.startswith("step_knotted:") and entry["residual"] <= CONVERGED:
            best = times.setdefault((simulator, f"step_knotted:{restart}"), {})
            if time < best.get(bodies, float("inf")):
                best[bodies] = time
                quickest[int(restart)][bodies] = (name.removeprefix("step_knotted:"), entry["residual"])
    return times, quickest


STEP, FREE = "step_knotted_active-set:10", "step_free:10"
# Row of the table, and of which parts of the core it is the ratio, or of what number of bodies, with its form.
RATIOS = {"knotted step, over 100 bodies": (STEP, 100, ".2f"), "knotted step by the midpoint rule, over Euler's": ("step_midpoint:10", STEP, ".2f"),
          "QP: Ipopt over active-set, both warm": ("qp_ipopt", "qp_active-set", ".0f"),
          "Eqs. 1 and 4: nothing prescribed over as it is": ("prescribe_nothing", "prescribe_all", ".2f"),
          "Eqs. 1 and 4: head alone prescribed": ("prescribe_head", "prescribe_all", ".2f"),
          "step without contact, over 100 bodies": (FREE, 100, ".2f")}
TIMES = {"knotted step, µs": STEP, "step without contact, µs": FREE, "contact alone, µs": "contact"}


def ratios(times: Times, quickest: Quickest) -> list[list[str]]:
    """Rows of the table of ratios; the first one has the numbers of bodies."""
    core, mujoco = ({part: of for (simulator, part), of in times.items() if simulator == name} for name in ("core", "mujoco"))
    bodies = sorted(core[FREE])
    over = lambda top, under, form=".1f": [f"{top[n] / under[n]:{form}}" for n in bodies]
    rows = {"bodies": [str(n) for n in bodies]}
    for restart in RESTARTS:
        steps = f"{restart} steps a start"
        rows[f"knotted step: MuJoCo over core, {steps}"] = over(mujoco[f"step_knotted:{restart}"], core[f"step_knotted_active-set:{restart}"])
        rows[f"by, {steps}"] = [quickest[restart][n][0] for n in bodies]
        rows[f"which is off by, {steps}"] = [f"{quickest[restart][n][1]:.0e}" for n in bodies]
    rows["step without contact: MuJoCo over core"] = over(mujoco[FREE], core[FREE])
    for text, (top, under, form) in RATIOS.items():
        rows[text] = over(core[top], core[under] if under in core else dict.fromkeys(bodies, core[top][under]), form)
    rows |= {text: [f"{core[part][n]:.3g}" for n in bodies] for text, part in TIMES.items()}
    return [[text, *cells] for text, cells in rows.items()]


def beside(built: str, bodies: int, ours: tuple[float, float], theirs: tuple[float, float], by: str) -> list[str]:
    """A row of the table of builds, from the times of a knotted step and of one without contact, microseconds."""
    return [built, str(bodies), f"{ours[0]:.4g}", f"{theirs[0] / ours[0]:.1f}", by, f"{ours[1]:.4g}", f"{theirs[1] / ours[1]:.1f}"]


def native_rows(built: str, benchmarks: list[dict[str, Any]]) -> list[list[str]]:
    times, quickest = medians(benchmarks)
    knotted = f"step_knotted:{RESTARTS[0]}"
    return [beside(built, n, (times[("core", STEP)][n], times[("core", FREE)][n]), (times[("mujoco", knotted)][n], times[("mujoco", FREE)][n]),
                   quickest[RESTARTS[0]][n][0])
            for n in (100, 400)]


def web_row(live: Path) -> list[str]:
    """Today's MuJoCo by the setting whose knotted step is the quickest there, whatever its error."""
    name, free, knotted = "simulator, integrator, solver, tolerance", "step without contact, µs", "knotted step, µs"
    ours, *theirs = tables.read_csv(live, (name, free, knotted))
    best = min(theirs, key=lambda row: float(row[knotted]))
    pair = lambda row: (float(row[knotted]), float(row[free]))
    return beside("both in WebAssembly", 100, pair(ours), pair(best), best[name])


def main(benchmarks: Path, any_processor: Path, live: Path, out: Path) -> None:
    measured, slower = (json.loads(path.read_text(encoding="utf-8"))["benchmarks"] for path in (benchmarks, any_processor))
    head, *rows = ratios(*medians(measured))
    tables.write_table(out, "step_cost", head, rows)
    tables.write_table(out, "step_cost_builds",
                       ["built", "bodies", "knotted step here, µs", "MuJoCo over it", "by", "without contact, µs", "MuJoCo over that"],
                       [*native_rows("here for the processor, MuJoCo by Debian", measured),
                        *native_rows("both without AVX, MuJoCo by Debian", slower), web_row(live)])


if __name__ == "__main__":
    run_script(__doc__, ["BENCHMARKS.json", "ANY_PROCESSOR.json", "LIVE.csv", "OUT_FOLDER"], main)
