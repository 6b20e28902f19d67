"""Files in SI: each key's unit, as the comments of the commented files have it, is the one by which it is read."""

import math
import re
import tomllib

import h5py
import pytest

from program import ROOT, logged, refused, sets
from scene_keys import rows_of

# The longest first: one is part of another. An SI unit is so many of it.
SIZES = {"dyn cm^2 s": 1e9, "dyn cm^2": 1e9, "dyn cm^-2": 10, "dyn cm": 1e7, "g/(s cm)": 10, "cm/s^2": 1e2, "cm/s": 1e2,
         "cm^2": 1e4, "dyn": 1e5, "cm": 1e2, "g": 1e3}
NAMED = re.compile("|".join(rf"(?<![\w/]){re.escape(unit)}(?![\w^])" for unit in SIZES))
INLINE = {"a": "cm/s", "b": "cm/s", "target": "cm/s", "from": "dyn", "to": "dyn"}  # of tables in one line
# Velocities of both kinds, rad/s and cm/s: the same number in all units; a share, whose comment tells what it makes.
NO_UNIT = {("time", "settled"), ("muscle", "radius_share")}
# Counts; food that is there is another scene; lists of other kinds.
KEPT = {"", "bodies", "votes", "passes", "corrections", "cosines", "seed", "noise_seed", "hold", "types", "knots"}
ROUNDING = 1e-12  # powers of ten are exact, products with them are rounded


def size_of(section: str, key: str, comment: str) -> float:
    """How many of the CGS unit that the comment names are one of SI."""
    found = [] if (section, key) in NO_UNIT else NAMED.findall(comment)
    return SIZES[min(found, key=list(SIZES).index)] if found else 1


def each(value: object, change, key: str = "") -> object:
    """A value with `change` made to its numbers; those of a table in one line with their key."""
    if isinstance(value, dict):
        return {name: each(one, change, name) for name, one in value.items()}
    return [each(one, change, key) for one in value] if isinstance(value, list) else change(value, key)


def written(value: object) -> str:
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{key} = {written(one)}" for key, one in value.items()) + " }"
    return f"[{', '.join(map(written, value))}]" if isinstance(value, list) else repr(value)


def files(name: str, least: float = 0) -> tuple[str, str, int]:
    """Numbers of a commented file, `least` for 0, in CGS and in SI, as texts, and how many keys have units."""
    text = (ROOT / "data" / name).read_text()
    whole, texts, units, begun = tomllib.loads(text), ["", 'units = "SI"\n'], 0, ""
    for section, key, _, comment in rows_of(text.split("\n\n", 1)[1].splitlines()):  # without the comment of the file
        table = whole
        for part in filter(None, section.split(".")):
            table = table[part]
        value = table.get(key)
        if key in KEPT or isinstance(value, (bool, str)):
            continue
        value, size = each(value, lambda one, _: one or least), size_of(section, key, comment)
        si = each(value, lambda one, name: one / (SIZES[INLINE[name]] if name in INLINE else 1 if name else size))
        units += si != value
        for k, own in enumerate((value, si)):
            texts[k] += (f"[{section}]\n" if section != begun else "") + f"{key} = {written(own)}\n"
        begun = section
    return texts[0], texts[1], units


def scene_of(folder, text: str) -> dict:
    """The scene that the program made of a file."""
    (folder / "s.toml").write_text(text)
    brief = sets("time.duration=0.02", "time.step=0.005", "time.frame_interval=0.02", "expect.types=[]")
    with h5py.File(logged(folder, "s.toml", "--log", "summary", *brief)) as log:
        return tomllib.loads(log.attrs["scene"])


def same(a: object, b: object) -> bool:
    if isinstance(a, dict):
        return a.keys() == b.keys() and all(same(a[key], b[key]) for key in a)
    if isinstance(a, list):
        return len(a) == len(b) and all(map(same, a, b))
    return a == pytest.approx(b, rel=ROUNDING, abs=0) if isinstance(a, float) else a == b


def keys_of(table: dict, path: str = "") -> set[str]:
    """Dotted keys of all numbers and texts; an angle's is the same in degrees and radians."""
    found = set()
    for key, value in table.items():
        name = f"{path}{key}"
        found |= keys_of(value, f"{name}.") if isinstance(value, dict) else {re.sub("_(deg|rad)$", "", name)}
    return found


