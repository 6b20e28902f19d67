"""Pages of results, a folder each: page.md, page.toml, study.sh and what it needs, tables as CSV, figures as PNG.

Usage: results.py render                 makes the blocks between markers again, of all pages and of README.md
       results.py adopt NAME FOLDER VERSION S   takes tables and figures that a study left in FOLDER, by the program
                                         VERSION in S seconds; says what differs from those that were here by more
                                         than chance (exit code 1)
       results.py mark                   notes in each CSV whether code has changed since it was measured, and renders
       results.py digest PROGRAM         notes the digests of scenes by this code, of PROGRAM (live_digest of the
                                         portable build): code of the same digests moves the animal alike, and a page
                                         is not older by it
       results.py names | list           names of pages; with their questions and times
       results.py page NAME              exit code 2 where there is no such page

page.toml has `[chance]`: of a table, by pattern of its headings, the share by which figures may differ from one machine to
another, inf where a column is not compared; `ROW; HEADING` has patterns of a row's first cell, too. The first pattern counts. Columns without one are as they were, times of the
computer are not compared. `data` are CSV files that figures are drawn from, besides the tables. Of its study's folder a page takes tables/NAME.csv of all these, and the PNG
files that it shows. A block of a page begins with one of these lines and ends with `<!-- end -->`:
    <!-- table: FILE.csv -->             the table; `; rows: WORDS; WORDS` picks the rows whose first cell has the words
    <!-- stamp: NAME -->                 when, where and by what the page's tables were made
    <!-- index: NAME, NAME -->           a row a page: the index of README.md has all pages, in their order
A figure in a sentence stands between <!-- of: FILE.csv; COLUMN; WORDS --> and <!-- end -->: the cell of the row whose
cells have the words (several with + between), or, of several rows, the least to the largest of their first numbers.
Without words, of all rows.
"""

import datetime
import hashlib
import math
import re
import subprocess
import sys
import tomllib
from pathlib import Path
from typing import Any

sys.path.append(str(Path(__file__).resolve().parents[1] / "drawing"))
from hagfish_log import LogError  # noqa: E402
from tables import Table, markdown, read_table, write_csv  # noqa: E402

ROOT = Path(__file__).resolve().parents[2]
RESULTS = ROOT / "experiments" / "results"
CODE = ("core", "solvers", "mujoco_ref", "data")  # what moves the animal: a change there may change figures
MOTION = ("core", "solvers")  # of these, what digests of scenes can tell to be as it was
DIGESTS = RESULTS / "digests.csv"
BLOCK = re.compile(
    r"<!-- (table|stamp|index)(?:: ([^;>]+?))?(?:; rows: ([^>]+?))? -->\n(?:.*?\n)??<!-- end -->", re.DOTALL)
VALUE = re.compile(r"(<!-- of: ([^;>]+); ([^;>]+?)(?:; ([^>]+?))? -->).*?(<!-- end -->)")
FIGURE = re.compile(r"^!\[.*\]\(([^/)]+\.png)\)$", re.MULTILINE)
NUMBER = re.compile(r"[-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?")
NAME = re.compile(r"\b\d_\d\b")  # of a knot, which is no number
EQUAL = 1e-9  # share by which figures without a chance may differ
TIMES = re.compile(r"CPU|clock|µs")  # headings of times of the computer
ROUNDING = 1e-5  # figures below are rounding errors, of which the order of magnitude counts
FACTOR = 10  # by which such a figure may differ
MEASURED = re.compile(r"Measured at ([0-9a-f]{7,40}\+?(?:, [0-9a-f]{7,40}\+?)*) on (.+), (\d{4}-\d\d-\d\d)\.")
OLDER = "Since then"
QUOTED = re.compile(r'"(?:[^"\\\n]|\\.)*"')


def row_of(table: Table, words: str) -> list[str]:
    found = [row for row in table.rows if words in row[0]]
    if len(found) != 1:
        raise LogError(f"{len(found)} rows have {words!r} in their first cell")
    return found[0]


