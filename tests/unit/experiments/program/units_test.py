"""Files in SI: each key's unit, as the comments of the commented files have it, is the one by which the program reads it."""

from __future__ import annotations

import math
import re
import sys
import tomllib
from pathlib import Path

import h5py
import pytest

ROOT = Path(__file__).parents[4]
sys.dont_write_bytecode = True
sys.path[:0] = [str(ROOT / "tests/support"), str(ROOT / "experiments/docs/reference")]

from program import hagfish, refused  # noqa: E402
from scene_keys import rows_of  # noqa: E402

# The longest first: one is part of another. An SI unit is so many of it.
SIZES = {"dyn cm^2 s": 1e9, "dyn cm^2": 1e9, "dyn cm^-2": 10, "dyn cm": 1e7, "g/(s cm)": 10, "cm/s^2": 1e2, "cm/s": 1e2, "cm^2": 1e4,
         "dyn": 1e5, "cm": 1e2, "g": 1e3}
NAMED = re.compile("|".join(rf"(?<![\w/]){re.escape(unit)}(?![\w^])" for unit in SIZES))
INLINE = {"a": "cm/s", "b": "cm/s", "target": "cm/s", "from": "dyn", "to": "dyn"}  # of tables in one line
# Velocities of both kinds, rad/s and cm/s: the same number in all units; a share, whose comment tells what it makes.
NO_UNIT = {("time", "settled"), ("muscle", "radius_share")}
KEPT = {"bodies", "votes", "passes", "corrections", "cosines", "seed", "noise_seed", "hold"}  # counts; food that is there is another scene
ROUNDING = 1e-12  # powers of ten are exact, products with them are rounded


def size_of(section: str, key: str, comment: str) -> float:
    """How many of the CGS unit that the comment names are one of SI."""
    found = NAMED.findall(comment)
    return 1 if (section, key) in NO_UNIT or not found else SIZES[min(found, key=list(SIZES).index)]


def written(value: object) -> str:
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{key} = {written(one)}" for key, one in value.items()) + " }"
    return f"[{', '.join(map(written, value))}]" if isinstance(value, list) else repr(value)


def scaled(value: object, size: float) -> object:
    if isinstance(value, dict):
        return {key: scaled(one, SIZES[INLINE[key]] if key in INLINE else 1) for key, one in value.items()}
    return [scaled(one, size) for one in value] if isinstance(value, list) else value / size


def no_zeros(value: object) -> object:
    """What is 0 would be the same in any unit."""
    if isinstance(value, dict):
        return {key: no_zeros(one) for key, one in value.items()}
    return [no_zeros(one) for one in value] if isinstance(value, list) else value or 0.001


def files(path: Path, changed) -> tuple[str, str, int]:
    """The numbers of a commented file in CGS and in SI, as texts, and how many keys have units."""
    texts, units, begun = ["", 'units = "SI"\n'], 0, ""
    whole = tomllib.loads(path.read_text())
    for section, key, _, comment in rows_of(path.read_text().split("\n\n", 1)[1].splitlines()):  # without the comment of the file
        table = whole
        for part in filter(None, section.split(".")):
            table = table[part]
        value = table.get(key)
        numbers = isinstance(value, (float, list, dict)) or (isinstance(value, int) and not isinstance(value, bool))
        if not key or key in KEPT or not numbers or "types" == key or key == "knots":
            continue
        value, size = changed(value), size_of(section, key, comment)
        units += size != 1 or isinstance(value, dict)
        for k, own in enumerate((value, scaled(value, size))):
            texts[k] += (f"[{section}]\n" if section != begun else "") + f"{key} = {written(own)}\n"
        begun = section
    return texts[0], texts[1], units


def scene_of(folder: Path, scene: str) -> dict:
    """The scene that the program made of a file."""
    (folder / "s.toml").write_text(scene)
    hagfish(folder, "run", "s.toml", "--quiet", "--force", "--log", "summary", "--set", "time.duration=0.02", "--set", "time.step=0.005", "--set",
            "time.frame_interval=0.02", "--set", "expect.types=[]", "--out", "s.h5")
    with h5py.File(folder / "s.h5") as log:
        text = log.attrs["scene"]
    return tomllib.loads(text.decode() if isinstance(text, bytes) else text)


def same(a: object, b: object) -> bool:
    if isinstance(a, dict):
        return a.keys() == b.keys() and all(same(a[key], b[key]) for key in a)
    if isinstance(a, list):
        return len(a) == len(b) and all(map(same, a, b))
    return a == pytest.approx(b, rel=ROUNDING, abs=0) if isinstance(a, float) else a == b


