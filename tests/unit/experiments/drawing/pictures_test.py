"""Pictures are drawn from CSV files as studies leave them, of runs made up here."""

from pathlib import Path

import numpy as np
import pytest

import few_numbers_picture
import figure7
import leverage_picture
import plots
import stability_picture
import tables
from conftest import RESULTS


@pytest.fixture
def drawn(monkeypatch):
    """The figures that would be written."""
    figures = []
    monkeypatch.setattr(plots, "save", lambda figure, png: figures.append(figure))
    return figures


def table_of(folder, head, rows):
    path = folder / "t.csv"
    tables.write_csv(path, head, [[row.get(name, "") for name in head] for row in rows], ["Measured at abc."])
    return tables.read_csv(path, head)


def joined(axes):
    """Lines through points at several places, but for those across the whole panel."""
    lines = [line for line in axes.lines if line.get_linestyle() != "None" and line.get_transform() == axes.transData]
    return [line for line in lines if len(set(np.round(np.asarray(line.get_xdata(), float), 6))) > 1]


def test_few_numbers_are_medians_of_the_knots_and_the_least(tmp_path, drawn):
    point = lambda knot, frame, numbers, share: {"knot": knot, "frame": frame, "found each, s": "0.1", "numbers": numbers, "share": share}
    rows = [point(knot, frame, n, way * n / 9) for frame in few_numbers_picture.FRAMES for n in (3, 9)
            for knot, way in (("3_1", 0.3), ("4_1", 0.9), ("5_1", 0.6))]
    few_numbers_picture.draw(table_of(tmp_path, few_numbers_picture.HEAD, rows), Path("x.png"))
    for line, _, (bars,) in drawn[0].axes[0].containers:
        np.testing.assert_allclose(line.get_ydata(), [0.2, 0.6])
        np.testing.assert_allclose([segment[:, 1].tolist() for segment in bars.get_segments()], [[0.1, 0.2], [0.3, 0.6]])
    assert len(drawn[0].axes[0].containers) == len(few_numbers_picture.FRAMES)


def test_pulls_have_the_spread_of_their_starts_and_meshes(tmp_path, drawn):
    run = lambda kind, value, seed, pull: {"kind": kind, "body": "living", "knot": "4_1", "value": value, "seed": seed, "outcome": "pulled", "pull_N": pull,
                                           "torque_mean_N_cm": 1, "estimate_N": 1, "too_deep": "no"}
    rows = [run("start", 0, 1, 0.2), run("start", 0, 2, 0.4), run("step", 0.002, 1, 0.6), run("bodies", 150, 1, 0.1), run("cap", 2, 1, 0.3)]
    seconds = [{"body": "living", "knot": "4_1", "second": k + 0.5, "pull_N": k} for k in range(3)]
    leverage_picture.draw(table_of(tmp_path, leverage_picture.HEAD, rows), table_of(tmp_path, leverage_picture.TIME_HEAD, seconds), Path("x.png"))
    assert [0, 1, 2] in [list(line.get_ydata()) for line in drawn[0].axes[3].lines]
    caps = drawn[0].axes[0]
    assert not joined(caps)
    assert [0.1, 0.6] in [list(line.get_ydata()) for line in caps.lines if line.get_linestyle() == "-"]
    low, high = caps.collections[0].get_segments()[0][:, 1]
    assert (low, high) == pytest.approx((0.3 - np.std([0.2, 0.4], ddof=1), 0.3 + np.std([0.2, 0.4], ddof=1)))


def test_methods_without_a_watch_stand_beside_mujoco(tmp_path, drawn):
    head, *rows = ([*row] for row in (["scene", "default", "Euler, no guard", "MuJoCo Euler"], ["whip", "all (50)", "none (energy gain)", "5 (limits)"]))
    stability_picture.draw_summary(head, rows, Path("x.png"))
    assert [text.get_text() for text in drawn[0].axes[0].texts] == ["50", "none E", "5 L"]
    stability_picture.main(RESULTS / "stability/stability.csv", Path("x.png"))
    assert len(drawn) == 2


@pytest.mark.parametrize("length", (5.0, 42.4, 200.0))
def test_stages_fill_the_page_whatever_the_length(length):
    shares = np.array([1, 0.7, 0.5, 0.4, 0.4, 0.4, 0.4, 0.4, 0.9])
    per_cm, rows = figure7.fitted(np.zeros(9), length * shares)
    widths = np.maximum(length * shares * per_cm + 2 * figure7.GAP, figure7.LEAST_WIDTH)
    assert sorted(sum(rows, [])) == list(range(9))
    assert 0.97 * plots.WIDTH < max(sum(widths[i] for i in row) for row in rows) <= plots.WIDTH
