"""`hagfish run --log`: what logs of each level hold, what each command says of one that holds too little, and that their axes
are named for h5py and xarray."""

from __future__ import annotations

import re
import sys
from pathlib import Path

import h5py
import numpy as np
import pytest

sys.dont_write_bytecode = True
sys.path.insert(0, str(Path(__file__).parents[3] / "support"))

from program import hagfish, refused, table  # noqa: E402

LEVELS = ("summary", "frames", "full")
MICROMETRE = 1e-4  # cm: places are rounded to 2^-13 cm and, like means of forces, stored as floats
SINGLE = 1e-7  # relative


@pytest.fixture(scope="module")
def logs(tmp_path_factory):
    folder = tmp_path_factory.mktemp("levels")
    for level in LEVELS:
        hagfish(folder, "run", "table1", "--preset", "quick", "--quiet", "--log", level, "--out", f"{level}.h5")
    hagfish(folder, "run", "table1", "--preset", "quick", "--quiet", "--out", "default.h5")
    return folder


def series(file):
    found = {}
    file.visititems(lambda path, item: found.update({item.name: item}) if isinstance(item, h5py.Dataset) and item.maxshape
                    and item.maxshape[0] is None else None)
    return found


def test_each_level_holds_the_same_numbers_as_the_full_log(logs):
    files = {level: h5py.File(logs / f"{level}.h5") for level in LEVELS}
    full = series(files["full"])
    sizes = [(logs / f"{level}.h5").stat().st_size for level in LEVELS]
    assert sizes[0] < 0.5 * sizes[1] < 0.25 * sizes[2]
    for level, others in (("summary", "frames"), ("frames", "full")):
        assert set(series(files[level])) < set(series(files[others]))
        for path, own in series(files[level]).items():
            if any(word in path for word in ("wall_time", "qp_time")):
                continue
            place = MICROMETRE if path == "/trajectory/position" else 2.0**-33 if path == "/trajectory/q" else float(np.finfo(np.float32).tiny)
            np.testing.assert_allclose(own[()], full[path][()], rtol=SINGLE, atol=place, err_msg=path)
            assert own.dtype == full[path].dtype or path == "/trajectory/position" or path.startswith("/mean/forces/"), path
            assert own.attrs["unit"] == full[path].attrs["unit"]
            assert own.fletcher32, path
    assert "/trajectory/q" in series(files["frames"]) and "/steps/kkt" not in series(files["frames"])
    assert h5py.File(logs / "default.h5").attrs["log_level"] == "full"


def test_the_reference_tells_the_sizes(tmp_path):
    text = (Path(__file__).parents[4] / "experiments/docs/reference/log_format.md").read_text(encoding="utf-8")
    for level in LEVELS:
        hagfish(tmp_path, "run", "table1", "--quiet", "--log", level, "--out", f"{level}.h5")
        told = float(re.search(rf"^\| `{level}`.* ([\d.]+) MB \|$", text, re.MULTILINE)[1])
        assert (tmp_path / f"{level}.h5").stat().st_size / 1e6 == pytest.approx(told, rel=0.1, abs=0.06), level


def test_commands_that_need_more_say_so_in_one_line(logs):
    wants = {"check": ("full", []), "playback": ("full", ["--out", "p.h5"]),
             "export": ("frames", ["--out", "tables"]), "view": ("frames", ["--out", "v.html"]), "figures": ("frames", []),
             "picture": ("frames", ["--out", "p.png"]), "movie": ("frames", ["--out", "m.mp4"]),
             "program": ("frames", ["--out", "p.csv"])}
    for command, (level, arguments) in wants.items():
        for held in LEVELS[:LEVELS.index(level)]:
            refused(logs, command, f"{held}.h5", *arguments, parts=(f"{held}.h5", f"--log {held}", f"--log {level}"))
    for level in LEVELS:
        assert "slide" in hagfish(logs, "info", f"{level}.h5") and level in hagfish(logs, "info", f"{level}.h5", "--json")
    hagfish(logs, "check", "full.h5")


