"""Where the paper's three claims about the sliding force hold: over readings of the bending limit, its scale, where the
knot is let go, stiffness and drag, each from several starts and at two steps.

Usage: claim_map.py SWEEP OUT_FOLDER, of what claim_of took of its logs.
"""

from collections.abc import Collection
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.lines import Line2D

import claim_row
import claims
import plots
import tables
from hagfish_log import HagfishLog
from script import run_script
from sweep_columns import BOTH_ENDS
from taken import taken_of_sweep

GROWTH = claims.NAMES[1]
READINGS = {"box": "limit on each axis (box)", "cone": "limit on the total angle (cone)"}
HEAD = ["what is changed", "box: slid by both ends", "effort near over far", "larger near the head?", "cone: slid by both ends",
        "effort near over far by cones", "larger near the head by cones?", "zero behind?", "roughness along the body", "in time",
        "smooth, noisy in time?", "Fourier modes for 95 %, of 50", "a few would do?"]

Claim = dict[str, Any]  # of one run: what it is by the grid, and what claim_row.py says


def claim_of(log: HagfishLog) -> Claim:
    scene = log.scene()
    return {"reading": scene["model"]["bending_limit"], "change": scene["title"], "step": scene["time"]["step"], **claim_row.judged(log)}


def groups(runs: list[Claim]) -> dict[tuple[str, str], list[Claim]]:
    """By reading and change, in the order of the grid."""
    return tables.grouped(runs, lambda run: (run["reading"], run["change"]))


def slid(runs: list[Claim]) -> list[Claim]:
    """A claim about the sliding force is judged of knots that slide by both ends alone."""
    return [run for run in runs if run["outcome"] == "slid" and run["slide"] == BOTH_ENDS]


def draw(runs: list[Claim], out: Path) -> None:
    keys = groups(runs)
    height = {key: -i - 1.2 * list(READINGS).index(key[0]) for i, key in enumerate(keys)}
    figure, (growth, rough) = plots.panels(1, 2, (8.6, 0.8 + 0.235 * (len(keys) + 2)), [
        "larger near the head?", "smooth along the body, noisy in time?"], sharey=True, gridspec_kw={"width_ratios": [1.3, 1]})
    finest = min(run["step"] for run in runs)
    for key, y in height.items():
        for run in slid(keys[key]):
            shift = 0.16 if run["step"] == finest else -0.16
            growth.plot(run["near_over_far"], y + shift, ms=3.6, mew=0, alpha=0.8, **plots.VERDICTS[run[GROWTH]].style)
            for shift, (name, look) in zip((0.16, -0.16), plots.ROUGHNESS.items()):
                rough.plot(run[f"roughness_{name}"], y + shift, ms=3, mew=0, alpha=0.7, **look.style)
        count = f"{len(slid(keys[key]))} of {len(keys[key])}"
        growth.text(1.005, y, count, transform=growth.get_yaxis_transform(), fontsize=7, va="center", color=plots.GREY)
    for reading, title in READINGS.items():
        tops = [y for key, y in height.items() if key[0] == reading]
        if tops:
            growth.text(0.01, max(tops) + 0.72, title, transform=growth.get_yaxis_transform(), fontsize=8.5, weight="bold")
    growth.axvline(1, color=plots.GREY, lw=0.8, ls="--", zorder=0)
    growth.set(xscale="log", xlabel="effort in the third nearest the head\nover that in the furthest third")
    growth.set_yticks(list(height.values()), [key[1] for key in keys])
    growth.set_ylim(min(height.values()) - 0.7, 1.3)
    growth.set_title("slid by\nboth ends", loc="right", fontsize=7, color=plots.GREY, x=1.08)
    plots.plain_ticks(growth.xaxis, [0.5, 1, 2, 5, 10])
    rough.set(xscale="log", xlabel="roughness of 20 ms means\n(0 smooth, 1 white noise; worst axis)")
    plots.plain_ticks(rough.xaxis, [0.02, 0.05, 0.1, 0.2])
    legend_below(growth, plots.VERDICTS.values())
    legend_below(rough, plots.ROUGHNESS.values())
    plots.save(figure, out)


def legend_below(axes: Any, looks: Collection[plots.Look]) -> None:
    axes.legend([Line2D([], [], ls="", ms=4, **look.style) for look in looks], [look.label for look in looks],
                loc="upper center", bbox_to_anchor=(0.5, -0.1), ncol=len(looks), frameon=False)


def summary(runs: list[Claim]) -> list[list[str]]:
    """A row a change: for each reading of the limit how many slid by both ends, the median ratio of efforts and the verdict over all runs; the other
    claims by the first reading."""
    of = groups(runs)
    zero, _, smooth, few = claims.NAMES
    rows = []
    for change in dict.fromkeys(change for _, change in of):
        row = [change]
        for reading in READINGS:
            own = of.get((reading, change), [])
            row += [f"{len(slid(own))} of {len(own)}", median(slid(own), "near_over_far"), over_runs(slid(own), GROWTH)]
        box = slid(of.get((next(iter(READINGS)), change), []))
        rows.append([*row, over_runs(box, zero), median(box, "roughness_space"), median(box, "roughness_time"), over_runs(box, smooth),
                     median(box, "dct_modes_95"), over_runs(box, few)])
    return rows


def median(runs: list[Claim], name: str) -> str:
    return f"{np.median([run[name] for run in runs]):.2g}" if runs else ""


def over_runs(runs: list[Claim], claim: str) -> str:
    return claims.over_runs([run[claim] for run in runs])


def main(folder: Path, out: Path) -> None:
    runs = taken_of_sweep(folder)
    draw(runs, out / "claims.png")
    tables.write_table(out, "claims", HEAD, summary(runs))


if __name__ == "__main__":
    run_script(__doc__, ["SWEEP", "OUT_FOLDER"], main)