def value_of(table: Table, column: str, words: list[str]) -> str:
    """The cell of the only row that has all of the words, or the range of the numbers of several."""
    if column not in table.head:
        raise LogError(f"no column {column!r}")
    named = [row for row in table.rows if all(any(word in cell for cell in row) for word in words)]
    cells = [row[table.head.index(column)] for row in named]
    numbers = sorted((found[0] for cell in cells if (found := NUMBER.search(cell))), key=float)
    if not numbers:
        raise LogError(f"no number of {column!r} in rows with {words}")
    if len(cells) == 1:
        return cells[0]
    return numbers[0] if numbers[0] == numbers[-1] else f"{numbers[0]} to {numbers[-1]}"


def write(path: Path, table: Table) -> None:
    write_csv(path, table.head, table.rows, table.notes)


def names() -> list[str]:
    """Of pages, in the order of the index; those that it lacks come last."""
    text = (RESULTS / "README.md").read_text(encoding="utf-8")
    listed = [name for block in BLOCK.finditer(text) if block[1] == "index" for name in block[2].split(", ")]
    there = sorted(path.parent.name for path in RESULTS.glob("*/page.toml"))
    return sorted(there, key=lambda name: listed.index(name) if name in listed else len(listed))


def settings_of(name: str) -> dict[str, Any]:
    if name not in names():
        raise LogError(f"no page {name}; there are {', '.join(names())}")
    return tomllib.loads((RESULTS / name / "page.toml").read_text(encoding="utf-8"))


def text_of(name: str) -> str:
    return (RESULTS / name / "page.md").read_text(encoding="utf-8")


def question_of(name: str) -> str:
    return text_of(name).splitlines()[0].removeprefix("# ")


def shown_by(name: str) -> list[str]:
    """The tables of a page, in its order, as it names them: other pages' have their folder before them. Those of which it
    has figures in sentences alone come last."""
    text = text_of(name)
    tables = [match[2] for match in BLOCK.finditer(text) if match[1] == "table"]
    return list(dict.fromkeys([*tables, *(match[2] for match in VALUE.finditer(text))]))


def tables_of(name: str) -> list[Path]:
    return [RESULTS / name / table for table in shown_by(name)]


def data_of(name: str) -> list[Path]:
    """What its figures are drawn from, besides its tables; there once a study has left it."""
    return [path for data in settings_of(name).get("data", ()) if (path := RESULTS / name / data).exists()]


def stamp(name: str) -> list[str]:
    """What the notes of the page's tables say, each once, and how to make them again."""
    notes: dict[str, list[str]] = {}
    tables = tables_of(name)
    for path in tables:
        for note in read_table(path).notes:
            notes.setdefault(note, []).append(path.stem)
    said = [note if len(of) == len(tables) else f"{note[:-1]} ({', '.join(of)})." for note, of in notes.items()]
    shares = [share for of in settings_of(name).get("chance", {}).values() for share in of.values() if share < math.inf]
    again = f"`bash experiments/reproduce.sh {name}` makes this page's tables again" + (
        f"; of some columns figures may differ from machine to machine, by up to {100 * max(shares):g} % ([which](page.toml))."
        if shares else ".")
    links = lambda files: ", ".join(f"[{file.rpartition('/')[2]}]({file})" for file in files)
    data = [path.name for path in data_of(name)]
    drawn = [f"{'Figures are drawn from' if FIGURE.search(text_of(name)) else 'Other data:'} {links(data)}."] if data else []
    return [*said, again, f"Tables are CSV files: {links(shown_by(name))}.", *drawn]


def index(wanted: list[str]) -> list[str]:
    rows = [[f"[{question_of(name)}]({name}/page.md)", f"`bash experiments/reproduce.sh {name}`"] for name in wanted]
    return markdown(["question", "command"], rows)


