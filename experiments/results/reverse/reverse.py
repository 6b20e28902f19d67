"""The knot slid back to the tail.

Usage: reverse.py SWEEP. Needs the program as built (HAGFISH_PROGRAM).
"""

from pathlib import Path

import audits
import tables
from script import run_script
from slides import MEAN, slide_of
from sweep_columns import read_cells


def main(folder: Path) -> None:
    back = [(slide_of(cell, "reverse"), audits.value_of(audits.audit(cell.path), "reverse of both ends")) for cell in read_cells(folder)]
    back.sort(key=lambda of: (of[0].knot, of[0].commanded))
    head = ["knot", "commanded, cm/s", "measured, cm/s", "tail end moved, cm", "head end, cm", "share of a slide by both ends, %", "time, s",
            f"force, median {MEAN}, dyn", f"largest {MEAN}, dyn", "steps that meet Eq. 6, %", "penetration, cm", "run"]
    tables.write_table(folder, "reverse", head, [
        [s.knot, f"{s.commanded:g}", f"{s.speed:.3g}", f"{s.travel:.1f}", f"{s.follows:.1f}", f"{share:.0f}", f"{s.seconds:.1f}", f"{s.force:.0f}",
         f"{s.peak:.0f}", f"{100 * s.met:.1f}", f"{s.penetration:.2g}", s.failure or "untied at the tail"] for s, share in back])


if __name__ == "__main__":
    run_script(__doc__, ["SWEEP"], main)
