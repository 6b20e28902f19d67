"""Logs in Python, the types, the examples and the installed package."""

import inspect
import os
import shutil
import subprocess
import sys
from pathlib import Path

import h5py
import hagfish
import pytest

import program
from program import ROOT

EXAMPLES = ROOT / "experiments/python/examples"
PACKAGE = ROOT / "experiments/python/hagfish"


@pytest.fixture(scope="session")
def log(tmp_path_factory):
    file = tmp_path_factory.mktemp("log") / "short.h5"
    with hagfish.Simulation("table1", set={"time.step": 0.01, "time.duration": 0.5}, log=file) as sim:
        sim.run()
    return hagfish.Log(file)


def test_a_logs_datasets_are_arrays(log):
    assert log.time[-2:] == pytest.approx([0.48, 0.5])
    assert log["trajectory/q"].shape == (len(log.time), 7 + log["model/dof_name"].size - 6)
    assert log.phase == ["form"] * len(log.time)
    assert "mean/forces/thigmotaxis" in log.names
    other = Path(log.file.filename).with_name("other.h5")
    with h5py.File(other, "w") as file:
        file.attrs["format"] = "else"
    with pytest.raises(ValueError, match="not a hagfish-log"):
        hagfish.Log(other)


def test_xarrays_have_named_axes_and_units(log):
    force = log.array("mean/forces/thigmotaxis")
    assert force.dims == ("time", "nv")
    assert force.sel(nv="j01_bend_y").shape == log.time.shape
    assert "dyn" in force.attrs["unit"]
    assert log.array("trajectory/q").sel(nq="root_x").shape == log.time.shape
    assert log.array("trajectory/position").dims == ("time", "body", "axis_2")


@pytest.mark.skipif(shutil.which("mypy") is None, reason="no mypy here")
def test_types_are_those_of_the_module(tmp_path):
    (tmp_path / "pybind11").write_text(r"hagfish\._core\.(Command|Contact|Control|Simulation)")  # their metaclass
    environment = os.environ | {"MYPYPATH": str(EXAMPLES.parent)}
    checks = ["mypy", "--strict", EXAMPLES, *PACKAGE.glob("*.py")], ["stubtest", "--allowlist", "pybind11", "hagfish._core"]
    for command in checks:
        done = subprocess.run(command, cwd=tmp_path, env=environment, capture_output=True, text=True)
        assert done.returncode == 0, done.stdout + done.stderr


def test_every_name_says_what_it_is():
    plain = {"contact", "towards", "end", "bodies", "nq", "nv"}
    for kind in (hagfish.Simulation, hagfish.Control, hagfish.Command, hagfish.Contact):
        there = {name: value for name, value in vars(kind).items() if not name.startswith("_")}
        assert [name for name, value in there.items() if name not in plain and not inspect.getdoc(value)] == []
    assert hagfish.__version__ == program.hagfish(".", "--version").split()[0]


@pytest.mark.parametrize(
    ("module", "text", "told"),
    [
        ("h5py", "raise ImportError('none')", "hagfish.Log needs h5py (Debian's python3-h5py), which cannot be imported: none"),
        ("numpy", "__version__ = '2.1.0'", "hagfish was built for NumPy 1, but this is NumPy 2.1.0: "),
    ],
)
def test_what_it_needs_is_told_where_it_is_not_there(tmp_path, module, text, told):
    (tmp_path / f"{module}.py").write_text(text)
    code = "import hagfish; hagfish.Simulation('table1').step(); print('stepped'); hagfish.Log('a.h5')"
    environment = os.environ | {"PYTHONPATH": f"{tmp_path}:{os.environ['PYTHONPATH']}"}
    done = subprocess.run([sys.executable, "-B", "-c", code], env=environment, capture_output=True, text=True)
    assert done.stdout == ("stepped\n" if module == "h5py" else "")
    assert done.stderr.splitlines()[-1].startswith("ImportError: " + told)


def run(script, *arguments):
    command = [sys.executable, EXAMPLES / script, *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, check=True).stdout.splitlines()


def test_the_example_of_a_law(tmp_path, verdicts):
    told = run("own_controller.py", tmp_path / "strokes.h5")
    assert "a 3_1" in told[0]
    assert float(told[-1].split()[1]) > 5
    assert verdicts(tmp_path / "strokes.h5") <= {"Eq. 6"}
    assert len((EXAMPLES / "own_controller.py").read_text().splitlines()) <= 34


def test_the_example_that_learns(tmp_path):
    told = run("learn_speeds.py", "--tries", "6")
    reached = [float(line.split(":")[1].split()[0]) for line in told]
    assert reached == sorted(reached)


def test_the_example_of_an_environment(tmp_path):
    slow, fast = (float(line.split("return ")[1].split()[0]) for line in run("environment.py"))
    assert 0 < slow < fast


def test_the_example_of_a_pd_controller_ties_the_knot(tmp_path):
    assert ": a 3_1, " in run("pd_controller.py")[0]


def test_the_installed_package_is_whole(tmp_path):
    build = Path(os.environ["HAGFISH_BUILD"])
    subprocess.run(["cmake", "--install", build, "--prefix", tmp_path], check=True, capture_output=True)
    (package,) = tmp_path.glob("lib/**/dist-packages")
    code = "import hagfish; print(hagfish.__file__); hagfish.Simulation('table1').step()"
    environment, command = os.environ | {"PYTHONPATH": str(package)}, [sys.executable, "-B", "-c", code]
    told = subprocess.run(command, env=environment, capture_output=True, text=True, check=True)
    assert told.stdout.strip() == str(package / "hagfish/__init__.py")
    assert all((package / "hagfish" / name).exists() for name in ("_core.pyi", "py.typed", "log.py"))


def test_a_design_says_what_it_found(tmp_path):
    sought = hagfish.design("7_7", out=tmp_path / "seven", budget="0.001s", threads=1, animals=True)
    assert not sought.found
    assert "animals = true" in (tmp_path / "seven/search.toml").read_text()
    assert "None of 32 tries tied the knot" in sought.message
    assert sought.figures == {}
    hagfish.design("7_7", out=tmp_path / "on", budget="0.001s", threads=1, start=tmp_path / "seven")
    assert (tmp_path / "on/start.csv").read_text() == (tmp_path / "seven/tries.csv").read_text()
    with pytest.raises(hagfish.InputError, match="not a known knot"):
        hagfish.design("3_2", out=tmp_path / "none")
