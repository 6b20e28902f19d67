"""Logs in Python, the type stubs, the examples and the installed package."""

import ast
import inspect
import os
import subprocess
import sys
from pathlib import Path

import h5py
import hagfish
import pytest

from program import ROOT

EXAMPLES = ROOT / "experiments/python/examples"


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


def members(stub: ast.ClassDef) -> set[str]:
    names = {getattr(node, "name", None) or getattr(getattr(node, "target", None), "id", "_") for node in stub.body}
    return {name for name in names if not name.startswith("_")}


def test_stubs_name_what_there_is_and_it_says_what_it_is():
    stub = ast.parse((Path(hagfish.__file__).with_name("__init__.pyi")).read_text())
    classes = {node.name: node for node in stub.body if isinstance(node, ast.ClassDef)}
    functions = {node.name for node in stub.body if isinstance(node, ast.FunctionDef)}
    imports = [node for node in stub.body if isinstance(node, ast.ImportFrom)]
    passed_on = {alias.asname for node in imports for alias in node.names} - {None}
    assert set(hagfish.__all__) == classes.keys() | functions | passed_on | {"laws", "revision"}
    plain = {"contact", "towards", "end", "bodies", "nq", "nv"}
    for name in ("Simulation", "Control", "Command", "Contact"):
        there = {member: value for member, value in vars(getattr(hagfish, name)).items() if not member.startswith("_")}
        assert members(classes[name]) == there.keys(), name
        assert [member for member, value in there.items() if member not in plain and not inspect.getdoc(value)] == []


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


def test_the_installed_package_is_whole(tmp_path):
    build = Path(os.environ["HAGFISH_BUILD"])
    subprocess.run(["cmake", "--install", build, "--prefix", tmp_path], check=True, capture_output=True)
    (package,) = tmp_path.glob("lib/**/dist-packages")
    code = "import hagfish; print(hagfish.__file__); hagfish.Simulation('table1').step()"
    environment, command = os.environ | {"PYTHONPATH": str(package)}, [sys.executable, "-B", "-c", code]
    told = subprocess.run(command, env=environment, capture_output=True, text=True, check=True)
    assert told.stdout.strip() == str(package / "hagfish/__init__.py")
    assert all((package / "hagfish" / name).exists() for name in ("__init__.pyi", "py.typed", "log.py"))


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
