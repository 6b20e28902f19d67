"""The reference that scripts make is made of what is there now."""

import re
import sys

import lines
import pytest
from pages import ROOT

sys.path.insert(0, str(ROOT / "experiments/docs/reference"))
import scene_keys  # noqa: E402

STATED = {  # keys whose value the paper states, and where
    "specimen": "Table 1", "clamp_head": "3.1", "model.bodies": "3.1", "model.joints": "3.1", "wall.present": "3.1", "script.kind": "3.2",
    "controller.law": "3.2", "controller.eq6_slip": "Eq. 6", "controller.leave_by": "3.2",
    **{f"controller.{phase}_{end}": "Table 1" for phase in ("tighten", "slide") for end in ("head", "tail")}, "expect.knot": "5"}


def test_scene_keys_are_those_of_the_commented_scene():
    source = (ROOT / "data/table1.toml").read_text(encoding="utf-8")
    page = scene_keys.page(source)
    assert page == (ROOT / "experiments/docs/reference/scene_keys.md").read_text(encoding="utf-8"), "make it again: see its first line"
    assert page.count("\n| `") == len(re.findall(r"^[a-z_0-9]+ = ", source, re.MULTILINE))


def test_the_paper_s_values_are_marked_and_no_others():
    lines = (ROOT / "data/table1.toml").read_text(encoding="utf-8").splitlines()
    rows = scene_keys.rows_of(lines[next(k for k, line in enumerate(lines) if not line):])  # behind the comment of the whole file
    marked = {f"{section}.{key}".lstrip("."): place for section, key, _, comment in rows for place in re.findall(r"\(paper, (.*?)\)", comment) if key}
    assert marked == STATED


@pytest.mark.skipif(not (ROOT / ".git").exists(), reason="needs git")
def test_lines_of_code_are_those_that_contributing_says():
    said = dict(re.findall(r"^\| (.+) \| (\d+\.\d) \|$", (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8"), re.MULTILINE))
    counted = lines.thousands()
    assert list(said) == list(counted)
    for part, count in counted.items():
        assert float(said[part]) == pytest.approx(count, rel=0.02), "python3 tests/documents/lines.py prints the table"
