"""How near a knot is tied to what it should be, for how much CPU time: animals that tie themselves, over steps, rules, bodies and
back ends. Tables and a chart.

Usage: tying.py RUNS OUT_FOLDER (writes speed_accuracy.png and a PDF beside). RUNS is what study.sh leaves.
"""

from pathlib import Path

import numpy as np

import plots
import tables
from accuracy import Motion, apart, beyond, cpu_of, handles_of, mark_presets, moments_of, name_of, pick, places_of, presets
from hagfish_log import HagfishLog, LogError
from script import run_script

FROM = 5.0  # s: before that nothing is knotted
KNOTS = {"overhand": "3_1", "figure_eight": "4_1"}
METHODS = {("euler", "active-set"): plots.INTEGRATORS["core"], ("midpoint", "active-set"): plots.INTEGRATORS["core_midpoint"],
           ("euler", "ipopt"): plots.Look("core, Euler, by Ipopt", plots.GREY, "P")}
SIZES = {25: 2.0, 50: 3.5, 100: 5.0, 200: 7.0, 400: 9.0}  # of markers, by bodies
MEASURES = {"place_cm": "places off, cm", "torque_percent": "torques off, %"}
LABELLED = 400  # bodies of the lines that tell their steps: each point has half the step of the last
USUAL = 10.0  # ms: the step at which CPU times are compared
HEAD = ["knot", "rule", "back_end", "bodies", "step_ms", "cpu_s", *MEASURES, "place_by_step_cm"]

Rows = list[dict[str, object]]


def read_motion(path: Path) -> Motion | None:
    """At the frames from FROM on: places at STATIONS and the muscles' moments there. Nothing of a run that ended early."""
    log = HagfishLog(path)
    if log.attribute("status") != "complete":
        return None
    frames = np.flatnonzero(log["/trajectory/time"] > FROM)
    return dict(zip(MEASURES, [places_of(log, frames), moments_of(log, "active", frames)]))


def read_runs(folder: Path, knot: str) -> Rows:
    """Errors are against the limit: Euler's two smallest steps extrapolated to none, in the first order, then the two finest meshes
    to bodies of no length, in the second. That by the step is against the same bodies, so extrapolated: rows of step 0."""
    runs = {}
    for path in sorted(folder.glob(f"tie_{knot}_*.cpu")):
        _, back_end, rule, bodies, step = path.stem.removeprefix("tie_").removeprefix(knot).split("_")
        runs[rule, back_end, int(bodies), 1e3 * float(step)] = cpu_of(path), read_motion(path.with_suffix(".h5"))
    still = {}
    for bodies in SIZES:
        least, more = sorted(step for rule, back_end, of, step in runs if (rule, back_end, of) == ("euler", "active-set", bodies))[:2]
        fine, coarse = (runs["euler", "active-set", bodies, step][1] for step in (least, more))
        if fine is None or coarse is None or not np.isclose(2 * least, more):
            raise LogError(f"{folder}: {knot}, {bodies} bodies: the two smallest steps cannot be extrapolated")
        still[bodies] = beyond(coarse, fine)
    middle, fine = sorted(still)[-2:]
    limit = beyond(still[middle], still[fine], 1 / 3)
    rows = [dict(zip(HEAD, [KNOTS[knot], "euler", "active-set", bodies, 0.0, "", *apart(moved, limit).values(), 0.0])) for bodies,
            moved in still.items()]
    for (rule, back_end, bodies, step), (cpu, own) in sorted(runs.items()):
        errors = [*apart(own, limit).values(), apart(own, still[bodies])["place_cm"]] if own else [""] * 3
        rows.append(dict(zip(HEAD, [KNOTS[knot], rule, back_end, bodies, step, cpu, *errors])))
    return rows


def one(rows: Rows, **wanted: object) -> dict[str, object]:
    return pick(rows, **wanted)[0]


def shown(value: object) -> str:
    return f"{value:.2g}" if value != "" else "stopped"


