"""Where knots sweep the skin on their way to the head and on their way back, a panel a knot and law.

Usage: world_skin.py SWEEP OUT.png, of experiments/studies/world.sh: SWEEP has a table, logs and what `hagfish export` made of each.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from matplotlib.colors import ListedColormap
from matplotlib.patches import Patch

import plots
import tables
from hagfish_log import HagfishLog
from script import run_script

LAWS = {"paper": "paper's law", "reflex": "reflex"}
NEVER, THERE, BACK = 0, 1, 2
COLOURS = {NEVER: plots.GRID, THERE: plots.BLUE, BACK: plots.ORANGE}


def passes(log: HagfishLog, skin: Path) -> tuple[np.ndarray, np.ndarray]:
    """Arc length of the rings, cm, and on which way each patch was first swept: a row a side of the body, a column a ring."""
    cells = tables.read_csv(skin, ["s_cm", "side_rad", "since_s"])
    s, side = (np.unique([float(cell[name]) for cell in cells]) for name in ("s_cm", "side_rad"))
    since = np.array([float(cell["since_s"] or "nan") for cell in cells]).reshape(s.size, side.size).T
    turn = float(log["/trajectory/time"][log.in_phase("reverse")[0]])
    return s, np.select([np.isnan(since), since < turn], [NEVER, THERE], BACK)


def main(sweep: Path, out: Path) -> None:
    drawn = []
    for row in tables.read_csv(sweep / "table.csv", ["cell", "controller.leave_by"]):
        if row["controller.leave_by"] == "tail":
            log = HagfishLog(sweep / "logs" / f"{row['cell']}.h5")
            scene = log.scene()
            title = f"{plots.KNOTS[scene['expect']['knot']].label}, {LAWS[scene['controller']['law']]}"
            drawn.append((title, *passes(log, sweep / "logs" / row["cell"] / "skin.csv")))
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
    run_script(__doc__, ["SWEEP", "OUT.png"], main)
