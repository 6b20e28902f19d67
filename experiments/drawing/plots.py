"""How every figure looks: style, colours, markers, panel letters, and a PDF beside each PNG.

Colours are Okabe and Ito's (https://jfly.uni-koeln.de/color), told apart with any colour vision; where they count, markers or
line styles tell the same.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from string import ascii_lowercase
from typing import Any

import matplotlib

matplotlib.rcdefaults()  # the user's own matplotlibrc is for the user's own figures
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.patheffects import withStroke
from matplotlib.ticker import NullLocator

from script import whole

DPI = 200
WIDTH = 7.2  # inches, of a page of a paper: texts are not made smaller there
INK, GREY, GRID = "#000000", "#777777", "#e5e5e5"
BLUE, YELLOW, ORANGE, VERMILION, PURPLE = "#0072b2", "#f0e442", "#e69f00", "#d55e00", "#cc79a7"
plt.rcParams.update({
    "font.size": 9, "axes.titlesize": 9.5, "axes.titlelocation": "left", "xtick.labelsize": 8, "ytick.labelsize": 8,
    "legend.fontsize": 8, "legend.framealpha": 0.85, "legend.edgecolor": "none", "legend.title_fontsize": 8,
    "axes.grid": True, "grid.color": GRID, "grid.linewidth": 0.6, "axes.axisbelow": True, "lines.linewidth": 1.2, "lines.markersize": 5})


@dataclass(frozen=True)
class Look:
    """How one of several is drawn and called."""

    label: str
    colour: str
    marker: str

    @property
    def style(self) -> dict[str, str]:
        """For `plot`."""
        return {"color": self.colour, "marker": self.marker}


SCENES = {"overhand": "3_1", "figure_eight": "4_1", "double_overhand": "5_1", "three_twist": "5_2"}  # what each knot's scenes are called
KNOTS = {"3_1": Look("$3_1$ overhand", BLUE, "o"), "4_1": Look("$4_1$ figure-eight", ORANGE, "s"),
         "5_1": Look("$5_1$ double overhand", INK, "^"), "5_2": Look("$5_2$ three-twist", PURPLE, "D")}
INTEGRATORS = {"core": Look("core, Euler", INK, "o"), "core_midpoint": Look("core, midpoint", VERMILION, "v"),
               "mujoco_euler": Look("MuJoCo Euler", BLUE, "s"),
               "mujoco_implicit": Look("MuJoCo implicit", ORANGE, "^"), "mujoco_rk4": Look("MuJoCo RK4", PURPLE, "D")}
VERDICTS = {"agrees": Look("agrees", BLUE, "^"), "undecided": Look("undecided", GREY, "o"), "disagrees": Look("disagrees", ORANGE, "v")}
ROUGHNESS = {"space": Look("along the body", BLUE, "o"), "time": Look("in time", ORANGE, "D")}
SIDES = {"left": ((-6, 0), "right", "center"), "right": ((6, 0), "left", "center"), "above": ((0, 5), "center", "bottom")}  # of labels
TICKS_APART = 1.3  # least ratio of two ticks


def knot_of(scene: str) -> str:
    """The type that a built-in scene of this name is of."""
    bare = scene.removesuffix("_free").removesuffix("_waypoints")
    return SCENES[next(name for name in sorted(SCENES, key=len, reverse=True) if bare.endswith(name))]


def panels(rows: int, columns: int, size: tuple[float, float], titles: Sequence[str], **options: Any) -> tuple[Any, np.ndarray]:
    """A figure of `size` inches and its panels in reading order, lettered and titled; `options` go to `subplots`."""
    figure, grid = plt.subplots(rows, columns, figsize=size, layout="constrained", squeeze=False, **options)
    name_panels(grid.flat, titles)
    return figure, grid.ravel()


def name_panels(panels: Iterable[Any], titles: Sequence[str]) -> None:
    """The one place that letters panels: (a), (b), ... before each title; a panel by itself has none."""
    for letter, (axes, title) in zip(ascii_lowercase, zip(panels, titles, strict=True)):
        axes.set_title(f"({letter}) {title}" if len(titles) > 1 else title)


def plain_ticks(axis: Any, values: Iterable[float]) -> None:
    """Ticks of a logarithmic axis at `values` alone, as plain numbers; none where it is too near to the last."""
    kept: list[float] = []
    for value in sorted(values):
        if not kept or value >= TICKS_APART * kept[-1]:
            kept.append(value)
    axis.set_ticks(kept, [f"{value:g}" for value in kept])
    axis.set_minor_locator(NullLocator())


def label(axes: Any, points: Iterable[tuple[float, float, str, str]]) -> None:
    """Text beside points (x, y, text, side), once limits and scales are set; of texts of a side that would meet, the first alone."""
    placed: list[tuple[str, np.ndarray]] = []
    for x, y, text, side in points:
        at = axes.transAxes.inverted().transform(axes.transData.transform((x, y)))
        if all(side != other or np.any(np.abs(at - place) > (0.13, 0.05)) for other, place in placed):
            placed.append((side, at))
            shift, across, up = SIDES[side]
            axes.annotate(text, (x, y), shift, textcoords="offset points", fontsize=7, ha=across, va=up,
                          path_effects=[withStroke(linewidth=2, foreground="white")])


def knot_handles(axes: Any) -> list[Any]:
    """Of a legend: each knot as its line is drawn."""
    return [axes.plot([], [], label=look.label, **look.style)[0] for look in KNOTS.values()]


def legend_above(figure: Any, handles: Sequence[Any], columns: int, room: float, **options: Any) -> None:
    """One legend for all panels, over them, in `room` of the figure's height."""
    figure.get_layout_engine().set(rect=(0, 0, 1, 1 - room))
    figure.legend(handles=handles, loc="upper center", ncols=columns, frameon=False, **options)


def save(figure: Any, png: Path, dpi: int = DPI) -> None:
    """Writes the figure as PNG and, beside it, as PDF. No time stamps: the same log gives the same files."""
    save_one(figure, png, dpi=dpi)
    save_one(figure, png.with_suffix(".pdf"), dpi=dpi, metadata={"CreationDate": None})
    plt.close(figure)


def save_one(figure: Any, file: Path, **options: Any) -> None:
    """Writes one file, which has its name only when it is whole."""
    with whole(file) as part:
        figure.savefig(part, **options)
