"""A page on a sweep: what became of its runs, and maps of their figures over its axes. Usage: sweep_page.py TABLE.csv OUT.html"""

import base64
import html
import io
import warnings
from collections import Counter
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.colors import LogNorm, Normalize

import plots
from script import run_script
from sweep_columns import SweepTable, read_sweep

SEED = "start.seed"
PASSED = "share of runs that meet all that is expected"
MAPPED = ["slide_distance_cm", "sliding_force_dyn", "work_thigmotaxis_erg", "eq6_percent", "penetration_cm"]
MOST_TICKS = 8
MOST_COLUMNS = 6  # maps side by side: places of the third axis
LOG_RATIO = 30  # of the largest to the least, from which on colours are logarithmic


def columns_of(table: SweepTable) -> dict[str, list[str]]:
    """Axes to be drawn: of keys that change together the first, and no seed."""
    seen: dict[tuple[int, ...], str] = {}
    for key, values in table.axes.items():
        place = {value: i for i, value in enumerate(dict.fromkeys(values))}
        if key != SEED and len(place) > 1:
            seen.setdefault(tuple(place[value] for value in values), key)
    return {key: table.axes[key] for key in seen.values()}


def mapped(values: np.ndarray, row: np.ndarray, column: np.ndarray, chosen: np.ndarray, mean: bool) -> np.ndarray:
    """Mean or median of the values at each place of two axes; nan where there is none."""
    out = np.full((row.max() + 1, column.max() + 1), np.nan)
    reduce = np.nanmean if mean else np.nanmedian
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)  # places where no run has the figure
        for r, c in {(r, c) for r, c in zip(row[chosen], column[chosen])}:
            out[r, c] = reduce(values[chosen & (row == r) & (column == c)])
    return out


def draw_map(axes: Any, values: np.ndarray, names: tuple[list[str], list[str]], keys: tuple[str, str], limits: tuple[float, float]) -> Any:
    low, high = limits
    scale = LogNorm(low, high) if 0 < LOG_RATIO * low < high else Normalize(low, high if high > low else low + 1)
    image = axes.imshow(values, norm=scale, origin="lower", aspect="auto", cmap="viridis", interpolation="nearest")
    axes.set_facecolor(plots.GRID)
    axes.grid(False)
    for axis, own, key in ((axes.yaxis, names[0], keys[0]), (axes.xaxis, names[1], keys[1])):
        step = -(-len(own) // MOST_TICKS)
        axis.set_ticks(range(0, len(own), step), [short(name) for name in own[::step]])
        axis.set_label_text(key)
    return image


def short(text: str) -> str:
    try:
        return f"{float(text):.3g}"
    except ValueError:
        return text


def draw_maps(table: SweepTable) -> list[str]:
    """PNG images as data of the page."""
    axes = columns_of(table)
    if not axes:
        return []
    keys = list(axes)[:3]
    names = [list(dict.fromkeys(axes[key])) for key in keys] + [[""]] * (3 - len(keys))
    place = [np.array([own.index(value) for value in axes[key]]) for key, own in zip(keys, names)]
    place += [np.zeros(len(table.passed), dtype=int)] * (3 - len(keys))
    keys += [""] * (3 - len(keys))
    measures = {PASSED: table.passed.astype(float)}
    measures |= {name: np.where(table.figures[name] == 0, np.nan, table.figures[name]) for name in MAPPED}
    images, shown = [], min(len(names[2]), MOST_COLUMNS)
    for title, values in measures.items():
        if not np.isfinite(values).any():
            continue
        maps = [mapped(values, place[0], place[1], place[2] == k, title == PASSED) for k in range(shown)]
        known = np.concatenate([m[np.isfinite(m)] for m in maps])
        limits = (0.0, 1.0) if title == PASSED else (float(known.min()), float(known.max()))
        titles = [f"{keys[2]} = {short(name)}" if keys[2] else "" for name in names[2][:shown]]
        figure, panels = plots.panels(1, shown, (1.6 + 2.9 * shown, 3.2), titles, sharey=True)
        for panel, own in zip(panels, maps):
            image = draw_map(panel, own, (names[0], names[1]), (keys[0], keys[1]), limits)
            panel.label_outer()
        figure.colorbar(image, ax=list(panels))
        figure.suptitle(title if title == PASSED else f"{title}, median", fontsize=9.5)
        buffer = io.BytesIO()
        figure.savefig(buffer, format="png", dpi=110)
        plots.plt.close(figure)
        images.append(base64.b64encode(buffer.getvalue()).decode())
    return images


def counts(title: str, values: list[str]) -> str:
    rows = "".join(f"<tr><td>{html.escape(what)}</td><td>{count}</td></tr>" for what, count in Counter(values).most_common())
    return f"<table><tr><th>{title}</th><th>runs</th></tr>{rows}</table>"


def write_sweep_page(table: SweepTable, out: Path) -> None:
    cells = len(table.passed)
    stopped = [outcome for outcome in table.texts["outcome"]]
    unmet = [name for text, outcome in zip(table.texts["unmet"], stopped) if text and outcome == "ok" for name in text.split("; ")]
    settings = "".join(f"<tr><td>{html.escape(key)}</td><td>{html.escape(', '.join(map(short, dict.fromkeys(values))))}</td></tr>"
                       for key, values in table.axes.items())
    images = "".join(f'<p><img src="data:image/png;base64,{image}" alt="map"></p>' for image in draw_maps(table))
    page = f"""<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><title>Sweep of {cells} runs</title>
<style>body {{ font: 15px/1.5 sans-serif; max-width: 70em; margin: 2em auto; padding: 0 1em }} table {{ border-collapse: collapse; margin: 1em 0 }}
td, th {{ text-align: left; padding: .2em .8em; border-bottom: 1px solid #ddd }} img {{ max-width: 100% }}</style></head><body>
<h1>Sweep of {cells} runs</h1>
<p>{int(table.passed.sum())} came to their end and meet all that their scenes expect. Maps are over the first two axes, a panel for
each place of the third, of all runs there; grey where none has the figure, or all have 0.</p>
<table><tr><th>setting</th><th>values</th></tr>{settings}</table>
{counts("outcome", stopped)}{counts("came to its end, but does not meet", unmet) if unmet else ""}{images}</body></html>
"""
    out.write_text(page, encoding="utf-8")


def main(table: Path, out: Path) -> None:
    write_sweep_page(read_sweep(table), out)


if __name__ == "__main__":
    run_script(__doc__, ["TABLE.csv", "OUT.html"], main)
