"""Found programs: their table, their page and a picture of each knot.

Usage: design.py FOLDER OUT.csv OUT.md OUT.png. FOLDER is what study.sh leaves. The page is made of the table
alone: a test makes it again. Needs the program as built (HAGFISH_PROGRAM).
"""

from __future__ import annotations

import csv
import datetime
import math
import tomllib
from pathlib import Path

import numpy as np

import plots
import tables
from audits import read_findings, unmet
from hagfish_log import HagfishLog, LogError
from log_pictures import pictures_of
from script import run_script

ROOT = Path(__file__).resolve().parents[3]
OWN = "Table 1's"  # animal
RANDOM = "drawn at random"  # in the names of such animals
# Kinds of animals that tie it. Hagfish: A. Haney and T. Uyeno in New Scientist, 6 January 2020, and the paper. Morays: "A moray's many
# knots", of Gymnothorax prasinus, who also tie two bulkier knots that have no name here.
SEEN = {"3_1": "hagfish, morays", "4_1": "hagfish, morays", "5_1": "morays", "5_2": "hagfish"}
SIZE, COLUMNS = "420x360", 4
STEPS = ("0.001", "0.002", "0.005")  # s, of the audited runs
KEPT = ["knot_wanted", "seed", "found", "tries", "tied_in_soft_body", "try", "slower", "starts", "starts_by_eq6", "starts_by_reflex", "cpu_s", "wall_s",
        "tighten_from_s", "slide_distance_cm", "release_from_s", "free_from_s", "largest_active_dyn_cm", "largest_thigmotaxis_dyn_cm",
        "work_active_erg", "penetration_cm"]
LAWS = ("eq6", "reflex")
OF_LOG = ["length_cm", "body_in_knot_cm", "body_in_knot_diameters"]
# By hand, of single searches by seed 1: not what this study measures.
TRIED = [
    ("all turns about lines fixed beforehand, for a 5_2, seed 1", "first 640 tries: 166 of 3_1, 71 of 4_1, 66 of 5_1, no 5_2"),
    ("all turns about strands where they then lie, the same", "first 5_2 by try 512; no 4_1 in 928 tries of another search"),
    ("turns that make the knot of a body at rest whose tail grows, the shortest of 100", "608 tries: 436 of 3_1, 42 of 5_1, no 4_1 and no 5_2"),
    ("a path of three quarters of the tries is drawn until the straight body with its tail on along it is the knot, for a 4_1",
     "first 64 tries: 30 of 3_1, none of 4_1"),
    ("programs of 20 stations, a time every 0.7 s", "try 23 of a 3_1 fails, by 0.019 rad of rms error; it ties at 25 and 0.35 s, by 0.010 rad"),
    ("a time every 0.2 or 0.1 s, for a square knot of the slender animal", "a path that is not tied at 0.35 s is tied by neither"),
    ("programs 1.5 times as slow, the same", "5 of 5 paths that are not tied still are not"),
    ("programs of the soft body's own pace, for a 6_3 of the slender animal, seed 1", "38 of 43 paths are not tied; 1.5 times as slow all 38 succeed"),
    ("a time every 0.2 s, for 18 paths of a granny", "all 18 are tied, 9 at 0.35 s; none slides well, one does at 0.35 s"),
    ("paths continued though the living body does not repeat them, for a granny, seed 2; a 7_1, seed 1; a 6_3, seed 1",
     "none in 185 s of CPU time, none in 193 s, found in 89 s; else found in 181 s, found in 87 s, none in 196 s"),
    ("no account of what failed in the living body, for a 6_1 of the slender animal, seed 2", "195 paths tied it in 226 s, all displaced from few; the living body ties none"),
    ("a sum led on from all types, not from its summands alone, for a square knot of the slender animal", "the first 544 tries tie none; else the first 576 tie a sum 67 times"),
    ("types of as many crossings as the wanted one led on from, too, for a 7_1 of the slender animal", "one search found it in 294 s of CPU time; another did not in 2592 tries"),
    ("programs kept whatever happens at steps of 1 and 2 ms and whatever the audit says",
     "2 of 29 fail: a 6_2 meets Eq. 6 in 70 % of the sliding steps of 1 ms, another is not untied in 9 of 126 frames at the end"),
    ("the knot taken up at steps of 10 ms, though it was found at 20 ms, for a 5_1", "12 of 14 paths lose it before it is tightened; at 20 ms none does"),
    ("other animals as they happen to be drawn, 0.89 to 1.07 times as thick for their length", "a 5_2 that serves nine of these serves 6 of the ten below, a 7_1 6; those of 1.08 to 1.10 fail"),
    ("the same of 40 others, one of each four in the order of thickness, 0.90 to 1.07 times as thick, for a square knot",
     "all ten of these are served, 6 of the ten below, which are up to 1.10 times as thick"),
    ("that square knot in the first 40 animals that are drawn as the ten below", "31 are served by each law, none of the seven that are at least 1.089 times as thick"),
    ("the square knot of seed 2 in the same 40", "27 by Eq. 6, 29 by the reflex; 12 of the 14 thinnest are not served, one of the 26 others"),
    ("the ten thickest of 40 asked for, not ten as thick as animals at large", "a 3_1, 4_1, 5_1, 5_2 serve 9, 10, 10, 8 of the ten below by each law; the square knot is the same, 6"),
    ("20 animals, each the middle one of 20 of 400 in the order of thickness; 19 must be served from starts with noise",
     "another square knot serves ten of the ten below, 37 and 39 of 40; a 3_1 6 and 10; no 5_2 in 802 s by the clock, beside other searches"),
    ("five thickest of 100 and five that lag most behind in water; eight of these ten must be served", "the square knot of the row before; no 5_2 in 483 s, beside another search, at most 7 and 8 of ten"),
    ("nine of the ten as now, and 16 of 20 with the five thickest and the five slowest of 80", "a square knot serves 8 of the ten below by each law; no 5_2 in 717 s, beside another search, at most 15 and 16 of 20"),
    ("the animal's own body led for a program that serves others, a 5_2", "1632 tries in 1367 s of CPU time: at most 2 of 4 other animals by each law; by turns with the thickest found by try 545"),
    ("the same, and each program tried in all ten", "928 tries in 637 s: at most 6 and 7 of 10"),
    ("only the thickest other animal led, for a 4_1, seed 1", "17 of 1472 tries tie it, none slides far enough; by turns with the own body found by try 42"),
    ("the same, for a square knot", "606 of 9824 tries tie it, the best serves 8 and 10 of 10; by turns found by try 781"),
    ("curvature displaced at 36 places and times by 0.4 or 1 rad per body length, of the best of these", "60 programs, none serves more animals"),
]
Row = dict[str, str]


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
    """What there is of a search that wrote no result.csv: no path could be tightened."""
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
    return {name: f"{value:.3g}" if math.isfinite(value) else "" for name, value in zip(OF_LOG, (float(length.sum()), body, body / diameter), strict=True)}