def rendered(path: Path) -> str:
    """The page with its blocks as they should be."""
    def block(match: re.Match[str]) -> str:
        kind, what, rows = match[1], match[2], match[3]
        if kind == "index":
            lines = index(what.split(", "))
        elif kind == "stamp":
            lines = stamp(what)
        else:
            table = read_table(path.parent / what)
            lines = markdown(table.head, [row_of(table, words.strip()) for words in rows.split(";")] if rows else table.rows)
        return "\n".join([match[0].split("\n", 1)[0], *lines, "<!-- end -->"])

    def value(match: re.Match[str]) -> str:
        words = match[4].split(" + ") if match[4] else []
        return f"{match[1]}{value_of(read_table(path.parent / match[2]), match[3], words)}{match[5]}"

    def told(work: Any) -> Any:
        """What is wrong names the page and the table."""
        def told_work(match: re.Match[str]) -> str:
            try:
                return work(match)
            except LogError as error:
                raise LogError(f"{path.relative_to(ROOT)}: {match[2]}: {error}") from None
        return told_work
    return VALUE.sub(told(value), BLOCK.sub(told(block), path.read_text(encoding="utf-8")))


def documents() -> list[Path]:
    return [ROOT / "README.md", RESULTS / "README.md", *(RESULTS / name / "page.md" for name in names())]


def render() -> None:
    for path in documents():
        path.write_text(rendered(path), encoding="utf-8")


def same(old: str, new: str, chance: float) -> bool:
    """Whether two cells say the same: words to the letter, figures to `chance`, rounding errors to FACTOR; any do where it is inf."""
    if chance == math.inf:
        return True
    if NAME.findall(old) != NAME.findall(new):
        return False
    old, new = NAME.sub("knot", old), NAME.sub("knot", new)
    if NUMBER.sub("#", old) != NUMBER.sub("#", new):
        return False
    pairs = [(float(a), float(b)) for a, b in zip(NUMBER.findall(old), NUMBER.findall(new))]
    near = lambda a, b: abs(a - b) <= chance * max(abs(a), abs(b)) or (
        max(abs(a), abs(b)) < ROUNDING and max(abs(a), abs(b)) <= FACTOR * min(abs(a), abs(b)))
    return all(near(a, b) for a, b in pairs)


def chance_of(row: str, head: str, shares: dict[str, float]) -> float:
    """Of a cell by its row's first cell and its heading; `shares` are those of its table, by pattern."""
    for pattern, share in shares.items():
        of_row, _, of_head = pattern.rpartition("; ")
        if re.search(of_row, row) and re.search(of_head, head):
            return share
    return math.inf if TIMES.search(head) else EQUAL


def differences(name: str, old: Table, new: Table, shares: dict[str, float]) -> list[str]:
    """A line for each cell that differs by more than its column's chance, and for headings and rows that are not the same."""
    if old.head != new.head:
        return [f"{name}: columns were {old.head}, are {new.head}"]
    before = {row[0]: row for row in old.rows}
    keyed = len(before) == len(old.rows) and len({row[0] for row in new.rows}) == len(new.rows)
    found = []
    if not keyed and len(old.rows) != len(new.rows):
        return [f"{name}: had {len(old.rows)} rows, has {len(new.rows)}"]
    for k, row in enumerate(new.rows):
        was = before.pop(row[0], None) if keyed else old.rows[k]
        if was is None:
            found.append(f"{name}: a new row: {row[0]}")
            continue
        found += [f"{name}: {row[0]}, {head}: was {a!r}, is {b!r}"
                  for head, a, b in zip(new.head, was, row) if not same(a, b, chance_of(row[0], head, shares))]
    return found + [f"{name}: no row any more: {first}" for first in (before if keyed else ())]


def git(*arguments: str) -> str:
    return subprocess.run(["git", "-C", str(ROOT), *arguments], check=True, capture_output=True, text=True, errors="replace").stdout


