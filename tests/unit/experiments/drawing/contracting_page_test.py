"""The page of results on what accuracy costs: its front and its choices, by hand."""

import contracting
from page_tables_test import read


def run(cpu, place, **of):
    base = {"law": "reflex", "simulator": "here", "contact_ms": "", "rule": "euler", "bodies": 100, "step_ms": 5.0, "outcome": "ok"}
    return base | {"cpu_s": cpu, **dict.fromkeys(contracting.NEEDS, place)} | of


def test_no_run_is_quicker_and_nearer_than_one_of_the_front():
    quick, worse, hardly, best = run(1.0, 3.0), run(2.0, 4.0), run(2.5, 2.9), run(3.0, 1.0)
    assert contracting.front([best, worse, hardly, quick], "place_cm") == [quick, best]


def test_a_choice_is_near_by_its_mesh_too(tmp_path):
    mesh = {"outcome": "extrapolated", "step_ms": 0.0, "cpu_s": None}
    rows = [run(1.0, 0.2), run(0, 0.3, **mesh), run(2.0, 0.24, bodies=200, rule="midpoint"), run(0, 0.1, bodies=200, **mesh)]
    contracting.choice_table(rows, tmp_path)
    assert read(tmp_path, "contracting_choice")[2] == ["knot's path to 0.25 cm", "midpoint, 200 bodies, 5 ms: 0.24 cm", "2", "figure, 2 s", "", "", ""]
    assert read(tmp_path, "contracting_choice")[3][1:4] == ["none", "", "none"]
