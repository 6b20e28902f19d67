"""What the documents show of the program is there: each command and each of its options."""

import re

import pytest

from program import ROOT, hagfish

SHOWN = re.compile(r"^(?:    )?hagfish ([a-z-]+)([^#\n]*)", re.MULTILINE)  # in blocks of commands, up to a comment
FOLDERS = (ROOT / "experiments", ROOT / "data")
PAGES = [ROOT / "README.md", *sorted(path for folder in FOLDERS for path in folder.rglob("*.md"))]


@pytest.mark.parametrize("page", PAGES, ids=lambda path: str(path.relative_to(ROOT)))
def test_commands_and_options_are_there(page, tmp_path):
    shown = SHOWN.findall(page.read_text())
    assert shown or page.name != "commands.md"
    for command, arguments in shown:
        known = set(re.findall(r"--[a-z-]+", hagfish(tmp_path, command, "--help")))
        assert set(re.findall(r"--[a-z-]+", arguments)) <= known, f"hagfish {command}{arguments}"
