"""Every snippet of the documents runs; tutorials show what is printed.

Blocks marked bash are run, a page's in order, as one script from the top of the project. Blocks marked text are what they print: each
line must be among it, with numbers that are NEAR. Blocks marked python are run as one script of their page, beside a log
knot.h5. Blocks marked toml are scenes, parts of scenes or grids, and are run as such.
"""

import os
import re
import subprocess
import tomllib
from pathlib import Path

import pytest

from pages import ROOT, documents
from program import HAGFISH as PROGRAM
from program import logged

TUTORIALS = sorted((ROOT / "experiments/docs/tutorials").glob("*.md"))
HOWTO = sorted(path for path in (ROOT / "experiments/docs/howto").glob("*.md") if "```bash" in path.read_text(encoding="utf-8"))
BLOCK = re.compile(r"^```(\w*)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
README = ROOT / "README.md"
PACKAGE = PROGRAM.parent / "python"  # of Python, as built
# What other tests run: the two commands of README.md, as whole scripts (table1_page and this), its flowchart, which is drawn, and what the
# consumer test builds (consumer.sh).
ELSEWHERE = {(README, "bash"), (README, "mermaid"), (ROOT / "experiments/docs/reference/cpp.md", "cpp"), (ROOT / "experiments/docs/reference/cpp.md", "cmake")}
NUMBER = re.compile(r"[-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?")
NEAR = 0.1  # share by which numbers of a tutorial may be off: those of another build differ, those of another result are old


def blocks(path: Path, kind: str) -> list[str]:
    return [text for what, text in BLOCK.findall(path.read_text(encoding="utf-8")) if what == kind]


def printed(said: str, line: str) -> bool:
    """Whether `line` is part of `said`, with other spaces and with numbers that are NEAR."""
    words = [r"\s+".join(map(re.escape, re.split(r"\s+", part))) for part in NUMBER.split(line)]
    shown = [float(number) for number in NUMBER.findall(line)]
    near = lambda a, b: abs(a - b) <= NEAR * max(abs(a), abs(b))
    return any(all(map(near, shown, map(float, found.groups()))) for found in re.finditer(f"({NUMBER.pattern})".join(words), said))


@pytest.fixture
def project(tmp_path):
    """The project's folders, its program at its usual place, and a log knot.h5 for the how-to pages."""
    for path in ROOT.iterdir():
        if path.name not in ("build", "out", ".git"):
            (tmp_path / path.name).symlink_to(path)
    (tmp_path / "build/release").mkdir(parents=True)
    (tmp_path / "build/release/experiments").symlink_to(PROGRAM.parent)
    return tmp_path


def with_blocks(kind: str) -> list[Path]:
    return [path for path in documents() if blocks(path, kind)]


def run(folder: Path, text: str) -> str:
    environment = os.environ | {"PATH": f"{PROGRAM.parent}:/usr/bin:/bin", "OPENBLAS_NUM_THREADS": "1", "PYTHONDONTWRITEBYTECODE": "1", "PYTHONPATH": str(PACKAGE)}
    done = subprocess.run(["bash", "-euo", "pipefail", "-c", text], cwd=folder, env=environment, capture_output=True, text=True, timeout=1800)
    said = done.stdout + done.stderr
    assert done.returncode == 0, said
    return said


@pytest.mark.parametrize("path", TUTORIALS, ids=lambda path: path.stem)
def test_a_tutorial_runs_and_says_what_it_shows(path, project):
    assert blocks(path, "bash"), "a tutorial without commands"
    said = run(project, "\n".join(blocks(path, "bash")))
    for line in (line for text in blocks(path, "text") for line in text.splitlines()):
        assert printed(said, line), line


@pytest.fixture(scope="module")
def knot(tmp_path_factory):
    return logged(tmp_path_factory.mktemp("knot"), "living_overhand", out="knot.h5")


@pytest.mark.parametrize("path", HOWTO, ids=lambda path: path.stem)
def test_a_how_to_page_runs(path, tmp_path, knot):
    (tmp_path / "knot.h5").symlink_to(knot)
    run(tmp_path, "\n".join(blocks(path, "bash")))


def name_of(path: Path) -> str:
    return str(path.relative_to(ROOT))


@pytest.mark.parametrize("path", with_blocks("python"), ids=name_of)
def test_python_of_a_page_runs(path, tmp_path, knot):
    (tmp_path / "knot.h5").symlink_to(knot)
    (tmp_path / "page.py").write_text("\n".join(blocks(path, "python")))
    run(tmp_path, "/usr/bin/python3 page.py")


@pytest.mark.parametrize("path", with_blocks("toml"), ids=name_of)
def test_toml_of_a_page_is_a_scene_or_a_grid(path, tmp_path):
    for text in blocks(path, "toml"):
        table = tomllib.loads(text)
        (tmp_path / "page.toml").write_text(text if {"base", "axis"} & set(table) else 'base = "table1"\n' + text)
        if "axis" in table:  # one cell of it
            run(tmp_path, "hagfish sweep page.toml --out grid --part 1/600 --quiet")
        else:
            run(tmp_path, "hagfish run page.toml --until form --set time.duration=0.1 --set expect.knot= --set expect.types=[] --out a.h5 --force --quiet")


def test_the_readmes_commands_run(tmp_path):
    run(tmp_path, "\n".join(blocks(README, "text")))
    assert blocks(README, "bash")[0].split()[:2] == ["bash", "experiments/table1.sh"]
    for line in blocks(README, "bash")[0].splitlines():
        assert (ROOT / line.split()[1]).is_file()


def test_no_snippet_is_left_out():
    run_here = {(path, kind) for paths, kinds in ((TUTORIALS, ("bash", "text")), (HOWTO, ("bash",)), (with_blocks("python"), ("python",)),
                                                  (with_blocks("toml"), ("toml",)), ([README], ("text",))) for path in paths for kind in kinds}
    there = {(path, kind) for path in documents() for kind, _ in BLOCK.findall(path.read_text(encoding="utf-8"))}
    assert there - run_here - ELSEWHERE == set()