def presets_table(rows: Rows, out: Path) -> None:
    body = []
    for knot in KNOTS.values():
        for name, of in presets().items():
            run = one(rows, knot=knot, back_end="active-set", **of)
            body.append([name, knot, name_of(run), *(shown(run[key]) for key in ("cpu_s", *MEASURES, "place_by_step_cm"))])
    tables.write_table(out, "speed_accuracy_presets", ["preset", "knot", "what it is", "CPU, s", *MEASURES.values(),
                                                       "of which by the step, cm"], body)


def runs_table(rows: Rows, out: Path) -> None:
    """A row a knot, rule and number of bodies."""
    steps = sorted({row["step_ms"] for row in rows if row["rule"] == "midpoint"}, reverse=True)
    body = []
    for knot in KNOTS.values():
        for bodies in SIZES:
            mesh = one(rows, knot=knot, bodies=bodies, step_ms=0.0)
            for rule in ("euler", "midpoint"):
                of = {step: one(rows, knot=knot, rule=rule, back_end="active-set", bodies=bodies, step_ms=step) for step in steps}
                cpu = of[USUAL]["cpu_s"]
                ipopt = f"{one(rows, knot=knot, back_end='ipopt', bodies=bodies)['cpu_s'] / cpu:.2g}" if rule == "euler" else ""
                body.append([knot, str(bodies), shown(mesh["place_cm"]), rule, *(shown(of[step]["place_by_step_cm"]) for step in steps),
                             f"{cpu:.2g}", ipopt])
    tables.write_table(out, "speed_accuracy_tying", ["knot", "bodies", "places off by the mesh, cm", "rule",
                                                     *(f"by the step at {step:g} ms, cm" for step in steps),
                                                     f"CPU at {USUAL:g} ms, s", "times that by Ipopt"], body)


def draw(rows: Rows, out: Path) -> None:
    named = dict(zip(KNOTS.values(), ("overhand knot", "figure-eight knot")))
    shows = [(knot, measure) for knot in named for measure in MEASURES]
    titles = [f"{named[knot]}: {measure.split('_')[0]}s" for knot, measure in shows]
    figure, panels = plots.panels(2, 2, (plots.WIDTH, 6.6), titles, sharex=True)
    for axes, (knot, measure) in zip(panels, shows):
        texts = []
        for (rule, back_end), look in METHODS.items():
            for bodies, size in SIZES.items():
                own = pick(rows, knot=knot, rule=rule, back_end=back_end, bodies=bodies)
                own = sorted((row for row in own if row["cpu_s"] and row[measure] != ""), key=lambda row: row["step_ms"])
                axes.plot([row["cpu_s"] for row in own], [row[measure] for row in own], **look.style, markersize=size, lw=0.7)
                if bodies == LABELLED and back_end == "active-set":
                    texts += [(row["cpu_s"], row[measure], f"{row['step_ms']:g} ms", side)
                              for row, side in zip((own[-1], own[0]), ("above" if rule == "midpoint" else "right", "right"))]
        run = lambda of, knot=knot: one(rows, knot=knot, back_end="active-set", **of)
        mark_presets(axes, lambda of, run=run, measure=measure: (run(of)["cpu_s"], run(of)[measure]))
        axes.set(xscale="log", yscale="log", ylabel=MEASURES[measure], xlim=(0.06, 10), ymargin=0.1)
        low, high = axes.get_ylim()
        plots.plain_ticks(axes.yaxis, [tick for tick in (0.001, 0.01, 0.1, 1, 10, 100) if low <= tick <= high])
        plots.plain_ticks(axes.xaxis, [0.1, 0.2, 0.5, 1, 2, 5])
        plots.label(axes, texts)
    for axes in panels[2:]:
        axes.set_xlabel("CPU time of the run, s")
    plots.legend_above(figure, handles_of(METHODS.values(), SIZES), 5, 0.075, columnspacing=1.2)
    plots.save(figure, out)


def main(folder: Path, out: Path) -> None:
    rows = [row for knot in KNOTS for row in read_runs(folder, knot)]
    presets_table(rows, out)
    runs_table(rows, out)
    tables.write_table(out, "speed_accuracy_runs", HEAD, [list(row.values()) for row in rows])
    draw(rows, out / "speed_accuracy.png")


if __name__ == "__main__":
    run_script(__doc__, ["RUNS", "OUT_FOLDER"], main)