def test_each_key_of_a_scene_is_explained(tmp_path):
    """The page of keys is made of the first file, and its head names the others."""
    files = [ROOT / "data" / f"{name}.toml" for name in ("table1", "overhand_waypoints", "living_overhand")]
    files += (ROOT / "experiments/results/stability/scenes").glob("*.toml")
    explained = set().union(*(keys_of(tomllib.loads(file.read_text())) for file in files))
    scene = scene_of(tmp_path, 'base = "table1"\n')
    del scene["specimen"]
    assert len(keys_of(scene)) > 130
    assert keys_of(scene) - explained == set()


def test_each_key_of_a_scene_is_read_in_its_unit(tmp_path):
    cgs, si, units = files("table1.toml", least=0.001)  # what is 0 would be the same in any unit
    assert units >= 40
    first, second = (scene_of(tmp_path, 'base = "table1"\n' + text) for text in (cgs, si))
    assert first["units"] == second["units"] == "CGS"  # of a log's scene
    for table, keys in first.items():
        if isinstance(keys, dict):
            assert [key for key, value in keys.items() if not same(value, second[table][key])] == [], table
    assert same(first, second)


def test_each_key_of_a_specimen_is_read_in_its_unit(tmp_path):
    _, si, units = files("specimens/pacific_hagfish.toml")
    assert units >= 10
    (tmp_path / "animal.toml").write_text('name = "animal"\n' + si)
    first = scene_of(tmp_path, 'base = "table1"\n')["specimen"]
    second = scene_of(tmp_path, 'base = "table1"\nspecimen = "animal.toml"\n')["specimen"]
    assert same({**first, "name": "animal"}, second)


def test_water_bears_what_the_robot_displaces():
    files = ("robot_overhand.toml", "specimens/snake_robot.toml")
    scene, robot = (tomllib.loads((ROOT / "data" / name).read_text()) for name in files)
    displaced = 1000 * robot["length"] * robot["circumference"][0] ** 2 / (4 * math.pi)  # kg
    assert -scene["gravity"][2] == pytest.approx(9.81 * (1 - displaced / robot["mass"]), rel=1e-3)
    assert scene["drag"]["normal"] > 0


BASE = 'base = "robot_overhand"\n'
IN_SI = f'units = "SI"\n{BASE}'
RING = f'{IN_SI}[[obstacle]]\nkind = "ring"\ncentre = [0.5, 1, 0]\naxis = [1, 0, 0]\n'
STRAND = f'{IN_SI}[[obstacle]]\nkind = "strand"\npoints = [[0.5, -0.2, 0], [0.5, 0.2, 0]]\nradius = 0.01\n'


@pytest.mark.parametrize(
    ("text", "parts"),
    [
        (f'units = "MKS"\n{BASE}', ('s.toml:1: units = "MKS"', '"CGS", "SI"')),
        (f"units = 3\n{BASE}", ("s.toml:1: units = 3",)),
        (f"{RING}inner_radius = 0.01\nradius = 0.01\n", ("inner_radius = 1 cm: the hole is too", "radius is 2.4987")),
        (f"{RING}inner_radius = 0.03\nradius = 0\n", ("radius = 0: must be positive",)),
        (STRAND, ("overlaps body", "at the start by 3.49", "cm")),
        (f"{IN_SI}[constraints]\nstride = 0\n", ("constraints.stride = 0: must be at least 0.001 cm",)),
        (f'{IN_SI}[wall]\nneck = "3 feet"\n', ("must be a number of m, or as",)),
        (f"{IN_SI}[start]\nq = [0, 0]\n", ("start.q", "use a file without units")),
    ],
)
def test_what_is_no_length_of_its_unit_is_refused_by_one_line(tmp_path, text, parts):
    (tmp_path / "s.toml").write_text(text)
    refused(tmp_path, "run", "s.toml", "--out", "s.h5", parts=parts)


def test_only_a_file_has_units(tmp_path):
    for key in ("units=SI", "specimen.units=CGS"):
        told = f"{key}: only a file has units"
        refused(tmp_path, "run", "robot_overhand", "--set", key, "--out", "s.h5", parts=(told,))
