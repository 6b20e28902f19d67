"""Other animals, drawn at random, as an axis of `hagfish sweep` or as specimen files.

Usage: animals.py COUNT [slender]      the axis
       animals.py specimen NUMBER      the specimen file of one of them, from 1
       animals.py specimen slender     that of the Pacific hagfish, 1.5 times as long and no thicker

The Pacific hagfish of data/specimens is made 25 to 60 cm long, each circumference and bending limit and the twisting limit are
changed by up to 20 %, and it has 60 to 200 bodies. Mass goes with volume. Muscles and passive stiffness go with the fourth
power of the diameter, as that of rods of one material does; capacity, area times arm, with the third. With `slender` all are 1.5
times as long and no thicker.
"""

import json
import random
import sys
import tomllib
from pathlib import Path

DATA = Path(__file__).parents[2] / "data"
FIRST_SEED = 1000
SLENDER = 1.5


def volume(circumference: list[float], station: list[float], length: float) -> float:
    """But for a factor: between stations cones, outside of them cylinders."""
    ends = station[0] * circumference[0] ** 2 + (1 - station[-1]) * circumference[-1] ** 2
    cones = sum((b - a) * (c * c + c * d + d * d) / 3
                for a, b, c, d in zip(station, station[1:], circumference, circumference[1:]))
    return (ends + cones) * length


def settings(seed: int, longer: float = 1) -> dict[str, object]:
    """`longer`: times as long as its girth goes with."""
    own = tomllib.loads((DATA / "specimens/pacific_hagfish.toml").read_text(encoding="utf-8"))
    active = tomllib.loads((DATA / "living_overhand.toml").read_text(encoding="utf-8"))["active"]
    draw = random.Random(seed)
    changed = lambda values: [value * draw.uniform(0.8, 1.2) for value in values]
    length = draw.uniform(25, 60)
    scale = length / own["length"]
    circumference = [scale * value for value in changed(own["circumference"])]
    thicker = sum(circumference) / sum(own["circumference"])
    return {
        "specimen.length": longer * length,
        "specimen.mass": own["mass"] * volume(circumference, own["station"], longer * length)
        / volume(own["circumference"], own["station"], own["length"]),
        "specimen.circumference": circumference,
        "specimen.bending_limit_deg": changed(own["bending_limit_deg"]),
        "specimen.twist_limit_deg": changed([own["twist_limit_deg"]])[0],
        "specimen.bending_span": own["bending_span"] * scale,
        "model.bodies": draw.randrange(60, 201),
        "active.stiffness": active["stiffness"] * thicker**4,
        "active.capacity": active["capacity"] * thicker**3,
    } | {f"specimen.passive.{key}": [value * thicker**4 for value in values] for key, values in own["passive"].items()}


def slender_file() -> None:
    own = tomllib.loads((DATA / "specimens/pacific_hagfish.toml").read_text(encoding="utf-8"))
    write(own | {"name": f"Pacific hagfish {SLENDER:g} times as slender", "length": SLENDER * own["length"], "mass": SLENDER * own["mass"]})


def specimen_file(number: int) -> None:
    """What the animals have in common is from the Pacific hagfish's own file."""
    own = tomllib.loads((DATA / "specimens/pacific_hagfish.toml").read_text(encoding="utf-8"))
    own["name"] = f"Animal {number}, drawn at random"
    for key, value in settings(FIRST_SEED + number - 1).items():
        table, _, rest = key.partition(".")
        if table == "specimen":
            place, _, last = rest.rpartition(".")
            (own[place] if place else own)[last] = value
    write(own)


def write(own: dict[str, object]) -> None:
    """TOML."""
    tables = {key: value for key, value in own.items() if isinstance(value, dict)}
    for key, value in own.items():
        if key not in tables:
            print(f"{key} = {json.dumps(value)}")
    for name, table in tables.items():
        print(f"\n[{name}]", *(f"{key} = {json.dumps(value)}" for key, value in table.items()), sep="\n")


def axis(count: int, longer: float) -> None:
    animals = [settings(FIRST_SEED + animal, longer) for animal in range(count)]
    print("[[axis]]")
    for key in animals[0]:
        print(f'"{key}" = {[animal[key] for animal in animals]}')


if __name__ == "__main__":
    what, *others = sys.argv[1:]
    if what != "specimen":
        axis(int(what), SLENDER if others else 1)
    elif others == ["slender"]:
        slender_file()
    else:
        specimen_file(int(others[0]))
