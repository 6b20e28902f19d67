"""Damage: to the bytes of a file, to datasets and attributes of HDF5, to texts of scenes, to cells of a CSV. It is
random but for NAMED, the changes of a log that once crashed or hung a command and that chance would hardly make."""

import os
import pathlib
import re
import shutil
import tomllib

import h5py
import numpy as np

import scene_keys

EXTREME_NUMBERS = [0.0, -0.0, 1.0, -1.0, 1e-300, 1e300, -1e300, np.inf, -np.inf, np.nan, 2.0**31, 2.0**63, 1e9, -1e9]
EXTREME_INTEGERS = [0, 1, -1, -2, 2**31 - 1, -(2**31), 2**63 - 1, -(2**63), 255]
TEXTS = ["", "\x1b[31m", "a" * 70000, "\0", "\n", "[" * 3000, "../..", "/dev/zero", "\udcff"]
WORDS = """1e308 -1e308 1e-308 0 -1 nan inf -inf 9223372036854775807 -9223372036854775808 99999999999999999999
    2147483647 4294967296 true "" "\\u001b[31m" [] {} [[[[1]]]] 1979-05-27 "/dev/zero" "/etc/passwd" 0x7fffffffffffffff
    1e-9 1e9""".split()
TEXT = {"dtype": h5py.string_dtype()}


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


def put(log, path, value, **how):
    """Replaces a dataset, which keeps its attributes, or adds one."""
    attributes = dict(log[path].attrs) if path in log else {}
    if path in log:
        del log[path]
    made = log.create_dataset(path, data=value, **how)
    for key, each in attributes.items():
        made.attrs[key] = each


def put_attribute(name, value):
    def change(log):
        old = log.attrs[name]
        del log.attrs[name]
        log.attrs.create(name, value(old) if callable(value) else value)

    return change


def mjcf(change):
    return lambda log: put(log, "mjcf/hagfish.xml", change(log["mjcf/hagfish.xml"].asstr()[()]), **TEXT)


def first_rows(count, *groups):
    """Of all datasets of groups, or of the one that is named."""

    def change(log):
        for group in groups:
            own = log[group]
            for path in [f"{group}/{name}" for name in own] if isinstance(own, h5py.Group) else [group]:
                put(log, path, log[path][:count])

    return change


NAMED = {
    "mjcf_fixed_length": lambda log: put(log, "mjcf/hagfish.xml", np.bytes_(b"<mujoco/>")),
    "mjcf_fixed_length_array": lambda log: put(log, "mjcf/hagfish.xml", np.array([b"<mujoco/>"] * 3)),
    "mjcf_empty_texts": lambda log: put(log, "mjcf/hagfish.xml", np.array([], object), **TEXT),
    "mjcf_empty_text": mjcf(lambda _: ""),
    "mjcf_group": lambda log: log.create_group("mjcf/other"),
    "mjcf_is_data": lambda log: put(log, "mjcf", np.arange(3.0)),
    "mjcf_long_name": lambda log: put(log, "mjcf/" + "a" * 3000, "<mujoco/>", **TEXT),
    "mjcf_many": lambda log: [put(log, f"mjcf/m{k}", "<mujoco/>", **TEXT) for k in range(3000)],
    "mjcf_path": lambda log: put(log, "mjcf/..", "<mujoco/>", **TEXT),
    "mjcf_nstack": mjcf(lambda text: text.replace("<worldbody>", '<size nstack="10"/><worldbody>', 1)),
    "mjcf_no_mass": mjcf(lambda text: text.replace("<worldbody>", '<worldbody><body name="z"><joint/></body>', 1)),
    "mjcf_control_characters": mjcf(lambda text: text.replace("<worldbody>", "<worldbody><\x1b[31mred/>", 1)),
    "mjcf_nan": mjcf(lambda text: text.replace('mass="', 'mass="nan', 1)),
    "scene_fixed": put_attribute("scene", lambda text: np.bytes_(text.encode())),
    "scene_missing": lambda log: log.attrs.__delitem__("scene"),
    "scene_votes": put_attribute("scene", lambda text: text.replace("votes = 15", "votes = 1000000000")),
    "scene_bodies": put_attribute("scene", lambda text: text.replace("bodies = ", "bodies = 2147483")),
    "scene_deep": put_attribute("scene", lambda text: "a = " + "[" * 15000 + "]" * 15000 + "\n" + text),
    "scene_base": put_attribute("scene", lambda text: 'base = "/etc/passwd.toml"\n' + text),
    "scene_specimen": put_attribute(
        "scene", lambda text: 'specimen = "/dev/zero"\n' + text.replace("[specimen]", "[other]")),
    "scene_tiny_step": put_attribute("scene", lambda text: text.replace("step = 0.0", "step = 0.0000000000")),
    "status_escape": put_attribute("status", "failed: \x1b]0;owned\x07\x1b[31m\n\r x"),
    "revision_escape": put_attribute("git_revision", "\x1b]0;owned\x07\x1b[31m"),
    "title_null": lambda log: log.attrs.create("title", b"a\0b"),
    "steps_short": first_rows(1, "steps"),
    "steps_empty": first_rows(0, "steps"),
    "frames_none": first_rows(0, "trajectory", "knot", "forces", "thigmotaxis", "diagnostics"),
    "diagnostics_short": first_rows(1, "diagnostics"),
    "diagnostics_none": first_rows(0, "diagnostics"),
    "knot_short": first_rows(1, "knot"),
    "means_short": first_rows(1, "mean/forces/thigmotaxis"),
    "hard_link_loop": lambda log: log["mjcf"].__setitem__("loop", log["/"]),
    "type_beside": lambda log: log.__setitem__("trajectory_type", np.dtype("f8")),
    "group_is_dataset": lambda log: put(log, "trajectory", 1.0),
    "mass_huge": lambda log: put(log, "model/mass", np.zeros(10**8), chunks=(10**6,), compression="gzip"),
}


