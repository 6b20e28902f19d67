"""What it costs to keep the strands of a pulled knot apart, MuJoCo beside the core.

Usage: overlap.py OVERLAP.csv OUT_FOLDER (rows of hagfish_overlap)
"""

from pathlib import Path

from hagfish_log import LogError
from script import run_script
from tables import read_csv, write_table

# Overlaps that MuJoCo is asked to keep to, cm; the last is the core's own.
BOUNDS = (0.02, 0.005, 0.0025, 0.001)
Row = dict[str, str]


def quickest(rows: list[Row], bound: float) -> Row | None:
    """Of those that overlap by `bound` (cm) at most."""
    within = [row for row in rows if float(row["overlap_cm"]) <= bound]
    return min(within, key=lambda row: float(row["cpu_s"])) if within else None


def table(rows: list[Row]) -> list[list[str]]:
    """By size and bound: the CPU time of a simulated second, MuJoCo's quickest setting over the core's quickest step."""
    lines = []
    for bodies in sorted({row["bodies"] for row in rows}, key=int):
        of = lambda simulator: [row for row in rows if row["bodies"] == bodies and row["simulator"] == simulator]
        core = quickest(of("core"), float("inf"))
        if core is None:
            raise LogError(f"no row of the core with {bodies} bodies")
        for bound in (*BOUNDS, float(core["overlap_cm"])):
            mujoco = quickest(of("mujoco"), bound)
            setting = [f"{float(mujoco['cpu_s']) / float(core['cpu_s']):.1f}", mujoco["h_ms"], mujoco["constant_ms"], mujoco["share"],
                       f"{float(mujoco['limits_deg']):.2g}"] if mujoco else ["none does", "", "", "", ""]
            lines.append([bodies, f"{bound:g}", *setting])
    return lines


def main(csv: Path, out: Path) -> None:
    rows = read_csv(csv, ("bodies", "simulator", "h_ms", "constant_ms", "share", "overlap_cm", "limits_deg", "cpu_s"))
    write_table(out, "step_cost_overlap", ["bodies", "overlap, cm, at most", "MuJoCo over core", "h, ms", "time constant, ms",
                                           "impedance", "past a limit, degrees"], table(rows))


if __name__ == "__main__":
    run_script(__doc__, ["OVERLAP.csv", "OUT_FOLDER"], main)
