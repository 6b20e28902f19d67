"""What the parts of a step cost, from `hagfish_benchmarks`: a CSV beside the figure, ratios to MuJoCo on standard output.

Usage: benchmarks.py BENCHMARKS.json OUT.png (writes a PDF and a CSV beside).
"""

from __future__ import annotations

import argparse
import csv
import json
from pathlib import Path
from typing import Any

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

from hagfish_log import save_figure

DPI = 200
MUJOCO_SOLVERS = ("pgs", "cg", "newton")
PARTS = {"kinematics": "kinematics", "mass_matrix": "mass matrix, dense", "bias": "bias",
         "system": "Eq. 1: M, factor, solve", "contact": "contact", "rows": "rows", "dual": "A and b of the QP",
         "qp_active-set": "QP, active-set"}
STEPS = {("core", "step_knotted_ipopt"): ("knotted, Ipopt", "#882255", "s", "-"),
         ("mujoco", "step_knotted"): ("knotted, MuJoCo's best solver", "#4477aa", "o", "-"),
         ("core", "step_knotted_active-set"): ("knotted, active-set", "#000000", "o", "-"),
         ("mujoco", "step_free"): ("without contact, MuJoCo", "#4477aa", "^", "--"),
         ("core", "step_free"): ("without contact, core", "#000000", "^", "--")}
Times = dict[tuple[str, str], dict[int, float]]


def medians(benchmarks: list[dict[str, Any]]) -> Times:
    """CPU time, microseconds, by (simulator, part) and body count; MuJoCo's knotted step is that of its best solver."""
    times: Times = {}
    for entry in benchmarks:
        if entry.get("aggregate_name") == "median":
            simulator, part, bodies = entry["run_name"].split("/")
            times.setdefault((simulator, part), {})[int(bodies)] = entry["cpu_time"]
    each = [times[("mujoco", f"step_knotted_{solver}")] for solver in MUJOCO_SOLVERS]
    times[("mujoco", "step_knotted")] = {bodies: min(solver[bodies] for solver in each) for bodies in each[0]}
    return times


def write_csv(times: Times, context: dict[str, Any], path: Path) -> None:
    with path.open("w", newline="", encoding="utf-8") as file:
        for key in ("cpu", "compiler", "libraries", "revision", "date"):
            file.write(f"# {key}: {context[key]}\n")
        writer = csv.writer(file)
        writer.writerow(["simulator", "part", "bodies", "cpu_time_us"])
        for (simulator, part), by_bodies in times.items():
            for bodies, time in by_bodies.items():
                writer.writerow([simulator, part, bodies, f"{time:.4g}"])


def print_ratios(times: Times) -> None:
    def row(text: str, values: list[str]) -> None:
        print(f"{text:<44}" + "".join(f"{value:>9}" for value in values))

    bodies = sorted(times[("core", "step_free")])
    row("bodies", [str(n) for n in bodies])
    for text, part, other in (("knotted step: MuJoCo's best over active-set", "step_knotted_active-set", "step_knotted"),
                              ("step without contact: MuJoCo over core", "step_free", "step_free")):
        row(text, [f"{times[('mujoco', other)][n] / times[('core', part)][n]:.1f}" for n in bodies])
    row("QP: Ipopt over active-set, both warm",
        [f"{times[('core', 'qp_ipopt')][n] / times[('core', 'qp_active-set')][n]:.0f}" for n in bodies])
    as_is = times[("core", "prescribe_all")]
    for text, part in (("Eqs. 1 and 4: nothing prescribed over as it is", "prescribe_nothing"), ("Eqs. 1 and 4: head alone prescribed", "prescribe_head")):
        row(text, [f"{times[('core', part)][n] / as_is[n]:.2f}" for n in bodies])
    free = times[("core", "step_free")]
    row("step without contact, over 100 bodies", [f"{free[n] / free[100]:.2f}" for n in bodies])


def draw_steps(axes: Any, times: Times) -> None:
    for key, (label, colour, marker, line) in STEPS.items():
        bodies = np.array(sorted(times[key]))
        axes.loglog(bodies, [times[key][n] for n in bodies], line, color=colour, marker=marker, ms=5, label=label)
    axes.set_xticks(bodies, [str(n) for n in bodies])
    axes.minorticks_off()
    axes.set_xlabel("bodies")
    axes.set_ylabel("CPU time of a whole step, µs")
    axes.set_title("(a) one step", loc="left")
    axes.legend(fontsize=8)


def draw_parts(axes: Any, times: Times, bodies: int) -> None:
    for row, part in enumerate(PARTS):
        for shift, simulator, colour in ((-0.18, "core", "#000000"), (0.18, "mujoco", "#4477aa")):
            if (simulator, part) in times:
                time = times[(simulator, part)][bodies]
                label = {"core": "core", "mujoco": "MuJoCo"}[simulator] if row == 0 else None
                axes.barh(row + shift, time, 0.34, color=colour, label=label)
                axes.text(time * 1.1, row + shift, f"{time:.2g}" if time < 10 else f"{time:.0f}", va="center", fontsize=8)
    axes.set_xscale("log")
    axes.set_xlim(1, 2 * axes.get_xlim()[1])
    axes.set_yticks(range(len(PARTS)), PARTS.values())
    axes.invert_yaxis()
    axes.set_xlabel("CPU time, µs")
    axes.set_title(f"(b) parts of the knotted step, {bodies} bodies", loc="left")
    axes.legend(fontsize=8, loc="lower right")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("benchmarks", type=Path)
    parser.add_argument("out", type=Path)
    arguments = parser.parse_args()
    results = json.loads(arguments.benchmarks.read_text(encoding="utf-8"))
    times = medians(results["benchmarks"])
    write_csv(times, results["context"], arguments.out.with_suffix(".csv"))
    print_ratios(times)
    figure, axes = plt.subplots(1, 2, figsize=(11, 4.4), layout="constrained")
    draw_steps(axes[0], times)
    draw_parts(axes[1], times, 100)
    save_figure(figure, arguments.out, DPI)


if __name__ == "__main__":
    main()