def test_tables_of_a_log_of_frames_are_those_of_the_full_one(logs):
    for level in ("frames", "full"):
        hagfish(logs, "export", f"{level}.h5", "--out", level)
    for name in sorted(path.name for path in (logs / "full").glob("*.csv")):
        own, full = table(logs / "frames" / name), table(logs / "full" / name)
        assert own.keys() == full.keys()
        for column in ("duration_s", "eq6_percent"):  # of steps, of which a log of frames says nothing
            full.pop(column, None)
        for column, values in full.items():
            if values.dtype.kind in "US":
                assert np.all(own[column] == values) or column.startswith("log"), (name, column)
            elif values.shape == own[column].shape:
                scale = np.nanmax(np.abs(values), initial=0)
                np.testing.assert_allclose(own[column], values, rtol=1e-5, atol=1e-6 * scale, err_msg=f"{name} {column}")
            else:
                raise AssertionError((name, column))


def test_every_axis_has_its_labels(logs):
    for level in LEVELS:
        file = h5py.File(logs / f"{level}.h5")
        for path, dataset in series(file).items():
            for axis, dimension in enumerate(dataset.dims):
                if h5py.h5ds.is_scale(dataset.id):
                    continue
                assert len(dimension) == 1, (path, axis)
                scale = dimension[0]
                assert len(scale) == dataset.shape[axis], (path, axis)
                assert dataset.parent[scale.name.rsplit("/", 1)[-1]] == scale, (path, axis)
    log = h5py.File(logs / "full.h5")
    names = log["forces/limit"].dims[1][0].asstr()[()]
    angles = log["trajectory/q"].dims[1][0].asstr()[()]
    for i in range(len(names) - 6):
        assert angles[7 + i] == names[6 + i] and angles[7 + i].startswith("j")
    np.testing.assert_array_equal(log["forces/limit"].dims[0][0], log["trajectory/time"])
    assert list(log["trajectory/position"].dims[2][0].asstr()) == ["x", "y", "z"]
    np.testing.assert_allclose(log["steps/time"][()], log["trajectory/time"][0] + 0.01 * np.arange(len(log["steps/time"])), atol=1e-9)


def test_xarray_opens_every_group_named(logs):
    import xarray  # with h5netcdf

    for group in ("model", "trajectory", "forces", "thigmotaxis", "mean/forces", "mean/thigmotaxis", "knot", "diagnostics", "steps",
                  "contacts", "pull"):
        opened = xarray.open_dataset(logs / "full.h5", group=group, engine="h5netcdf").load()
        assert not any(name.startswith("phony") for name in opened.dims), group
        assert set(opened.dims) == set(opened.coords), group
    force = xarray.open_dataset(logs / "full.h5", group="mean/forces", engine="h5netcdf").thigmotaxis
    log = h5py.File(logs / "full.h5")
    column = list(log["model/dof_name"].asstr()).index("j21_bend_y")
    np.testing.assert_array_equal(force.sel(dof_name="j21_bend_y"), log["mean/forces/thigmotaxis"][:, column])


def test_a_run_of_any_level_is_gone_on_with(logs, tmp_path):
    hagfish(tmp_path, "run", "table1", "--preset", "quick", "--quiet", "--log", "summary", "--step-limit", "1e-9", "--out", "s.h5", code=1)
    if (tmp_path / "s.h5").exists():
        hagfish(tmp_path, "run", "--resume", "s.h5", "--quiet")
        own, whole = h5py.File(tmp_path / "s.h5"), h5py.File(logs / "summary.h5")
        assert own.attrs["log_level"] == "summary"
        np.testing.assert_array_equal(own["knot/head_end"], whole["knot/head_end"])


@pytest.mark.parametrize("time", [6, 11, 14, 17])
def test_branches_pass_the_audit(logs, tmp_path, time):
    """Running totals go on with those of the run, and what was asked of its start is not asked again."""
    hagfish(logs, "branch", "default.h5", "--time", time, "--quiet", "--out", tmp_path / "b.h5")
    hagfish(tmp_path, "check", "b.h5")
