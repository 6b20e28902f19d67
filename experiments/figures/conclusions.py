"""The page of conclusions on speed against accuracy, all figures from the runs.

Usage: conclusions.py RUNS OUT.md
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from back_ends import BACK_ENDS, read_table
from hagfish_log import HagfishLog, Results
from integration import MOTIONS, steps
from needs import needs
from plots import INTEGRATORS
from script import run_script
from study import FORCE_WINDOW, Run, path_error, read_runs
from tables import of_page, write_page
from whole_runs import CHANCE_STEPS, REFERENCE, chance, front_of, reference_of


def reached(cost: np.ndarray, error: np.ndarray, wanted: float) -> float:
    """Least CPU time at which the error is no larger, between the steps tried; nan where none comes so near."""
    known = np.isfinite(error)
    cost, error = cost[known], error[known]
    if not error.size or error.min() > wanted:
        return np.nan
    order = np.argsort(error)
    between = np.exp(np.interp(np.log(wanted), np.log(error[order]), np.log(cost[order])))
    return float(min(between, cost[error <= wanted].min()))


def crossings(folder: Path) -> list[tuple[str, float]]:
    """What the core's error is at the cost of the cheapest RK4 that does not blow up."""
    found = []
    for motion in MOTIONS:
        results = Results(folder / f"{motion}.h5")
        _, cost, error = steps(results, "core")
        _, dear, fine = steps(results, "mujoco_rk4")
        known, able = np.isfinite(error), np.isfinite(fine)
        found.append((results.root("motion"), float(np.exp(np.interp(np.log(dear[able].min()), np.log(cost[known]),
                                                                     np.log(error[known]))))))
    return found


def integration(folder: Path, out: Path) -> list[str]:
    lines = ["## Smooth motions", "", "CPU time per simulated time for an error of at most so much of a body centre at 0.5 s, "
             "between the steps tried (-: not reached by any), and the largest step that does not blow up. 100 bodies, head clamped, "
             "no contacts.", ""]
    wanted = (0.3, 0.1, 0.03, 0.01, 1e-3, 1e-5)
    rows, agreements = [], []
    for motion in MOTIONS:
        results = Results(folder / f"{motion}.h5")
        agreements.append(float(results["/reference/agreement"][0]))
        for method, look in INTEGRATORS.items():
            h, cost, error = steps(results, method)
            times = [reached(cost, error, w) for w in wanted]
            rows.append([results.root("motion"), look.label, *("-" if np.isnan(t) else f"{t:.2g}" for t in times),
                         f"{h[np.isfinite(error)].max():g}"])
    lines += of_page(out, "speed_accuracy_motions", ["Motion", "Method", *(f"{w:g} cm" for w in wanted), "Largest h, ms"], rows)
    ratio = []
    for motion in MOTIONS:
        results = Results(folder / f"{motion}.h5")
        core, euler = (dict(zip(*steps(results, m)[:2])) for m in ("core", "mujoco_euler"))
        ratio += [euler[h] / core[h] for h in core if h in euler and np.isfinite(euler[h] + core[h])]
    lines += ["", f"- References: RK4 at 0.2 and 0.1 ms differ by {max(agreements):.1e} cm at most.",
              f"- A step of the core costs 1/{np.median(ratio):.2g} of one of MuJoCo's Euler (1/{min(ratio):.2g} to "
              f"1/{max(ratio):.2g}), and errs as much: both are of first order.",
              f"- RK4 is cheaper than the core's Euler for errors below {', '.join(f'{c:.2g} cm ({m})' for m, c in crossings(folder))}. "
              "Contacts that come and go leave a step of first order at best.", ""]
    return lines