def read_study(folder: Path) -> tuple[list[Row], list[str]]:
    rows = []
    results = []
    revisions = set()
    for search in sorted(folder.glob("*/search.toml")):
        result = search.parent / "result.csv"
        what = tomllib.loads(search.read_text(encoding="utf-8"))
        revisions.add(what["revision"])
        animal = tomllib.loads(what["specimen"])
        beside = {"folder": search.parent.name, "revision": what["revision"], "animal": animal.get("name", ""), "for_animals": "yes" if what.get("animals") else "no",
                  **{f"unseen_by_{law}": served(search.parent, law) for law in LAWS}}
        if result.exists():
            results.append(result)
            row = tables.read_csv(result, KEPT)[0]
            rows.append({**{name: row[name] for name in KEPT}, **{f"audit_{step}_s": audited(result.parent, step) for step in STEPS}, **beside,
                         **of_log(HagfishLog(search.parent / "knot.h5"))})
        else:
            rows.append({**dict.fromkeys([*KEPT, *(f"audit_{step}_s" for step in STEPS), *OF_LOG], ""), "knot_wanted": what["knot"],
                         "seed": str(what["seed"]), **without_result(search.parent), **beside})
    if not results:
        raise LogError(f"{folder}: holds no folder with a result.csv")
    log = HagfishLog(results[0].parent / "knot.h5")
    date = datetime.datetime.fromtimestamp(results[0].stat().st_mtime, datetime.UTC)
    return rows, [f"Measured at {', '.join(sorted(revisions))} on {log.attribute('cpu')}, {date:%Y-%m-%d}."]


