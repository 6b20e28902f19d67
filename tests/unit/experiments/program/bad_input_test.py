"""A folder that cannot be written, no ffmpeg, no OpenGL: each command that writes says it in one line, exits 2 and leaves nothing
behind. Damaged logs are the fuzz test's (tests/fuzz)."""

from __future__ import annotations

import os
import shutil
import sys
from pathlib import Path

import numpy as np
import pytest

sys.dont_write_bytecode = True
sys.path.insert(0, str(Path(__file__).parents[3] / "support"))

from program import hagfish, refused  # noqa: E402

SHOW = {"export": "tables", "view": "v.html", "movie": "m.mp4", "picture": "p.png", "figures": "drawn"}
NOWHERE = "/proc/nowhere"  # where nobody, not even root, writes
ANIMAL = ["--length", 35, "--mass", 45, "--circumference", "4.6,4.4,4.4,3.2", "--bending", "25,80,50,55", "--twist", 60]


@pytest.fixture(scope="module")
def log(tmp_path_factory):
    folder = tmp_path_factory.mktemp("bad")
    hagfish(folder, "run", "table1", "--preset", "quick", "--quiet", "--set", "time.duration=1", "--out", "a.h5")
    return folder / "a.h5"


@pytest.fixture
def folder(tmp_path, log):
    shutil.copy(log, tmp_path / "a.h5")
    return tmp_path


def test_a_folder_that_cannot_be_written(folder):
    for command, out in SHOW.items():
        refused(folder, command, "a.h5", "--out", f"{NOWHERE}/{out}", parts=(NOWHERE,))
    refused(folder, "specimen", *ANIMAL, "--out", f"{NOWHERE}.toml", parts=(NOWHERE,))
    refused(folder, "specimen", *ANIMAL, "--out", "a.toml", "--scene-out", f"{NOWHERE}.toml", parts=(NOWHERE,))
    points = "".join(f"{t},{2 * k},{2 * k},{0.1 * t * k}\n" for t in (0, 1) for k in range(20))
    (folder / "film.csv").write_text("time_s,s_cm,x_cm,y_cm\n" + points)
    refused(folder, "midlines", "film.csv", "--times", 2, "--out", f"{NOWHERE}.csv", parts=(NOWHERE,))
    for arguments in (["--csv", f"{NOWHERE}.csv"], ["--csv", "ok.csv", "--png", f"{NOWHERE}.png"], ["--csv", "ok.csv", "--png", "x.jpg"]):
        refused(folder, "against", "a.h5", "film.csv", *arguments, parts=(arguments[-1],))


def test_a_machine_without_ffmpeg_or_opengl(folder, monkeypatch):
    monkeypatch.setenv("__EGL_VENDOR_LIBRARY_FILENAMES", "/nowhere.json")
    refused(folder, "picture", "a.h5", "--out", "p.png", parts=("no off-screen OpenGL",))
    if shutil.which("ffmpeg"):
        refused(folder, "movie", "a.h5", "--out", "m.mp4", parts=("no off-screen OpenGL",))
    monkeypatch.setenv("PATH", os.devnull)
    refused(folder, "movie", "a.h5", "--out", "m.mp4", parts=("no ffmpeg",))


def test_a_colour_bar_has_room_below_the_animal_and_goes_from_dark_to_light(folder, tmp_path):
    image = pytest.importorskip("matplotlib.image")
    hagfish(folder, "picture", "a.h5", "--out", "plain.png", "--size", "800x300")
    hagfish(folder, "picture", "a.h5", "--out", "bar.png", "--size", "800x300", "--colour", "curvature")
    plain, coloured = (image.imread(folder / name)[..., :3] for name in ("plain.png", "bar.png"))
    assert plain.shape == coloured.shape == (300, 800, 3)
    # The widest run of columns whose pixels below are no grey: the bar.
    lower = coloured[230:]
    vivid = (lower.max(axis=2) - lower.min(axis=2)) > 0.2
    row = lower[np.argmax(vivid.sum(axis=1))]
    columns = np.flatnonzero((row.max(axis=1) - row.min(axis=1)) > 0.2)
    assert len(columns) == 320 and np.all(np.diff(columns) == 1)
    bar = row[columns]
    np.testing.assert_allclose(bar[0], np.array([68, 1, 84]) / 255, atol=0.02)  # viridis' ends
    np.testing.assert_allclose(bar[-1], np.array([253, 231, 37]) / 255, atol=0.02)
    assert np.all(np.diff(bar @ [0.2126, 0.7152, 0.0722]) > -0.01)
    assert np.sum(np.all(lower < 0.3, axis=2)) > 200  # its words
