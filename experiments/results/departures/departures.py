"""What each departure from the paper changes: the scenes of changes.toml with a grid of them, and tables of what the study leaves.

Usage: departures.py scenes|tables FOLDER
"""

import json
import math
import tomllib
from pathlib import Path

import tables
from accuracy import cpu_of
from script import run_script
from sweep_columns import read_sweep

HERE = Path(__file__).parent
DATA = HERE.parents[2] / "data"
PRINTED = "table1_as_printed"
FIGURES = {  # heading: column of a sweep, its form, what it is multiplied by
    "knot off the head at, s": ("free_from_s", ".1f", 1), "head end of the knot, cm": ("slide_distance_cm", ".1f", 1),
    "its tail end, cm": ("tail_distance_cm", ".1f", 1), "taper asks, cm": ("taper_asks_cm", ".1f", 1),
    "curvature travels, cm": ("curvature_travel_cm", ".1f", 1), "share of a slide of both ends, %": ("both_ends_percent", ".0f", 1),
    "steps that meet Eq. 6, %": ("eq6_percent", ".1f", 1), "penetration, cm": ("penetration_cm", ".2g", 1),
    "past a limit, °": ("limit_violation_rad", ".2g", math.degrees(1)),
    "largest f_thigmo, dyn cm": ("largest_thigmotaxis_dyn_cm", ".0f", 1),
    "sum of multipliers, dyn": ("sliding_force_dyn", ".0f", 1), "work of f_thigmo, erg": ("work_thigmotaxis_erg", ".0f", 1),
    "CPU, s": ("cpu_s", ".2g", 1)}
ALONE = {"ipopt": "Ipopt for the quadratic programs", "explicit": "springs by the angles at the start of a step, by a law in Python"}  # folders
SLID = ("head end of the knot, cm", "largest f_thigmo, dyn cm", "sum of multipliers, dyn",
        "work of f_thigmo, erg")  # 0 means nothing where no knot slid


def became(run: dict[str, str]) -> str:
    """What the slide is by name, or why there is none."""
    return run["slide"] or {"never tied": "never tied", "knot lost": "lost"}.get(run["outcome"], f"stopped: {run['outcome']}")


def shown(runs: list[dict[str, str]], heading: str) -> str:
    """The figure of a run, or the least to the largest of several."""
    column, form, factor = FIGURES[heading]
    return tables.span((factor * float(run[column]) for run in runs if run[column] and (run["slide"] or heading not in SLID)), form) or "-"


def read_runs(folder: Path) -> list[dict[str, str]]:
    """Every run of the study: its scene's base and title, its figures, and cpu_s."""
    sweep, times = folder / "sweep/table.csv", tables.read_csv(folder / "sweep/times.csv", ["cpu_s"])
    read_sweep(sweep)  # of this version
    runs = []
    for run, time in zip(tables.read_csv(sweep, ["scene"]), times):
        scene = tomllib.loads((folder / "scenes" / Path(run["scene"]).name).read_text(encoding="utf-8"))
        runs.append(run | time | {"base": Path(scene["base"]).stem, "title": scene["title"]})
    for way, title in ALONE.items():
        for scene in ("table1", PRINTED):
            cpu = cpu_of(folder / way / f"{scene}.cpu")
            summary = tables.read_csv(folder / way / scene / "summary.csv", ["slide"])[0]
            runs.append(summary | {"outcome": summary["status"], "base": scene, "title": title, "cpu_s": str(cpu)})
    return runs


def toml(value: object) -> str:
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{key} = {toml(one)}" for key, one in value.items()) + " }"
    return json.dumps(value, ensure_ascii=False)


def scenes(folder: Path) -> None:
    """A file for each change of each scene and start, and grid.toml of them all."""
    (folder / "scenes").mkdir(exist_ok=True)
    known, names = tomllib.loads((HERE / "changes.toml").read_text(encoding="utf-8")), []
    for change in known["change"]:
        for start in range(1, 1 + change.get("starts", 1)):
            for base in change.get("of", known["both"]):
                scene = {"base": base, "title": change["title"]} | change.get("set", {}) | ({"start.seed": start} if "starts" in change else {})
                if "script" in change:
                    scene["script"] = tomllib.loads((DATA / f"{change['script']}.toml").read_text(encoding="utf-8"))["script"]
                names.append(f"scenes/{101 + len(names)}.toml")
                text = "".join(f"{key} = {toml(value)}\n" for key, value in scene.items())
                (folder / names[-1]).write_text(text, encoding="utf-8")
    (folder / "grid.toml").write_text(f"[[axis]]\nscene = {toml(names)}\n", encoding="utf-8")


def tables_of(folder: Path) -> None:
    runs = read_runs(folder)
    for name, scene in (("departures", "table1"), ("departures_as_printed", PRINTED)):
        own = [run for run in runs if (run["base"] == PRINTED) == (scene == PRINTED)]
        rows = []
        for title in dict.fromkeys(run["title"] for run in own):
            same = [run for run in own if run["title"] == title]
            rows.append([title, ", ".join(dict.fromkeys(map(became, same))), *(shown(same, heading) for heading in FIGURES)])
        tables.write_table(folder, name, [f"{scene} with", "the knot", *FIGURES], rows)


def main(what: str, folder: Path) -> None:
    {"scenes": scenes, "tables": tables_of}[what](folder)


if __name__ == "__main__":
    run_script(__doc__, ["WHAT", "FOLDER"], main)