def processor() -> str:
    for line in Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines():
        if line.startswith("model name"):
            return line.split(":", 1)[1].strip()
    return "an unknown processor"


def measured(version: str, seconds: float) -> list[str]:
    """`version` is what the program says of itself: its release and its commit, with a + where files were changed."""
    return [f"Measured at {version.split()[-1]} on {processor()}, {datetime.date.today():%Y-%m-%d}.",
            f"The study took {int(seconds) // 60} min {int(seconds) % 60} s."]


def take_figure(source: Path, target: Path, text: str) -> None:
    """A figure in 256 colours, which says where it was measured."""
    from PIL import Image, PngImagePlugin  # comes with Debian's matplotlib

    info = PngImagePlugin.PngInfo()
    info.add_text("Comment", text)
    with Image.open(source) as picture:
        picture.convert("RGB").quantize(256, dither=Image.Dither.NONE).save(target, optimize=True, pnginfo=info)


def adopt(name: str, folder: Path, version: str, seconds: float) -> list[str]:
    """Takes what a study left; returns what differs from what was here. A table that says itself where it was measured
    is of several programs: a part of its study was made anew."""
    settings, found = settings_of(name), []
    shown = [table for table in shown_by(name) if "/" not in table]
    for wanted in [*settings.get("data", ()), *shown]:
        new, here = read_table(folder / "tables" / wanted), RESULTS / name / wanted
        if not any(MEASURED.match(note) for note in new.notes):
            new.notes += measured(version, seconds)
        if wanted in shown and here.exists():
            found += differences(here.stem, read_table(here), new, settings.get("chance", {}).get(here.stem, {}))
        write(here, new)
    for figure in FIGURE.findall(text_of(name)):
        take_figure(folder / figure, RESULTS / name / figure, measured(version, seconds)[0])
    render()
    return found


def without_comments(path: str, text: str) -> str:
    """What of a file can change a figure: no comments, no layout, and in C++ no words in quotes, which are messages."""
    cpp = Path(path).suffix in (".cpp", ".hpp", ".h")
    if cpp:
        text = QUOTED.sub('""', text)
    words = " ".join(re.sub(r"//.*" if cpp else r"#.*", "", line) for line in text.splitlines()).split()
    joined = re.sub(r'(""\s*)+', '""', " ".join(words))
    return re.sub(r"(?<=\W) | (?=\W)", "", joined) if cpp else joined  # a longer message may break its line elsewhere


def texts_of(commit: str, names: list[str]) -> list[str]:
    """Files as they were; empty where there was none."""
    asked = "".join(f"{commit}:{name}\n" for name in names).encode()
    said = subprocess.run(["git", "-C", str(ROOT), "cat-file", "--batch"], input=asked, check=True, capture_output=True).stdout
    texts, at = [], 0
    for _ in names:
        end = said.index(b"\n", at)
        words = said[at:end].split()
        at = end + 1
        if words[-1] == b"missing":
            texts.append("")
            continue
        size = int(words[-1])
        texts.append(said[at:at + size].decode("utf-8", "replace"))
        at += size + 1
    return texts


def motion_key(commit: str | None) -> str:
    """Of the code of MOTION at a commit, or as it lies here, without comments and messages."""
    lying = ("ls-files", "--cached", "--others", "--exclude-standard")
    listed = git(*(("ls-tree", "-r", "--name-only", commit) if commit else lying), "--", *MOTION)
    names = sorted(name for name in listed.split() if name.endswith((".cpp", ".hpp")) and (commit or (ROOT / name).is_file()))
    texts = texts_of(commit, names) if commit else [(ROOT / name).read_text(encoding="utf-8") for name in names]
    code = "\0".join(f"{name}\0{without_comments(name, text)}" for name, text in zip(names, texts))
    return hashlib.sha256(code.encode()).hexdigest()[:16]


def scenes() -> list[str]:
    """All built-in scenes, and one by the other time rule."""
    return [*sorted(path.stem for path in (ROOT / "data").glob("*.toml") if path.stem != "presets"), "living_figure_eight time.rule=midpoint"]


