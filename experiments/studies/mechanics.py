"""Tables of experiments/results/mechanics.md, from what the tests of rods and the program `mechanics` left in a folder.

Usage: mechanics.py FOLDER     reads tests.json, loose.csv, tight.csv; writes tables/*.csv
"""

import csv
import json
import sys
from pathlib import Path


def limit(points: list[tuple[float, float]]) -> float:
    """At x = 0, of the line through (x, y) with the least squares."""
    x, y = (sum(column) / len(points) for column in zip(*points))
    slope = sum((a - x) * (b - y) for a, b in points) / sum((a - x) ** 2 for a, _ in points)
    return y - slope * x


def read(path: Path) -> list[dict[str, str]]:
    with path.open(encoding="utf-8") as file:
        return list(csv.DictReader(file))


def write(path: Path, head: list[str], rows: list[list[str]]) -> None:
    with path.open("w", encoding="utf-8", newline="") as file:
        csv.writer(file, lineterminator="\n").writerows([head, *rows])


def rods(folder: Path) -> list[list[str]]:
    suites = json.loads((folder / "tests.json").read_text(encoding="utf-8"))["testsuites"]
    tests = [test for suite in suites for test in suite["testsuite"]]
    return [row.split(",") for test in tests for name, row in sorted(test.items()) if name.startswith("row_")]


def loose(folder: Path) -> list[list[str]]:
    """Each knot, and with the load that its thin rods come to: the excess is in proportion to ε²."""
    rows = []
    knots = read(folder / "loose.csv")
    for knot in knots:
        error = f"{100 * (float(knot['load']) / 0.5 - 1):.1f}"
        twist = knot["ratio"] if float(knot["ratio"]) else "no twist"
        rows.append([knot["type"], knot["thin"], knot["bodies"], twist, knot["load"], error, knot["integral"], knot["touches"], knot["interval"],
                     knot["points"], knot["rest"], knot["cpu"]])
    for kind in dict.fromkeys(knot["type"] for knot in knots):
        thin = [knot for knot in knots if knot["type"] == kind and knot["series"] == "thin"][-3:]
        load = limit([(float(knot["thin"]) ** 2, float(knot["load"])) for knot in thin])
        rows.append([kind, "extrapolated", "", "no twist", f"{load:.4f}", f"{100 * (load / 0.5 - 1):.1f}", *[""] * 6])
    return rows


KNOWN = {"3_1": (10.10, 10.08), "4_1": (13.71, 13.70), "5_2": (17.22, 17.20)}  # animal's chain, rope code


def tight(folder: Path) -> list[list[str]]:
    rows = []
    knots = read(folder / "tight.csv")
    for kind, (chain, rope) in KNOWN.items():
        same = [knot for knot in knots if knot["type"] == kind]
        for knot in same:
            rows.append([kind, knot["link"], knot["bodies"], knot["shortening"], f"{100 * (float(knot['shortening']) / rope - 1):.2f}", "", "", knot["rest"],
                         knot["cpu"]])
        ideal = limit([(float(knot["link"]) ** 2, float(knot["shortening"])) for knot in same])
        rows.append([kind, "extrapolated", "", f"{ideal:.3f}", f"{100 * (ideal / rope - 1):.2f}", f"{chain:.2f}", f"{rope:.2f}", "", ""])
    return rows


def main(folder: Path) -> None:
    tables = folder / "tables"
    tables.mkdir(exist_ok=True)
    write(tables / "mechanics.csv", ["problem", "bending over twist rigidity", "bodies", "closed form, dyn cm", "error, %", "CPU time, s"], rods(folder))
    write(tables / "mechanics_loose.csv",
          ["knot", "ε", "bodies", "twist over bending rigidity", "F R² / B", "error of 1/2, %", "(T + B κ² / 2) / F", "touches",
           "interval, bodies", "points, bodies", "at rest", "CPU time, s"], loose(folder))
    write(tables / "mechanics_tight.csv",
          ["knot", "link, diameters", "bodies", "shortening, diameters", "over the rope code's, %", "animal's chain before", "rope code", "at rest",
           "CPU time, s"], tight(folder))


if __name__ == "__main__":
    main(Path(sys.argv[1]))
