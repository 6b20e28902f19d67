"""Four knots side by side: pictures of four stages, and tables of how surely each is tied.

Usage: knots.py FOLDER, of the sweeps of study.sh. Needs the program as built (HAGFISH_PROGRAM).
"""

from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import claims
import plots
from audits import audit, unmet
from figure7 import Stage, choose_camera, label_ends, take_stages
from hagfish_log import HagfishLog, LogError
from means import Means, effort_per_cm, read_means
from script import HAGFISH, run_script
from slides import MEAN
from sweep_columns import Cell, read_cells
from tables import write_table

GAP = 1.2  # around the animal in a picture, cm
KEPT = {"knot held", "unknot at end", "limits"}  # what a run that ties, holds and lets go meets


def stages_of(log: HagfishLog) -> list[Stage]:
    """Tied by the script, tightened, at the head, and half way through letting go."""
    tighten, slide, release = (log.in_phase(phase) for phase in ("tighten", "slide", "release"))
    if not (tighten.size and slide.size and release.size):
        raise LogError(f"{log.path}: ends before the knot is let go")
    return [Stage(int(tighten[0]), "tied"), Stage(int(slide[0]), "tightened"), Stage(int(release[0]), "slid to the head"),
            Stage(int(release[release.size // 2]), "slipping off")]


def draw_pictures(logs: dict[str, HagfishLog], out: Path) -> None:
    """A row for each knot, a column for each stage; one scale throughout."""
    pictures = {}
    for knot, log in logs.items():
        stages = stages_of(log)
        view = choose_camera(log, stages)
        pictures[knot] = stages, take_stages(log, HAGFISH, stages, view), view
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
            axes.text(0.03, 0.0, f"$t$ = {log['/trajectory/time'][stage.frame]:.2f} s{spans}", fontsize=7, va="top", transform=axes.transAxes)
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


def by_knot(folder: Path, axis: str) -> dict[str, dict[str, list[Cell]]]:
    """Runs of a sweep by knot and by their place on an axis."""
    found: dict[str, dict[str, list[Cell]]] = {}
    for cell in read_cells(folder):
        found.setdefault(plots.knot_of(cell.axes["scene"]), {}).setdefault(cell.axes[axis], []).append(cell)
    return found


def chance_figures(cells: list[Cell]) -> dict[str, np.ndarray]:
    """`force_figures` of every start that differs by rounding alone."""
    found = [force_figures(cell.log, read_means(cell.log)) for cell in cells]
    return {name: np.array([each[name] for each in found]) for name in found[0]}


def outcome(cell: Cell) -> str:
    """What the audit of a run names."""
    return ", ".join(dict.fromkeys(unmet(audit(cell.path)))) or "passes"


def sure(cells: list[Cell]) -> str:
    """Of noisy starts, how many were tied, held and came off."""
    missed = [set(cell.unmet) for cell in cells if cell.outcome == "ok"]
    good, clean = (sum(not each & names for each in missed) for names in (KEPT, KEPT | {"penetration"}))
    return f"{good} of {len(cells)}" + (f" ({clean} within the penetration)" if clean != good else "")


def mirror_error(plain: Cell, mirrored: Cell) -> float:
    """Largest distance of a body from where the mirror of the plain run has it, cm."""
    own, image = (cell.log["/trajectory/position"] for cell in (plain, mirrored))
    frames = min(len(own), len(image))
    return float(np.abs(own[:frames] * [1.0, -1.0, 1.0] - image[:frames]).max())


def force_by_step(runs: dict[str, list[Cell]], out: Path) -> None:
    """The sliding force at every step tried, one run each: median of the means and, in brackets, mean over the slide, dyn."""
    cells: dict[float, list[str]] = {}
    for log in (cell.log for own in runs.values() for cell in own):
        found = force_figures(log, read_means(log))
        cells.setdefault(log.scene()["time"]["step"], []).append(f"{found['median']:.0f} ({found['mean']:.0f})")
    write_table(out, "knots_step", ["h, ms", *runs], [[f"{1000 * step:g}", *own] for step, own in sorted(cells.items())])


def force_by_chance(folder: Path, out: Path) -> None:
    """What chance and the step make of the sliding force: mean ± standard deviation of starts that differ by rounding alone, and
    the change from one step to the other ± its standard error."""
    runs = by_knot(folder, "time.step")
    chance = {knot: [chance_figures(cells) for cells in own.values()] for knot, own in runs.items()}
    rows = []
    for name, key in ((f"sum of the four λ/h: median of the {MEAN}s, dyn", "median"), ("mean over the slide, dyn", "mean"),
                      (f"largest {MEAN}, dyn", "peak_multipliers"), ("effort for each cm of slide, dyn s", "effort"),
                      ("slide, s", "seconds"), ("head end of the knot, cm", "travel")):
        form = ".2f" if key in ("seconds", "travel") else ".0f"
        for i, step in enumerate(next(iter(runs.values()))):
            rows.append([f"{name}, at h = {1000 * float(step):g} ms", *(
                f"{found[i][key].mean():{form}} ± {found[i][key].std(ddof=1):{form}}" for found in chance.values())])
        rows.append(["change, %", *(change(coarse[key], fine[key]) for coarse, fine in chance.values())])
    write_table(out, "knots_chance", ["", *runs], rows)


def change(coarse: np.ndarray, fine: np.ndarray) -> str:
    """From one set of runs to the other, % of the first, with its standard error."""
    error = np.sqrt(coarse.var(ddof=1) / coarse.size + fine.var(ddof=1) / fine.size)
    return f"{100 * (fine.mean() / coarse.mean() - 1):+.1f} ± {100 * error / coarse.mean():.1f}"


def write_tables(folder: Path, plain: dict[str, Cell], mirrored: dict[str, Cell]) -> None:
    rows: list[list[str]] = []
    logs = {knot: cell.log for knot, cell in plain.items()}
    row = lambda name, cell: rows.append([name, *(cell(knot) for knot in logs)])
    noise, steps = by_knot(folder / "noise", "script.noise"), by_knot(folder / "step", "time.step")
    row("scene", lambda k: plain[k].axes["scene"])
    row("audit", lambda k: outcome(plain[k]))
    row("mirror image, audit", lambda k: outcome(mirrored[k]))
    row("mirror image, farthest body off the reflected run, cm", lambda k: f"{mirror_error(plain[k], mirrored[k]):.1g}")
    row("penetration, cm", lambda k: f"{logs[k]['/steps/penetration'].max():.5f}")
    row("past a limit, deg", lambda k: f"{np.degrees(logs[k]['/steps/limit_violation'].max()):.0e}")
    for size in next(iter(noise.values())):
        row(f"tied, held and off, noise {float(size):g} cm", lambda k, size=size: sure(noise[k][size]))
    for step in next(iter(steps.values())):
        row(f"audit at h = {1000 * float(step):g} ms", lambda k, step=step: outcome(steps[k][step][0]))
    figures = {k: force_figures(logs[k], read_means(logs[k])) for k in logs}
    for name, key, form in (("slide, s", "seconds", ".2f"), ("head end of the knot, cm", "travel", ".2f"),
                            (f"sum of the four λ/h: median of the {MEAN}s, dyn", "median", ".0f"), ("mean over the slide, dyn", "mean", ".0f"),
                            (f"largest {MEAN}, dyn", "peak_multipliers", ".0f"),
                            (f"f_thigmo of a hinge: largest {MEAN}, dyn cm", "peak", ".0f"),
                            (f"of 99 % of the {MEAN}s, no hinge above", "peak99", ".0f"),
                            (f"largest hinge, median of the {MEAN}s", "median_hinge", ".0f"),
                            ("effort: mean size of f_thigmo along the body, over time, for each cm of slide, dyn s", "effort", ".0f"),
                            ("work, erg", "work", ".0f")):
        row(name, lambda k, key=key, form=form: format(figures[k][key], form))
    modes = {k: claims.smooth_in_space(claims.read_sliding(logs[k]))["axes"].values() for k in logs}
    for name, key in (("Fourier modes for 95 % of the energy, of 50", "dct_modes_95"), ("SVD modes", "svd_modes_95")):
        row(name, lambda k, key=key: str(max(axis[key] for axis in modes[k])))
    write_table(folder, "knots", ["", *logs], rows)
    force_by_step({knot: [plain[knot], *(cell for cell, in steps[knot].values())] for knot in plain}, folder)
    force_by_chance(folder / "chance", folder)


def main(folder: Path) -> None:
    plain, mirrored = ({knot: cells[is_mirrored][0] for knot, cells in by_knot(folder / "plain", "mirror").items()}
                       for is_mirrored in ("false", "true"))
    draw_pictures({knot: cell.log for knot, cell in plain.items()}, folder / "knots.png")
    write_tables(folder, plain, mirrored)


if __name__ == "__main__":
    run_script(__doc__, ["FOLDER"], main)
