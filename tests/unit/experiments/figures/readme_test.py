"""README's table goes red when it ages, and not for what another machine rounds."""

import pytest

import audits
import readme
import tables
from hagfish_log import LogError

VALUES = {"knot held": "349", "slide": "9.1849", "Eq. 6": "96.43", "penetration": "0.00020153", "head drift": "0",
          "f_thigmo past the knot": "0"}  # the rest is rounding


@pytest.fixture
def files(tmp_path):
    """An audit, and a README with its table."""
    def write(**changes):
        values = dict.fromkeys(readme.ROWS, "4e-15") | VALUES | changes
        tables.write_csv(tmp_path / "c.csv", audits.COLUMNS, [["a.h5", name, value, "1", "", "yes"] for name, value in values.items()])
        return tmp_path / "c.csv", tmp_path / "README.md", tmp_path / "out.md"

    check, page, _ = write()
    page.write_text("\n".join(["# Title", readme.BEGIN, *readme.table(audits.read_findings(check)), readme.END, "more"]))
    return write


@pytest.mark.parametrize("changes", [{}, {"slide": "9.17"}, {"force balance": "1e-15"}, {"knot held": "350"}])
def test_what_chance_and_rounding_leave_open(files, changes):
    readme.main(*files(**changes))


@pytest.mark.parametrize("changes", [{"slide": "8.9"}, {"force balance": "5e-14"}, {"head drift": "1e-9"}, {"penetration": ""}, {"penetration": "0.0006"}])
def test_what_has_aged_is_named(files, capsys, changes):
    with pytest.raises(SystemExit) as stopped:
        readme.main(*files(**changes))
    assert stopped.value.code == 1
    words = readme.ROWS[next(iter(changes))][0]
    assert [line for line in capsys.readouterr().err.splitlines() if words in line]


def test_a_changed_bound_or_row_is_named(files):
    paths = files()
    for old, new in (("≥ 1", "≥ 2"), ("scaled KKT", "KKT"), ("| energy ledger closes, of the energy that passed | ≤ 1 | 4e-15 |\n", "")):
        text = paths[1].read_text()
        paths[1].write_text(text.replace(old, new))
        with pytest.raises(SystemExit):
            readme.main(*paths)
        paths[1].write_text(text)
    readme.main(*paths)


def test_a_readme_without_markers_and_an_audit_without_a_row(files, tmp_path):
    check, page, out = files()
    (tmp_path / "other.md").write_text("none")
    with pytest.raises(LogError, match="does not have the lines"):
        readme.main(check, tmp_path / "other.md", out)
    tables.write_csv(check, audits.COLUMNS, [["a.h5", "slide", "9", "9", "cm", "yes"]])
    with pytest.raises(LogError, match="the audit has no Eq. 6"):
        readme.main(check, page, out)
