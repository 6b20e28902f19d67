"""Settings that would be recorded and do nothing are refused by name."""

import pytest

from program import ROOT, logged, refused, sets


@pytest.mark.parametrize(
    ("scene", "key", "why"),
    [
        ("table1", "start.seed=3", "start.noise_deg is 0"),
        ("table1", "script.noise_seed=3", "script.noise is 0"),
        ("table1", "script.spring=3", 'script.kind = "position"'),
        ("table1", "food.strength=3", "food.hold is 0"),
        ("table1", "time.passes=3", "midpoint"),
        ("table1", "controller.knot_speed.gain=1", "knot_speed"),
        ("table1", "controller.reflex.shift=1", "reflex"),
        ("table1", "controller.reverse_head.a=1", "controller.leave_by"),
        ("table1", "controller.reflex.noise=0.1", '"reflex" or "reflex_muscles" reads it'),
        ("table1", "muscle.activation_time=0.1", "drives no muscles"),
        ("table1", "time.ring_damping=2", "midpoint"),
        ("table1", "active.tone_time=0.2", "no torque is active"),
        ("table1", "script.program=p.csv", 'script.kind = "curvature"'),
        ("table1_as_printed", "constraints.corrections=3", "corrects no step"),
        ("reflex_overhand", "controller.slide_head.a=1", "asks for no speeds"),
        ("reflex_overhand", "controller.cap=3000", "asks for no speeds"),
        ("reflex_reverse", "controller.reverse_head.a=1", "asks for no speeds"),
        ("reflex_overhand", "start.seed=2", "start.noise_deg is 0"),
        ("living_overhand_free", "controller.free_from=slide", "clamp_head is false"),
        ("living_overhand", "model.bending_stiffness=1", "model.passive"),
    ],
)
def test_a_run_refuses_what_does_nothing(tmp_path, scene, key, why):
    told = f"--set {key.split('=')[0]}: has no effect here"
    refused(tmp_path, "run", scene, "--set", key, "--out", "a.h5", parts=(told, why))


@pytest.mark.parametrize(
    ("grid", "key", "why"),
    [
        ('[[axis]]\n"start.seed" = [1, 2]\n', "start.seed", "start.noise_deg is 0"),
        ('set = ["food.strength=3"]\n[[axis]]\n"model.bodies" = [20, 30]\n', "food.strength", "food.hold is 0"),
    ],
)
def test_a_sweep_refuses_what_does_nothing_in_all_cells(tmp_path, grid, key, why):
    (tmp_path / "grid.toml").write_text(f'scene = "table1"\n{grid}')
    told = f"{key}: has no effect in any cell"
    refused(tmp_path, "sweep", "grid.toml", "--out", "out", parts=("grid.toml", told, why))


def test_a_sweep_takes_what_two_of_its_axes_make_act(tmp_path):
    axes = {"law": ["paper", "reflex"], "reflex.noise": [0, 0.1], "reflex.seed": [1, 2]}
    text = "".join(f'[[axis]]\n"controller.{key}" = {values}\n' for key, values in axes.items())
    (tmp_path / "grid.toml").write_text(f'scene = "reflex_overhand"\n{text}')
    refused(tmp_path, "sweep", "grid.toml", "--out", "out", "--part", "2/1", parts=("--part 2/1",))


GRIDS = sorted((ROOT / "experiments/results").glob("*/grids/*.toml"))


@pytest.mark.parametrize("grid", GRIDS, ids=lambda grid: f"{grid.parts[-3]}-{grid.stem}")
def test_all_that_the_studies_set_does_something(tmp_path, grid):
    """What is refused is the part, after the keys: no run begins."""
    refused(tmp_path, "sweep", str(grid), "--out", "out", "--part", "2/1", parts=("--part 2/1",))


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return logged(tmp_path_factory.mktemp("branch"), "table1").parent


@pytest.mark.parametrize(
    ("time", "set_", "parts"),
    [
        (8, ["start.seed=2", "start.noise_deg=0.3"], ("start.seed", "begins where its log stands")),
        (8, ["start.noise_deg=0.3"], ("start.noise_deg", "begins where its log stands")),
        (8, ["start.phase=slide"], ("start.phase", "begins where its log stands")),
        (8, ["script.noise_seed=2"], ("script.noise_seed", "script.noise is 0")),
        (14, ["script.noise=2.0"], ("script.noise", "begins in phase slide")),
        (14, ["controller.tighten_time=1"], ("controller.tighten_time", "begins in phase slide")),
        (14, ["time.duration=10"], ("cannot branch at 14 s", "time.duration = 10 s")),
    ],
)
def test_a_branch_refuses_what_does_nothing(folder, time, set_, parts):
    refused(folder, "branch", "a.h5", "--time", time, *sets(*set_), "--out", "b.h5", parts=parts)
