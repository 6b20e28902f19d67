"""The knot slid back to the tail.

Usage: reverse.py SWEEP.
"""

from pathlib import Path

import tables
from script import run_script
from slides import MEAN, read_slides


def main(folder: Path) -> None:
    head = ["knot", "commanded, cm/s", "measured, cm/s", "tail end moved, cm", "head end, cm", "time, s", f"force, median {MEAN}, dyn",
            f"largest {MEAN}, dyn", "steps that meet Eq. 6, %", "penetration, cm", "run"]
    tables.write_table(folder, "reverse", head, [
        [s.knot, f"{s.commanded:g}", f"{s.speed:.3g}", f"{s.travel:.1f}", f"{s.follows:.1f}", f"{s.seconds:.1f}", f"{s.force:.0f}", f"{s.peak:.0f}",
         f"{100 * s.met:.1f}", f"{s.penetration:.2g}", s.failure or "untied at the tail"] for s in read_slides(folder, "reverse")])


if __name__ == "__main__":
    run_script(__doc__, ["SWEEP"], main)
