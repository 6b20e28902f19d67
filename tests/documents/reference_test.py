"""The reference that scripts make is made of what is there now."""

import re
import sys

from pages import ROOT

sys.path.insert(0, str(ROOT / "experiments/reference"))
import scene_keys  # noqa: E402


def test_scene_keys_are_those_of_the_commented_scene():
    source = (ROOT / "data/table1.toml").read_text(encoding="utf-8")
    page = scene_keys.page(source)
    assert page == (ROOT / "experiments/reference/scene_keys.md").read_text(encoding="utf-8"), "make it again: see its first line"
    assert page.count("\n| `") == len(re.findall(r"^[a-z_0-9]+ = ", source, re.MULTILINE))
