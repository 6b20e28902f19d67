"""The page of found programs says what its table says."""

from pathlib import Path

import design
import tables

RESULTS = Path(__file__).resolve().parents[4] / "experiments" / "results"


def test_the_page_is_made_of_its_table(tmp_path):
    tables.write_page(tmp_path / "design.md", design.page(*design.read_table(RESULTS / "design.csv")))
    assert (tmp_path / "design.md").read_text(encoding="utf-8") == (RESULTS / "design.md").read_text(encoding="utf-8")
