"""The README's table of the Table 1 run: written anew from an audit, and compared with what README says.

Usage: readme.py CHECK.csv README.md OUT.md, where CHECK.csv is of `hagfish check --csv`. OUT.md is what belongs between the
README's markers; exits 1, naming each row, where README says something else.
"""

from __future__ import annotations

import sys
from pathlib import Path

import audits
from hagfish_log import LogError
from script import run_script
from tables import markdown, write_page

BEGIN, END = "<!-- table1: readme.py writes this -->", "<!-- end of table1 -->"
# Criterion, how README calls it, and how it says the bound.
ROWS = {"knot held": ("the knot is a 3_1 from tightening to release, frames", "all"),
        "slide": ("head end of the knot slides, cm", "≥ {}"), "Eq. 6": ("Eq. 6 met without slack, % of sliding steps", "≥ {}"),
        "penetration": ("penetration at any step, cm", "≤ {}"), "limits": ("past a joint limit at any step, °", "≤ {}"),
        "head drift": ("head drift at any step, cm", "≤ {}"), "KKT residual": ("scaled KKT residual at any step", "≤ {}"),
        "forces of rows": ("logged forces, recomputed from q, q̇ and multipliers, off by, of 1e-9 of their scale", "≤ {}"),
        "f_thigmo past the knot": ("f_thigmo past the knot, dyn cm", "{}"), "force balance": ("forces balance, of their scale", "≤ {}"),
        "balance of means": ("their means balance", "≤ {}"), "forward-inverse": ("MuJoCo makes q̇ of them, off by", "≤ {}"),
        "energy ledger": ("energy ledger closes, of the energy that passed", "≤ {}")}
ROUNDING = 1e-6  # figures below are rounding, of which the order of magnitude counts
ROUNDING_OF_TOLERANCE = 1e-5  # the same of what is a share of a tolerance of 1e-9
FACTOR = 10  # by which such a figure may differ, on another machine
SHARE = 0.02  # by which any other may: starts that differ by rounding differ by less at h = 2 ms
DEEPEST = 0.5  # by which the deepest of all steps may, which is one step's: at h = 2 ms 0.00028 cm with AVX-512, 0.00033 without FMA


def rounding_of(words: str) -> float:
    return ROUNDING_OF_TOLERANCE if words == ROWS["forces of rows"][0] else ROUNDING


def figure(text: str, rounding: float) -> str:
    """Of an audit, in short; a run that failed may lack it."""
    if not text:
        return "none"
    value = float(text)
    return f"{value:.0e}" if 0 < value < rounding else f"{value:.3g}"


def table(findings: list[audits.Finding]) -> list[str]:
    found = {finding.criterion: finding for finding in findings}
    missing = ROWS.keys() - found.keys()
    if missing:
        raise LogError(f"the audit has no {sorted(missing)[0]}")
    return markdown(["", "required", "measured"], [
        [words, required.format(f"{float(found[name].bound):g}"), figure(found[name].value, rounding_of(words))]
        for name, (words, required) in ROWS.items()])


def stated(readme: Path, begin: str = BEGIN, end: str = END) -> list[str]:
    """The lines between the markers."""
    text = readme.read_text(encoding="utf-8")
    if text.count(begin) != 1 or text.count(end) != 1:
        raise LogError(f"{readme}: does not have the lines {begin} and {end} once each")
    return text.split(begin)[1].split(end)[0].strip().splitlines()


def same(stated_row: str, row: str) -> bool:
    """Whether two rows say the same: words and bounds to the letter, figures to what chance and rounding leave open."""
    old, new = ([cell.strip() for cell in each.strip("|").split("|")] for each in (stated_row, row))
    if old == new or len(old) != len(new) or old[:-1] != new[:-1]:
        return old == new
    try:
        a, b = float(old[-1]), float(new[-1])
    except ValueError:
        return False
    share = DEEPEST if old[0] == ROWS["penetration"][0] else SHARE
    return max(a, b) < rounding_of(old[0]) and max(a, b) <= FACTOR * min(a, b) or abs(a - b) <= share * max(a, b)


def main(check: Path, readme: Path, out: Path) -> None:
    lines = table(audits.read_findings(check))
    write_page(out, lines)
    old, new = stated(readme), lines[:-1]
    differ = [f"has {a!r} where the run has {b!r}" for a, b in zip(old, new) if not same(a, b)]
    if len(old) != len(new):
        differ.append(f"has {len(old)} lines where the run has {len(new)}")
    if differ:
        print("\n".join(f"{readme.name} {words}" for words in differ), f"{out} is the table as it is now.", sep="\n",
              file=sys.stderr)
        sys.exit(1)


if __name__ == "__main__":
    run_script(__doc__, ["CHECK.csv", "README.md", "OUT.md"], main)
