"""Every command of the tutorials and how-to pages runs, and says what the page shows.

Blocks marked bash are run, a page's in order, as one script from the top of the project. Blocks marked text are what they say: each
line must be among what was printed, but for its numbers.
"""

from __future__ import annotations

import os
import re
import subprocess
from pathlib import Path

import pytest

from pages import ROOT

PROGRAM = Path(os.environ.get("HAGFISH_PROGRAM", ROOT / "build/release/experiments/hagfish"))
TUTORIALS = sorted((ROOT / "experiments/tutorials").glob("*.md"))
HOWTO = sorted(path for path in (ROOT / "experiments/howto").glob("*.md") if "```bash" in path.read_text(encoding="utf-8"))
BLOCK = re.compile(r"^```(bash|text)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
NUMBER = re.compile(r"[-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?")


def blocks(path: Path, kind: str) -> list[str]:
    return [text for what, text in BLOCK.findall(path.read_text(encoding="utf-8")) if what == kind]


def without_numbers(text: str) -> str:
    return " ".join(NUMBER.sub("#", text).split())


@pytest.fixture
def project(tmp_path):
    """The project's folders, its program at its usual place, and a log knot.h5 for the how-to pages."""
    for path in ROOT.iterdir():
        if path.name not in ("build", "out", ".git"):
            (tmp_path / path.name).symlink_to(path)
    (tmp_path / "build/release").mkdir(parents=True)
    (tmp_path / "build/release/experiments").symlink_to(PROGRAM.parent)
    return tmp_path


def run(folder: Path, text: str) -> str:
    environment = os.environ | {"PATH": f"{PROGRAM.parent}:/usr/bin:/bin", "OPENBLAS_NUM_THREADS": "1", "PYTHONDONTWRITEBYTECODE": "1"}
    done = subprocess.run(["bash", "-euo", "pipefail", "-c", text], cwd=folder, env=environment, capture_output=True, text=True, timeout=1800)
    said = done.stdout + done.stderr
    assert done.returncode == 0, said
    return said


@pytest.mark.parametrize("path", TUTORIALS, ids=lambda path: path.stem)
def test_a_tutorial_runs_and_says_what_it_shows(path, project):
    assert blocks(path, "bash"), "a tutorial without commands"
    said = without_numbers(run(project, "\n".join(blocks(path, "bash"))))
    for line in (line for text in blocks(path, "text") for line in text.splitlines()):
        assert without_numbers(line) in said, line


@pytest.fixture(scope="module")
def knot(tmp_path_factory):
    folder = tmp_path_factory.mktemp("knot")
    run(folder, "hagfish run living_overhand --quiet --out knot.h5")
    return folder / "knot.h5"


@pytest.mark.parametrize("path", HOWTO, ids=lambda path: path.stem)
def test_a_how_to_page_runs(path, tmp_path, knot):
    (tmp_path / "knot.h5").symlink_to(knot)
    run(tmp_path, "\n".join(blocks(path, "bash")))
