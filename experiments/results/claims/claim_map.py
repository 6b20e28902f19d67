"""Where the paper's three claims about the sliding force hold: over readings of the bending limit, its scale, where the
knot is let go, stiffness and drag, each from several starts and at two steps.

Usage: claim_map.py RUNS OUT_FOLDER, where RUNS holds READING_CHANGE_STEP_SEED.csv.
"""

from collections.abc import Collection
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.lines import Line2D

import claims
import plots
import tables
from claim_row import HEADING, MEASURES
from hagfish_log import LogError
from script import run_script

GROWTH = claims.NAMES[1]
CHANGES = {"as-it-is": "Table 1", "scale": "limits ×", "release": "let go at, cm:", "waypoints": "waypoints",
           "stiffness": "same, stiffness ×",
           "drag": "same, drag ×"}
READINGS = {"box": "limit on each axis (box)", "cone": "limit on the total angle (cone)"}
HEAD = ["what is changed", "box: slid", "effort near over far", "larger near the head?", "cone: slid",
        "effort near over far by cones", "larger near the head by cones?", "zero behind?", "roughness along the body", "in time",
        "smooth, noisy in time?", "Fourier modes for 95 %, of 50", "a few would do?"]


@dataclass
class Claim:
    """One run."""

    reading: str
    change: str  # as CHANGES has it, with its value
    step: float  # s
    seed: int
    outcome: str
    verdict: dict[str, str]
    measure: dict[str, float]


def read_claims(folder: Path) -> list[Claim]:
    runs = []
    for path in sorted(folder.glob("*_*_*.csv")):
        reading, change, step, seed = path.stem.split("_")
        row = tables.read_csv(path, HEADING)[0]
        kind, _, value = (change, "", "") if change in CHANGES else change.partition("-")
        label = f"{CHANGES[kind]} {value}".strip()
        runs.append(Claim(reading, label, float(step), int(seed), row["outcome"],
                          {name: row[name] for name in claims.NAMES}, {name: float(row[name]) for name in MEASURES}))
    if not runs:
        raise LogError(f"{folder}: holds no run")
    return runs


def groups(runs: list[Claim]) -> list[tuple[str, str]]:
    """Readings and changes in the order of the figure."""
    order = list(CHANGES.values())
    def place(key: tuple[str, str]) -> tuple[int, int, float]:
        kind = next(i for i, name in enumerate(order) if key[1].startswith(name))
        value = key[1].removeprefix(order[kind]).strip()
        return list(READINGS).index(key[0]), kind, float(value) if value else 0.0
    return sorted({(run.reading, run.change) for run in runs}, key=place)


def of_group(runs: list[Claim], key: tuple[str, str]) -> list[Claim]:
    return [run for run in runs if (run.reading, run.change) == key]


def draw(runs: list[Claim], out: Path) -> None:
    keys = groups(runs)
    height = {key: -i - 1.2 * list(READINGS).index(key[0]) for i, key in enumerate(keys)}
    figure, (growth, rough) = plots.panels(1, 2, (8.6, 0.8 + 0.235 * (len(keys) + 2)), [
        "larger near the head?", "smooth along the body, noisy in time?"], sharey=True, gridspec_kw={"width_ratios": [1.3, 1]})
    finest = min(run.step for run in runs)
    for key, y in height.items():
        slid = [run for run in of_group(runs, key) if run.outcome == "slid"]
        for run in slid:
            shift = 0.16 if run.step == finest else -0.16
            growth.plot(run.measure["near_over_far"], y + shift, ms=3.6, mew=0, alpha=0.8, **plots.VERDICTS[run.verdict[GROWTH]].style)
            for shift, (name, look) in zip((0.16, -0.16), plots.ROUGHNESS.items()):
                rough.plot(run.measure[f"roughness_{name}"], y + shift, ms=3, mew=0, alpha=0.7, **look.style)
        count = f"{len(slid)} of {len(of_group(runs, key))}"
        growth.text(1.005, y, count, transform=growth.get_yaxis_transform(), fontsize=7, va="center", color=plots.GREY)
    for reading, title in READINGS.items():
        tops = [y for key, y in height.items() if key[0] == reading]
        if tops:
            growth.text(0.01, max(tops) + 0.72, title, transform=growth.get_yaxis_transform(), fontsize=8.5, weight="bold")
    growth.axvline(1, color=plots.GREY, lw=0.8, ls="--", zorder=0)
    growth.set(xscale="log", xlabel="effort in the third nearest the head\nover that in the furthest third")
    growth.set_yticks(list(height.values()), [key[1] for key in keys])
    growth.set_ylim(min(height.values()) - 0.7, 1.3)
    growth.set_title("slid", loc="right", fontsize=7, color=plots.GREY, x=1.08)
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
    """A row a change: for each reading of the limit how many slid, the median ratio of efforts and the verdict over all runs; the other
    claims by the first reading."""
    rows = []
    for change in dict.fromkeys(change for _, change in groups(runs)):
        row = [change]
        for reading in READINGS:
            own = of_group(runs, (reading, change))
            slid = [run for run in own if run.outcome == "slid"]
            row += [f"{len(slid)} of {len(own)}", median(slid, "near_over_far"), over_runs(slid, GROWTH)]
        slid = [run for run in of_group(runs, (next(iter(READINGS)), change)) if run.outcome == "slid"]
        rows.append([*row, over_runs(slid, claims.NAMES[0]), median(slid, "roughness_space"), median(slid, "roughness_time"),
                     over_runs(slid, claims.NAMES[2]),
                     median(slid, "dct_modes_95"), over_runs(slid, claims.NAMES[3])])
    return rows


def median(runs: list[Claim], name: str) -> str:
    return f"{np.median([run.measure[name] for run in runs]):.2g}" if runs else ""


def over_runs(runs: list[Claim], claim: str) -> str:
    return claims.over_runs([run.verdict[claim] for run in runs])


def main(folder: Path, out: Path) -> None:
    runs = read_claims(folder)
    draw(runs, out / "claims.png")
    tables.write_table(out, "claims", HEAD, summary(runs))


if __name__ == "__main__":
    run_script(__doc__, ["RUNS", "OUT_FOLDER"], main)
