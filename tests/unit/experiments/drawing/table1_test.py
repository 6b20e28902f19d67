"""The table of the Table 1 run goes red when it ages, and not for what another machine rounds."""

import pytest

import audits
import table1
import tables
from hagfish_log import LogError

VALUES = {"knot held": "349", "slide": "9.1849", "slide of both ends": "106", "Eq. 6": "96.43", "penetration": "0.00020153", "head drift": "0",
          "f_thigmo past the knot": "0"}  # the rest is rounding


@pytest.fixture
def files(tmp_path):
    """An audit, and the table that is known of it."""
    def write(**changes):
        values = dict.fromkeys(table1.ROWS, "4e-15") | VALUES | changes
        tables.write_csv(tmp_path / "c.csv", audits.COLUMNS, [["a.h5", name, value, "1", "", "yes"] for name, value in values.items()])
        return tmp_path / "c.csv", tmp_path / "known.csv", tmp_path

    check, known, _ = write()
    tables.write_csv(known, table1.HEAD, table1.table(audits.read_findings(check)), ["Measured somewhere."])
    return write


@pytest.mark.parametrize("changes", [{}, {"slide": "9.17"}, {"force balance": "1e-15"}, {"knot held": "350"}, {"penetration": "0.0003"}])
def test_what_chance_and_rounding_leave_open(files, changes):
    table1.main(*files(**changes))


@pytest.mark.parametrize("changes", [{"slide": "8.9"}, {"slide of both ends": "69"}, {"force balance": "5e-14"}, {"head drift": "1e-9"}, {"penetration": ""}, {"penetration": "0.0006"}])
def test_what_has_aged_is_named(files, capsys, changes):
    with pytest.raises(SystemExit) as stopped:
        table1.main(*files(**changes))
    assert stopped.value.code == 1
    words = table1.ROWS[next(iter(changes))][0]
    assert [line for line in capsys.readouterr().err.splitlines() if words in line]


def test_an_audit_without_a_row(files):
    check, known, out = files()
    tables.write_csv(check, audits.COLUMNS, [["a.h5", "slide", "9", "9", "cm", "yes"]])
    with pytest.raises(LogError, match="the audit has no Eq. 6"):
        table1.main(check, known, out)
