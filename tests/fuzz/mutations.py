"""Random damage: to the bytes of a file, to the datasets and attributes of HDF5, to the text of a scene."""

import h5py
import numpy as np

import named_cases

EXTREME_NUMBERS = [0.0, -0.0, 1.0, -1.0, 1e-300, 1e300, -1e300, np.inf, -np.inf, np.nan, 2.0**31, 2.0**63, 1e9, -1e9]
EXTREME_INTEGERS = [0, 1, -1, -2, 2**31 - 1, -(2**31), 2**63 - 1, -(2**63), 255]
TEXTS = ["", "\x1b[31m", "a" * 70000, "\0", "\n", "[" * 3000, "../..", "/dev/zero", "\udcff"]
WORDS = [
    "1e308", "-1e308", "1e-308", "0", "-1", "nan", "inf", "-inf", "9223372036854775807", "-9223372036854775808",
    "99999999999999999999", "2147483647", "4294967296", "true", '""', '"\\u001b[31m"', "[]", "{}", "[[[[1]]]]",
    "1979-05-27", '"/dev/zero"', '"/etc/passwd"', "0x7fffffffffffffff", "1e-9", "1e9",
]  # fmt: skip


def used_blocks(data, size=64):
    """Where the file has anything: most of a small one is room for more."""
    array = np.frombuffer(data[: len(data) // size * size], np.uint8).reshape(-1, size)
    return np.flatnonzero(array.any(axis=1)) * size


def flipped(data, blocks, random):
    """`data` with one to eight places damaged, now and then cut."""
    damaged = bytearray(data)
    for _ in range(random.integers(1, 9)):
        at = int(random.choice(blocks)) + int(random.integers(64))
        kind = random.integers(6)
        if kind <= 2:
            damaged[at] ^= 1 << int(random.integers(8))
        elif kind == 3:
            damaged[at] = int(random.integers(256))
        elif kind == 4:
            length = int(random.integers(1, 9))
            damaged[at : at + length] = bytes([int(random.choice([0, 255, 127, 128]))]) * length
        else:
            other = int(random.choice(blocks))
            damaged[at : at + 8] = data[other : other + 8]
    if random.random() < 0.02:
        del damaged[int(random.integers(len(damaged))) :]
    return bytes(damaged)


def datasets_of(log):
    paths = []
    log.visititems(lambda path, item: paths.append(path) if isinstance(item, h5py.Dataset) else None)
    return paths


def extreme_value(dataset, random):
    if dataset.dtype.kind == "f":
        return random.choice(EXTREME_NUMBERS)
    if dataset.dtype.kind in "iu":
        limits = np.iinfo(dataset.dtype)
        return int(np.clip(int(random.choice(np.array(EXTREME_INTEGERS, object))), limits.min, limits.max))
    return str(random.choice(TEXTS[:3]))


def fill_with_extremes(log, path, random):
    log[path][...] = extreme_value(log[path], random)


def set_one(log, path, random):
    place = tuple(int(random.integers(n)) for n in log[path].shape)
    log[path][place] = extreme_value(log[path], random)


def change_shape(log, path, random):
    values = log[path][()]
    changes = [
        lambda v: v[:0], lambda v: v[:1], lambda v: v[:-1], lambda v: np.concatenate([v, v]), lambda v: v[..., None],
        lambda v: v.ravel()[0], lambda v: v.T, lambda v: np.repeat(v[..., None], 3, -1), lambda v: v.ravel(),
    ]  # fmt: skip
    named_cases.reshape(path, changes[random.integers(len(changes))])(log) if values.ndim else None


def change_type(log, path, random):
    kinds = ["f2", "f4", ">f8", "c16", "i1", "u8", "i8", ">i4", "S5", "S0", "?"]
    named_cases.retype(path, str(random.choice(kinds)))(log)


def remove(log, path, random):
    del log[path if random.random() < 0.7 else path.split("/")[0]]


def link(log, path, random):
    to = random.choice(datasets_of(log))
    makers = [
        lambda: named_cases.soft_link(path, "/" + to), lambda: named_cases.external_link(path, "/etc/passwd", "/x"),
        lambda: named_cases.external_link(path, ".", "/" + to), lambda: named_cases.external_storage(path, "/etc/passwd"),
        lambda: named_cases.virtual(path, "."), lambda: named_cases.empty_rows(path, int(random.choice([10, 2**20, 2**31, 2**45]))),
    ]  # fmt: skip
    makers[random.integers(len(makers))]()(log)


def swap(log, path, random):
    other = str(random.choice(datasets_of(log)))
    log.move(path, "swapped")
    if other != path:
        log.move(other, path)
        log.move("swapped", other)


def change_attribute(log, path, random):
    owner = log if random.random() < 0.6 else log[path]
    names = list(owner.attrs)
    if not names:
        return
    name = str(random.choice(names))
    values = [
        np.arange(500.0), np.zeros(0), h5py.Empty("f8"), h5py.Empty("S4"), 3, 2.5, np.bytes_(b"abc"), "",
        np.array(["a", "b"], object), "\x1b]0;x\x07", "a" * 60000, np.zeros(2, dtype=[("a", "i4")]), b"\xff\xfe",
    ]  # fmt: skip
    if random.random() < 0.2:
        del owner.attrs[name]
    else:
        owner.attrs[name] = values[random.integers(len(values))]


def change_texts(log, path, random):
    texts = [p for p in datasets_of(log) if log[p].dtype.kind in "OS"]
    if random.random() < 0.5 or not texts:
        named_cases.scene_text(log, lambda text: mutated_text(text, random))
    else:
        path = str(random.choice(texts))
        value = log[path][()]
        if isinstance(value, bytes):
            text = mutated_xml(value.decode(), random)
            named_cases.put(log, path, text, dtype=h5py.string_dtype())


CHANGES = [fill_with_extremes, set_one, set_one, change_shape, change_type, remove, link, swap, change_attribute, change_texts]


def structured(log, random):
    """One to three changes of a log or a set of QPs."""
    for _ in range(random.integers(1, 4)):
        paths = datasets_of(log)
        if paths:
            CHANGES[random.integers(len(CHANGES))](log, str(random.choice(paths)), random)


def mutated_xml(text, random):
    words = text.split('"')
    if len(words) > 3:
        for _ in range(random.integers(1, 4)):
            at = 2 * int(random.integers(len(words) // 2)) + 1
            words[at] = str(random.choice(["nan", "1e300", "-1", "0", "", "x" * 500, "inf", "1 2 3 4 5 6 7", "2147483647", "/etc/passwd"]))
    text = '"'.join(words)
    if random.random() < 0.3:
        lines = text.split("\n")
        at = int(random.integers(len(lines)))
        lines[at : at + int(random.integers(0, 3))] = [str(random.choice(lines))]
        text = "\n".join(lines)
    return text


def mutated_text(text, random):
    """A TOML text with one to four lines changed."""
    lines = text.split("\n")
    for _ in range(random.integers(1, 5)):
        at = int(random.integers(len(lines)))
        line = lines[at]
        kind = random.integers(8)
        if kind <= 2 and "=" in line:
            lines[at] = line.split("=")[0] + "= " + str(random.choice(WORDS))
        elif kind == 3:
            lines[at] = str(random.choice(lines))
        elif kind == 4:
            lines[at] = line + "\n" + str(random.choice(lines))
        elif kind == 5 and line:
            place = int(random.integers(len(line)))
            lines[at] = line[:place] + chr(int(random.integers(1, 256))) + line[place + 1 :]
        elif kind == 6:
            deep = int(random.choice([10, 100, 10000]))
            lines[at] = str(random.choice(["a = " + "[" * deep, "a." * deep + "b = 1", "[" + "t." * deep + "u]", "b = " + "{a=" * deep]))
        else:
            del lines[at]
            lines = lines or [""]
    return "\n".join(lines)


def mutated_csv(text, random):
    """A curvature program with one to six cells, lines or columns changed."""
    rows = [line.split(",") for line in text.rstrip("\n").split("\n")]
    for _ in range(random.integers(1, 7)):
        at = int(random.integers(len(rows))) if random.random() < 0.9 else 0
        kind = random.integers(8)
        if kind <= 3 and rows[at]:
            word = random.choice(["1e308", "-1e9", "1e-300", "nan", "inf", "", '"', "x", "0x1", "1,5", "#", "9" * 400, "3.0"])
            rows[at][int(random.integers(len(rows[at])))] = str(word)
        elif kind == 4:
            rows[at : at + int(random.integers(1, 30))] = []
        elif kind == 5:
            rows.insert(at, list(rows[int(random.integers(len(rows)))]))
        elif kind == 6:
            column = int(random.integers(5))
            rows = [row[:column] + row[column + 1 :] for row in rows]
        else:
            rows[at].append("y" * int(random.choice([1, 100, 100000])))
        rows = rows or [[""]]
    data = bytearray("\n".join(",".join(row) for row in rows).encode())
    if random.random() < 0.3 and data:
        data[int(random.integers(len(data)))] = int(random.integers(256))
    return bytes(data)


# A script, muscles, torques of few numbers, food, and a knot that slides.
EXTREME_SCENES = ["table1", "table1", "muscles", "few_numbers", "pull_overhand", "overhand_reverse", "knot_into_head.toml"]


def extreme_overrides(random, any_bodies=True):
    """`--set` values that the reader of scenes accepts, far from any animal, for a run of some steps. A scene that
    gives a posture has its own number of bodies."""
    low, high = 1e-12, 1e12

    def wild():
        return 10 ** random.uniform(np.log10(low), np.log10(high))

    choices = {
        "model.bodies": lambda: random.choice([2, 3, 5, 8, 20]),
        "model.bending_stiffness": wild, "model.bending_damping": wild, "model.twist_stiffness": wild,
        "model.twist_damping": wild, "model.largest_limit_deg": lambda: random.choice([1e-9, 1, 89.999999]),
        "model.limit_scale": wild, "model.mass_ratio": wild, "model.bending_limit": lambda: random.choice(["box", "cone"]),
        "drag.normal": wild, "drag.tangential": wild, "constraints.activation": lambda: "violated",
        "constraints.baumgarte": lambda: random.choice([0, 1, 0.5]), "constraints.baumgarte_speed": wild,
        "constraints.tolerance": wild, "constraints.corrections": lambda: random.choice([0, 100]),
        "constraints.stride": wild, "contact.margin": wild, "contact.least_arc": wild,
        "wall.present": lambda: random.choice(["true", "false"]), "wall.neck": wild,
        "clamp_head": lambda: random.choice(["true", "false"]),
        "gravity": lambda: f"[{wild():g}, {-wild():g}, 0]", "script.noise": wild, "script.kind": lambda: random.choice(["none", "force"]),
        "start.noise_deg": wild, "start.phase": lambda: random.choice(["form", "tighten", "slide", "release", "free"]),
        "start.bend": lambda: f"[[0.0, {wild():g}, 0.0, {wild():g}], [1.0, 0.0, {wild():g}, 0.0]]",
        "start.bend_rate": lambda: f"[[0.0, {wild():g}, 0.0, {wild():g}]]",
        "controller.cap": wild, "controller.contact_gap": lambda: 0,
        "controller.release_at": wild, "controller.tight_span": wild,
        "knot.votes": lambda: random.choice([1, 15, 200]), "knot.interval": wild, "guard.action": lambda: "warn",
        "guard.speed": wild, "guard.energy_gain": wild, "guard.energy_action": lambda: random.choice(["warn", "stop", "hold"]),
        "model.passive": lambda: random.choice(["scene", "specimen"]), "active.stiffness": wild, "active.tone_time": wild,
        "active.relax_time": wild, "active.capacity": wild, "muscle.present": lambda: random.choice(["true", "false"]),
        "muscle.activation_time": wild, "specimen.muscle.stress": wild, "specimen.muscle.radius_share": lambda: random.choice([0, 1e-12, 1]),
        "specimen.muscle.oblique_angle_deg": lambda: random.choice([0, 1e-9, 80]),
        "specimen.muscle.oblique_area": lambda: f"[{wild():g}, {wild():g}, {wild():g}, {wild():g}]",
        "specimen.passive.bending_stiffness": lambda: f"[{wild():g}, {wild():g}, {wild():g}, {wild():g}]",
        "controller.law": lambda: random.choice(["paper", "all_contacts", "knot_speed", "reduced_basis", "muscles", "reflex", "reflex_muscles"]),
        "controller.reflex.shift": lambda: -wild(), "controller.reflex.pull_shift": wild, "controller.reflex.delay": wild, "controller.reflex.noise": wild,
        "controller.reflex.gate": lambda: random.choice(["all", "touch"]), "controller.reflex.reach": wild,
        "controller.knot_speed.target": wild, "controller.knot_speed.gain": wild, "controller.knot_speed.filter": wild,
        "controller.reduced_basis.cosines": lambda: random.choice([1, 3, 100]), "controller.reduced_basis.softness": wild,
        "controller.reduced_basis.frame": lambda: random.choice(["body", "knot"]), "controller.reduced_basis.most": wild,
        "controller.reduced_basis.margin": wild, "controller.reduced_basis.smooth": wild, "controller.reduced_basis.filter": wild,
        "controller.free_from": lambda: random.choice(["tighten", "slide", "release", "free"]), "controller.tighten_from": wild,
        "controller.slide_head.a": wild, "controller.slide_tail.b": lambda: -wild(), "controller.leave_by": lambda: random.choice(["head", "tail"]),
        "food.hold": wild, "food.strength": wild, "food.average": wild, "mirror": lambda: random.choice(["true", "false"]),
        "time.rule": lambda: random.choice(["euler", "midpoint"]), "time.settled": wild, "time.passes": lambda: random.choice([1, 1000]),
        "start.spin": lambda: f"[{wild():g}, {-wild():g}, {wild():g}]",
        "script.spring": wild, "script.damper": wild, "script.largest_force": wild,
        "specimen.length": wild, "specimen.mass": wild, "specimen.twist_limit_deg": wild,
        "specimen.circumference": lambda: f"[{wild():g}, {wild():g}, {wild():g}, {wild():g}]",
    }  # fmt: skip
    step = float(10 ** random.uniform(-9, 3))
    # The number of bodies first: the commands that compare take time with its square.
    bodies = choices.pop("model.bodies")()
    values = {"model.bodies": bodies} if any_bodies else {}
    for key in random.choice(list(choices), int(random.integers(1, 7)), replace=False):
        values[str(key)] = choices[str(key)]()
    values["time.step"] = repr(step)
    values["time.frame_interval"] = repr(step * int(random.integers(1, 4)))
    values["time.duration"] = repr(step * int(random.integers(4, 12)))
    return [part for key, value in values.items() for part in ("--set", f"{key}={value}")]
