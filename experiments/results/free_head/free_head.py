"""Slides with the head free (no clamp, no plate), beside the same with the head held.

Usage: free_head.py SWEEPS, where SWEEPS holds held, free and forming.
"""

from pathlib import Path

import tables
from script import run_script
from slides import MEAN, read_slides


def main(folder: Path) -> None:
    sets = {name: read_slides(folder / name) for name in ("held", "free")}
    print("Forming with a free head too:", *(f"{s.knot}: {s.failure or 'tied'}" for s in read_slides(folder / "forming")), sep="\n")
    head = ["head", "knot", "commanded, cm/s", "measured, cm/s", "head end of the knot, cm", "its tail end, cm", "the knot", f"force, median {MEAN}, dyn", f"largest {MEAN}, dyn",
            "steps that meet Eq. 6, %", "penetration, cm", "run"]
    tables.write_table(folder, "free_head", head, [
        [name, s.knot, f"{s.commanded:g}", f"{s.speed:.3g}", f"{s.travel:.1f}", f"{s.follows:.1f}", s.kind or "-", f"{s.force:.0f}", f"{s.peak:.0f}",
         f"{100 * s.met:.1f}", f"{s.penetration:.2g}", s.failure or "complete"] for name, slides in sets.items() for s in slides])


if __name__ == "__main__":
    run_script(__doc__, ["SWEEPS"], main)
