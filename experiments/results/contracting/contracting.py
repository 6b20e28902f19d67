"""Accuracy against CPU time where a motion forgets its start: tables and chart of study.sh.

Usage: contracting.py RUNS FOLDER. RUNS is what the study leaves. The chart comes into FOLDER, and the tables into its folder tables.
"""

import json
from pathlib import Path
from typing import Any

import numpy as np

import plots
import tables
from accuracy import Motion, apart, beyond, cpu_of, distance, handles_of, mark_presets, moments_of, name_of, pareto, pick, places_of, presets
from hagfish_log import HagfishLog, LogError
from script import run_script

LAWS = {"reflex": "reflex", "paper": "Eq. 6"}
# s: of the slide, which begins when the program has ended. By Eq. 6 two places of the strand touch in turn later on, and the knot's head
# end goes to and fro between them.
WINDOWS = {"reflex": (11.8, 16.8), "paper": (13.8, 15.8)}
DRY = 3.5  # s from the tied knot without water: the slide is not over in any
FRAME, LONG = 0.1, 5  # s between frames; frames of a long mean
MEASURES = {"knot_cm": "knot's path", "place_cm": "places", "torque_percent": "torques", "force_percent": "f_thigmo"}
NEEDS = {"knot_cm": (0.5, 0.25, 0.1), "place_cm": (0.25, 0.1), "torque_percent": (20, 10, 5), "force_percent": (40, 20, 5, 2)}
METHODS = {("here", "euler"): plots.INTEGRATORS["core"], ("here", "midpoint"): plots.INTEGRATORS["core_midpoint"],
           ("mujoco", "euler"): plots.INTEGRATORS["mujoco_euler"], ("mujoco", "implicit"): plots.INTEGRATORS["mujoco_implicit"]}
CONTACT = {"here": "", "mujoco": "5"}  # ms, of MuJoCo's contacts, where runs are compared with each other
SIZES = {50: 3.0, 100: 5.0, 200: 7.0, 400: 9.0}  # of markers, by bodies
USUAL = 100  # bodies
STEPS = (20.0, 10.0, 5.0, 2.0, 1.0, 0.5)  # ms, of a table
NOISE = 0.1  # share of an error by which runs must differ to be told apart
# A row a run. Errors are against the reference; by_step_ against the same bodies in the same simulator, extrapolated to no step; off_here_cm
# of MuJoCo's knot's path against the same bodies here, so extrapolated. Rows of step 0 are what is extrapolated.
HEAD = ["law", "simulator", "contact_ms", "rule", "bodies", "step_ms", "cpu_s", "outcome", *MEASURES,
        *(f"by_step_{name}" for name in MEASURES), "off_here_cm"]

Rows = list[dict[str, Any]]


def unit(measure: str) -> str:
    return "cm" if measure.endswith("_cm") else "%"


def long_means(force: np.ndarray, frames: int) -> np.ndarray:
    whole = len(force) // frames
    return force[:whole * frames].reshape(whole, frames, -1).mean(axis=1)


def motion(log: HagfishLog, law: str) -> Motion:
    """At the frames of a window: the knot's head end along the body, places at STATIONS (frames x 99 x 3), moments there (dyn cm)."""
    time = log["/trajectory/time"]
    first, last = WINDOWS[law]
    frames = np.flatnonzero((time > first + 0.5 * FRAME) & (time < last + 0.5 * FRAME))
    of = lambda name: moments_of(log, name, frames)
    return dict(zip(MEASURES, [log["/knot/head_end"][frames][:, None, None], places_of(log, frames), of("active"),
                               long_means(of("thigmotaxis"), LONG)]))


def read_runs(folder: Path) -> list[tuple[dict[str, Any], Motion | None]]:
    found = []
    for path in sorted(path for law in LAWS for path in folder.glob(f"{law}_*.cpu")):
        law, method, rule, bodies, step = path.stem.split("_")
        simulator, _, contact = method.partition("-")
        row = {"law": law, "simulator": simulator, "contact_ms": f"{1e3 * float(contact):g}" if contact else "", "rule": rule,
               "bodies": int(bodies),
               "step_ms": 1e3 * float(step), "cpu_s": cpu_of(path), "outcome": "ok"}
        own = None
        try:
            log = HagfishLog(path.with_suffix(".h5"))
            if log.attribute("status") == "complete":
                own = motion(log, law)
        except LogError:  # without frames
            pass
        if own is None:
            row["outcome"] = path.with_suffix(".err").read_text(encoding="utf-8").split("failed: ")[-1].split(" at step ")[0].split(";")[0].strip()
        found.append((row, own))
    return found