def test_each_key_of_a_scene_is_read_in_its_unit(tmp_path):
    cgs, si, units = files(ROOT / "data/table1.toml", no_zeros)
    assert units >= 40
    first, second = (scene_of(tmp_path, f'base = "table1"\n{text}' if "units" not in text else text.replace("\n", '\nbase = "table1"\n', 1)) for text in (cgs, si))
    assert first["units"] == second["units"] == "CGS"  # of a log's scene
    different = [f"{table}.{key}" for table, keys in first.items() if isinstance(keys, dict) for key in keys if not same(keys[key], second[table][key])]
    assert different == [] and same(first, second)


def test_each_key_of_a_specimen_is_read_in_its_unit(tmp_path):
    path = ROOT / "data/specimens/pacific_hagfish.toml"
    _, si, units = files(path, lambda value: value)
    assert units >= 10
    (tmp_path / "animal.toml").write_text(si.replace("\n", '\nname = "animal"\n', 1))
    first, second = (scene_of(tmp_path, f'base = "table1"\n{more}')["specimen"] for more in ("", 'specimen = "animal.toml"\n'))
    assert same({**first, "name": "animal"}, second)


def test_a_robot_is_the_same_in_both_units(tmp_path):
    si = (ROOT / "data/robot_overhand.toml").read_text()
    cgs = {'"SI"': '"CGS"', "-0.886]": "-88.6]", "= 0.1 ": "= 1e8 ", "= 2.5 ": "= 25 ", "= 0.08 ": "= 0.8 ", "-0.025]": "-2.5]", "= 1.0 ": "= 1e9 ", "= 2.0 ": "= 2e7 ",
           "0.015 ": "1.5 "}
    text = si
    for old, new in cgs.items():
        assert old in text, old
        text = text.replace(old, new, 1)
    (tmp_path / "specimens").mkdir()
    (tmp_path / "specimens/snake_robot.toml").write_text((ROOT / "data/specimens/snake_robot.toml").read_text())
    assert same(scene_of(tmp_path, si), scene_of(tmp_path, text))


def test_water_bears_what_the_robot_displaces():
    scene, robot = (tomllib.loads((ROOT / "data" / name).read_text()) for name in ("robot_overhand.toml", "specimens/snake_robot.toml"))
    displaced = 1000 * robot["length"] * robot["circumference"][0] ** 2 / (4 * math.pi)  # kg
    assert -scene["gravity"][2] == pytest.approx(9.81 * (1 - displaced / robot["mass"]), rel=1e-3) and scene["drag"]["normal"] > 0


def test_what_is_no_unit_is_refused_by_one_line(tmp_path):
    def told(text: str, *parts: str, more: tuple[str, ...] = ()) -> None:
        (tmp_path / "s.toml").write_text(text)
        refused(tmp_path, "run", "s.toml", "--out", "s.h5", *more, parts=parts)

    base = 'base = "robot_overhand"\n'
    told(f'units = "MKS"\n{base}', "s.toml:1: units = \"MKS\"", '"CGS", "SI"')
    told(f"units = 3\n{base}", "s.toml:1: units = 3")
    told(base, "units=SI: only a file has units", more=("--set", "units=SI"))
    told(base, "specimen.units=CGS: only a file has units", more=("--set", "specimen.units=CGS"))
    ring = '[[obstacle]]\nkind = "ring"\ncentre = [0.5, 1, 0]\naxis = [1, 0, 0]\n'
    si = f'units = "SI"\n{base}'
    told(f"{si}{ring}inner_radius = 0.01\nradius = 0.01\n", "inner_radius = 1 cm: the hole is too narrow for the body, whose radius is 2.4987")
    told(f"{si}{ring}inner_radius = 0.03\nradius = 0\n", "radius = 0: must be positive")
    told(f'{si}[[obstacle]]\nkind = "strand"\npoints = [[0.5, -0.2, 0], [0.5, 0.2, 0]]\nradius = 0.01\n', "overlaps body", "at the start by 3.49", "cm")
    told(f"{si}[constraints]\nstride = 0\n", "constraints.stride = 0: must be at least 0.001 cm")
    told(f'{si}[wall]\nneck = "3 feet"\n', "must be a number of m, or as")
    told(f"{si}[start]\nq = [0, 0]\n", "start.q", "use a file without units")
