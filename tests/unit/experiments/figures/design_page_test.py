"""The page of found programs says what its table says."""

from pathlib import Path

import design
import tables

HEAD = "cell,outcome,unmet,message\n"
RESULTS = Path(__file__).resolve().parents[4] / "experiments" / "results"


def test_the_page_is_made_of_its_table(tmp_path):
    tables.write_page(tmp_path / "design.md", design.page(*design.read_table(RESULTS / "design.csv")))
    assert (tmp_path / "design.md").read_text(encoding="utf-8") == (RESULTS / "design.md").read_text(encoding="utf-8")


def test_an_animal_is_served_by_a_run_that_ends_and_meets_all(tmp_path):
    for law, rows in (("paper", ["ok,,", "ok,Eq. 6,", "never tied,,why"]), ("reflex", ["ok,,", "ok,,", "capped,slide,why"])):
        (tmp_path / f"unseen_{law}").mkdir()
        (tmp_path / f"unseen_{law}/table.csv").write_text(HEAD + "".join(f"{cell},{row}\n" for cell, row in enumerate(rows)))
    assert design.served(tmp_path, "paper") == "1"
    assert design.served(tmp_path, "reflex") == "2"
    assert design.served(tmp_path / "none", "paper") == ""
