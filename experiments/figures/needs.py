"""What each choice of the Table 1 scene costs and buys: the run with one choice changed, against the scene as it is.

Usage: needs.py RUNS OUT.csv OUT.png (writes a PDF beside).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import plots
from hagfish_log import LogError
from script import run_script
from study import Run, read_runs
from tables import write_csv
from whole_runs import CHANCE_STEPS, chance

AS_IS = "as_is"
# Run, the choice as it is, what is tried instead.
CHOICES = {
    "bodies_25": ("100 bodies", "25"), "bodies_50": ("100 bodies", "50"), "bodies_200": ("100 bodies", "200"),
    "violated": ("speculative rows", "violated rows only"),
    "margin_0.06": ("rows from a gap of 0.1 cm", "0.06 cm"), "margin_0.3": ("rows from a gap of 0.1 cm", "0.3 cm"),
    "least_arc_2.12": ("contacts 2.97 cm of body apart", "2.12 cm"),
    "least_arc_4.24": ("contacts 2.97 cm of body apart", "4.24 cm"),
    "no_stiffness": ("joint stiffness", "none"), "no_drag": ("water drag", "none"),
    "baumgarte_0.2": ("half a violation pushed out", "a fifth"), "baumgarte_1": ("half a violation pushed out", "all"),
    "no_corrections": ("steps corrected along their path", "not corrected"),
    "cap_1000": ("thigmotaxis up to 5000 dyn", "1000 dyn"), "no_cap": ("thigmotaxis up to 5000 dyn", "no cap"),
    "votes_5": ("15 votes on the knot", "5"), "votes_45": ("15 votes on the knot", "45"),
    "no_wall": ("head plate", "none"),
}
LEAST_SAVING = 0.1  # of CPU time, to change what works
LEAST_FACTOR = 2  # of penetration, to count as deeper
LEAST_FORCE = 2  # times what chance makes of the sliding force, to count as another


@dataclass
class Need:
    choice: str
    instead: str
    run: Run
    cpu: float  # over that of the scene as it is
    slide: float  # cm more
    force: float  # % more
    verdict: str


def verdict_of(run: Run, as_is: Run, least_force: float) -> str:
    """Keep or change, and why, from the figures alone."""
    saving = 1 - run.cpu / as_is.cpu
    if run.failure:
        return f"keep: else {run.failure}"
    if run.unmet:
        return f"keep: else the audit fails ({', '.join(run.unmet)})"
    if run.penetration > LEAST_FACTOR * as_is.penetration:
        return f"keep: else {run.penetration / as_is.penetration:.1f} times the penetration"
    force = 100 * (run.force / as_is.force - 1)
    if abs(force) > least_force:
        return f"keep: else the sliding force is {force:+.0f} %"
    if run.penetration < as_is.penetration / LEAST_FACTOR and saving > -LEAST_SAVING:
        return (f"change: {as_is.penetration / run.penetration:.1f} times less penetration at "
                f"{run.cpu / as_is.cpu:.2f} of the time")
    same = (run.slide, run.force, run.penetration) == (as_is.slide, as_is.force, as_is.penetration)
    if same and abs(saving) < LEAST_SAVING:
        return "keep: the same motion to the last bit, at no other cost"
    if saving >= LEAST_SAVING:
        return f"change: saves {100 * saving:.0f} %"
    if saving <= -LEAST_SAVING:
        return f"keep: else {-100 * saving:.0f} % more time for {'the same motion' if same else 'no gain that counts'}"
    return "keep: no difference that counts"


def needs(folder: Path) -> tuple[Run, list[Need]]:
    """The scene as it is, and what each change makes of it; forces are compared with what chance makes of them."""
    runs = {run.name.removeprefix("need_"): run for run in read_runs(folder, "need")}
    missing = {AS_IS, *CHOICES} - set(runs)
    if missing:
        raise LogError(f"{folder}: has no run need_{sorted(missing)[0]}")
    as_is = runs[AS_IS]
    least_force = LEAST_FORCE * max(chance(folder, step).force for step in CHANCE_STEPS)
    return as_is, [Need(choice, instead, run, run.cpu / as_is.cpu, run.slide - as_is.slide,
                        100 * (run.force / as_is.force - 1), verdict_of(run, as_is, least_force))
                   for (choice, instead), run in ((texts, runs[name]) for name, texts in CHOICES.items())]


def draw(panel: Any, found: list[Need], value: Callable[[Need], float], base: float, costs: bool) -> None:
    """A bar for each choice, from what the scene as it is has; a failed run has a cost alone."""
    for row, need in enumerate(found):
        if not need.run.failure:
            panel.barh(row, value(need) - base, left=base, color=plots.BLUE, height=0.6)
        elif costs:
            panel.barh(row, value(need) - base, left=base, color="white", edgecolor=plots.VERMILION, hatch="////", height=0.6)
        else:
            panel.text(0.03, row, "failed", transform=panel.get_yaxis_transform(), va="center", color=plots.VERMILION)
    panel.axvline(base, color=plots.INK, lw=0.9)
    panel.grid(axis="y", visible=False)


def main(folder: Path, csv: Path, png: Path) -> None:
    as_is, found = needs(folder)
    heading = ["choice", "instead", "cpu_ratio", "slide_change_cm", "force_change_percent", "penetration_cm", "outcome",
               "audit_fails", "verdict"]
    own = ["as it is", "", 1.0, 0.0, 0.0, as_is.penetration, as_is.failure or "slid", "; ".join(as_is.unmet), ""]
    write_csv(csv, heading, [own] +
              [[n.choice, n.instead, n.cpu, n.slide, n.force, n.run.penetration, n.run.failure or "slid",
                "; ".join(n.run.unmet), n.verdict] for n in found])

    columns = [("CPU time, of the scene's as it is", lambda n: n.cpu, 1), ("change in slide, cm", lambda n: n.slide, 0),
               ("change in sliding force, %", lambda n: n.force, 0),
               ("deepest penetration, cm", lambda n: n.run.penetration, as_is.penetration)]
    figure, panels = plots.panels(1, 4, (12, 6.4), ["cost", "slide", "force", "penetration"], sharey=True,
                                  gridspec_kw={"width_ratios": [1.2, 1, 1, 1.2]})
    for panel, (label, value, base) in zip(panels, columns):
        draw(panel, found, value, base, costs=panel is panels[0])
        panel.set_xlabel(label)
    # Three choices change slide and force ten to a hundred times as much as the rest: linear near 0 alone.
    for panel, least, ends in ((panels[1], 0.01, (-0.5, 0.8)), (panels[2], 1, (-60, 60))):
        panel.set_xscale("symlog", linthresh=least, linscale=0.5)
        panel.set_xlim(ends)
    panels[3].set_xscale("log")
    panels[3].set_xlim(as_is.penetration / 4)
    panels[0].set_yticks(range(len(found)), [f"{n.choice} → {n.instead}" for n in found])
    panels[0].invert_yaxis()
    plots.save(figure, png)


if __name__ == "__main__":
    run_script(__doc__, ["RUNS", "OUT.csv", "OUT.png"], main)