def extrapolated(runs: list[tuple[dict[str, Any], Motion | None]]) -> dict[tuple[str, str, int], Motion]:
    """Of each law, simulator and number of bodies: Euler's two smallest steps, of which one is half the other, extrapolated to no step.
    Euler's errors fall evenly, in the first order, to the smallest steps; the midpoint rule's do not."""
    found = {}
    for law, simulator, bodies in {(row["law"], row["simulator"], row["bodies"]) for row, _ in runs}:
        wanted = {"law": law, "simulator": simulator, "bodies": bodies, "rule": "euler", "contact_ms": CONTACT[simulator]}
        own = {row["step_ms"]: moved for row, moved in runs if moved is not None and pick([row], **wanted)}
        least = min(own, default=0)
        if least and least <= 1 and 2 * least in own:
            found[law, simulator, bodies] = beyond(own[2 * least], own[least])
    return found


def reference_of(still: dict[tuple[str, str, int], Motion], law: str) -> Motion:
    """The two finest meshes', extrapolated to no length of a body, in the order by which places of the three finest differ."""
    coarse, middle, fine = (still[key] for key in sorted(key for key in still if key[:2] == (law, "here"))[-3:])
    order = np.log2(distance(coarse["place_cm"], middle["place_cm"]) / distance(middle["place_cm"], fine["place_cm"]))
    return beyond(middle, fine, 1 / (2 ** np.clip(order, 1, 2) - 1))


def read_study(folder: Path) -> Rows:
    runs = read_runs(folder)
    still = extrapolated(runs)
    runs += [({"law": law, "simulator": simulator, "contact_ms": CONTACT[simulator], "rule": "euler", "bodies": bodies, "step_ms": 0.0,
               "outcome": "extrapolated"}, moved)
             for (law, simulator, bodies), moved in still.items()]
    for row, own in runs:
        if own is None:
            continue
        key = row["law"], row["simulator"], row["bodies"]
        row |= apart(own, reference_of(still, row["law"]))
        if key in still and row["step_ms"]:
            row |= apart(own, still[key], "by_step_")
        if row["simulator"] == "mujoco":
            row["off_here_cm"] = apart(own, still[row["law"], "here", row["bodies"]])["knot_cm"]
    order = lambda row: (row["law"] != "reflex", *(row[key] for key in ("simulator", "contact_ms", "rule", "bodies")), -row["step_ms"])
    return sorted((row for row, _ in runs), key=order)


def done(rows: Rows, simulator: str = "here", **wanted: object) -> Rows:
    """Runs with the contacts by which they are compared, quickest first."""
    return sorted(pick(rows, outcome="ok", simulator=simulator, contact_ms=CONTACT[simulator], **wanted), key=lambda row: row["cpu_s"])


def front(rows: Rows, measure: str) -> Rows:
    """The runs than which none is both quicker and nearer, quickest first; none that is nearer than the last by less than NOISE."""
    kept: Rows = []
    for k in pareto(np.array([row["cpu_s"] for row in rows]), np.array([row[measure] for row in rows])):
        if not kept or rows[k][measure] < (1 - NOISE) * kept[-1][measure]:
            kept.append(rows[k])
    return kept


