"""The page of results on forces says what its table says; how runs are compared, by hand."""

from pathlib import Path

import numpy as np

import forces
import tables

RESULTS = Path(__file__).resolve().parents[4] / "experiments" / "results"


def test_the_page_is_made_of_its_table(tmp_path):
    rows, notes = forces.read_table(RESULTS / "forces.csv")
    tables.write_page(tmp_path / "forces.md", forces.page(rows, notes))
    assert (tmp_path / "forces.md").read_text(encoding="utf-8") == (RESULTS / "forces.md").read_text(encoding="utf-8")


def test_what_is_off_is_a_share_of_what_is_wanted():
    wanted = np.array([[3.0, 0.0], [0.0, 4.0]])
    assert forces.off(wanted, wanted) == 0
    assert np.isclose(forces.off(wanted + [[0, 0], [0, 0.5]], wanted), 10)
    # Windows of two frames; what is left at the end is left out.
    assert np.allclose(forces.long_means(np.array([[1.0], [3.0], [5.0], [7.0], [100.0]]), 2), [[2], [6]])
