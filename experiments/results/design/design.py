"""Found programs: their tables and a picture of each knot.

Usage: design.py FOLDER KNOWN.csv. FOLDER is what study.sh leaves, KNOWN.csv the table of all searches as the page has it: of a
FOLDER without searches the other tables are made of it. A test makes them so. Needs the program as built (HAGFISH_PROGRAM).
"""

import datetime
import math
import tomllib
from collections.abc import Callable
from pathlib import Path

import numpy as np

import plots
import tables
from audits import read_findings, unmet
from hagfish_log import HagfishLog, LogError
from log_pictures import take_pictures
from script import run_script

LIVING, SURE = (Path(__file__).resolve().parents[1] / name for name in ("living/living.csv", "sure/sure.csv"))
OWN = "Table 1's"  # animal
RANDOM = "drawn at random"  # in the names of such animals
# Kinds of animals that tie it. Hagfish: A. Haney and T. Uyeno in New Scientist, 6 January 2020, and the paper. Morays: "A moray's many
# knots", of Gymnothorax prasinus, who also tie two bulkier knots that have no name here.
SEEN = {"3_1": "hagfish, morays", "4_1": "hagfish, morays", "5_1": "morays", "5_2": "hagfish"}
SIZE = "420x360"  # pixels of a picture
PANELS = 4  # pictures in a row
STEPS = ("0.001", "0.002", "0.005")  # s, of the audited runs
KEPT = ["knot_wanted", "seed", "found", "tries", "tied_in_soft_body", "try", "slower", "starts", "starts_by_eq6", "starts_by_reflex", "cpu_s",
        "wall_s", "slide_from_s", "slide_distance_cm", "both_ends_percent", "release_from_s", "free_from_s", "largest_active_dyn_cm",
        "largest_thigmotaxis_dyn_cm", "work_active_erg", "penetration_cm"]
LAWS = ("eq6", "reflex")
OF_LOG = ["length_cm", "body_in_knot_cm", "body_in_knot_diameters"]
Row = dict[str, str]
Cells = tuple[list[str], list[list[str]]]  # heading and rows of a table


def audited(folder: Path, step: str) -> str:
    """What the audit of the run at that step says: "clean", or what is not met."""
    findings = folder / f"step_{step}.csv"
    if not findings.exists():
        return "no log"
    return "; ".join(unmet(read_findings(findings))) or "clean"


def served(folder: Path, law: str) -> str:
    """Of ten animals that the search never saw, those in which the program does all that is asked of it; "" where none was tried."""
    table = folder / f"unseen_{law}" / "table.csv"
    if not table.exists():
        return ""
    return str(sum(row["outcome"] == "ok" and not row["unmet"] for row in tables.read_csv(table, ["outcome", "unmet"])))


def without_result(folder: Path) -> Row:
    """What there is of a search that wrote no result.csv: no path that tied the knot made a program."""
    lines = {name: (folder / f"{name}.csv").read_text(encoding="utf-8").splitlines() for name in ("tries", "candidates", "times")}
    wall, cpu = lines["times"][-1].split(",")
    return {"found": "no", "tries": str(len(lines["tries"])), "tied_in_soft_body": str(len(lines["candidates"])), "cpu_s": cpu, "wall_s": wall}


def of_log(log: HagfishLog) -> Row:
    """The body, and what of it lies between the knot's ends as it starts to slide; none of that in a run that does not."""
    length = log["/model/length"]
    diameter = 2 * float((log["/model/radius"] * length).sum() / length.sum())
    between = log["/knot/tail_end"] - log["/knot/head_end"]  # NaN where it has none
    slides = between[log.in_phase("slide")]
    body = float(slides[np.isfinite(slides)][0]) if np.isfinite(slides).any() else math.nan
    return {name: f"{value:.3g}" if math.isfinite(value) else "" for name,
            value in zip(OF_LOG, (float(length.sum()), body, body / diameter), strict=True)}


def read_study(folder: Path) -> tuple[list[Row], list[str]]:
    rows, results, revisions = [], [], set()
    for search in sorted(folder.glob("*/search.toml")):
        result = search.parent / "result.csv"
        what = tomllib.loads(search.read_text(encoding="utf-8"))
        revisions.add(what["revision"])
        animal = tomllib.loads(what["specimen"])
        beside = {"folder": search.parent.name, "revision": what["revision"], "animal": animal.get("name", ""),
                  "for_animals": "yes" if what.get("animals") else "no",
                  **{f"unseen_by_{law}": served(search.parent, law) for law in LAWS}}
        row = dict.fromkeys([*KEPT, *(f"audit_{step}_s" for step in STEPS), *beside, *OF_LOG], "")
        if result.exists():
            results.append(result)
            found = tables.read_csv(result, KEPT)[0]
            row |= {name: found[name] for name in KEPT} | {f"audit_{step}_s": audited(result.parent, step) for step in STEPS}
            row |= of_log(HagfishLog(search.parent / "knot.h5"))
        else:
            row |= {"knot_wanted": what["knot"], "seed": str(what["seed"])} | without_result(search.parent)
        rows.append(row | beside)
    if not results:
        raise LogError(f"{folder}: holds no folder with a result.csv")
    log = HagfishLog(results[0].parent / "knot.h5")
    date = datetime.datetime.fromtimestamp(results[0].stat().st_mtime, datetime.UTC)
    return rows, [f"Measured at {', '.join(sorted(revisions))} on {log.attribute('cpu')}, {date:%Y-%m-%d}."]