def choice_table(rows: Rows, out: Path) -> None:
    """For each need and law the quickest run, and the quickest preset. A run counts where its mesh without steps is as near, too."""
    body = []
    for measure, limit in ((measure, limit) for measure, limits in NEEDS.items() for limit in limits):
        cells = [f"{MEASURES[measure]} to {limit:g} {unit(measure)}"]
        for law in LAWS:
            known = any(measure in row for row in pick(rows, law=law))
            meshes = {row["bodies"] for row in pick(rows, law=law, simulator="here", outcome="extrapolated") if known and row[measure] <= limit}
            near = [row for row in done(rows, law=law) if row["bodies"] in meshes and row[measure] <= limit]
            named = [f"{name}, {row['cpu_s']:.2g} s" for row in near for name, of in presets().items() if pick([row], **of)]
            run = [f"{name_of(near[0])}: {near[0][measure]:.2g} {unit(measure)}",
                   f"{near[0]['cpu_s']:.2g}"] if near else ["none" if known else "", ""]
            cells += [*run, named[0] if named else "none" if known else ""]
        body.append(cells)
    tables.write_table(out, "contracting_choice", ["you need", *(f"{name}{what}" for name in LAWS.values()
                                                                 for what in (": quickest run", ": CPU, s", ": quickest preset"))], body)


def steps_table(rows: Rows, out: Path) -> None:
    body = []
    for law, measure in (("reflex", "torque_percent"), ("paper", "force_percent")):
        for (simulator, rule), look in METHODS.items():
            own = {row["step_ms"]: row for row in done(rows, simulator, law=law, rule=rule, bodies=USUAL)}
            if not own:
                continue
            halves = [step for step in own if 2 * step in own and step > 2 * min(own)]  # the smallest make the limit, or are near it
            orders = [np.log2(own[2 * step][f"by_step_{measure}"] / own[step][f"by_step_{measure}"]) for step in halves]
            cells = [tables.shown(own[step][f"by_step_{measure}"], ".2g") if step in own else "" for step in STEPS]
            body.append([LAWS[law], MEASURES[measure], look.label, *cells, tables.span(orders, ".1f"),
                         f"{own[5.0]['cpu_s']:.2g}" if 5.0 in own else ""])
    tables.write_table(out, "contracting_steps", ["slide by", "of", "method", *(f"off at {step:g} ms, %" for step in STEPS), "order",
                                                  "CPU at 5 ms, s"], body)


def meshes_table(rows: Rows, out: Path) -> None:
    still = pick(rows, simulator="here", outcome="extrapolated")
    body = []
    for row in still:
        finer = pick(still, law=row["law"], bodies=2 * row["bodies"])
        body.append([LAWS[row["law"]], str(row["bodies"]), *(tables.shown(row.get(measure), ".2g") for measure in MEASURES),
                     f"{np.log2(row['place_cm'] / finer[0]['place_cm']):.1f}" if finer else ""])
    tables.write_table(out, "contracting_meshes", ["slide by", "bodies",
                                                   *(f"{name} off, {unit(measure)}" for measure, name in MEASURES.items()),
                                                   "order of places to the next"], body)


def mujoco_table(rows: Rows, out: Path) -> None:
    """MuJoCo's runs, and the quickest one here that is as near to the reference."""
    body = []
    for row in pick(rows, simulator="mujoco", outcome="ok"):
        near = [own["cpu_s"] for own in done(rows, law="reflex") if own["knot_cm"] <= row["knot_cm"]]
        body.append([f"{name_of(row)}, contacts {row['contact_ms']} ms", f"{row['cpu_s']:.2g}",
                     *(tables.shown(row[key], ".2g") for key in ("knot_cm", "off_here_cm")),
                     f"{row['cpu_s'] / near[0]:.0f}" if near else ""])
    tables.write_table(out, "contracting_mujoco", ["run", "CPU, s", "knot's path off the reference, cm", "off the path here, cm",
                                                   "CPU, of a run here as near"], body)


def read_dry(folder: Path) -> dict[str, dict[float, tuple[float, np.ndarray]]]:
    """CPU time and centres of bodies at each frame, of the runs without water, by simulator and step."""
    found: dict[str, dict[float, tuple[float, np.ndarray]]] = {}
    for path in sorted(folder.glob("dry_*.cpu")):
        _, method, rule, _, step = path.stem.split("_")
        log = HagfishLog(path.with_suffix(".h5"))
        time = log["/trajectory/time"]
        places = log["/trajectory/position"][(time > 0.5 * FRAME) & (time < DRY + 0.5 * FRAME)]
        found.setdefault(METHODS[method.split("-")[0], rule].label, {})[1e3 * float(step)] = cpu_of(path), places
    for path in sorted(folder.glob("dry_*.json")):  # none where the study had no npm
        run = json.loads(path.read_text(encoding="utf-8"))
        found.setdefault(f"MuJoCo {run['version']} (WebAssembly), {run['rule']}",
                         {})[1e3 * run["step"]] = run["cpu"], np.array(run["places"])[:round(DRY / FRAME)]
    return found


