"""`hagfish sure`: a run a change, each the run that `hagfish run` makes of it; spreads, by hand."""

import csv
from pathlib import Path

import numpy as np
import pytest

import sure
import sweep_columns
from program import hagfish, logged, sets, table

SHORT = sets("time.duration=0.2", "time.until=form", "expect.knot=")


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    folder = tmp_path_factory.mktemp("sure")
    (folder / "said.txt").write_text(hagfish(folder, "sure", "table1", *SHORT, "--out", "s", "--quiet"))
    return folder


def rows(path: Path) -> list[dict[str, str]]:
    with path.open(newline="") as file:
        return list(csv.DictReader(file))


def test_each_cause_changes_its_own_settings_alone(folder):
    causes, cells = rows(folder / "s/causes.csv"), rows(folder / "s/table.csv")
    assert len(causes) == len(cells) and causes[0]["cause"] == "as it is"
    keys = {"chance": "start.", "start": "start.", "step": "time.step", "bodies": "model.bodies",
            "girth": "specimen.circumference", "limits": "model.limit_scale", "stiffness": "model."}
    settings = list(cells[0])[1:list(cells[0]).index("outcome")]
    for cause, cell in zip(causes, cells):
        changed = {key for key in settings if cell[key]}
        assert bool(changed) == (cause["cause"] != "as it is")
        assert all(key.startswith(keys[cause["cause"]]) for key in changed)
    assert {row["cause"] for row in causes} == {"as it is", *keys}
    values = lambda key: sorted(float(cell[key].strip("[]").split(",")[0]) for cell in cells if cell[key])
    bodies = values("model.bodies")
    assert bodies[0] == 60 and bodies[-1] == 200 and 96 in bodies
    assert values("time.step") == pytest.approx([0.001, 0.00125, 0.0025])
    assert values("specimen.circumference") == pytest.approx([0.95 * 5.6, 1.05 * 5.6])


def test_a_cell_is_the_run_with_that_setting(folder):
    cell = next(cell for cell in rows(folder / "s/table.csv") if cell["model.bodies"] == "96")
    logged(folder, "table1", *SHORT, "--set", "model.bodies=96")
    hagfish(folder, "export", "a.h5", "--out", "a")
    (work,) = table(folder / "a/summary.csv")["work_tip_erg"]
    assert work == pytest.approx(float(cell["work_tip_erg"]), rel=1e-8)  # nine digits


def test_what_it_says_and_leaves_is_the_spread_of_the_runs(folder):
    cells, causes = rows(folder / "s/table.csv"), [row["cause"] for row in rows(folder / "s/causes.csv")]
    work = np.array([float(cell["work_tip_erg"]) for cell in cells])
    own = work[[cause in ("as it is", "bodies") for cause in causes]]
    spreads = {(row["figure"], row["cause"]): row for row in rows(folder / "s/sure.csv")}
    found = spreads["work_tip_erg", "bodies"]
    wanted = [own.min(), own.max(), 100 * np.abs(own / work[0] - 1).max()]
    assert [float(found[name]) for name in ("least", "most", "furthest_percent")] == pytest.approx(wanted, rel=1e-5)
    said = (folder / "said.txt").read_text()
    line = next(line for line in said.splitlines() if line.startswith("work_tip_erg"))
    assert f"{work.min():.4g}" in line.split()[-2:] and f"{work.max():.4g}" in line.split()[-2:]
    assert (folder / "s/sure.png").stat().st_size > 10000
    # The same command again runs nothing.
    before = (folder / "s/table.csv").stat().st_mtime_ns
    hagfish(folder, "sure", "table1", *SHORT, "--out", "s", "--quiet")
    assert (folder / "s/table.csv").stat().st_mtime_ns == before


def test_runs_that_end_otherwise_do_not_count():
    number = lambda *values: {name: np.array(values, float) for name in sweep_columns.FIGURES}
    both, grows = sweep_columns.BOTH_ENDS, "only grows"
    texts = {"outcome": ["ok", "ok", "never tied", "ok", "ok"], "knot": ["3_1", "3_1", "", "0_1", "3_1"], "slide": [both, both, "", both, grows]}
    made = sweep_columns.SweepTable({}, texts, number(10, 12, 50, 90, 70))
    found = sure.Sure(made, ["as it is", "step", "step", "bodies", "bodies"])
    step, bodies, _, every = found.spreads(found.table.figures["slide_distance_cm"])
    assert (step.least, step.most, step.furthest, step.runs, step.of) == (10, 12, 20, 1, 2)
    assert np.isnan(bodies.least) and (every.runs, every.of) == (1, 4)
    assert found.lost() == ["step: 1 of 2: never tied", "bodies: 1 of 2: tied 0_1", "bodies: 1 of 2: only grows"]
    texts["slide"][0] = grows  # of a scene that slides no knot all do that end with it
    assert list(found.counted) == [True, True, False, False, True]
