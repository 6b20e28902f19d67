"""Documents can be read: short sentences, short front pages, links that lead somewhere, no commits in prose."""

import re
from pathlib import Path

import pytest

from pages import FENCE, LINK, ROOT, documents, paragraphs, plain, sentences

LONGEST = 40  # words of a sentence
MEAN = 18
FOR_ALL = [ROOT / "README.md", ROOT / "experiments/README.md", *sorted(ROOT.glob("experiments/docs/tutorials/*.md")), *sorted(ROOT.glob("experiments/docs/howto/*.md"))]
COMMIT = re.compile(r"\b(?=[0-9a-f]*\d)(?=[0-9a-f]*[a-f])[0-9a-f]{7,40}\b")
STAMP = "Measured "  # of a page that a study writes
name = lambda path: str(path.relative_to(ROOT))


@pytest.mark.parametrize("path", FOR_ALL, ids=name)
def test_sentences_are_short(path):
    found = sentences(path.read_text(encoding="utf-8"))
    words = [len(each.split()) for each in found]
    assert max(words) <= LONGEST, max(found, key=lambda each: len(each.split()))
    assert sum(words) / len(words) <= MEAN


def test_front_pages_are_short():
    assert len((ROOT / "README.md").read_text(encoding="utf-8").splitlines()) <= 120
    assert len((ROOT / "experiments/README.md").read_text(encoding="utf-8").split()) <= 600


def anchors(path: Path) -> set[str]:
    """Of a page's headings, as public hosts make them."""
    headings = re.findall(r"^#+ (.+)$", FENCE.sub("", path.read_text(encoding="utf-8")), re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", plain_heading.lower()).replace(" ", "-") for plain_heading in (LINK.sub(r"\1", each) for each in headings)}


@pytest.mark.parametrize("path", documents(), ids=name)
def test_links_lead_somewhere(path):
    for _, target in LINK.findall(FENCE.sub("", path.read_text(encoding="utf-8"))):
        if target.startswith(("http:", "https:", "mailto:")):
            continue
        place, _, anchor = target.partition("#")
        there = (path.parent / place).resolve() if place else path
        assert there.exists(), target
        if anchor:
            assert anchor in anchors(there), target


@pytest.mark.parametrize("path", documents(), ids=name)
def test_prose_names_no_commit(path):
    for paragraph in paragraphs(path.read_text(encoding="utf-8")):
        if path.name != "CHANGELOG.md" and STAMP not in paragraph:
            assert not COMMIT.search(plain(paragraph)), paragraph


def test_what_counts_as_a_sentence():
    text = "# Head\n\nOne two `a b c` three. See Eq. 6 and [four five](x.md).\n\n| a. b. |\n\n```bash\nx. y.\n```\n- item one.\n- item two"
    assert sentences(text) == ["One two code three.", "See Eq 6 and four five.", "item one.", "item two"]
