"""Found programs: their table and their page.

Usage: design.py FOLDER OUT.csv OUT.md. FOLDER is what experiments/studies/design.sh leaves. The page is made of the table alone: a
test makes it again.
"""

from __future__ import annotations

import csv
import datetime
import math
import tomllib
from pathlib import Path

import tables
from audits import read_findings, unmet
from hagfish_log import HagfishLog, LogError
from script import run_script

STEPS = ("0.001", "0.002", "0.005")  # s, of the audited runs
KEPT = ["knot_wanted", "seed", "found", "tries", "tied_in_soft_body", "try", "starts", "starts_by_paper", "starts_by_reflex", "cpu_s", "wall_s",
        "tighten_from_s", "slide_distance_cm", "release_from_s", "free_from_s", "largest_active_dyn_cm", "largest_thigmotaxis_dyn_cm",
        "work_active_erg", "penetration_cm"]
LAWS = ("paper", "reflex")
# By hand, of single searches by seed 1: not what this study measures.
TRIED = [
    ("all turns about lines fixed beforehand, for a 5_2, seed 1", "first 640 tries: 166 of 3_1, 71 of 4_1, 66 of 5_1, no 5_2"),
    ("all turns about strands where they then lie, the same", "first 5_2 by try 512; no 4_1 in 928 tries of another search"),
    ("turns that make the knot of a body at rest whose tail grows, the shortest of 100", "608 tries: 436 of 3_1, 42 of 5_1, no 4_1 and no 5_2"),
    ("a path of three quarters of the tries is drawn until the straight body with its tail on along it is the knot, for a 4_1",
     "first 64 tries: 30 of 3_1, none of 4_1"),
    ("programs of 20 stations, a time every 0.7 s", "try 23 of a 3_1 fails, by 0.019 rad of rms error; it ties at 25 and 0.35 s, by 0.010 rad"),
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


def read_study(folder: Path) -> tuple[list[Row], list[str]]:
    rows = []
    results = []
    revisions = set()
    for search in sorted(folder.glob("*/search.toml")):
        result = search.parent / "result.csv"
        what = tomllib.loads(search.read_text(encoding="utf-8"))
        revisions.add(what["revision"])
        animal = tomllib.loads(what["specimen"])
        beside = {"animal": animal.get("name", ""), "length_cm": str(animal.get("length", "")), "for_animals": "yes" if what.get("animals") else "no",
                  **{f"unseen_by_{law}": served(search.parent, law) for law in LAWS}}
        if result.exists():
            results.append(result)
            row = tables.read_csv(result, KEPT)[0]
            rows.append({**{name: row[name] for name in KEPT}, **{f"audit_{step}_s": audited(result.parent, step) for step in STEPS}, **beside})
        else:  # nothing tied the knot
            tries = (search.parent / "tries.csv").read_text(encoding="utf-8").count("\n")
            rows.append({**dict.fromkeys([*KEPT, *(f"audit_{step}_s" for step in STEPS)], ""), "knot_wanted": what["knot"],
                         "seed": str(what["seed"]), "found": "no", "tries": str(tries), "tied_in_soft_body": "0", **beside})
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


def found_table(rows: list[Row]) -> list[str]:
    head = ["knot", "seed", "other animals asked for", "found", "CPU time, s", "clock, s", "paths tried", "paths that tied it", "starts, paper's law", "starts, reflex"]
    return tables.markdown(head, [[row["knot_wanted"], row["seed"], row["for_animals"], row["found"], number(row["cpu_s"]), number(row["wall_s"]), row["tries"],
                                   row["tied_in_soft_body"], passed(row, "paper"), passed(row, "reflex")] for row in rows])


def unseen_table(rows: list[Row]) -> list[str]:
    head = ["knot", "seed", "other animals asked for", "of ten, paper's law", "of ten, reflex"]
    return tables.markdown(head, [[row["knot_wanted"], row["seed"], row["for_animals"], *(row[f"unseen_by_{law}"] for law in LAWS)]
                                  for row in rows if row["unseen_by_paper"]])


def animals_table(rows: list[Row]) -> list[str]:
    head = ["animal", "length, cm", "found", "CPU time, s", "clock, s", "paths tried", "starts, paper's law", "starts, reflex", "audit at 1 ms",
            "at 2 ms", "at 5 ms"]
    return tables.markdown(head, [[row["animal"], number(row["length_cm"]), row["found"], number(row["cpu_s"]), number(row["wall_s"]), row["tries"],
                                   passed(row, "paper"), passed(row, "reflex"), *(row[f"audit_{step}_s"] for step in STEPS)] for row in rows])


def needs_table(rows: list[Row]) -> list[str]:
    head = ["knot", "seed", "other animals asked for", "tightened from, s", "way, cm", "untied at, s", "largest active torque, dyn cm", "largest torque of f_thigmo, dyn cm",
            "work of active torques, erg", "audit at 1 ms", "at 2 ms", "at 5 ms"]
    return tables.markdown(head, [[row["knot_wanted"], row["seed"], row["for_animals"], number(row["tighten_from_s"]), number(row["slide_distance_cm"], 2), number(row["free_from_s"]),
                                   number(row["largest_active_dyn_cm"], 2), number(row["largest_thigmotaxis_dyn_cm"], 2),
                                   number(row["work_active_erg"], 2), *(row[f"audit_{step}_s"] for step in STEPS)] for row in rows if row["try"]])


def page(all_rows: list[Row], notes: list[str]) -> list[str]:
    rows = [row for row in all_rows if not row["animal"]]
    others = sorted((row for row in all_rows if row["animal"]), key=lambda row: (len(row["animal"]), row["animal"]))
    found = [row for row in rows if row["found"] == "yes"]
    longest = max((float(row["cpu_s"]) for row in found), default=0)
    answer = (f"It does: {len(found)} of {len(rows)} searches found their knot, each within {math.ceil(longest)} s of CPU time." if found else "It did not here.")
    if others:
        answer += f" For {sum(row['found'] == 'yes' for row in others)} of {len(others)} random animals a program was found, too."
    return [
        "# From a knot's name to an animal that ties it", "",
        "`bash experiments/studies/design.sh` makes this page and [its table](design.csv). " + " ".join(notes), "",
        "**Question.** Does a body find out by itself how to knot itself?", "",
        f"**Answer.** {answer}", "",
        "## How it is found", "",
        "1. A hand leads the tail of an animal with a soft body. The tail winds about strands near it, which are drawn at random. "
        "Half of the paths wind about lines where strands lie before anything moves.",
        "2. A path on which some knot was seen is continued in other ways. It is drawn by type, so that rare knots are continued as often as common ones.",
        "3. As soon as the wanted knot is seen twice, 0.4 s apart, the tail is pulled on to where it points. Such paths are then displaced at random.",
        "4. The soft body is tightened. Its shapes become a curvature program of 25 stations, a time every 0.35 s.",
        "5. The animal of measured stiffness ties itself by that program, without a hand. The knot slides by the paper's law, then by the reflex.",
        "6. A program is kept if at least 19 of 20 starts succeed by each law. Starts have normal noise of 3 degrees on every hinge.", "",
        "No script and no program of `data/` is a start of the search. The head is clamped.", "",
        "## What was found", "",
        *found_table(rows),
        "Times hold everything: the search, the fit and all runs of the starts. The machine was shared, so compare CPU times.", "",
        "## What each takes", "",
        "These are figures of the run from a straight start by the paper's law. The audit is `hagfish check`.", "",
        *needs_table(rows),
        "## Other animals", "",
        "Ten animals are drawn at random, 25 to 60 cm long, with girths and limits changed by up to 20 %. No search judged by them. "
        "A program serves an animal that ties, holds and slides the knot by it, within all bounds. "
        "With `--animals` a program is kept only if it serves nine of ten other animals by each law. Those are drawn otherwise.", "",
        *unseen_table(rows),
        "From nothing for each of them, a 4_1:", "",
        *animals_table(others),
        "## What was tried", "",
        *tables.markdown(["what", "figure"], TRIED),
        "## What this page does not show", "",
        "- How long a search takes on a quiet machine: other programs took most of this one's time.",
        "- Searches of the same knot by other seeds than those of the table. One without success may have been stopped before its 15 minutes were over.",
        "- Other drawings of random animals than the ten.",
        "- Knots of six crossings and more, and composites. The classifier tells them apart; ten minutes of one thread each found none of them.",
        "- What the rows of what was tried are worth: they are of one seed and few tries.",
        "- A refinement of found programs. The first program that passes is kept, not the best.",
    ]


def main(folder: Path, table: Path, out: Path) -> None:
    rows, notes = read_study(folder)
    tables.write_csv(table, list(rows[0]), [list(row.values()) for row in rows], notes)
    tables.write_page(out, page(*read_table(table)))


if __name__ == "__main__":
    run_script(__doc__, ["FOLDER", "OUT.csv", "OUT.md"], main)
