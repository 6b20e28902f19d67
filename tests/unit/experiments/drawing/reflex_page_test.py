"""The page's tables are made of the table of all runs."""

import reflex
from conftest import RESULTS
from tables import read_table


def test_tables_are_made_of_the_runs(tmp_path):
    reflex.main(tmp_path, RESULTS / "reflex/reflex.csv")
    for path in (RESULTS / "reflex").glob("*.csv"):
        made, stated = read_table(tmp_path / "tables" / path.name), read_table(path)
        assert (made.head, made.rows) == (stated.head, stated.rows), path.name
