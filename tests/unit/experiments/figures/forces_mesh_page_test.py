"""The page of results on the mesh says what its table says; a chain on a curve, and sudden steps, by hand."""

from pathlib import Path

import numpy as np

import carried_curve
import forces_mesh
import tables

RESULTS = Path(__file__).resolve().parents[4] / "experiments" / "results"


def alternating(bodies: int, length: float = 40.0) -> carried_curve.Chain:
    kinds = [(body, kind) for body in range(1, bodies) for kind in (["bend_y", "bend_z"] if body % 2 else ["twist"])]
    return carried_curve.Chain(bodies, length / bodies, np.array([body for body, _ in kinds]), np.array([kind for _, kind in kinds]))


def bent(chain: carried_curve.Chain, curvature: float, twist: float = 0.0, swell: bool = False) -> np.ndarray:
    """Coordinates of a chain that has them everywhere, 1/cm and rad/cm, or in its middle and from there less, to nothing at its ends."""
    each = {"bend_y": curvature, "bend_z": 0.0, "twist": twist}
    q = np.concatenate([[0, 0, 0, 1, 0, 0, 0], np.zeros(len(chain.joint))])
    for kind, value in each.items():
        edges = chain.edges(kind)
        share = np.sin(np.pi * 0.5 * (edges[1:] + edges[:-1]) / edges[-1]) ** 2 if swell else 1.0
        q[7:][chain.kind == kind] = value * share * np.diff(edges)
    return q


def test_the_page_is_made_of_its_table(tmp_path):
    tables.write_page(tmp_path / "page.md", forces_mesh.page(*forces_mesh.read_table(RESULTS / "forces_mesh.csv")))
    assert (tmp_path / "page.md").read_text(encoding="utf-8") == (RESULTS / "forces_mesh.md").read_text(encoding="utf-8")


def test_bodies_that_bend_at_every_other_joint_lie_inside_their_circle():
    radius = 5.0
    for bodies in (100, 200):
        chain = alternating(bodies)
        a, b, c = carried_curve.places(chain, bent(chain, 1 / radius))[0][[20, 31, 42]]
        sides = [np.linalg.norm(x - y) for x, y in ((a, b), (b, c), (c, a))]
        through = np.prod(sides) / (2 * np.linalg.norm(np.cross(b - a, c - a)))
        assert np.isclose((radius - through) / (chain.h**2 / radius), carried_curve.INSIDE, rtol=0.01)


def test_a_carried_curve_errs_by_the_second_order_and_less_where_it_is_corrected():
    fine = alternating(400)
    q = bent(fine, 0.3, 0.1, swell=True)
    off = {inside: [carried_curve.carried(fine, q, alternating(bodies), inside)[1] for bodies in (50, 100)] for inside in (0.0, carried_curve.INSIDE)}
    # 64 - 1 over 16 - 1 where 400 bodies are the measure.
    assert 3.5 < off[0.0][0] / off[0.0][1] < 5
    assert off[carried_curve.INSIDE][1] < 0.2 * off[0.0][1]
    same, misplaced = carried_curve.carried(fine, q, fine, 0.0)
    assert np.allclose(same, q) and misplaced < 1e-9


def test_sudden_steps_are_those_far_above_what_is_around_them():
    steady = np.full(200, 10.0)
    assert forces_mesh.sudden_share(steady) == 0
    steady[[40, 90]] = 60.0
    assert np.isclose(forces_mesh.sudden_share(steady), 100 * 100 / 2100)


def test_universal_joints_that_turn_about_y_before_z_err_by_the_first_order_and_in_turn_by_the_second():
    first, second = ([carried_curve.turns_off(bodies, in_turn) for bodies in (50, 100)] for in_turn in (False, True))
    assert np.isclose(first[0] / first[1], 2, rtol=0.05)
    assert np.isclose(second[0] / second[1], 4, rtol=0.05)
