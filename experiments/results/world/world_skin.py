"""Where knots sweep the skin on their way to the head and on their way back, a panel a knot and law.

Usage: world_skin.py FOLDER OUT.png, of study.sh, of what taken.py kept of the logs of FOLDER.
"""

from pathlib import Path

import numpy as np
from matplotlib.colors import ListedColormap
from matplotlib.patches import Patch

import plots
from script import run_script
from taken import taken
from world_logs import LAWS

NEVER, THERE, BACK = 0, 1, 2
COLOURS = {NEVER: plots.GRID, THERE: plots.BLUE, BACK: plots.ORANGE}


def main(folder: Path, out: Path) -> None:
    drawn = []
    for run in taken(folder):
        if run["back"]:
            since = np.array(run["since"])
            title = f"{plots.KNOTS[run['knot']].label}, {LAWS[run['law']]}"
            drawn.append((title, run["s"], np.select([np.isnan(since), since < run["turn"]], [NEVER, THERE], BACK)))
    figure, panels = plots.panels(len(drawn) // 2, 2, (7.2, 4.6), [title for title, *_ in drawn], sharex=True, sharey=True)
    for panel, (_, s, swept) in zip(panels, drawn):
        panel.imshow(swept, extent=(s[0], s[-1], 0, 360), aspect="auto", origin="lower", interpolation="nearest", vmin=NEVER, vmax=BACK,
                     cmap=ListedColormap(list(COLOURS.values())))
        panel.grid(False)
        panel.set_yticks([0, 180, 360])
    figure.supxlabel("arc length from the head, cm", fontsize=9)
    figure.supylabel("side of the body, degrees", fontsize=9)
    words = {THERE: "on the way to the head", BACK: "on the way back alone", NEVER: "never"}
    plots.legend_above(figure, [Patch(color=COLOURS[what], label=word) for what, word in words.items()], 3, 0.07)
    plots.save(figure, out)


if __name__ == "__main__":
    run_script(__doc__, ["FOLDER", "OUT.png"], main)
