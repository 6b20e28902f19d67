"""What the READMEs show of the program is there: each command and each of its options."""

from __future__ import annotations

import re
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[4]
sys.dont_write_bytecode = True
sys.path.insert(0, str(ROOT / "tests/support"))

from program import hagfish  # noqa: E402

SHOWN = re.compile(r"^    hagfish ([a-z-]+)([^#\n]*)", re.MULTILINE)  # in blocks of commands, up to a comment


@pytest.mark.parametrize("readme", ["README.md", "experiments/README.md"])
def test_commands_and_options_are_there(readme, tmp_path):
    shown = SHOWN.findall((ROOT / readme).read_text())
    assert len(shown) > 10
    for command, arguments in shown:
        known = set(re.findall(r"--[a-z-]+", hagfish(tmp_path, command, "--help")))
        assert set(re.findall(r"--[a-z-]+", arguments)) <= known, f"hagfish {command}{arguments}"