def read_table(path: Path) -> tuple[list[Row], list[str]]:
    with path.open(newline="", encoding="utf-8") as file:
        lines = file.readlines()
    notes = [line[2:].rstrip("\n") for line in lines if line.startswith("# ")]
    return list(csv.DictReader(line for line in lines if not line.startswith("#"))), notes


def number(text: str, digits: int = 3) -> str:
    return f"{float(text):.{digits}g}".replace("e+0", "e") if text else "-"


def passed(row: Row, law: str) -> str:
    return f"{row[f'starts_by_{law}']} of {row['starts']}" if row["starts"] not in ("", "0") else "-"


def animal(row: Row) -> str:
    return row["animal"].removeprefix("Pacific hagfish ") or OWN


def found_table(rows: list[Row]) -> list[str]:
    head = ["knot", "animal", "seed", "other animals asked for", "found", "CPU time, s", "clock, s", "paths tried", "paths that tied it",
            "starts, Eq. 6", "starts, reflex"]
    return tables.markdown(head, [[row["knot_wanted"], animal(row), row["seed"], row["for_animals"], row["found"], number(row["cpu_s"]), number(row["wall_s"]),
                                   row["tries"], row["tied_in_soft_body"], passed(row, "eq6"), passed(row, "reflex")] for row in rows])


def unseen_table(rows: list[Row]) -> list[str]:
    head = ["knot", "animal", "seed", "other animals asked for", "of ten, Eq. 6", "of ten, reflex"]
    return tables.markdown(head, [[row["knot_wanted"], animal(row), row["seed"], row["for_animals"], *(row[f"unseen_by_{law}"] for law in LAWS)]
                                  for row in rows if row["found"] == "yes" and row["unseen_by_eq6"]])


def animals_table(rows: list[Row]) -> list[str]:
    head = ["animal", "length, cm", "found", "CPU time, s", "clock, s", "paths tried", "starts, Eq. 6", "starts, reflex", "audit at 1 ms",
            "at 2 ms", "at 5 ms"]
    return tables.markdown(head, [[row["animal"], number(row["length_cm"]), row["found"], number(row["cpu_s"]), number(row["wall_s"]), row["tries"],
                                   passed(row, "eq6"), passed(row, "reflex"), *(row[f"audit_{step}_s"] for step in STEPS)] for row in rows])


def needs_table(rows: list[Row]) -> list[str]:
    head = ["knot", "animal", "seed", "other animals asked for", "times as slow", "tightened from, s", "way, cm", "untied at, s", "largest torque of f_thigmo, dyn cm",
            "work of active torques, erg", "audit at 1 ms", "at 2 ms", "at 5 ms"]
    return tables.markdown(head, [[row["knot_wanted"], animal(row), row["seed"], row["for_animals"], number(row["slower"]), number(row["tighten_from_s"]),
                                   number(row["slide_distance_cm"], 2), number(row["free_from_s"]), number(row["largest_thigmotaxis_dyn_cm"], 2),
                                   number(row["work_active_erg"], 2), *(row[f"audit_{step}_s"] for step in STEPS)] for row in rows if row["found"] == "yes"])


def one_of_each(rows: list[Row]) -> list[Row]:
    """The found program of each knot that serves most other animals, knots in the order of their names; sums last."""
    best: dict[str, Row] = {}
    serves = lambda row: sum(int(row[f"unseen_by_{law}"] or 0) for law in LAWS)
    for row in rows:
        if row["found"] == "yes" and (row["knot_wanted"] not in best or serves(row) > serves(best[row["knot_wanted"]])):
            best[row["knot_wanted"]] = row
    return [best[knot] for knot in sorted(best, key=lambda knot: ("#" in knot, knot))]


def least_served(rows: list[Row]) -> int:
    """By any of these programs and either law, of the ten animals that no search saw."""
    return min(int(row[f"unseen_by_{law}"]) for row in rows for law in LAWS)


def gallery_table(rows: list[Row]) -> list[str]:
    head = ["knot", "animal", "body in the knot, cm", "in mean diameters", "largest active torque, dyn cm", "who is seen to tie it"]
    return tables.markdown(head, [[row["knot_wanted"], animal(row), number(row["body_in_knot_cm"]), number(row["body_in_knot_diameters"]),
                                   number(row["largest_active_dyn_cm"], 2), SEEN.get(row["knot_wanted"], "nobody")] for row in one_of_each(rows)])