def dry_table(runs: dict[str, dict[float, tuple[float, np.ndarray]]], out: Path) -> None:
    still = {name: 2 * of[min(of)][1] - of[2 * min(of)][1] for name, of in runs.items()}
    here = still[METHODS["here", "euler"].label]
    steps = sorted({step for of in runs.values() for step in of}, reverse=True)
    body = [[name, f"{of[min(of)][0]:.2g}", *(f"{distance(of[step][1], still[name]):.2g}" for step in steps),
             f"{distance(of[min(of)][1], here):.2g}"] for name, of in runs.items()]
    tables.write_table(out, "contracting_today", ["simulator", f"CPU at {steps[-1]:g} ms, s",
                                                  *(f"places off its own at {step:g} ms, cm" for step in steps),
                                                  f"off the places here at {steps[-1]:g} ms, cm"], body)


def draw(rows: Rows, out: Path) -> None:
    shows = [("reflex", "knot_cm"), ("paper", "knot_cm"), *[("reflex", "torque_percent"), ("paper", "force_percent")] * 2]
    figure, panels = plots.panels(3, 2, (plots.WIDTH, 8.6), [
        f"{LAWS[law]}: {MEASURES[measure]}" + (", by the step alone" if k > 3 else "") for k, (law, measure) in enumerate(shows)])
    for k, (axes, (law, measure)) in enumerate(zip(panels, shows)):
        by_step = k > 3
        error, texts = f"by_step_{measure}" if by_step else measure, []
        for (simulator, rule), look in METHODS.items():
            for bodies, size in SIZES.items() if not by_step else ((USUAL, SIZES[USUAL]),):
                own = done(rows, simulator, law=law, rule=rule, bodies=bodies)
                axes.plot([row["cpu_s"] for row in own], [row[error] for row in own], **look.style, markersize=size, lw=0.6)
                side = "left" if simulator == "here" and (rule == "euler") == (law == "reflex") and by_step else "right"
                texts += [(row["cpu_s"], row[error], f"{row['step_ms']:g} ms" if by_step else f"{bodies}", side)
                          for row in (own if by_step else own[-1:])]
        axes.set(xscale="log", yscale="log", ylabel=f"off, {unit(measure)}", xlabel="CPU time of the run, s" if by_step else "",
                 xmargin=0.25 if by_step else 0.14)
        if not by_step:
            best = front(done(rows, law=law), measure)
            axes.plot([row["cpu_s"] for row in best], [row[measure] for row in best], color=plots.GREY, lw=5, alpha=0.3, zorder=0)
            run = lambda of, law=law: done(rows, law=law, **of)[0]
            mark_presets(axes, lambda of, run=run, measure=measure: (run(of)["cpu_s"], run(of)[measure]))
        for axis, (least, most) in ((axes.xaxis, axes.get_xlim()), (axes.yaxis, axes.get_ylim())):
            ticks = [m * 10.0**k for k in range(-4, 3) for m in ((1, 2, 5) if most < 1000 * least else (1,))]
            plots.plain_ticks(axis, [tick for tick in ticks if least <= tick <= most])
        plots.label(axes, texts)
    handles = [*handles_of(METHODS.values(), SIZES), plots.plt.Line2D([], [], color=plots.GREY, lw=5, alpha=0.3, label="quickest for its error")]
    plots.legend_above(figure, handles, 5, 0.055, columnspacing=1.2)
    plots.save(figure, out)


def page(rows: Rows, out: Path) -> None:
    for table in (choice_table, steps_table, meshes_table, mujoco_table):
        table(rows, out)
    draw(rows, out / "contracting.png")


def main(folder: Path, out: Path) -> None:
    rows = read_study(folder)
    page(rows, out)
    tables.write_table(out, "contracting", HEAD, [[row.get(name, "") for name in HEAD] for row in rows])
    dry_table(read_dry(folder), out)


if __name__ == "__main__":
    run_script(__doc__, ["RUNS", "FOLDER"], main)
