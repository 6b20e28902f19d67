"""Four knots side by side: pictures of four stages, and tables of how surely each is tied.

Usage: knots.py RUNS HAGFISH OUT_FOLDER, where HAGFISH is the program.
"""

from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import claims
import plots
from figure7 import Stage, choose_camera, label_ends, take_pictures
from hagfish_log import HagfishLog, LogError
from means import Means, effort_per_cm, read_means
from script import run_script
from slides import MEAN, unmet_of
from tables import write_table

GAP = 1.2  # around the animal in a picture, cm
NOISES = ("0.2", "0.5", "1")
STEPS = ("0.0005", "0.001", "0.005", "0.01", "0.02")
CHANCE_STEPS = ("0.002", "0.001")


def stages_of(log: HagfishLog) -> list[Stage]:
    """Tied by the script, tightened, at the head, and half way through letting go."""
    tighten, slide, release = (log.in_phase(phase) for phase in ("tighten", "slide", "release"))
    if not (tighten.size and slide.size and release.size):
        raise LogError(f"{log.path}: ends before the knot is let go")
    return [Stage(int(tighten[0]), "tied"), Stage(int(slide[0]), "tightened"), Stage(int(release[0]), "slid to the head"),
            Stage(int(release[release.size // 2]), "slipping off")]


def draw_pictures(logs: dict[str, HagfishLog], hagfish: Path, out: Path) -> None:
    """A row for each knot, a column for each stage; one scale throughout."""
    pictures = {}
    for knot, log in logs.items():
        stages = stages_of(log)
        view = choose_camera(log, stages)
        pictures[knot] = stages, take_pictures(log, hagfish, [s.frame for s in stages], view), view
    wide = max(p.right - p.left for _, row, _ in pictures.values() for p in row) + 2 * GAP
    heights = {knot: max(p.top for p in row) - min(p.bottom for p in row) + 2 * GAP for knot, (_, row, _) in pictures.items()}
    per_cm, above, below = plots.WIDTH / (4 * wide), 0.18, 0.32  # inches of text about a row
    tall = sum(heights.values()) * per_cm + (above + below) * len(pictures) + 0.25
    figure, top = plt.figure(figsize=(plots.WIDTH, tall)), tall - 0.25 - above
    for knot, (stages, row, view) in pictures.items():
        height, low = heights[knot] * per_cm, min(p.bottom for p in row) - GAP
        for column, (stage, p) in enumerate(zip(stages, row)):
            axes = figure.add_axes([column / 4, (top - height) / tall, 1 / 4, height / tall])
            middle = (p.left + p.right) / 2
            axes.imshow(p.pixels, extent=(p.left, p.right, p.bottom, p.top))
            axes.set(xlim=(middle - wide / 2, middle + wide / 2), ylim=(low, low + heights[knot]), aspect="auto")
            axes.axis("off")
            log = logs[knot]
            label_ends(axes, log, stage.frame, view, p, per_cm)
            ends = [log[f"/knot/{end}_end"][stage.frame] for end in ("head", "tail")]
            spans = f", {ends[0]:.1f} to {ends[1]:.1f} cm" if np.all(np.isfinite(ends)) else ""
            axes.text(0.03, 0.0, f"$t$ = {log['/trajectory/time'][stage.frame]:.2f} s{spans}", fontsize=7, va="top",
                      transform=axes.transAxes)
            if column == 0:
                axes.text(0.03, 1.0, plots.KNOTS[knot].label, fontsize=8.5, va="bottom", weight="bold", transform=axes.transAxes)
        top -= height + above + below
    for column, stage in enumerate(next(iter(pictures.values()))[0]):
        figure.text(column / 4 + 0.01, 1 - 0.16 / tall, stage.title, fontsize=8.5, va="center")
    scale = figure.add_axes([1 - 5 * per_cm / plots.WIDTH - 0.015, 1 - 0.16 / tall, 5 * per_cm / plots.WIDTH, 0])
    scale.plot([0, 1], [0, 0], color=plots.INK, lw=1.5, solid_capstyle="butt", clip_on=False)
    scale.text(-0.1, 0, "5 cm", fontsize=7, ha="right", va="center")
    scale.set(xlim=(0, 1))
    scale.axis("off")
    plots.save(figure, out)


def force_figures(log: HagfishLog, means: Means) -> dict[str, float]:
    """f_thigmo over the slide, in means over WINDOW, dyn, dyn cm, dyn s; the work in erg."""
    first, last = means.start[0], means.end[-1]
    work, head_end = log["/diagnostics/work_thigmotaxis"], log["/knot/head_end"]
    largest = np.abs(means.force).max(axis=1)  # of any hinge
    return {"seconds": float(means.end.size * means.window), "travel": float(head_end[first] - head_end[last]),
            "median": float(np.median(means.total)), "mean": float(means.total.mean()),
            "peak_multipliers": float(means.total.max()), "peak": float(largest.max()),
            "peak99": float(np.percentile(largest, 99)), "median_hinge": float(np.median(largest)),
            "effort": effort_per_cm(log, means), "work": float(work[last] - work[first])}


def chance_figures(folder: Path, scene: str, step: str) -> dict[str, np.ndarray]:
    """`force_figures` of every start that differs by rounding alone."""
    paths = sorted(folder.glob(f"chance_{scene}_{step}_*.h5"))
    if len(paths) < 2:
        raise LogError(f"{folder}: holds too few runs chance_{scene}_{step}_*")
    found = [force_figures(log, read_means(log)) for log in map(HagfishLog, paths)]
    return {name: np.array([each[name] for each in found]) for name in found[0]}


def outcome(folder: Path, name: str) -> str:
    """What the audit of a run names, the step's own penetration aside; empty where all is well."""
    return ", ".join(dict.fromkeys(unmet_of(folder, name)))


def sure(folder: Path, scene: str) -> list[str]:
    """Of ten noisy starts, how many were tied, held, slid and came off, for each noise."""
    cells = []
    for noise in NOISES:
        names = sorted(path.name.removesuffix(".check.csv") for path in folder.glob(f"noise_{scene}_{noise}_*.check.csv"))
        unmet = [set(unmet_of(folder, name)) for name in names]
        good = sum(not each & {"status", "knot held", "unknot at end", "limits"} for each in unmet)
        clean = sum(not each & {"status", "knot held", "unknot at end", "limits", "penetration"} for each in unmet)
        cells.append(f"{good} of {len(names)}" + (f" ({clean} within the penetration)" if clean != good else ""))
    return cells


def scene_of(folder: Path, knot: str) -> str:
    for path in sorted(folder.glob("plain_*.h5")):
        if HagfishLog(path).scene()["expect"]["knot"] == knot:
            return path.stem.removeprefix("plain_")
    raise LogError(f"{folder}: holds no run plain_* of {knot}")


def mirror_error(folder: Path, scene: str) -> float:
    """Largest distance of a body from where the mirror of the plain run has it, cm."""
    plain, image = (HagfishLog(folder / f"{kind}_{scene}.h5")["/trajectory/position"] for kind in ("plain", "mirror"))
    frames = min(len(plain), len(image))
    return float(np.abs(plain[:frames] * [1.0, -1.0, 1.0] - image[:frames]).max())


def force_by_step(folder: Path, scenes: dict[str, str], out: Path) -> None:
    """The sliding force at every step tried, one run each: median of the means and, in brackets, mean over the slide, dyn."""
    runs: dict[float, list[str]] = {}
    for scene in scenes.values():
        for name in (f"plain_{scene}", *(f"step_{scene}_{step}" for step in STEPS)):
            log = HagfishLog(folder / f"{name}.h5")
            found = force_figures(log, read_means(log))
            runs.setdefault(log.scene()["time"]["step"], []).append(f"{found['median']:.0f} ({found['mean']:.0f})")
    write_table(out, "knots_step", ["h, ms", *scenes], [[f"{1000 * step:g}", *cells] for step, cells in sorted(runs.items())])


def force_by_chance(folder: Path, scenes: dict[str, str], out: Path) -> None:
    """What chance and the step make of the sliding force: mean ± standard deviation of starts that differ by rounding alone, and
    the change from one step to the other ± its standard error."""
    chance = {k: [chance_figures(folder, scene, step) for step in CHANCE_STEPS] for k, scene in scenes.items()}
    rows = []
    for name, key in ((f"sum of the four λ/h: median of the {MEAN}s, dyn", "median"), ("mean over the slide, dyn", "mean"),
                      (f"largest {MEAN}, dyn", "peak_multipliers"), ("effort for each cm of slide, dyn s", "effort"),
                      ("slide, s", "seconds"), ("slide, cm", "travel")):
        form = ".2f" if key in ("seconds", "travel") else ".0f"
        for i, step in enumerate(CHANCE_STEPS):
            rows.append([f"{name}, at h = {1000 * float(step):g} ms", *(
                f"{found[i][key].mean():{form}} ± {found[i][key].std(ddof=1):{form}}" for found in chance.values())])
        rows.append(["change, %", *(change(coarse[key], fine[key]) for coarse, fine in chance.values())])
    write_table(out, "knots_chance", ["", *scenes], rows)


def change(coarse: np.ndarray, fine: np.ndarray) -> str:
    """From one set of runs to the other, % of the first, with its standard error."""
    error = np.sqrt(coarse.var(ddof=1) / coarse.size + fine.var(ddof=1) / fine.size)
    return f"{100 * (fine.mean() / coarse.mean() - 1):+.1f} ± {100 * error / coarse.mean():.1f}"


def write_tables(folder: Path, logs: dict[str, HagfishLog], slides: dict[str, claims.Sliding], out: Path) -> None:
    rows: list[list[str]] = []
    scenes = {knot: scene_of(folder, knot) for knot in logs}
    row = lambda name, cell: rows.append([name, *(cell(knot) for knot in logs)])
    row("scene", lambda k: scenes[k])
    row("audit", lambda k: outcome(folder, f"plain_{scenes[k]}") or "passes")
    row("mirror image, audit", lambda k: outcome(folder, f"mirror_{scenes[k]}") or "passes")
    row("mirror image, farthest body off the reflected run, cm", lambda k: f"{mirror_error(folder, scenes[k]):.1g}")
    row("penetration, cm", lambda k: f"{logs[k]['/steps/penetration'].max():.5f}")
    row("past a limit, deg", lambda k: f"{np.degrees(logs[k]['/steps/limit_violation'].max()):.0e}")
    for i, noise in enumerate(NOISES):
        row(f"tied, held and off, noise {noise} cm", lambda k, i=i: sure(folder, scenes[k])[i])
    for step in STEPS:
        row(f"audit at h = {1000 * float(step):g} ms", lambda k, step=step:
            outcome(folder, f"step_{scenes[k]}_{step}") or "passes")
    figures = {k: force_figures(logs[k], read_means(logs[k])) for k in logs}
    for name, key, form in (("slide, s", "seconds", ".2f"), ("slide, cm", "travel", ".2f"),
                            (f"sum of the four λ/h: median of the {MEAN}s, dyn", "median", ".0f"),
                            ("mean over the slide, dyn", "mean", ".0f"),
                            (f"largest {MEAN}, dyn", "peak_multipliers", ".0f"),
                            (f"f_thigmo of a hinge: largest {MEAN}, dyn cm", "peak", ".0f"),
                            (f"of 99 % of the {MEAN}s, no hinge above", "peak99", ".0f"),
                            (f"largest hinge, median of the {MEAN}s", "median_hinge", ".0f"),
                            ("effort: mean size of f_thigmo along the body, over time, for each cm of slide, dyn s",
                             "effort", ".0f"),
                            ("work, erg", "work", ".0f")):
        row(name, lambda k, key=key, form=form: format(figures[k][key], form))
    modes = {k: claims.smooth_in_space(slides[k])["axes"].values() for k in logs}
    for name, key in (("Fourier modes for 95 % of the energy, of 50", "dct_modes_95"), ("SVD modes", "svd_modes_95")):
        row(name, lambda k, key=key: str(max(axis[key] for axis in modes[k])))
    write_table(out, "knots", ["", *logs], rows)
    force_by_step(folder, scenes, out)
    force_by_chance(folder, scenes, out)


def main(folder: Path, hagfish: Path, out: Path) -> None:
    logs = {knot: HagfishLog(folder / f"plain_{scene_of(folder, knot)}.h5") for knot in plots.KNOTS}
    slides = {knot: claims.read_sliding(log) for knot, log in logs.items()}
    draw_pictures(logs, hagfish, out / "knots.png")
    write_tables(folder, logs, slides, out)


if __name__ == "__main__":
    run_script(__doc__, ["RUNS", "HAGFISH", "OUT_FOLDER"], main)
