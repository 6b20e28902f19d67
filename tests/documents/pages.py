"""The documents as text: prose without code, tables and what scripts write."""

import re
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
FENCE = re.compile(r"^```.*?^```$", re.MULTILINE | re.DOTALL)
WRITTEN = re.compile(r"^<!-- (?:table|stamp|index).*?^<!-- end -->$", re.MULTILINE | re.DOTALL)
COMMENT = re.compile(r"<!--.*?-->", re.DOTALL)
LINK = re.compile(r"!?\[([^\]]*)\]\(([^)\s]+)\)")
CODE = re.compile(r"`[^`]*`")
ABBREVIATION = re.compile(r"\b(Eqs?|Fig|e\.g|i\.e|Neurosci|Rev|Lett|Phys|Sci|Biol|Exp|J|vs|cf)\. ?")


def documents() -> list[Path]:
    return [path for path in sorted(ROOT.rglob("*.md"))
            if not {"build", "out", ".git"} & set(path.relative_to(ROOT).parts) and not path.relative_to(ROOT).parts[0].startswith("build")]


def paragraphs(text: str) -> list[str]:
    """Prose, a paragraph or list item each; inline code and links as their words."""
    text = COMMENT.sub("", WRITTEN.sub("", FENCE.sub("", text)))
    found: list[str] = [""]
    for line in text.splitlines():
        if not line.strip() or line.startswith(("    ", "|", "#", "!")):
            found.append("")
        elif re.match(r"\s*(?:[-*]|\d+\.) ", line):
            found.append(re.sub(r"^\s*(?:[-*]|\d+\.) ", "", line))
        else:
            found[-1] = f"{found[-1]} {line.strip()}".strip()
    return [paragraph for paragraph in found if paragraph]


def plain(paragraph: str) -> str:
    return CODE.sub("code", LINK.sub(r"\1", paragraph))


def sentences(text: str) -> list[str]:
    found = []
    for paragraph in paragraphs(text):
        whole = ABBREVIATION.sub(r"\1 ", plain(paragraph))
        found += [each for each in re.split(r"(?<=[.!?])[)\"*]*\s+", whole) if len(each.split()) > 1]
    return found
