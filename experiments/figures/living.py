"""The animal that ties itself: torques and where their work goes, noisy starts, and sweeps of stiffness, drag and haste.

Usage: living.py RUNS OUT.csv OUT.png OUT.md (writes a PDF beside).
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

import audits
import plots
import tables
from hagfish_log import HagfishLog, LogError
from script import run_script
from slides import read_slide

KNOTS = {"overhand": "3_1", "figure_eight": "4_1", "double_overhand": "5_1", "three_twist": "5_2"}
SWEEPS = {"stiffness": "flexural rigidity, dyn cm²", "drag": "drag, times that of the scenes", "haste": "speed of the program"}
CAPACITY = 2.7e5  # dyn cm, a guess: data/living_overhand.toml
PHASES = ("form", "tighten", "slide", "release")


@dataclass
class Run:
    """What one run shows; cm, dyn cm, erg."""

    name: str
    knot: str
    outcome: str  # "off", or why the run is not one
    travel: float
    met: float  # share of sliding steps that meet Eq. 6
    force: float  # median of the sum of the four multipliers / h while sliding, dyn
    penetration: float
    torque: dict[str, float]  # largest of a hinge, by phase
    worked: dict[str, float]  # muscles, drag and damping, stored, thigmotaxis, until release


def outcome_of(log: HagfishLog, unmet: list[str]) -> str:
    status = str(log.attribute("status"))
    if status != "complete":
        return status.removeprefix("failed: ").split(" at step")[0]
    return "knot lost" if "knot held" in unmet else "still tied" if "unknot at end" in unmet else "off"


def read_run(folder: Path, name: str, knot: str) -> Run:
    log = HagfishLog(folder / f"{name}.h5")
    unmet = audits.unmet(audits.read_findings(folder / f"{name}.check.csv"))
    slide = read_slide(folder, name)
    torque = np.abs(log["/forces/active"]).max(axis=1)
    frames = {phase: log.in_phase(phase) for phase in PHASES}
    held = np.concatenate([frames[phase] for phase in ("form", "tighten", "slide")])
    total = lambda what: float(log[f"/diagnostics/{what}"][held[-1]])
    start = float(log["/diagnostics/elastic_energy"][0] + log["/diagnostics/kinetic_energy"][0])
    worked = {"muscles": total("work_active"), "thigmotaxis": total("work_thigmotaxis"),
              "water and damping": total("dissipated"), "stored": total("elastic_energy") + total("kinetic_energy") - start}
    return Run(name, knot, outcome_of(log, unmet), slide.travel, slide.met, slide.force,
               float(log["/steps/penetration"].max()),
               {phase: float(torque[rows].max()) if rows.size else np.nan for phase, rows in frames.items()}, worked)


def shape_apart(log: HagfishLog, other: HagfishLog) -> tuple[np.ndarray, np.ndarray]:
    """Time and the largest difference of a hinge's angle, rad, at frames that both runs have."""
    frames = min(log.frames, other.frames)
    q, p = (one["/trajectory/q"][:frames, 7:] for one in (log, other))
    return log["/trajectory/time"][:frames], np.abs(q - p).max(axis=1)


def likeness(log: HagfishLog, other: HagfishLog) -> float:
    """Median correlation along the body of f_thigmo at frames in which both runs slide."""
    f, g = (one["/forces/thigmotaxis"] for one in (log, other))
    both = np.intersect1d(log.in_phase("slide"), other.in_phase("slide"))
    rows = [np.corrcoef(f[k], g[k])[0, 1] for k in both if f[k].any() and g[k].any()]
    return float(np.median(rows)) if rows else np.nan


def starts_table(folder: Path) -> list[str]:
    rows = []
    for head in ("held", "free"):
        for scene, knot in KNOTS.items():
            plain = HagfishLog(folder / f"{head}_{scene}.h5")
            travel = read_slide(folder, f"{head}_{scene}").travel
            end = plain.in_phase("form")[-1]
            off = far = 0
            apart, alike = [], []
            paths = sorted(folder.glob(f"{head}start_{scene}_*.check.csv"))
            for path in paths:
                run = read_run(folder, path.name.removesuffix(".check.csv"), knot)
                log = HagfishLog(folder / f"{run.name}.h5")
                off += run.outcome == "off"
                far += abs(run.travel - travel) <= 0.1 * travel
                apart.append(shape_apart(plain, log)[1][min(end, log.frames - 1)])
                alike.append(likeness(plain, log))
            noise = np.degrees(float(log.scene()["start"].get("noise_rad", np.radians(log.scene()["start"].get("noise_deg", 0)))))
            rows.append([head, knot, f"{noise:g}", f"{off} of {len(paths)}", f"{far} of {len(paths)}", f"{max(apart):.1e}",
                         f"{np.nanmin(alike):.4f}"])
    return tables.markdown(["head", "knot", "noise, deg", "tied, kept, off", "slide within 10 % of the undisturbed one",
                            "hinges apart at the end of forming, rad", "likeness of f_thigmo, least of the medians"], rows)