def changed_log(base, change, file):
    """Writes `base` with `change` as `file`; False where the change does not apply to this log."""
    shutil.copyfile(base, file)
    try:
        with h5py.File(file, "r+") as log:
            change(log)
    except (KeyError, ValueError, TypeError, IndexError, OSError, RuntimeError, OverflowError):
        os.remove(file)
        return False
    return True


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
    changes = [
        lambda v: v[:0], lambda v: v[:1], lambda v: v[:-1], lambda v: v[: len(v) // 2], lambda v: v[::-1],
        lambda v: v.T, lambda v: np.concatenate([v, v]), lambda v: v[..., None], lambda v: v.ravel()[0],
        lambda v: v.ravel(), lambda v: np.repeat(v[..., None], 3, -1),
    ]
    if log[path].ndim:
        put(log, path, changes[random.integers(len(changes))](log[path][()]))


def change_type(log, path, random):
    kinds = ["f2", "f4", ">f8", "c16", "i1", "u8", "i8", ">i4", "S5", "S0", "?", np.longdouble]
    put(log, path, log[path][()].astype(kinds[random.integers(len(kinds))]))


def change_kind(log, path, random):
    """Other things of HDF5 in a dataset's place."""
    rows = len(log[path]) if log[path].ndim else 1
    values = [
        np.zeros(rows, [("x", "f8"), ("y", "i2")]), np.zeros(rows, [("x", "f8", (14,))]), np.array([b"abc"] * rows),
        np.array([log.ref] * rows, h5py.ref_dtype), h5py.Empty("f8"), np.zeros((1,) * 32),
    ]
    kind = int(random.integers(len(values) + 3))
    if kind < len(values):
        put(log, path, values[kind])
        return
    del log[path]
    if kind == len(values):
        log.create_group(path)
    elif kind == len(values) + 1:
        log[path] = np.dtype("f8")
    else:
        lists = log.create_dataset(path, rows, h5py.vlen_dtype(np.dtype("f8")))
        lists[0] = np.arange(3.0)


def claim_rows(log, path, random):
    """Many, of which none is in the file."""
    shape, dtype = log[path].shape[1:], log[path].dtype
    attributes = dict(log[path].attrs)
    del log[path]
    rows = int(random.choice([10, 2**20, 2**31, 2**40, 2**45]))
    made = log.create_dataset(path, (rows, *shape), dtype, chunks=(4, *shape), maxshape=(None, *shape))
    for key, value in attributes.items():
        made.attrs[key] = value


def remove(log, path, random):
    del log[path if random.random() < 0.7 else path.split("/")[0]]


def link(log, path, random):
    other, shape, dtype = str(random.choice(datasets_of(log))), log[path].shape, log[path].dtype
    del log[path]
    kind = random.integers(5)
    if kind <= 2:
        outside = h5py.ExternalLink("/etc/passwd", "/x")
        log[path] = [h5py.SoftLink("/" + other), outside, h5py.ExternalLink(".", "/" + other)][kind]
    elif kind == 3:
        log.create_dataset(path, shape, dtype, external=[("/etc/passwd", 0, h5py.h5f.UNLIMITED)])
    else:
        layout = h5py.VirtualLayout(shape, dtype)
        layout[...] = h5py.VirtualSource(".", other, shape)
        log.create_virtual_dataset(path, layout)


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
        put_attribute("scene", lambda text: mutated_text(text, random))(log)
    else:
        path = str(random.choice(texts))
        value = log[path][()]
        if isinstance(value, bytes):
            put(log, path, mutated_text(value.decode(), random), **TEXT)


CHANGES = [fill_with_extremes, set_one, set_one, change_shape, change_type, change_kind, claim_rows, remove, link, swap,
           change_attribute, change_texts]


def structured(log, random):
    """One to three changes of a log or a set of QPs."""
    for _ in range(random.integers(1, 4)):
        paths = datasets_of(log)
        if paths:
            CHANGES[random.integers(len(CHANGES))](log, str(random.choice(paths)), random)


def mutated_text(text, random):
    """A text, as TOML or XML, with one to four lines changed."""
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
            texts = ["a = " + "[" * deep, "a." * deep + "b = 1", "[" + "t." * deep + "u]", "b = " + "{a=" * deep]
            lines[at] = str(random.choice(texts))
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
            words = ["1e308", "-1e9", "1e-300", "nan", "inf", "", '"', "x", "0x1", "1,5", "#", "9" * 400, "3.0"]
            word = random.choice(words)
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
EXTREME_SCENES = "table1 table1 muscles few_numbers pull_overhand overhand_reverse knot_into_head.toml".split()


DATA = pathlib.Path(__file__).resolve().parents[2] / "data"
NEEDS_OTHERS = {"", "start", "expect", "time"}  # of texts, of postures, and with values of its own below
FEW = {"model.bodies": [2, 3, 5, 8, 20], "knot.votes": [1, 15, 200], "controller.leave_by": ["head", "tail"],
       "controller.law": "paper all_contacts knot_speed reduced_basis muscles reflex reflex_muscles".split()}
ACT_WITH = {  # what settings need so that anything reads them
    "controller.reflex": {"controller.law": "reflex", "controller.reflex.shift": 1},
    "controller.knot_speed": {"controller.law": "knot_speed", "controller.knot_speed.target": 1},
    "controller.reduced_basis": {"controller.law": "reduced_basis", "controller.reduced_basis.cosines": 3},
    "controller.reverse": {"controller.leave_by": "tail"},
    "food": {"food.hold": 1},
}


def settings():
    """Keys of scenes with a good value and the words that their comments name, from the two commented files."""
    found = {"time.rule": ("euler", ["euler", "midpoint"])}
    for prefix, file in (("", "table1.toml"), ("specimen.", "specimens/pacific_hagfish.toml")):
        lines = (DATA / file).read_text().split("\n\n", 1)[1].splitlines()
        for section, key, value, comment in scene_keys.rows_of(lines):
            if key and value not in ("[...]", '""') and (prefix or section not in NEEDS_OTHERS):
                name = f"{prefix}{section}.{key}".replace("..", ".")
                good = tomllib.loads(f"v = {value}")["v"]
                words = FEW.get(name) or re.findall(r'"(\w+)"', f"{value} {comment}")
                parts = good if isinstance(good, dict) else {"": good}
                found |= {f"{name}.{part}".rstrip("."): (each, words) for part, each in parts.items()}
    return found


SETTINGS = settings()


def extreme_overrides(random, any_bodies=True):
    """`--set` values far from any animal, for some steps. A scene that gives a posture has its own number of bodies."""

    def extreme(good, words):
        if isinstance(good, list):
            return "[" + ", ".join(str(extreme(each, [])) for each in good) + "]"
        if isinstance(good, bool):
            return random.choice(["true", "false"])
        if isinstance(good, str) or (isinstance(good, int) and words):
            return random.choice(words) if words else good
        if isinstance(good, int):
            return random.choice([0, 1, 2, 15])
        return f"{random.choice([1] * 18 + [-1, 0]) * 10 ** random.uniform(-12, 12):g}"

    # The number of bodies first: the commands that compare take time with its square.
    chosen = random.choice(list(SETTINGS), int(random.integers(1, 6)), replace=False)
    keys = [str(key) for key in chosen if key != "model.bodies"]
    values = {key: extreme(*SETTINGS[key]) for key in [*(["model.bodies"] if any_bodies else []), *keys]}
    for prefix, needs in ACT_WITH.items():
        if any(key.startswith(prefix) for key in keys):
            values = needs | values
    step = float(10 ** random.uniform(-9, 3))
    values |= {"time.step": repr(step), "time.frame_interval": repr(step * int(random.integers(1, 4))),
               "time.duration": repr(step * int(random.integers(4, 12)))}
    return [part for key, value in values.items() for part in ("--set", f"{key}={value}")]
