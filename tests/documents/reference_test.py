"""The reference that scripts make is made of what is there now."""

import re
import sys

import lines
import pytest
from pages import ROOT

sys.path.insert(0, str(ROOT / "experiments/docs/reference"))
import scene_keys  # noqa: E402

read = lambda path: (ROOT / path).read_text(encoding="utf-8")
STATED = {  # keys whose value the paper states, and where
    "specimen": "Table 1", "clamp_head": "3.1", "model.bodies": "3.1", "model.joints": "3.1", "wall.present": "3.1", "script.kind": "3.2",
    "controller.law": "3.2", "controller.eq6_slip": "Eq. 6", "controller.leave_by": "3.2",
    **{f"controller.{phase}_{end}": "Table 1" for phase in ("tighten", "slide") for end in ("head", "tail")}, "expect.knot": "5"}


def test_scene_keys_are_those_of_the_commented_scene():
    source = read("data/table1.toml")
    page = scene_keys.page(source)
    assert page == read("experiments/docs/reference/scene_keys.md"), "make it again: see its first line"
    assert page.count("\n| `") == len(re.findall(r"^[a-z_0-9]+ = ", source, re.MULTILINE))


def test_the_paper_s_values_are_marked_and_no_others():
    lines = read("data/table1.toml").splitlines()
    rows = scene_keys.rows_of(lines[next(k for k, line in enumerate(lines) if not line):])  # behind the comment of the whole file
    marked = {f"{section}.{key}".lstrip("."): place for section, key, _, comment in rows for place in re.findall(r"\(paper, (.*?)\)", comment) if key}
    assert marked == STATED


def test_documents_repeat_the_example_and_the_version_as_they_are():
    version = re.search(r"VERSION (\d+\.\d+\.\d+)", read("CMakeLists.txt"))[1]
    page = read("experiments/docs/reference/cpp.md")
    assert f"```cpp\n{read('experiments/example.cpp')}```\n" in page
    assert f"find_package(hagfish {version.rpartition('.')[0]} REQUIRED" in page
    assert re.findall(r"^version: (.*)", read("CITATION.cff"), re.MULTILINE) == [version]
    assert re.search(r"^## \[(\d.*?)\]", read("CHANGELOG.md"), re.MULTILINE)[1] == version


@pytest.mark.skipif(not (ROOT / ".git").exists(), reason="needs git")
def test_lines_of_code_are_those_that_contributing_says():
    said = dict(re.findall(r"^\| (.+) \| (\d+\.\d) \|$", read("CONTRIBUTING.md"), re.MULTILINE))
    counted = lines.thousands()
    assert list(said) == list(counted)
    for part, count in counted.items():
        assert float(said[part]) == pytest.approx(count, rel=0.02), "python3 tests/documents/lines.py prints the table"