def number(text: str, digits: int = 3) -> str:
    return tables.short(float(text), f".{digits}g") if text else "-"


def passed(row: Row, law: str) -> str:
    return f"{row[f'starts_by_{law}']} of {row['starts']}" if row["starts"] not in ("", "0") else "-"


def animal(row: Row) -> str:
    return row["animal"].removeprefix("Pacific hagfish ") or OWN


of = lambda name: lambda row: row[name]
figure = lambda name, digits=3: lambda row: number(row[name], digits)
COLUMNS: dict[str, Callable[[Row], str]] = {  # of tables, by heading
    "knot": of("knot_wanted"), "animal": animal, "its name": of("animal"), "seed": of("seed"), "other animals asked for": of("for_animals"),
    "found": of("found"), "CPU time, s": figure("cpu_s"), "clock, s": figure("wall_s"), "paths tried": of("tries"),
    "paths that tied it": of("tied_in_soft_body"), "starts, Eq. 6": lambda row: passed(row, "eq6"),
    "starts, reflex": lambda row: passed(row, "reflex"), "of ten, Eq. 6": of("unseen_by_eq6"), "of ten, reflex": of("unseen_by_reflex"),
    "length, cm": figure("length_cm"), "times as slow": figure("slower"), "slides from, s": figure("slide_from_s"),
    "head end of the knot, cm": figure("slide_distance_cm", 2), "share of a slide of both ends, %": figure("both_ends_percent"),
    "untied at, s": figure("free_from_s"),
    "largest torque of f_thigmo, dyn cm": figure("largest_thigmotaxis_dyn_cm", 2),
    "work of active torques, erg": figure("work_active_erg", 2), "body in the knot, cm": figure("body_in_knot_cm"),
    "in mean diameters": figure("body_in_knot_diameters"), "largest active torque, dyn cm": figure("largest_active_dyn_cm", 2),
    "who is seen to tie it": lambda row: SEEN.get(row["knot_wanted"], "nobody"),
    "audit at 1 ms": of("audit_0.001_s"), "at 2 ms": of("audit_0.002_s"), "at 5 ms": of("audit_0.005_s")}
SEARCH = ["knot", "animal", "seed", "other animals asked for"]
AUDITS = ["audit at 1 ms", "at 2 ms", "at 5 ms"]


def table(rows: list[Row], head: list[str]) -> Cells:
    return ["animal" if name == "its name" else name for name in head], [[COLUMNS[name](row) for name in head] for row in rows]


def one_of_each(rows: list[Row]) -> list[Row]:
    """The found program of each knot that serves most other animals, knots in the order of their names; sums last."""
    best: dict[str, Row] = {}
    serves = lambda row: sum(int(row[f"unseen_by_{law}"] or 0) for law in LAWS)
    for row in rows:
        if row["found"] == "yes" and (row["knot_wanted"] not in best or serves(row) > serves(best[row["knot_wanted"]])):
            best[row["knot_wanted"]] = row
    return [best[knot] for knot in sorted(best, key=lambda knot: ("#" in knot, knot))]


def least_served(rows: list[Row]) -> int:
    """Of the ten animals that no search saw, by the law and the found program that serve fewest."""
    return min(int(row[f"unseen_by_{law}"]) for row in rows for law in LAWS if row["found"] == "yes")


def beside_table(rows: list[Row]) -> Cells:
    """The programs of data/ as the pages `living` and `sure` have them, and the found ones of the same knots."""
    living = tables.read_table(LIVING)
    stated = lambda what, knot: next(row for row in living.rows if row[0].startswith(what))[living.head.index(knot)]
    sure = tables.read_table(SURE)
    torque = {row[0]: row[sure.head.index("as it is")] for row in sure.rows}
    found = {row["knot_wanted"]: row for row in one_of_each([row for row in rows if not row["animal"]])}
    scenes, lines = {knot: scene for scene, knot in plots.SCENES.items()}, []
    for knot in living.head[1:]:
        lines.append([knot, "of data/", stated("of 10 other animals", knot).split(";")[1].strip(),
                      number(torque[f"living_{scenes[knot]}: largest torque of muscles, dyn cm"], 2), stated("clamped: way", knot).split(";")[0]])
        if knot in found:
            lines.append([knot, "found", found[knot]["unseen_by_eq6"] or "-",
                          number(found[knot]["largest_active_dyn_cm"], 2), number(found[knot]["slide_distance_cm"], 2)])
    return ["knot", "program", "other animals that it serves, of ten", "largest torque of the muscles, dyn cm", "head end of the knot, cm"], lines


