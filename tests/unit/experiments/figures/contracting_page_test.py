"""The page of results on what accuracy costs says what its table says; the front, by hand."""

from pathlib import Path

import contracting
import contracting_today
import tables

RESULTS = Path(__file__).resolve().parents[4] / "experiments" / "results"


def test_the_page_is_made_of_its_table(tmp_path):
    tables.write_page(tmp_path / "page.md", contracting.page(*contracting.read_table(RESULTS / "contracting.csv"), contracting_today.read_table(RESULTS / "contracting_today.csv")))
    assert (tmp_path / "page.md").read_text(encoding="utf-8") == (RESULTS / "contracting.md").read_text(encoding="utf-8")


def test_each_preset_is_a_run_of_the_table():
    rows, _ = contracting.read_table(RESULTS / "contracting.csv")
    for preset in contracting.presets().values():
        assert contracting.one(contracting.done(rows, simulator="here", back_end="active-set"), **preset)


def test_no_run_is_quicker_and_nearer_than_one_of_the_front():
    run = lambda cpu, place: contracting.Row("reflex", "here", "euler", "active-set", 100, 5.0, cpu, "ok", place=place)
    quick, worse, hardly, best = run(1.0, 3.0), run(2.0, 4.0), run(2.5, 2.9), run(3.0, 1.0)
    rows = [best, worse, hardly, quick]
    assert contracting.front(rows, "place") == [quick, best]
    assert [contracting.on_front(row, rows, "place") for row in rows] == [True, False, True, True]