def digests() -> dict[str, dict[str, str]]:
    """By motion_key, of each scene."""
    if not DIGESTS.exists():
        return {}
    table = read_table(DIGESTS)
    return {row[0]: dict(zip(table.head[1:], row[1:])) for row in table.rows}


def note_digests(program: Path) -> None:
    """`program SCENE` says `SCENE: DIGEST of ...`. Digests of scenes that are no more are dropped; a scene that was not
    yet has none."""
    digest = lambda scene: subprocess.run([program, *scene.split()], check=True, capture_output=True, text=True).stdout.split()[1]
    now = {scene: digest(scene) for scene in scenes()}
    known = {key: {scene: row.get(scene, "") for scene in now} for key,
             row in digests().items()} | {motion_key(None): now}
    write(DIGESTS, Table(["code", *now], [[key, *row.values()] for key, row in known.items()],
                         ["Digests of q at every frame by the portable build (live_digest), for the code of core and "
                          "solvers with that key."]))


def moves_as(commit: str) -> bool:
    known = digests()
    then, now = known.get(motion_key(commit)), known.get(motion_key(None))
    return then is not None and now is not None and all(digest in ("", now[scene]) for scene, digest in then.items())


def changed_since(commit: str) -> int | None:
    """Files of CODE whose code is not what it was then, in a way that digests do not tell to be none; None where the commit is not
    known."""
    try:
        names = git("diff", "--name-only", "--no-renames", commit, "--", *CODE).split()
    except subprocess.CalledProcessError:
        return None
    names = [name for name in names if not name.endswith((".md", ".cmake"))]
    now = [(ROOT / name).read_text(encoding="utf-8", errors="replace") if (ROOT / name).is_file() else ""
           for name in names]
    changed = [name for name, old, new in zip(names, texts_of(commit, names), now)
               if without_comments(name, old) != without_comments(name, new)]
    if changed and all(name.startswith(MOTION) for name in changed) and moves_as(commit):
        return 0
    return len(changed)


def mark() -> None:
    counts: dict[str, int | None] = {}
    for path in dict.fromkeys(path for name in names() for path in tables_of(name) + data_of(name)):
        table = read_table(path)
        match = next((found for note in table.notes if (found := MEASURED.match(note))), None)
        if match is None:
            raise LogError(f"{path.name}: no note says at which commit it was measured")
        for commit in (commits := match[1].replace("+", "").split(", ")):
            counts.setdefault(commit, changed_since(commit))
        notes = [note for note in table.notes if not note.startswith(OLDER)]
        if any(counts[commit] is None for commit in commits):
            notes.append(f"{OLDER} the history has been rewritten; how much code has changed is not known.")
        elif any(counts[commit] for commit in commits):
            notes.append(f"{OLDER} the simulator or its scenes have changed, in more than comments and messages.")
        if notes != table.notes:
            write_csv(path, table.head, table.rows, notes)
    render()


def list_pages() -> None:
    for name in names():
        took = [note for path in tables_of(name)[:1] for note in read_table(path).notes if note.startswith("The study took")]
        print(f"{name:16s} {question_of(name)} {took[0] if took else ''}".rstrip())


def main(arguments: list[str]) -> int:
    try:
        match arguments:
            case ["render"]:
                render()
            case ["mark"]:
                mark()
            case ["digest", program]:
                note_digests(Path(program))
            case ["names"]:
                print(*names(), sep="\n")
            case ["list"]:
                list_pages()
            case ["page", name]:
                settings_of(name)
            case ["adopt", name, folder, version, seconds]:
                found = adopt(name, Path(folder), version, float(seconds))
                print(*(found or [f"{name}: nothing differs by more than chance"]), sep="\n")
                return 1 if found else 0
            case _:
                print(__doc__, file=sys.stderr)
                return 2
    except LogError as error:
        print(f"results: {error}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
