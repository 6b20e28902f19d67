"""A film's program with its standard errors: draws what `hagfish midlines` writes.

Usage: midlines.py PROGRAM.csv OUT.png.
"""

from pathlib import Path

import numpy as np

import plots
from script import run_script
from tables import read_csv

SHOWN = (0.1, 0.3, 0.5, 0.7, 0.9)  # of the body from the head: stations near these
BAND = 1.645  # standard errors to each side: 90 %


def main(table: Path, out: Path) -> None:
    names = ("time (s)", "station (L)", "bend_y (rad/L)", "bend_z (rad/L)", "bend_y error (rad/L)", "bend_z error (rad/L)")
    rows = read_csv(table, names)
    time, station, *columns = (np.array([float(row[name]) for row in rows]) for name in names)
    times, stations = np.unique(time), np.unique(station)
    bend_y, bend_z, error_y, error_z = (column.reshape(times.size, stations.size) for column in columns)
    figure, axes = plots.panels(3, 1, (7.5, 9), ["bend about Y", "bend about Z", "standard error, both"])
    for axis, bend, error in ((axes[0], bend_y, error_y), (axes[1], bend_z, error_z)):
        for k, at in enumerate(SHOWN):
            near = int(np.argmin(np.abs(stations - at)))
            line, = axis.plot(times, bend[:, near], label=f"{stations[near]:.2f} L")
            axis.fill_between(times, bend[:, near] - BAND * error[:, near], bend[:, near] + BAND * error[:, near], color=line.get_color(),
                              alpha=0.25, linewidth=0)
        axis.set(xlabel="time, s", ylabel="rad / length, 90 % band")
    axes[0].legend(ncol=len(SHOWN), fontsize=7)
    image = axes[2].pcolormesh(times, stations, np.hypot(error_y, error_z).T, cmap="viridis", vmin=0, shading="nearest", rasterized=True)
    axes[2].grid(visible=False)
    axes[2].set(xlabel="time, s", ylabel="place, of the length")
    figure.colorbar(image, ax=axes[2], label="rad / length")
    plots.save_one(figure, out, dpi=plots.DPI)  # no PDF beside: the program asked for one file


if __name__ == "__main__":
    run_script(__doc__, ["PROGRAM.csv", "OUT.png"], main)
