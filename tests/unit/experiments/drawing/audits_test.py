"""Findings of an audit."""

import pytest

import audits
import summary
import tables
from hagfish_log import LogError

FINDINGS = [["a.h5", "status", "complete", "complete", "", "yes"], ["a.h5", "knot held", "1", "1", "", "yes"],
            ["a.h5", "penetration", "0.002", "0.0015", "cm", "no"]]


@pytest.fixture
def check(tmp_path):
    path = tmp_path / "run.check.csv"
    tables.write_csv(path, audits.COLUMNS, FINDINGS)
    return path


def test_what_failed(check):
    assert audits.unmet(audits.read_findings(check)) == ["penetration"]


def test_findings_on_two_logs_are_not_those_on_one(tmp_path):
    tables.write_csv(tmp_path / "c.csv", audits.COLUMNS, [*FINDINGS, ["b.h5", *FINDINGS[0][1:]]])
    with pytest.raises(LogError, match="covers several logs"):
        audits.read_findings(tmp_path / "c.csv")


def test_the_summary_names_what_is_not_met(log, check):
    page = summary.requirements(log(), audits.read_findings(check))
    assert "| status | complete | complete | yes |" in page
    assert "| penetration | 0.002 cm | 0.0015 | **no** |" in page
    assert "| median time of a QP, every step | 1 ms | 4 | yes |" in page
