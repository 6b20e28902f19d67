"""What the parts of a step cost, from `hagfish_benchmarks`: times as CSV, ratios to MuJoCo as the page's table.

Usage: benchmarks.py BENCHMARKS.json ANY_PROCESSOR.json LIVE.csv OUT_FOLDER.
ANY_PROCESSOR.json is of the build without AVX, LIVE.csv the table of steps in WebAssembly of the page `live`.
"""

from __future__ import annotations

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


def write_times(times: Times, context: dict[str, Any], path: Path) -> None:
    notes = [f"{key}: {context[key]}" for key in ("cpu", "compiler", "libraries", "revision", "date")]
    tables.write_csv(path, ["simulator", "part", "bodies", "cpu_time_us"],
                     [[simulator, part, bodies, f"{time:.4g}"] for (simulator, part), by_bodies in times.items()
                      for bodies, time in by_bodies.items()], notes)


def ratios(times: Times, quickest: Quickest) -> list[list[str]]:
    """Rows of the table of ratios; the first one has the numbers of bodies."""
    rows: list[list[str]] = []

    def row(text: str, values: list[str]) -> None:
        rows.append([text.strip(), *values])

    bodies = sorted(times[("core", "step_free:10")])
    row("bodies", [str(n) for n in bodies])
    for restart in RESTARTS:
        mujoco, core = times[("mujoco", f"step_knotted:{restart}")], times[("core", f"step_knotted_active-set:{restart}")]
        row(f"knotted step: MuJoCo over core, {restart} steps a start", [f"{mujoco[n] / core[n]:.1f}" for n in bodies])
        row(f"  by, {restart} steps a start", [quickest[restart][n][0] for n in bodies])
        row(f"  which is off by, {restart} steps a start", [f"{quickest[restart][n][1]:.0e}" for n in bodies])
    free = times[("core", "step_free:10")]
    row("step without contact: MuJoCo over core", [f"{times[('mujoco', 'step_free:10')][n] / free[n]:.1f}" for n in bodies])
    knotted = times[("core", "step_knotted_active-set:10")]
    row("knotted step, over 100 bodies", [f"{knotted[n] / knotted[100]:.2f}" for n in bodies])
    midpoint = times[("core", "step_midpoint:10")]
    row("knotted step by the midpoint rule, over Euler's", [f"{midpoint[n] / knotted[n]:.2f}" for n in bodies])
    row("QP: Ipopt over active-set, both warm",
        [f"{times[('core', 'qp_ipopt')][n] / times[('core', 'qp_active-set')][n]:.0f}" for n in bodies])
    as_is = times[("core", "prescribe_all")]
    for text, part in (("Eqs. 1 and 4: nothing prescribed over as it is", "prescribe_nothing"),
                       ("Eqs. 1 and 4: head alone prescribed", "prescribe_head")):
        row(text, [f"{times[('core', part)][n] / as_is[n]:.2f}" for n in bodies])
    row("step without contact, over 100 bodies", [f"{free[n] / free[100]:.2f}" for n in bodies])
    for text, part in (("knotted step, µs", "step_knotted_active-set:10"), ("step without contact, µs", "step_free:10"),
                       ("contact alone, µs", "contact")):
        row(text, [f"{times[('core', part)][n]:.3g}" for n in bodies])
    return rows


def beside(built: str, bodies: int, ours: tuple[float, float], theirs: tuple[float, float], by: str) -> list[str]:
    """A row of the table of builds, from the times of a knotted step and of one without contact, microseconds."""
    return [built, str(bodies), f"{ours[0]:.4g}", f"{theirs[0] / ours[0]:.1f}", by, f"{ours[1]:.4g}", f"{theirs[1] / ours[1]:.1f}"]


def native_rows(built: str, benchmarks: list[dict[str, Any]]) -> list[list[str]]:
    times, quickest = medians(benchmarks)
    knotted = f"step_knotted:{RESTARTS[0]}"
    return [beside(built, n, (times[("core", f"step_knotted_active-set:{RESTARTS[0]}")][n], times[("core", f"step_free:{RESTARTS[0]}")][n]),
                   (times[("mujoco", knotted)][n], times[("mujoco", f"step_free:{RESTARTS[0]}")][n]), quickest[RESTARTS[0]][n][0])
            for n in (100, 400)]


def web_row(live: Path) -> list[str]:
    """Today's MuJoCo by the setting whose knotted step is the quickest there, whatever its error."""
    name, free, knotted = "simulator, integrator, solver, tolerance", "step without contact, µs", "knotted step, µs"
    ours, *theirs = tables.read_csv(live, (name, free, knotted))
    best = min(theirs, key=lambda row: float(row[knotted]))
    pair = lambda row: (float(row[knotted]), float(row[free]))
    return beside("both in WebAssembly", 100, pair(ours), pair(best), best[name])


def main(benchmarks: Path, any_processor: Path, live: Path, out: Path) -> None:
    results = json.loads(benchmarks.read_text(encoding="utf-8"))
    times, quickest = medians(results["benchmarks"])
    write_times(times, results["context"], out / "benchmarks.csv")
    head, *rows = ratios(times, quickest)
    tables.write_table(out, "step_cost", head, rows)
    tables.write_table(out, "step_cost_builds", ["built", "bodies", "knotted step here, µs", "MuJoCo over it", "by", "without contact, µs",
                                                 "MuJoCo over that"],
                       [*native_rows("here for the processor, MuJoCo by Debian", results["benchmarks"]),
                        *native_rows("both without AVX, MuJoCo by Debian", json.loads(any_processor.read_text(encoding="utf-8"))["benchmarks"]),
                        web_row(live)])


if __name__ == "__main__":
    run_script(__doc__, ["BENCHMARKS.json", "ANY_PROCESSOR.json", "LIVE.csv", "OUT_FOLDER"], main)
