"""The page of results on the reflex says what its table says."""

from pathlib import Path

import reflex
import tables

RESULTS = Path(__file__).resolve().parents[4] / "experiments" / "results"


def test_the_page_is_made_of_its_table(tmp_path):
    rows, notes = reflex.read_table(RESULTS / "reflex.csv")
    tables.write_page(tmp_path / "reflex.md", reflex.page(rows, notes))
    assert (tmp_path / "reflex.md").read_text(encoding="utf-8") == (RESULTS / "reflex.md").read_text(encoding="utf-8")
