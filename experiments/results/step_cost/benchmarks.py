"""What the parts of a step cost, from `hagfish_benchmarks`: times as CSV, ratios to MuJoCo as the page's table.

Usage: benchmarks.py BENCHMARKS.json OUT_FOLDER.
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


def main(benchmarks: Path, out: Path) -> None:
    results = json.loads(benchmarks.read_text(encoding="utf-8"))
    times, quickest = medians(results["benchmarks"])
    write_times(times, results["context"], out / "benchmarks.csv")
    head, *rows = ratios(times, quickest)
    tables.write_table(out, "step_cost", head, rows)


if __name__ == "__main__":
    run_script(__doc__, ["BENCHMARKS.json", "OUT_FOLDER"], main)