def draw(folder: Path, sweeps: dict[str, dict[str, list[tuple[float, Run]]]], out: Path) -> None:
    figure, axes = plots.panels(2, 2, (10, 7), ["what a noisy start leaves behind", *(f"torque: {what}" for what in SWEEPS)])
    for scene, knot in KNOTS.items():
        look = plots.KNOTS[knot]
        plain = HagfishLog(folder / f"held_{scene}.h5")
        time, apart = shape_apart(plain, HagfishLog(folder / f"heldstart_{scene}_1.h5"))
        axes[0].plot(time, np.maximum(apart, 1e-12), color=look.colour, label=look.label)
    axes[0].set(yscale="log", xlabel="time, s", ylabel="largest difference of a hinge's angle, rad")
    axes[0].legend()
    for panel, (what, label) in zip(axes[1:], SWEEPS.items(), strict=True):
        for knot, runs in sweeps[what].items():
            look = plots.KNOTS[knot]
            largest = [run.torque["form"] for _, run in runs]
            panel.plot([value for value, _ in runs], largest, label=look.label, **look.style)
            lost = [(value, torque) for (value, run), torque in zip(runs, largest, strict=True) if run.outcome != "off"]
            panel.plot([v for v, _ in lost], [t for _, t in lost], color=look.colour, marker=look.marker, mfc="white", ls="")
        panel.axhline(CAPACITY, color=plots.GREY, ls="--", lw=0.8)
        panel.set(xscale="log", yscale="log", xlabel=label, ylabel="largest torque of a hinge, forming, dyn cm")
    axes[1].legend(title="open: not tied, or not off\ndashed: a guess at the capacity")
    plots.save(figure, out)


def run_rows(named: list[tuple[str, Run]]) -> list[list[str]]:
    return [[name, run.knot, run.outcome, f"{run.travel:.1f}", f"{100 * run.met:.1f}", f"{run.force:.0f}", f"{run.penetration:.1e}",
             f"{run.torque['form']:.2g}", f"{run.torque['slide']:.2g}",
             *(f"{run.worked[key]:.2g}" for key in ("muscles", "thigmotaxis", "water and damping", "stored"))]
            for name, run in named]


def main(folder: Path, table: Path, out: Path, page: Path) -> None:
    if not list(folder.glob("held_*.check.csv")):
        raise LogError(f"{folder}: holds no run held_*")
    scenes = [(kind, read_run(folder, f"{kind}_{scene}", knot))
              for kind in ("held", "free", "ipopt", "fine") for scene, knot in KNOTS.items()]
    sweeps = {what: {knot: sorted((float(path.name.removesuffix(".check.csv").rsplit("_", 1)[1]),
                                   read_run(folder, path.name.removesuffix(".check.csv"), knot))
                                  for path in folder.glob(f"{what}_{scene}_*.check.csv"))
                     for scene, knot in KNOTS.items()} for what in SWEEPS}
    of_sweeps = [(f"{what} {value:g}", run) for what, knots in sweeps.items() for runs in knots.values() for value, run in runs]
    draw(folder, sweeps, out)
    head = ["run", "knot", "outcome", "slide, cm", "Eq. 6 met, %", "λ/h, median, dyn", "deepest overlap, cm",
            "torque forming, dyn cm", "torque sliding, dyn cm", "work of muscles, erg", "of thigmotaxis, erg",
            "to water and damping, erg", "stored, erg"]
    tables.write_csv(table, head, run_rows(scenes + of_sweeps))
    tables.write_page(page, [
        "# The animal ties itself", "", "`ipopt`: that back end; `fine`: h = 2 ms instead of 5. Works are until release.", "",
        *tables.markdown(head, run_rows(scenes)), "## Noisy starts", "", *starts_table(folder), "## Sweeps", "",
        *tables.markdown(head, run_rows(of_sweeps))])


if __name__ == "__main__":
    run_script(__doc__, ["RUNS", "OUT.csv", "OUT.png", "OUT.md"], main)
