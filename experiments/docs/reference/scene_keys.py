"""The reference of a scene's keys, made of the one commented file: data/table1.toml.

Usage: scene_keys.py TABLE1.toml OUT.md. A test makes the page again and compares.
"""

import re
import sys
from pathlib import Path

HEAD = """# Keys of a scene

`python3 experiments/docs/reference/scene_keys.py data/table1.toml experiments/docs/reference/scene_keys.md` makes this page from the comments of the file.
Values are those of the scene `table1`. A scene that names a base holds only what differs.
*(paper, PLACE)* marks a value that the paper states at that place. All other values are ours.
`data/overhand_waypoints.toml` shows the keys of a script of positions, `data/living_overhand.toml` a curvature program, and `experiments/results/stability/scenes/` other starts.
Obstacles and curvature programs are in [data/README.md](../../../data/README.md).
"""
SECTION = re.compile(r"\[([a-z_.]+)\]$")
KEY = re.compile(r"([a-z_0-9]+) = (.*?)(?:  +# ?(.*)| # (.*))?$")
CONTINUED = re.compile(r" {20,}# ?(.*)$")


def cell(text: str) -> str:
    return text.replace("|", "\\|").strip()


def rows_of(lines: list[str]) -> list[list[str]]:
    """Section, key, value and comment of each key; comments above a section stand as its own row without a key."""
    rows: list[list[str]] = []
    section, above = "", []
    skipping = False  # within a list of several lines
    for line in lines:
        if skipping:
            skipping = line.rstrip() != "]"
            continue
        if found := SECTION.match(line):
            section = found[1]
            rows.append([section, "", "", " ".join(above)])
            above = []
        elif line.startswith("#"):
            above.append(line.removeprefix("#").strip())
        elif found := CONTINUED.match(line):
            rows[-1][3] += " " + found[1].strip()
        elif found := KEY.match(line):
            value = found[2].strip()
            if value == "[":
                value, skipping = "[...]", True
            comment = found[3] or found[4] or ""
            if above and rows:  # what stands above a key within a section is its own
                comment = " ".join([*above, comment]).strip()
            above = []
            rows.append([section, found[1], value, comment])
        elif above:  # a comment with an empty line behind it belongs to the section that it ends
            begin = max(k for k, row in enumerate(rows) if not row[1])
            rows[begin][3] += " " + " ".join(above)
            above = []
    return rows


def page(text: str) -> str:
    lines = text.splitlines()
    # The comment of the whole file stands in HEAD.
    while lines and (lines[0].startswith("#") or not lines[0].strip()):
        lines.pop(0)
    out = [HEAD, "## The scene itself", "", "| key | value | meaning |", "|---|---|---|"]
    for section, key, value, comment in rows_of(lines):
        if not key:
            out += ["", f"## `[{section}]`", "", cell(comment[:1].upper() + comment[1:]), "", "| key | value | meaning |", "|---|---|---|"]
            continue
        out.append(f"| `{key}` | `{cell(value)}` | {cell(comment)} |")
    return "\n".join(out) + "\n"


def main() -> None:
    source, out = map(Path, sys.argv[1:3])
    out.write_text(page(source.read_text(encoding="utf-8")), encoding="utf-8")


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main()
