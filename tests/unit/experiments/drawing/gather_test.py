"""Parts of a sweep, gathered."""

import h5py
import numpy as np
import pytest

import gather
import sweep_columns
import sweep_page
from hagfish_log import LogError
from sweep_columns import FIGURES, TEXTS

HEADING = ",".join(["cell", "drag.normal", "script.kind", "start.seed", *TEXTS, *FIGURES]) + "\n"


def row(cell, drag, kind, seed, outcome="ok", unmet="", message='"no, ""none"""', force=""):
    figures = dict.fromkeys(FIGURES, "0.5") | {"sliding_force_dyn": force}
    return ",".join([str(cell), drag, kind, str(seed), outcome, unmet, message, "3_1", "slides by both ends", *figures.values()]) + "\n"


# Two settings of drag and kind, changed together, from two starts each.
ROWS = [row(0, "1", "force", 1, force="10"), row(1, "1", "force", 2, force="30"), row(2, "1e2", "none", 1, unmet="Eq. 6; slide"),
        row(3, "1e2", "none", 2, outcome="never tied")]


@pytest.fixture
def folder(tmp_path):
    for part in (1, 2, 3):
        (tmp_path / f"table.{part}-of-3.csv").write_text(HEADING + "".join(ROWS[part - 1::3]))
        (tmp_path / f"times.{part}-of-3.csv").write_text("cell,cpu_s\n" + "".join(f"{cell},0.1\n" for cell in range(part - 1, 4, 3)))
    return tmp_path


def test_hdf5_holds_the_table_with_units(folder):
    gather.main(folder)
    with h5py.File(folder / "table.h5") as h5:
        assert list(h5["axes/drag.normal"]) == [1, 1, 100, 100]
        assert list(h5["axes/script.kind"].asstr()) == ["force", "force", "none", "none"]
        assert h5["texts/message"].asstr()[0] == 'no, "none"'
        np.testing.assert_array_equal(h5["figures/sliding_force_dyn"], [10, 30, np.nan, np.nan])
        assert h5["figures/sliding_force_dyn"].attrs["unit"] == "dyn"
    assert "Sweep of 4 runs" in (folder / "page.html").read_text() and not list(folder.glob("*.new"))


@pytest.mark.parametrize("spoil, why", [
    (lambda f: (f / "table.2-of-3.csv").unlink(), "2-of-3"),
    (lambda f: (f / "table.2-of-3.csv").write_text(HEADING), "not its share"),
    (lambda f: (f / "table.2-of-3.csv").write_text(HEADING + ROWS[2]), "not of cell 1"),
    (lambda f: (f / "table.2-of-3.csv").write_text("cell\n1\n"), "differ in their columns"),
    (lambda f: (f / "table.1-of-2.csv").write_text(HEADING), "2 and 3 parts"),
    (lambda f: [path.unlink() for path in f.glob("table.*")], "no part")])
def test_what_does_not_fit_together_is_refused(folder, spoil, why):
    spoil(folder)
    with pytest.raises((LogError, OSError), match=why):
        gather.main(folder)
    assert not (folder / "table.csv").exists()


def test_maps_are_of_what_changes(folder):
    gather.main(folder)
    table = sweep_columns.read_sweep(folder / "table.csv")
    assert list(table.passed) == [True, True, False, False]
    assert list(sweep_page.columns_of(table)) == ["drag.normal"]
    place = np.array([0, 0, 1, 1])
    values = sweep_page.mapped(table.figures["sliding_force_dyn"], place, 0 * place, place >= 0, False)
    np.testing.assert_array_equal(values, [[20], [np.nan]])


def test_a_table_of_another_version_is_refused(folder):
    (folder / "table.csv").write_text(HEADING.replace("kkt,", "") + "0\n")
    with pytest.raises(LogError, match="not a table of this version"):
        sweep_columns.read_sweep(folder / "table.csv")


def test_a_cell_has_its_place_its_figures_and_its_log(folder):
    gather.main(folder)
    cells = list(sweep_columns.read_cells(folder))
    assert [cell.axes["drag.normal"] for cell in cells] == ["1", "1", "1e2", "1e2"]
    assert (cells[2].outcome, cells[2].unmet, cells[3].outcome) == ("ok", ["Eq. 6", "slide"], "never tied")
    assert cells[1].figures["sliding_force_dyn"] == 30 and np.isnan(cells[2].figures["sliding_force_dyn"])
    assert cells[3].path == folder / "logs/3.h5"
