"""The table of the Table 1 run (table1.csv): written anew from an audit, and compared with the one that is there.

Usage: table1.py CHECK.csv STATED.csv OUT_FOLDER, where CHECK.csv is of `hagfish check --csv`. Exits 1, naming each row, where
STATED.csv says something else.
"""

import sys
from pathlib import Path

import audits
import results
from hagfish_log import LogError
from script import run_script
from tables import Table, read_table, write_table

HEAD = ["", "required", "measured"]
# Criterion, how the page calls it, and how it says the bound.
ROWS = {"knot held": ("the knot is a 3_1 from tightening to release, frames", "all"),
        "slide": ("head end of the knot slides, cm", "≥ {}"), "slide of both ends": ("share of a slide of both ends, %", "≥ {}"),
        "Eq. 6": ("Eq. 6 met without slack, % of sliding steps", "≥ {}"), "penetration": ("penetration at any step, cm", "≤ {}"),
        "limits": ("past a joint limit at any step, °", "≤ {}"), "head drift": ("head drift at any step, cm", "≤ {}"),
        "KKT residual": ("scaled KKT residual at any step", "≤ {}"),
        "forces of rows": ("logged forces, recomputed from q, q̇ and multipliers, off by, of 1e-9 of their scale", "≤ {}"),
        "f_thigmo past the knot": ("f_thigmo past the knot, dyn cm", "{}"), "force balance": ("forces balance, of their scale", "≤ {}"),
        "balance of means": ("their means balance", "≤ {}"), "forward-inverse": ("MuJoCo makes q̇ of them, off by", "≤ {}"),
        "energy ledger": ("imbalance of the energy ledger, of the energy that passed; 0 within rounding", "≤ {}")}
ROUNDING = 1e-6  # figures below are rounding, of which one digit is shown
ROUNDING_OF_TOLERANCE = 1e-5  # the same of what is a share of a tolerance of 1e-9


def rounding_of(words: str) -> float:
    return ROUNDING_OF_TOLERANCE if words == ROWS["forces of rows"][0] else ROUNDING


def figure(text: str, rounding: float) -> str:
    """Of an audit, in short; a run that failed may lack it."""
    if not text:
        return "none"
    value = float(text)
    return f"{value:.0e}" if 0 < value < rounding else f"{value:.3g}"


def table(findings: list[audits.Finding]) -> list[list[str]]:
    found = {finding.criterion: finding for finding in findings}
    missing = ROWS.keys() - found.keys()
    if missing:
        raise LogError(f"the audit has no {sorted(missing)[0]}")
    return [[words, required.format(f"{float(found[name].bound):g}"), figure(found[name].value, rounding_of(words))]
            for name, (words, required) in ROWS.items()]


def main(check: Path, known: Path, out: Path) -> None:
    new = Table(HEAD, table(audits.read_findings(check)))
    write_table(out, "table1", new.head, new.rows)
    differ = results.differences(known.stem, read_table(known), new, results.settings_of("table1")["chance"]["table1"])
    if differ:
        print(*differ, f"{out}/tables/table1.csv is the table as it is now.", sep="\n", file=sys.stderr)
        sys.exit(1)


if __name__ == "__main__":
    run_script(__doc__, ["CHECK.csv", "STATED.csv", "OUT_FOLDER"], main)
