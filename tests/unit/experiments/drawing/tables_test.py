"""Tables of the studies and the verdicts that are read from them."""

import pytest

import stability
import tables
from hagfish_log import LogError


def test_markdown():
    assert tables.markdown(["a", "b"], [["1", "2"]]) == ["| a | b |", "|---|---|", "| 1 | 2 |"]


def test_csv_to_six_digits_and_back(tmp_path):
    tables.write_csv(tmp_path / "t.csv", ["a", "b"], [[1 / 3, "x, y"], [2, ""]])
    assert tables.read_csv(tmp_path / "t.csv", ["b"]) == [{"a": "0.333333", "b": "x, y"}, {"a": "2", "b": ""}]
    with pytest.raises(LogError, match="has no column c"):
        tables.read_csv(tmp_path / "t.csv", ["a", "c"])
    tables.write_csv(tmp_path / "empty.csv", ["a"], [])
    with pytest.raises(LogError, match="holds no rows"):
        tables.read_csv(tmp_path / "empty.csv", ["a"])


@pytest.mark.parametrize("outcomes, text", [
    (["ok", "ok", "ok"], "all (5)"), (["ok", "limits", "ok"], "1 (limits)"), (["speed", "ok", "ok"], "none (speed)"),
    (["not applicable"] * 3, "n/a"), ([], "")])
def test_largest_step_that_a_method_survives(outcomes, text):
    cells = [{"h_ms": h, "outcome": outcome} for h, outcome in zip(("1", "2", "5"), outcomes)]
    assert stability.survived(cells[::-1]) == text


def test_an_outcome_or_method_that_no_figure_knows_is_refused(tmp_path):
    for method, outcome in (("default", "fine"), ("magic", "ok")):
        tables.write_csv(tmp_path / "s.csv", ["scene", "level", "method", "h_ms", "outcome"], [["whip", "as is", method, "1", outcome]])
        with pytest.raises(LogError, match="no such"):
            stability.read(tmp_path / "s.csv")