def beside_table(rows: list[Row]) -> list[str]:
    """The programs of data/ as the page `living` has them, and the found ones of the same knots."""
    with (ROOT / "experiments/results/living.csv").open(newline="", encoding="utf-8") as file:
        head, *figures = csv.reader(line for line in file if not line.startswith("#"))
    of = lambda what, knot: next(row for row in figures if row[0].startswith(what))[head.index(knot)]
    larger = lambda torques: max(torques.split("; "), key=float)
    found = {row["knot_wanted"]: row for row in one_of_each([row for row in rows if not row["animal"]])}
    lines = []
    for knot in head[1:]:
        lines.append([knot, "of data/", of("of 10 other animals", knot), larger(of("largest torque of a hinge", knot)), of("clamped: way", knot).split(";")[0]])
        if knot in found:
            lines.append([knot, "found", found[knot]["unseen_by_eq6"] or "-", number(found[knot]["largest_active_dyn_cm"], 2),
                          number(found[knot]["slide_distance_cm"], 2)])
    return tables.markdown(["knot", "program", "other animals that it serves, of ten", "largest torque, dyn cm", "way, cm"], lines)


def share(rows: list[Row]) -> str:
    return f"{sum(row['found'] == 'yes' for row in rows)} of {len(rows)}"


def page(all_rows: list[Row], notes: list[str]) -> list[str]:
    rows = sorted((row for row in all_rows if RANDOM not in row["animal"]),
                  key=lambda row: (row["animal"] != "", "#" in row["knot_wanted"], row["knot_wanted"], row["seed"], row["for_animals"]))
    others = sorted((row for row in all_rows if RANDOM in row["animal"]), key=lambda row: (len(row["animal"]), row["animal"]))
    own = [row for row in rows if not row["animal"]]
    small = [row for row in own if row["knot_wanted"] in SEEN]
    slender = [row for row in rows if row["animal"]]
    longest = lambda some: math.ceil(max((float(row["cpu_s"]) for row in some if row["found"] == "yes"), default=0))
    answer = f"It does. Searches for knots of up to five crossings found them in {share(small)} cases, each within {longest(small)} s of CPU time."
    if slender:
        names = ", ".join(row["knot_wanted"] for row in one_of_each(slender))
        answer += (f" An animal 1.5 times as slender ties larger knots, too: {share(slender)} searches found theirs, each within {longest(slender)} s. "
                   f"These are {names}.")
    if others:
        answer += f" For {share(others)} random animals a 4_1 was found."
    asked = [row for row in rows if row["for_animals"] == "yes" and row["found"] == "yes"]
    if asked:
        answer += f" Found with `--animals`, a knot serves at least {least_served(asked)} of ten animals that the search never saw, by each law."
    return [
        "# From a knot's name to an animal that ties it", "",
        "`bash study.sh` makes this page and [its table](design.csv). " + " ".join(notes), "",
        "**Question.** Does a body find out by itself how to knot itself?", "",
        f"**Answer.** {answer}", "",
        "## How it is found", "",
        "1. A hand leads the tail of an animal with a soft body. The tail winds about strands near it, which are drawn at random. "
        "Half of the paths wind about lines where strands lie before anything moves.",
        "2. A path on which some knot was seen is continued in other ways. It is drawn by type, so that rare knots are continued as often as common ones. "
        "Of each type the paths that leave most of the tail are kept. A third of the continuations first leads the tail off the body, which tightens the knot.",
        "3. Before a path is continued, its shapes so far become a program. The animal of measured stiffness must tie the same by it. "
        "If the result must serve other animals, four of these must, too. Then the thickest of these is led in every second try, since its strands keep apart.",
        "4. As soon as the wanted knot is seen twice, 0.4 s apart, the tail is pulled on to where it points. Such paths are then displaced at random.",
        "5. The soft body is tightened. Its shapes become a curvature program of 25 stations, a time every 0.35 s.",
        "6. The animal of measured stiffness ties itself by that program, without a hand. The knot slides by Eq. 6, then by the reflex. "
        "Where this does not succeed, the program is made 1.5 times as slow. "
        "A path is continued less often the more of its programs have failed here.",
        "7. A program is kept if at least 19 of 20 starts succeed by each law. Starts have normal noise of 3 degrees on every hinge. "
        "The run from a straight start must also succeed at steps of 1 and 2 ms, and pass the audit.", "",
        "No script and no program of `data/` is a start of the search. The head is clamped.", "",
        "## What was found", "",
        *found_table(rows),
        "Times hold everything: the search, the fit and all runs of the starts. The machine was shared, so compare CPU times.", "",
        "## What a hagfish could tie", "",
        "![Each knot as it starts to slide to the head](../figures/design.png)", "",
        "The pictures show each knot as it starts to slide. The body in the knot lies between the first and the last contact.", "",
        *gallery_table(rows),
        "Hagfish are seen to tie knots of up to five crossings (A. Haney and T. Uyeno). The moray *Gymnothorax prasinus* ties the overhand most, and two bulkier knots without a name here. "
        "Larger knots were found for a longer body only, of the same girth and muscles.", "",
        "## What each takes", "",
        "These are figures of the run from a straight start by Eq. 6. The audit is `hagfish check`.", "",
        *needs_table(rows),
        "## Other animals", "",
        "Ten animals are drawn at random, 25 to 60 cm long, with girths and limits changed by up to 20 %. For the slender animal's programs they are 1.5 times as long. "
        "No search judged by them. A program serves an animal that ties, holds and slides the knot by it, within all bounds. "
        "With `--animals` a program is kept only if it serves nine of ten other animals by each law. Those are of 40 others, one of each four in the order of thickness.", "",
        *unseen_table(rows),
        "Beside the programs of `data/`, which were made by hand:", "",
        *beside_table(rows),
        "For the programs of `data/` an animal counts that ties the knot, keeps it and gets rid of it, whatever the bounds ([living](living.md)). "
        "The scenes of `data/` keep their programs, since other pages rest on them.", "",
        "From nothing for each of ten random animals, a 4_1:", "",
        *animals_table(others),
        "## What was tried", "",
        *tables.markdown(["what", "figure"], TRIED),
        "## What this page does not show", "",
        "- How long a search takes on a quiet machine: other programs took some of this one's time.",
        "- Times of one machine: the square of seed 2 and the 6_3, both with `--animals`, are of one about twice as fast.",
        "- The whole time of most searches: runs at 1 and 2 ms and the audit were not yet part of them. These take 15 s of CPU time for a 3_1.",
        "- Searches of the same knot by other seeds than those of the table.",
        "- Other drawings of random animals than the ten.",
        "- Whether the Table 1 animal could tie a knot of six crossings at all. The length bound of 0.6 closed ropelengths allows it. "
        "As they are tied here, these knots take nearly as much body as it has, or more.",
        "- An hour on two cores for each knot that was not found: its search was stopped sooner, after the tries of the table.",
        "- Drag, lengths of contact and time steps that go with an animal's size: the ten animals keep those of the scene.",
        "- 6_1, 6_2, 7_1 and 3_1#3_1 with `--animals` by the present search. Those of 6_1, 6_2 and 3_1#3_1 were judged by ten animals as they happened to be drawn. "
        "That of 7_1 led the thickest animal alone. The table has the revision of each.",
        "- What the rows of what was tried are worth: they are of one seed and few tries.",
        "- The best program. The first one that passes is kept.",
    ]


