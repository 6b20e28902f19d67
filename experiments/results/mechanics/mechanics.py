"""Tables of the page, from what the program `mechanics` left in a folder.

Usage: mechanics.py FOLDER     reads twisted.csv, hooked.csv, loose.csv, mujoco.csv, ply.csv, tight.csv, time.csv; writes tables/*.csv
"""

import math
from itertools import groupby
from pathlib import Path

from script import run_script
from tables import read_csv, write_table


def limit(points: list[tuple[float, float]]) -> float:
    """At x = 0, of the line through (x, y) with the least squares."""
    x, y = (sum(column) / len(points) for column in zip(*points))
    slope = sum((a - x) * (b - y) for a, b in points) / sum((a - x) ** 2 for a, _ in points)
    return y - slope * x


def twisted(folder: Path) -> None:
    """Each mesh with the order in the length of a body by which its error is less than that of the mesh before it."""
    rows = []
    for name, meshes in groupby(read_csv(folder / "twisted.csv", ["moment"]), lambda rod: (rod["problem"], rod["joints"], rod["ratio"])):
        before = 0.0
        for rod in meshes:
            error = float(rod["moment"]) - 1
            order = f"{math.log2(before / error):.1f}" if before else ""
            rows.append([*name, rod["bodies"], f"{100 * error:.2f}", order, rod["cpu"]])
            coarser, before = before, error
        if name[1] == "in turn":  # of second order
            rows.append([*name, "extrapolated", f"{round(100 * (error - (coarser - error) / 3), 2) + 0:.2f}", "", ""])
    write_table(folder, "mechanics", ["problem", "universal joints", "bending over twist rigidity", "bodies", "error of the moment, %",
                                      "order", "CPU time, s"], rows)


def hooked(folder: Path) -> None:
    rows = []
    for rope in read_csv(folder / "hooked.csv", ["value"]):
        value, expected = float(rope["value"]), float(rope["expected"])
        rows.append([rope["problem"], rope["figure"], rope["link"], rope["bodies"], f"{value:.4f}", f"{expected:.4f}",
                     f"{100 * (value / expected - 1):.2f}", rope["rest"], rope["cpu"]])
    write_table(folder, "mechanics_hooked", ["rope", "figure", "link", "bodies", "measured", "theory", "error, %", "at rest",
                                             "CPU time, s"], rows)


def mujoco(folder: Path) -> None:
    """MuJoCo's ropes beside this program's of as many bodies."""
    rows = []
    error = lambda tips, expected: f"{100 * (float(tips) / float(expected) - 1):.2f}"
    own = {rope["link"]: rope for rope in read_csv(folder / "hooked.csv", ["value"]) if rope["figure"] == "distance of the tips"}
    for link, ropes in groupby(read_csv(folder / "mujoco.csv", ["tips"]), lambda rope: rope["link"]):
        here = own[link]
        rows.append(["this one", "", "", here["bodies"], f"{float(here['value']):.4f}", error(here["value"], here["expected"]), "",
                     here["rest"], here["cpu"]])
        for rope in ropes:
            rows.append(["MuJoCo 2.2.2", rope["step"], rope["density"], rope["bodies"], f"{float(rope['tips']):.4f}",
                         error(rope["tips"], rope["expected"]), rope["overlap"], rope["rest"], rope["cpu"]])
    write_table(folder, "mechanics_mujoco", ["simulator", "step, s", "mass, g/cm", "bodies", "distance of the tips, diameters", "error, %",
                                             "overlap of capsules, diameters", "at rest", "CPU time, s"], rows)


def ply(folder: Path) -> None:
    percent = lambda over: f"{100 * (float(over) - 1):.1f}"
    rows = [[rod["bodies"], rod["per_radius"], rod["angle"], percent(rod["radius"]), percent(rod["force"]), percent(rod["moment"]),
             rod["rest"], rod["cpu"]]
            for rod in read_csv(folder / "ply.csv", ["force"])]
    write_table(folder, "mechanics_ply", ["bodies", "bodies to a radius", "angle of the strands, rad", "their distance over two radii, %",
                                          "error of F, %",
                                          "error of M, %", "at rest", "CPU time, s"], rows)


def time_rules(folder: Path) -> None:
    """Each step with the order by which its error is less than that of the step before it."""
    rows = []
    for rule, steps in groupby(read_csv(folder / "time.csv", ["error"]), lambda run: run["rule"]):
        before = 0.0
        for run in steps:
            error = float(run["error"])
            rows.append([rule, run["steps"], f"{error:.1e}", f"{math.log2(before / error):.1f}" if before else "", run["cpu"]])
            before = error
    write_table(folder, "mechanics_time", ["rule", "steps", "error of the tail's place, lengths", "order", "CPU time, s"], rows)


def loose(folder: Path) -> None:
    """Each knot, and the load that its thinnest rods come to, where the excess is in proportion to ε²."""
    rows = []
    knots = read_csv(folder / "loose.csv", ["load"])
    for knot in knots:
        error = f"{100 * (float(knot['load']) / 0.5 - 1):.1f}"
        twist = knot["ratio"] if float(knot["ratio"]) else "no twist"
        rows.append([knot["type"], knot["thin"], knot["bodies"], twist, knot["load"], error, knot["integral"], knot["touches"],
                     knot["interval"], knot["points"], knot["rest"], knot["cpu"]])
    for kind in dict.fromkeys(knot["type"] for knot in knots):
        thin = [knot for knot in knots if knot["type"] == kind and knot["series"] == "thin"][-3:]
        load = limit([(float(knot["thin"]) ** 2, float(knot["load"])) for knot in thin])
        rows.append([kind, "extrapolated", "", "no twist", f"{load:.4f}", f"{100 * (load / 0.5 - 1):.1f}", *[""] * 6])
    write_table(folder, "mechanics_loose",
                ["knot", "ε", "bodies", "twist over bending rigidity", "F R² / B", "error of 1/2, %", "(T + B κ² / 2) / F", "touches",
                 "interval, bodies", "points, bodies", "at rest", "CPU time, s"], rows)


KNOWN = {"3_1": (10.10, 10.08), "4_1": (13.71, 13.70), "5_1": (17.21, 17.19), "5_2": (17.22, 17.20)}  # animal's chain, rope code


def tight(folder: Path) -> None:
    rows = []
    knots = read_csv(folder / "tight.csv", ["shortening"])
    for kind, (chain, rope) in KNOWN.items():
        same = [knot for knot in knots if knot["type"] == kind]
        for knot in same:
            rows.append([kind, knot["link"], knot["bodies"], knot["shortening"], f"{100 * (float(knot['shortening']) / rope - 1):.2f}", "",
                         "", knot["rest"], knot["cpu"]])
        ideal = limit([(float(knot["link"]) ** 2, float(knot["shortening"])) for knot in same])
        rows.append([kind, "extrapolated", "", f"{ideal:.3f}", f"{100 * (ideal / rope - 1):.2f}", f"{chain:.2f}", f"{rope:.2f}", "", ""])
    write_table(folder, "mechanics_tight",
                ["knot", "link, diameters", "bodies", "shortening, diameters", "over the rope code's, %", "animal's chain before", "rope code",
                 "at rest", "CPU time, s"], rows)


def main(folder: Path) -> None:
    for table in (twisted, hooked, loose, mujoco, ply, tight, time_rules):
        table(folder)


if __name__ == "__main__":
    run_script(__doc__, ["FOLDER"], main)
