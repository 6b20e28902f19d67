"""`hagfish run --log`: what logs of each level hold, what each command says of one that holds too little, and names of
their axes for h5py and xarray."""

import re

import h5py
import numpy as np
import pytest

from program import ROOT, SANITIZED, different, hagfish, logged, refused, series, table

LEVELS = ("summary", "frames", "full")  # the last one where nothing is asked
WANTS = dict.fromkeys(("check", "playback"), "full") | dict.fromkeys(
    ("export", "view", "figures", "picture", "movie", "program"), "frames")
ENDING = {"picture": ".png", "movie": ".mp4"}
MICROMETRE = 1e-4  # cm: places are rounded to 2^-13 cm and, like means of forces, stored as floats
SINGLE = 1e-7  # relative
ROUNDED = {"trajectory/position": MICROMETRE, "trajectory/q": 2.0**-33}


def of_level(folder, level, *settings):
    return logged(folder, "table1", *settings, *([] if level == "full" else ["--log", level]), out=f"{level}.h5")


@pytest.fixture(scope="module")
def logs(tmp_path_factory):
    folder = tmp_path_factory.mktemp("levels")
    for level in LEVELS:
        of_level(folder, level, "--preset", "quick")
    return folder


def rows_in_time(file):
    return {path: item for path, item in series(file).items() if item.maxshape and item.maxshape[0] is None}


def test_each_level_holds_the_same_numbers_as_the_full_log(logs):
    files = {level: h5py.File(logs / f"{level}.h5") for level in LEVELS}
    rows = {level: rows_in_time(file) for level, file in files.items()}
    sizes = [(logs / f"{level}.h5").stat().st_size for level in LEVELS]
    assert sizes[0] < 0.5 * sizes[1] < 0.25 * sizes[2]
    for level, more in (("summary", "frames"), ("frames", "full")):
        assert files[level].attrs["log_level"] == level and files[more].attrs["log_level"] == more
        assert set(rows[level]) < set(rows[more])
        for path, own in rows[level].items():
            full = rows["full"][path]
            place = ROUNDED.get(path, float(np.finfo(np.float32).tiny))
            np.testing.assert_allclose(own[()], full[()], rtol=SINGLE, atol=place, err_msg=path)
            assert own.dtype == full.dtype or path == "trajectory/position" or path.startswith("mean/forces/"), path
            assert own.attrs["unit"] == full.attrs["unit"] and own.fletcher32, path
    assert "trajectory/q" in rows["frames"] and "steps/kkt" not in rows["frames"]


@pytest.mark.skipif(SANITIZED, reason="sizes are those of a release")
@pytest.mark.parametrize("level", LEVELS)
def test_the_reference_tells_the_sizes(tmp_path, level):
    text = (ROOT / "experiments/docs/reference/log_format.md").read_text(encoding="utf-8")
    told = float(re.search(rf"^\| `{level}`.* ([\d.]+) MB \|$", text, re.MULTILINE)[1])
    assert of_level(tmp_path, level).stat().st_size / 1e6 == pytest.approx(told, rel=0.1, abs=0.06)


def test_commands_that_need_more_say_so_in_one_line(logs):
    for command, level in WANTS.items():
        arguments = [] if command == "check" else ["--out", f"out{ENDING.get(command, '')}"]
        for held in LEVELS[:LEVELS.index(level)]:
            refused(logs, command, f"{held}.h5", *arguments, parts=(f"{held}.h5", f"--log {held}", f"--log {level}"))
    for level in LEVELS:
        assert "slide" in hagfish(logs, "info", f"{level}.h5")
        assert level in hagfish(logs, "info", f"{level}.h5", "--json")
    hagfish(logs, "check", "full.h5")


def test_tables_of_a_log_of_frames_are_those_of_the_full_one(logs):
    for level in ("frames", "full"):
        hagfish(logs, "export", f"{level}.h5", "--out", level)
    for path in (logs / "full").glob("*.csv"):
        own, full = table(logs / "frames" / path.name), table(path)
        assert own.keys() == full.keys()
        # Of steps, of which a log of frames says nothing; and what is said of the log itself.
        for column in full.keys() - {"duration_s", "eq6_percent", "log", "log_level"}:
            values, where = full[column], f"{path.name} {column}"
            if values.dtype.kind in "US":
                np.testing.assert_array_equal(own[column], values, err_msg=where)
            else:
                scale = np.nanmax(np.abs(values), initial=0)
                np.testing.assert_allclose(own[column], values, rtol=1e-5, atol=1e-6 * scale, err_msg=where)


def test_axes_are_labelled_by_what_they_are(logs):
    log = h5py.File(logs / "full.h5")
    labels = lambda path, axis: log[path].dims[axis][0]
    names, angles = labels("forces/limit", 1).asstr()[6:], labels("trajectory/q", 1).asstr()[7:]
    assert list(angles) == list(names) and all(name.startswith("j") for name in names)
    assert list(labels("trajectory/position", 2).asstr()) == ["x", "y", "z"]
    time = log["trajectory/time"][()]
    np.testing.assert_array_equal(labels("forces/limit", 0), time)
    np.testing.assert_allclose(log["steps/time"][()], time[0] + 0.01 * np.arange(len(log["steps/time"])), atol=1e-9)


def test_xarray_opens_every_group_named(logs):
    import xarray  # with h5netcdf

    for level in ("summary", "full"):
        file = logs / f"{level}.h5"
        with h5py.File(file) as log:
            groups = {"model", *(path.rpartition("/")[0] for path in rows_in_time(log))}
        for group in groups:
            opened = xarray.open_dataset(file, group=group, engine="h5netcdf")
            # An axis without a scale of its length.
            assert not any(name.startswith("phony") for name in opened.dims), group
            assert set(opened.dims) == set(opened.coords), group
    force = xarray.open_dataset(logs / "full.h5", group="mean/forces", engine="h5netcdf").thigmotaxis
    log = h5py.File(logs / "full.h5")
    column = list(log["model/dof_name"].asstr()).index("j21_bend_y")
    np.testing.assert_array_equal(force.sel(dof_name="j21_bend_y"), log["mean/forces/thigmotaxis"][:, column])


@pytest.mark.parametrize("level", ["summary", "full"])
def test_a_run_that_was_stopped_is_gone_on_with_to_the_last_bit(logs, tmp_path, level):
    """A limit of a step's time is as good as a signal, and strikes where rows are solved for."""
    run = ["run", "table1", "--preset", "quick", "--log", level, "--quiet", "--out", "s.h5"]
    said = hagfish(tmp_path, *run, "--step-limit", "1e-9", code=1)
    assert "a step took longer than --step-limit 1e-09 s at step " in said
    hagfish(tmp_path, "run", "--resume", "s.h5", "--quiet")
    with h5py.File(tmp_path / "s.h5") as own:
        assert (own.attrs["log_level"], own.attrs["status"]) == (level, "complete")
    assert different(tmp_path / "s.h5", logs / f"{level}.h5", least=10) == []


@pytest.mark.parametrize("time", [6, 11, 14, 17])
def test_branches_pass_the_audit(logs, tmp_path, time):
    """Running totals go on with those of the run, and what was asked of its start is not asked again."""
    hagfish(logs, "branch", "full.h5", "--time", time, "--quiet", "--out", tmp_path / "b.h5")
    hagfish(tmp_path, "check", "b.h5")