def draw_gallery(folder: Path, rows: list[Row], out: Path) -> None:
    kept = one_of_each([row for row in rows if RANDOM not in row["animal"]])
    figure, axes = plots.plt.subplots(math.ceil(len(kept) / COLUMNS), COLUMNS, figsize=(11, 2.3 * math.ceil(len(kept) / COLUMNS)), squeeze=False)
    for panel in axes.flat:
        panel.set_axis_off()
    for panel, row in zip(axes.flat, kept):
        log = folder / row["folder"] / "knot.h5"
        slides = HagfishLog(log)["/trajectory/time"][HagfishLog(log).in_phase("slide")]
        panel.imshow(pictures_of(log, slides[:1], size=SIZE)[0])
        panel.set_title(f"{row['knot_wanted']}: {float(row['body_in_knot_cm']):.0f} of {float(row['length_cm']):.0f} cm")
    figure.tight_layout(pad=0.4)
    plots.save(figure, out)


def main(folder: Path, table: Path, out: Path, picture: Path) -> None:
    rows, notes = read_study(folder)
    draw_gallery(folder, rows, picture)
    tables.write_csv(table, list(rows[0]), [[row[name] for name in rows[0]] for row in rows], notes)
    tables.write_page(out, page(*read_table(table)))


if __name__ == "__main__":
    run_script(__doc__, ["FOLDER", "OUT.csv", "OUT.md", "OUT.png"], main)