def solvers(folder: Path, out: Path) -> list[str]:
    table_rows = read_table(folder)
    rows = [[BACK_ENDS[row["back_end"]].label, row["tolerance"] or "exact", row["start"], f"{1e6 * float(row['median_s']):.0f}",
             f"{1e6 * float(row['p99_s']):.0f}", f"{float(row['error_norm_relative']):.1e}", f"{float(row['kkt']):.1e}",
             row["failures"]] for row in table_rows]
    return ["## QPs", "", f"{table_rows[0]['qps']} QPs of the Table 1 run, of every tenth step; errors are the worst of them, "
            "in the H norm, over the rows' change of the velocity.", "",
            *of_page(out, "speed_accuracy_qps", ["Back end", "Tolerance", "Start", "Median, µs", "99 %, µs", "Error of the velocity", "KKT residual",
                    "Failures"], rows), ""]


def body_counts(runs: list[Run], reference: Run, out: Path) -> list[str]:
    rows = []
    for bodies in sorted({run.bodies for run in runs}):
        own = {run.step: run for run in runs if run.bodies == bodies}
        found = [path_error(run, reference)[0] for step, run in own.items() if step <= 0.005 and run is not reference]
        if 0.002 in own:
            at = own[0.002]
            rows.append([str(bodies), f"{at.cpu:.2f}", f"{min(found):.2f} to {max(found):.2f}", f"{at.force:.0f}",
                         f"{at.penetration:.5f}"])
    return of_page(out, "speed_accuracy_bodies", ["Bodies", "CPU, s", "Head end of the knot off, cm", "Sliding force, dyn", "Penetration, cm"], rows)


def midpoint(done: list[Run], reference: Run, out: Path) -> list[str]:
    """A row for each step of the midpoint rule at 100 bodies."""
    rows = []
    for run in sorted((run for run in done if run.bodies == 100 and run.rule == "midpoint"), key=lambda run: run.step):
        off = path_error(run, reference)
        rows.append([f"{1e3 * run.step:g}", f"{run.cpu:.2f}", "0 (reference)" if run is reference else f"{off[0]:.2f} ({off[1]:.2f})",
                     f"{run.force:.0f}", f"{run.penetration:.5f}"])
    return of_page(out, "speed_accuracy_midpoint", ["h, ms", "CPU, s", "Head end of the knot off, cm", "Sliding force, dyn", "Penetration, cm"], rows)


