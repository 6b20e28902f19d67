"""Files that are not there, are no logs, cannot be written or would be replaced: each command of the program's help says
so in one line, with exit 2, and leaves nothing behind. Damaged logs are the fuzz test's (tests/fuzz)."""

import os
import shutil
from pathlib import Path

import numpy as np
import pytest

import commands
from program import hagfish, logged, outcome, refused

NOWHERE = "/proc/nowhere"  # where nobody, not even root, writes
KNOWN = {name: commands.Command(name, hagfish(Path.cwd(), name, "--help"))
         for name in commands.subcommands(hagfish(Path.cwd(), "--help"))}
WRITES = [(name, option) for name, command in KNOWN.items() for option in ("--out", "--csv", "--png", "--scene-out")
          if option in command.valued and (name, option) != ("midlines", "--png")]  # it has told by then what it found
IN_FOLDERS = {"export": "midline.csv", "mjcf": "hagfish.xml"}  # one of the files that they write


def line(name: str, option: str, value: str) -> list[str]:
    """A good command line, but for the value of an option and without --force."""
    words = [word for word in KNOWN[name].good if word != "--force"]
    if option in words:
        words[words.index(option) + 1] = value
    return words if option in words else [*words, option, value]


def ending(name: str, option: str) -> str:
    return ".png" if option == "--png" else commands.ENDINGS.get(name, "")


@pytest.fixture(scope="module")
def good(tmp_path_factory):
    """The files that good command lines name."""
    folder = tmp_path_factory.mktemp("good")
    logged(folder, "table1", "--preset", "quick", "--set", "time.duration=1", out="good.h5")
    twist = ["--set", "specimen.twist_limit_deg=0.01"]  # so that rows bear
    hagfish(folder, "record-qp", *commands.SHORT, *commands.SMALL, *twist, "--quiet", "--out", "good.qp.h5")
    points = "".join(f"{t},{2 * k},{2 * k},{0.1 * t * k}\n" for t in (0, 1) for k in range(20))
    (folder / "film.csv").write_text("time_s,s_cm,x_cm,y_cm\n" + points)
    (folder / "small.toml").write_text('base = "living_overhand"\n[model]\nbodies = 20\n')
    (folder / "scene_grid.toml").write_text(commands.grid_text("table1", commands.SHORT + commands.SMALL))
    return folder


@pytest.fixture
def folder(tmp_path, good):
    return Path(shutil.copytree(good, tmp_path, dirs_exist_ok=True))


@pytest.mark.parametrize(("name", "option"), WRITES)
def test_a_file_that_cannot_be_written(folder, name, option):
    nowhere = NOWHERE + ending(name, option)
    refused(folder, *line(name, option, nowhere), parts=(nowhere,))


@pytest.mark.parametrize(("name", "option"), [each for each in WRITES if "--force" in KNOWN[each[0]].good])
def test_a_file_that_is_there_is_replaced_by_force_alone(folder, name, option):
    out = "kept" + ending(name, option)
    kept = folder / out / IN_FOLDERS[name] if name in IN_FOLDERS else folder / out
    kept.parent.mkdir(exist_ok=True)
    kept.write_text("precious")
    refused(folder, *line(name, option, out), parts=(out, "--force"))
    assert kept.read_text() == "precious"
    if name != "playback":  # of which the log has no slide
        done = outcome(folder, *line(name, option, out), "--force")
        # 1: a run so short fails its audit.
        assert done.returncode in (0, 1, 3) and kept.read_bytes() != b"precious", done


@pytest.mark.parametrize("name", [name for name, command in KNOWN.items() if command.reads_log])
def test_a_log_that_is_none(folder, name):
    (folder / "text.h5").write_text("no log")
    (folder / "half.h5").write_bytes((folder / "good.h5").read_bytes()[:100_000])
    for file in ("none.h5", "text.h5", "half.h5"):
        refused(folder, *(file if word == "good.h5" else word for word in KNOWN[name].good), parts=(file,))


def test_a_machine_without_ffmpeg_or_opengl(folder, monkeypatch):
    monkeypatch.setenv("__EGL_VENDOR_LIBRARY_FILENAMES", "/nowhere.json")
    refused(folder, "picture", "good.h5", "--out", "p.png", parts=("no off-screen OpenGL",))
    if shutil.which("ffmpeg"):
        refused(folder, "movie", "good.h5", "--out", "m.mp4", parts=("no off-screen OpenGL",))
    monkeypatch.setenv("PATH", os.devnull)
    refused(folder, "movie", "good.h5", "--out", "m.mp4", parts=("no ffmpeg",))


def test_a_colour_bar_has_room_below_the_animal_and_goes_from_dark_to_light(folder):
    image = pytest.importorskip("matplotlib.image")
    hagfish(folder, "picture", "good.h5", "--out", "plain.png", "--size", "800x300")
    hagfish(folder, "picture", "good.h5", "--out", "bar.png", "--size", "800x300", "--colour", "curvature")
    plain, coloured = (image.imread(folder / name)[..., :3] for name in ("plain.png", "bar.png"))
    assert plain.shape == coloured.shape == (300, 800, 3)
    # The widest run of columns whose pixels below are no grey: the bar.
    lower = coloured[230:]
    vivid = np.ptp(lower, axis=2) > 0.2
    row = np.argmax(vivid.sum(axis=1))
    columns = np.flatnonzero(vivid[row])
    assert len(columns) == 320 and np.all(np.diff(columns) == 1)
    bar = lower[row, columns]
    np.testing.assert_allclose(bar[[0, -1]], np.array([[68, 1, 84], [253, 231, 37]]) / 255, atol=0.02)  # viridis' ends
    assert np.all(np.diff(bar @ [0.2126, 0.7152, 0.0722]) > -0.01)
    assert np.sum(np.all(lower < 0.3, axis=2)) > 200  # its words
