"""What the study of few numbers reads from logs: torques of the numbers, and profiles of them by the knot's place."""

import tomllib

import numpy as np
import pytest

from animal import spans
from few_numbers import basis_torque
from hagfish_log import HagfishLog
from played_numbers import profile
from program import logged, script, sets

BRIEF = sets("time.duration=14.5")


STUDY = "results/few_numbers"


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    folder = tmp_path_factory.mktemp("few")
    logged(folder, "few_numbers", *BRIEF)
    return folder


def test_torques_of_the_numbers_are_what_the_run_took_beside_tone(folder):
    log = HagfishLog(folder / "a.h5")
    hinges, joint, kind = log.hinges()
    span, scene = spans(log)[joint], log.scene()
    passive = scene["specimen"]["passive"]  # the same at all stations
    stiffness = np.where(kind == "twist", passive["twist_stiffness"][0], passive["bending_stiffness"][0]) / span
    rest, q = log["/trajectory/q_ref"][:, hinges], log["/trajectory/q"][:, 7:]
    after = q + scene["time"]["step"] * log["/trajectory/qdot_next"][:, hinges]
    tone = scene["active"]["stiffness"] / span * (rest - after) + stiffness * rest
    frames = log.in_phase("slide")
    frames = frames[frames < log.begun()]
    assert frames.size > 20
    wanted = (log["/forces/active"][:, hinges] - tone)[frames]
    assert np.abs(wanted).max() > 100
    rounding = 1e-9 * np.nanmax(np.abs(log["/forces/active"]))
    np.testing.assert_allclose(basis_torque(log)[frames], wanted, rtol=0, atol=rounding)


def test_a_profile_is_of_means_by_place():
    place = np.array([10.0, 9.9, 6.1, 6.0, 2.0])  # hops over 8 and 4
    places, numbers = profile(place, np.array([[1.0, 0], [3, 0], [5, 1], [7, 1], [8, 4]]), 5)
    np.testing.assert_allclose(places, [2, 4, 6, 8, 10])
    np.testing.assert_allclose(numbers, [[8, 4], [7, 2.5], [6, 1], [4, 0.5], [2, 0]])


def test_a_profile_is_a_scene_that_plays_it(folder):
    assert script(f"{STUDY}/played_numbers.py", "a.h5", "b.toml", 4, "few_numbers", folder=folder).returncode == 0
    log = HagfishLog(logged(folder, "b.toml", *BRIEF, out="b.h5"))
    basis = tomllib.loads((folder / "b.toml").read_text())["controller"]["reduced_basis"]
    frame = log.in_phase("slide")[10]
    played = np.reshape(basis["played"], (4, 9))
    now = np.array([np.interp(log["/basis/window"][frame, 0], basis["places"], column) for column in played.T])
    np.testing.assert_allclose(log["/basis/amplitude"][frame], now, rtol=1e-9)


def test_learned_shapes_make_up_the_forces_that_they_were_learned_from(folder):
    log = HagfishLog(logged(folder, "table1", "--set", "time.step=0.02", "--until", "slide", out="d.h5"))
    done = script(f"{STUDY}/sliding_shapes.py", "d.h5", "d.csv", 4, folder=folder)
    said = float(done.stdout.split("hold ")[1].split(" %")[0]) / 100
    rows = np.loadtxt(folder / "d.csv", delimiter=",", skiprows=2)
    hinges, joint, kind = log.hinges()
    left = total = 0.0
    for frame in log.in_phase("slide")[1:]:
        first, last = log["/knot/head_end"][frame] - 2, log["/knot/tail_end"][frame] + 2
        share = (log.joint_arc()[joint] - first) / (last - first)
        inside = (share >= 0) & (share <= 1)
        force = log["/mean/forces/thigmotaxis"][frame, hinges][inside]
        shapes = np.zeros((inside.sum(), 4))
        for k in range(4):
            own = rows[rows[:, 0] == k + 1]
            for column, axis in ((2, "bend_y"), (3, "bend_z"), (4, "twist")):
                of = kind[inside] == axis
                shapes[of, k] = np.interp(share[inside][of], own[:, 1], own[:, column])
        left += np.sum((force - shapes @ np.linalg.lstsq(shapes, force, rcond=None)[0]) ** 2)
        total += np.sum(force**2)
    # Stations are not hinges, and joints take turns in which axis comes first: seen 0.0102 apart. With two axes
    # exchanged shapes make up 0.31.
    assert 0.8 < said < 1 and abs(1 - left / total - said) < 0.02


def test_a_log_without_numbers_is_one_line(folder):
    logged(folder, "table1", *sets("time.step=0.02", "time.duration=0.2"), out="c.h5")
    done = script(f"{STUDY}/played_numbers.py", "c.h5", "c.toml", 4, "table1", folder=folder)
    assert done.returncode == 2 and "c.h5: has no slide of a knot by a reduced basis" in done.stderr
    assert not (folder / "c.toml").exists()