def whole(folder: Path, out: Path) -> list[str]:
    runs = read_runs(folder, "whole")
    reference = reference_of(runs)
    floor = chance(folder, reference.step)
    done = [run for run in runs if not run.failure]
    lines = ["## Whole runs", "", f"{len(runs)} runs, of which {len(done)} tie, slide and untie. Errors are against "
             f"{reference.bodies} bodies at {1e3 * reference.step:g} ms, at like times since the slide began: rms over the slide, and "
             f"largest at any frame in brackets. The sliding force is the sum of the four λ/h: median of its means over "
             f"{1000 * FORCE_WINDOW:g} ms.", ""]
    usual = [run for run in done if run.activation == "speculative" and run.qp == "active-set" and run.rule == "euler"]
    twins = {(run.step, run.bodies, run.activation): run for run in done if run.qp == "ipopt"}
    rows = []
    for run in sorted((run for run in usual if run.bodies == 100), key=lambda run: run.step):
        twin, off = twins.get((run.step, run.bodies, run.activation)), path_error(run, reference)
        rows.append([f"{1e3 * run.step:g}", f"{run.cpu:.2f}", f"{twin.cpu:.1f}" if twin else "", "0 (reference)" if run is reference
                     else f"{off[0]:.2f} ({off[1]:.2f})", f"{run.force:.0f}", f"{run.penetration:.5f}"])
    lines += of_page(out, "speed_accuracy_steps", ["h, ms", "CPU, s (active-set)", "CPU, s (Ipopt)", "Head end of the knot off, cm", "Sliding force, dyn",
                    "Penetration, cm"], rows)
    lines += ["By the midpoint rule:", "", *midpoint(done, reference, out)]
    lines += ["Speculative rows, active-set; errors at 5 ms and finer, the rest at 2 ms:", "", *body_counts(usual, reference, out)]
    found = [(step, chance(folder, step)) for step in CHANCE_STEPS]
    lines += ["- Chance: starts that differ by rounding alone come apart by up to "
              + "; ".join(f"{c.position:.2f} cm (knot's head end, rms over the slide), {c.pointwise:.2f} cm (at any frame) and "
                          f"{c.force:.1f} % of the sliding force (standard deviation {c.force_spread:.1f} %) at h = {1e3 * step:g} ms, "
                          f"{c.starts} starts" for step, c in found) + ". No smaller difference means more accuracy."]
    both = [(run, twins[key]) for run in done if run.qp == "active-set" and run.rule == "euler" and (key := (run.step, run.bodies, run.activation)) in twins]
    ratios = [twin.cpu / run.cpu for run, twin in both]
    lines += [f"- Ipopt takes {min(ratios):.0f} to {max(ratios):.0f} times the CPU time of active-set for the whole run."]
    pairs = [(run.penetration, other.penetration) for run in done for other in done
             if run.activation == "violated" and other.activation == "speculative"
             and (run.step, run.bodies, run.qp, run.rule) == (other.step, other.bodies, other.qp, other.rule)]
    lines.append(f"- Violated rows only: {np.median([a / b for a, b in pairs]):.1f} times the penetration of speculative rows "
                 f"({min(a / b for a, b in pairs):.1f} to {max(a / b for a, b in pairs):.1f}), and joint limits are passed.")
    for words in sorted({run.failure for run in runs if run.failure}):
        own = [run for run in runs if run.failure == words]
        which = ", ".join(sorted({f"{run.scene} with {run.bodies} bodies" for run in own}))
        least, largest = (f"{1e3 * limit(r.step for r in own):g}" for limit in (min, max))
        lines.append(f"- Failed: {words}, in {len(own)} of the runs ({which}; h "
                     f"{least if least == largest else f'{least} to {largest}'} ms).")
    for what, words in (("position", "position of the knot"), ("penetration", "penetration")):
        front = front_of(runs, reference, what, floor.of(what))
        names = [f"{run.bodies} bodies at {1e3 * run.step:g} ms{'' if run.activation == 'speculative' else ', violated'}"
                 f"{'' if run.qp == 'active-set' else ', Ipopt'}{'' if run.rule == 'euler' else ', midpoint'} ({run.cpu:.2f} s)"
                 for run in front]
        lines.append(f"- Pareto front in CPU time and {words}: {'; '.join(names)}.")
    return [*lines, ""]


def choices(folder: Path, out: Path) -> list[str]:
    as_is, found = needs(folder)
    rows = [["as it is", "", "1", "0", "0", f"{as_is.penetration:.5f}", ""]]
    for n in found:
        failed = bool(n.run.failure)
        rows.append([n.choice, n.instead, f"{n.cpu:.2f}", *(["", "", ""] if failed else
                     [f"{n.slide:+.2f}", f"{n.force:+.0f}", f"{n.run.penetration:.5f}"]), n.verdict])
    return ["## What the scene needs", "", f"Each choice changed by itself; the scene as it is takes {as_is.cpu:.2f} s of CPU time.",
            "", *of_page(out, "speed_accuracy_choices", ["Choice", "Instead", "CPU, ratio", "Slide, cm more", "Force, % more", "Penetration, cm", "Verdict"], rows),
            ""]


def main(folder: Path, out: Path) -> None:
    version = (folder / "version").read_text().strip()
    cpu = HagfishLog(folder / f"{REFERENCE}.h5").attribute("cpu")
    text = ["# Speed against accuracy", "", f"hagfish {version}, {cpu}. Times are CPU times of one process, serial, "
            "measured with a run on every core.", "", *whole(folder, out.parent), *choices(folder, out.parent),
            *solvers(folder, out.parent), *integration(folder, out.parent)]
    write_page(out, text)


if __name__ == "__main__":
    run_script(__doc__, ["RUNS", "OUT.md"], main)
