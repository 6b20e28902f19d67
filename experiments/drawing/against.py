"""How far a run is from a film, by time and along the body: draws what `hagfish against --csv` writes.

Usage: against.py DISTANCES.csv OUT.png.
"""

from pathlib import Path

import numpy as np

import plots
from script import run_script
from tables import read_csv

BINS = 50  # along the body


def main(table: Path, out: Path) -> None:
    rows = read_csv(table, ("time_s", "s_cm", "distance_cm"))
    time, arc, off = (np.array([float(row[name]) for row in rows]) for name in ("time_s", "s_cm", "distance_cm"))
    times, at = np.unique(time, return_inverse=True)
    bounds = np.linspace(0, max(arc.max(), 1e-9), BINS + 1)
    place = np.clip(np.digitize(arc, bounds) - 1, 0, BINS - 1)
    places = np.unique(place)
    rms = lambda cells: np.sqrt(np.bincount(cells, off**2) / np.maximum(np.bincount(cells), 1))
    middle = (bounds[1:] + bounds[:-1]) / 2
    figure, (by_time, along, both) = plots.panels(3, 1, (7.5, 8), ["by time", "along the body", "by time and along the body"])
    by_time.plot(times, rms(at), color=plots.BLUE)
    by_time.set(xlabel="time, s", ylabel="distance, rms, cm", ylim=(0, None))
    along.plot(middle[places], rms(place)[places], color=plots.BLUE)
    along.set(xlabel="arc length, cm: head on the left, tail on the right", ylabel="distance, rms, cm", ylim=(0, None))
    # Points are fewer than bins, and some are missing: in between, linear along the body.
    shown = np.empty((times.size, BINS))
    for row in range(times.size):
        here = np.flatnonzero(at == row)
        here = here[np.argsort(arc[here])]
        shown[row] = np.interp(middle, arc[here], off[here], left=np.nan, right=np.nan)
    shown = np.ma.masked_invalid(shown)
    edges = np.r_[times, 2 * times[-1] - times[-2]] if times.size > 1 else np.r_[times, times + 1]
    image = both.pcolormesh(edges, bounds, shown.T, cmap="viridis", vmin=0, rasterized=True)
    both.grid(visible=False)
    both.set(xlabel="time, s", ylabel="cm from the head")
    figure.colorbar(image, ax=both, label="distance, cm")
    plots.save_one(figure, out, dpi=plots.DPI)  # no PDF beside: the program asked for one file


if __name__ == "__main__":
    run_script(__doc__, ["DISTANCES.csv", "OUT.png"], main)