def share(rows: list[Row]) -> str:
    return f"{sum(row['found'] == 'yes' for row in rows)} of {len(rows)}"


def figures_table(rows: list[Row], others: list[Row]) -> Cells:
    """What sentences of the page say and no other table has."""
    asked = [row for row in rows if row["for_animals"] == "yes"]
    own = [row for row in rows if row["for_animals"] == "no"]
    small = [row for row in own if not row["animal"] and row["knot_wanted"] in SEEN]
    slender = [row for row in own if row["animal"]]
    longest = lambda some: str(math.ceil(max(float(row["cpu_s"]) for row in some if row["found"] == "yes")))
    return ["figure", "value"], [
        ["small knots that were found", share(small)],
        ["small knots: longest search, s", longest(small)],
        ["slender animal's knots that were found", share(slender)],
        ["slender animal's knots: longest search, s", longest(slender)],
        ["slender animal's knots by name", ", ".join(row["knot_wanted"] for row in one_of_each(slender))],
        ["random animals with a 4_1", share(others)],
        ["programs for other animals that were found", share(asked)],
        ["unseen animals that a program for others serves, at least", str(least_served(asked))]]


def page_tables(every: list[Row]) -> dict[str, Cells]:
    """The page's tables of all searches."""
    order = lambda row: (row["animal"] != "", "#" in row["knot_wanted"], row["knot_wanted"], row["seed"],
                         row["for_animals"])
    rows = sorted((row for row in every if RANDOM not in row["animal"]), key=order)
    others = sorted((row for row in every if RANDOM in row["animal"]),
                    key=lambda row: (len(row["animal"]), row["animal"]))
    found = [row for row in rows if row["found"] == "yes"]
    cost = ["found", "CPU time, s", "clock, s", "paths tried"]
    return {"found": table(rows, [*SEARCH, *cost, "paths that tied it", "starts, Eq. 6", "starts, reflex"]),
            "gallery": table(one_of_each(rows), ["knot", "animal", "body in the knot, cm", "in mean diameters",
                                                 "largest active torque, dyn cm", "who is seen to tie it"]),
            "needs": table(found, [*SEARCH, "times as slow", "slides from, s", "head end of the knot, cm",
                                   "share of a slide of both ends, %", "untied at, s",
                                   "largest torque of f_thigmo, dyn cm", "work of active torques, erg", *AUDITS]),
            "unseen": table([row for row in found if row["unseen_by_eq6"]], [*SEARCH, "of ten, Eq. 6", "of ten, reflex"]),
            "beside": beside_table(rows),
            "animals": table(others, ["its name", "length, cm", *cost, "starts, Eq. 6", "starts, reflex", *AUDITS]),
            "figures": figures_table(rows, others)}


def draw_gallery(folder: Path, rows: list[Row], out: Path) -> None:
    kept = one_of_each([row for row in rows if RANDOM not in row["animal"]])
    figure, axes = plots.plt.subplots(math.ceil(len(kept) / PANELS), PANELS,
                                      figsize=(11, 2.3 * math.ceil(len(kept) / PANELS)), squeeze=False)
    for panel in axes.flat:
        panel.set_axis_off()
    for panel, row in zip(axes.flat, kept):
        log = folder / row["folder"] / "knot.h5"
        slides = HagfishLog(log)["/trajectory/time"][HagfishLog(log).in_phase("slide")]
        panel.imshow(take_pictures(log, slides[:1], "--size", SIZE)[0].pixels)
        panel.set_title(f"{row['knot_wanted']}: {float(row['body_in_knot_cm']):.0f} of {float(row['length_cm']):.0f} cm")
    figure.tight_layout(pad=0.4)
    plots.save(figure, out)


def main(folder: Path, known: Path) -> None:
    if list(folder.glob("*/search.toml")):
        rows, notes = read_study(folder)
        draw_gallery(folder, rows, folder / "design.png")
    else:
        table = tables.read_table(known)
        rows, notes = [dict(zip(table.head, row)) for row in table.rows], table.notes
    tables.write_table(folder, "design", list(rows[0]), [[row[name] for name in rows[0]] for row in rows], notes)
    for name, cells in page_tables(rows).items():
        tables.write_table(folder, f"design_{name}", *cells, notes)


if __name__ == "__main__":
    run_script(__doc__, ["FOLDER", "KNOWN.csv"], main)
