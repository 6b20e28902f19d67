"""What the parts of a step cost, from `hagfish_benchmarks`: a CSV beside the figure, ratios to MuJoCo on standard output.

Usage: benchmarks.py BENCHMARKS.json OUT.png (writes a PDF and a CSV beside).
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import plots
import tables
from script import run_script

# Steps between restarts from the knotted state; the figure has the first.
RESTARTS = (10, 100)
# MuJoCo's accelerations may be this far from its own converged ones, as a share of what constraints change them by.
CONVERGED = 0.01
PARTS = {"kinematics": "kinematics", "mass_matrix": "mass matrix, dense", "bias": "bias",
         "system": "Eq. 1: M, factor, solve", "contact": "contact", "rows": "rows", "dual": "A and b of the QP",
         "qp_active-set": "QP, active-set"}
SIMULATORS = {"core": ("core", plots.INK), "mujoco": ("MuJoCo", plots.BLUE)}
# Part, label, marker and line; the colour is the simulator's.
STEPS = {("core", "step_knotted_ipopt:10"): ("knotted, core with Ipopt", "s", ":"),
         ("mujoco", "step_knotted:10"): ("knotted, MuJoCo's quickest that converges", "o", "-"),
         ("core", "step_knotted_active-set:10"): ("knotted, core with active-set", "o", "-"),
         ("mujoco", "step_free:10"): ("without contact, MuJoCo", "^", "--"),
         ("core", "step_free:10"): ("without contact, core", "^", "--")}
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
    for text, part in (("Eqs. 1 and 4: nothing prescribed over as it is", "prescribe_nothing"), ("Eqs. 1 and 4: head alone prescribed", "prescribe_head")):
        row(text, [f"{times[('core', part)][n] / as_is[n]:.2f}" for n in bodies])
    row("step without contact, over 100 bodies", [f"{free[n] / free[100]:.2f}" for n in bodies])
    for text, part in (("knotted step, µs", "step_knotted_active-set:10"), ("step without contact, µs", "step_free:10"), ("contact alone, µs", "contact")):
        row(text, [f"{times[('core', part)][n]:.3g}" for n in bodies])
    return rows


def draw_steps(axes: Any, times: Times) -> None:
    for (simulator, part), (label, marker, line) in STEPS.items():
        by_bodies = dict(sorted(times[(simulator, part)].items()))
        axes.loglog(by_bodies.keys(), by_bodies.values(), line, color=SIMULATORS[simulator][1], marker=marker, label=label)
    plots.plain_ticks(axes.xaxis, by_bodies)
    axes.set(xlabel="bodies", ylabel="CPU time of a whole step, µs")
    axes.legend(loc="upper left")


def draw_parts(axes: Any, times: Times, bodies: int) -> None:
    for row, part in enumerate(PARTS):
        for shift, (simulator, (label, colour)) in zip((-0.18, 0.18), SIMULATORS.items()):
            if (simulator, part) in times:
                time = times[(simulator, part)][bodies]
                axes.barh(row + shift, time, 0.34, color=colour, label=label if row == 0 else None)
                axes.text(time * 1.1, row + shift, f"{time:.2g}" if time < 10 else f"{time:.0f}", va="center", fontsize=8)
    axes.set(xscale="log", xlabel="CPU time, µs", xlim=(1, 2 * axes.get_xlim()[1]))
    axes.set_yticks(range(len(PARTS)), PARTS.values())
    axes.grid(axis="y", visible=False)
    axes.invert_yaxis()
    axes.legend(loc="lower right")


def main(benchmarks: Path, out: Path) -> None:
    results = json.loads(benchmarks.read_text(encoding="utf-8"))
    times, quickest = medians(results["benchmarks"])
    write_times(times, results["context"], out.with_suffix(".csv"))
    head, *rows = ratios(times, quickest)
    tables.write_table(out.parent, "step_cost", head, rows)
    for cells in (head, *rows):
        print(f"{cells[0]:<50}" + "".join(f"{value:>20}" for value in cells[1:]))
    bodies = 100
    figure, (step, parts) = plots.panels(1, 2, (11, 4.4), ["one step", f"parts of the knotted step, {bodies} bodies"])
    draw_steps(step, times)
    draw_parts(parts, times, bodies)
    plots.save(figure, out)


if __name__ == "__main__":
    run_script(__doc__, ["BENCHMARKS.json", "OUT.png"], main)
