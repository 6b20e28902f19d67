"""The summary of a run leaves out none of its time, and none of its energy, whatever acts in its scene."""

import h5py
import pytest

import summary
from hagfish_log import HagfishLog
from program import outcome

# Of each phase, and of each force that does work or loses energy: scripts, muscles, flesh, gravity, plates and poles.
SCENES = """table1 overhand_reverse pull_overhand living_overhand_free living_overhand_soft muscles_forward reflex_hole_overhand
    robot_overhand slit knot_round_a_pole""".split()
COARSE = ("--preset", "quick", "--set", "time.rule=euler", "--log", "summary", "--quiet")
PULL = ("--set", "time.duration=20")  # of scenes that pull at food: a tighter knot takes ever longer, and tells no more
PRINTED = 0.005  # s, to which times are rounded
CLOSED = 1e-6  # of the energy that passed: the scenes' own expect.energy
DIGITS = 1e-5  # to which energies are rounded


def rows_of(page: list[str]) -> dict[str, list[str]]:
    """The cells of a table by the first one of each row, without its heading."""
    cells = [[cell.strip() for cell in line.strip("|").split("|")] for line in page if line.startswith("|")]
    return {first: others for first, *others in cells[2:]}


@pytest.mark.parametrize("scene", SCENES)
def test_a_summary_has_all_time_and_energy(tmp_path, scene):
    # Coarse and cheap: a run that fails so has a summary, too.
    outcome(tmp_path, "run", scene, *COARSE, *(PULL if scene.startswith("pull_") else ()), "--out", "a.h5")
    log = HagfishLog(tmp_path / "a.h5")
    reached = [row for row in rows_of(summary.timetable(log)).values() if row[0] != "not reached"]
    end = 0.0
    for row in reached:
        start, end_of_phase = (float(time) for time in row[0].split(" to "))
        assert start == pytest.approx(end, abs=2 * PRINTED)
        assert float(row[1]) == pytest.approx(end_of_phase - start, abs=3 * PRINTED)
        end = end_of_phase
    assert end == pytest.approx(log["/trajectory/time"][-1], abs=2 * PRINTED)
    energies = {name: float(row[0]) for name, row in rows_of(summary.ledger(log)).items()}
    passed = sum(abs(energy) for energy in energies.values())
    assert abs(energies["left over"]) <= CLOSED * passed
    with h5py.File(tmp_path / "a.h5") as file:
        works = [data[-1] - data[0] for name, data in file["diagnostics"].items() if name.startswith("work_")]
    told = sum(energy for name, energy in energies.items() if name.startswith("work of "))
    assert told == pytest.approx(sum(works), abs=DIGITS * passed)
