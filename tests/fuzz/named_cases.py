"""Hostile inputs by name: each is a change of a good log that once crashed or hung a command. What the readers of
HDF5 and MJCF refuse whatever asks them is in their own tests (hdf5_hostile_test)."""

import os
import shutil

import h5py
import numpy as np


def put(log, path, value, **how):
    """Replaces a dataset, or adds one."""
    if path in log:
        del log[path]
    log.create_dataset(path, data=value, **how)


def replace_attribute(log, name, value, **how):
    del log.attrs[name]
    log.attrs.create(name, value, **how)


def set_number(log, path, index, value):
    log[path][index] = value


def scene_text(log, change):
    replace_attribute(log, "scene", change(log.attrs["scene"]))


def mjcf_root(log, change):
    text = log["mjcf/hagfish.xml"][()]
    text = text.decode() if isinstance(text, bytes) else text
    put(log, "mjcf/hagfish.xml", change(text), dtype=h5py.string_dtype())


def world(extra):
    return lambda text: text.replace("<worldbody>", "<worldbody>" + extra, 1)


def before_world(extra):
    return lambda text: text.replace("<worldbody>", extra + "<worldbody>", 1)


def empty_rows(path, rows):
    """A dataset of many rows of which none is in the file."""

    def change(log):
        old = log[path]
        shape = (rows,) + old.shape[1:]
        dtype, attributes = old.dtype, dict(old.attrs)
        del log[path]
        new = log.create_dataset(path, shape, dtype, chunks=(4,) + shape[1:], maxshape=(None,) + shape[1:])
        for key, value in attributes.items():
            new.attrs[key] = value

    return change


def retype(path, dtype):
    def change(log):
        old = log[path]
        values, attributes = old[()], dict(old.attrs)
        put(log, path, values.astype(dtype))
        for key, value in attributes.items():
            log[path].attrs[key] = value

    return change


def reshape(path, how):
    def change(log):
        old = log[path]
        values, attributes = how(old[()]), dict(old.attrs)
        put(log, path, values)
        for key, value in attributes.items():
            log[path].attrs[key] = value

    return change


def fill(path, value):
    def change(log):
        log[path][...] = value

    return change


EXTREMES = [2**31 - 1, -(2**31), -1, -2]


def log_changes():
    """Changes of a log by name."""
    cases = {
        "mjcf_fixed_length": lambda log: put(log, "mjcf/hagfish.xml", np.bytes_(b"<mujoco/>")),
        "mjcf_fixed_length_array": lambda log: put(log, "mjcf/hagfish.xml", np.array([b"<mujoco/>"] * 3)),
        "mjcf_numbers": lambda log: put(log, "mjcf/hagfish.xml", np.arange(4.0)),
        "mjcf_no_text": lambda log: put(log, "mjcf/hagfish.xml", h5py.Empty("f8")),
        "mjcf_empty_array": lambda log: put(log, "mjcf/hagfish.xml", np.zeros(0, "S4")),
        "mjcf_empty_texts": lambda log: put(
            log, "mjcf/hagfish.xml", np.array([], object), dtype=h5py.string_dtype()
        ),
        "mjcf_group": lambda log: log.create_group("mjcf/other"),
        "mjcf_is_data": lambda log: put(log, "mjcf", np.arange(3.0)),
        "mjcf_empty_text": lambda log: put(log, "mjcf/hagfish.xml", "", dtype=h5py.string_dtype()),
        "mjcf_long_name": lambda log: put(log, "mjcf/" + "a" * 3000, "<mujoco/>", dtype=h5py.string_dtype()),
        "mjcf_many": lambda log: [put(log, f"mjcf/m{k}", "<mujoco/>", dtype=h5py.string_dtype()) for k in range(3000)],
        "mjcf_path": lambda log: put(log, "mjcf/..", "<mujoco/>", dtype=h5py.string_dtype()),
        "mjcf_nstack": lambda log: mjcf_root(log, before_world('<size nstack="10"/>')),
        "mjcf_no_mass": lambda log: mjcf_root(log, world('<body name="z"><joint/></body>')),
        "mjcf_control_characters": lambda log: mjcf_root(log, world("<\x1b[31mred/>")),
        "mjcf_nan": lambda log: mjcf_root(log, lambda text: text.replace('mass="', 'mass="nan', 1)),
        "scene_fixed": lambda log: replace_attribute(log, "scene", np.bytes_(log.attrs["scene"].encode())),
        "scene_missing": lambda log: log.attrs.__delitem__("scene"),
        "scene_votes": lambda log: scene_text(log, lambda text: text.replace("votes = 15", "votes = 1000000000")),
        "scene_bodies": lambda log: scene_text(log, lambda text: text.replace("bodies = ", "bodies = 2147483")),
        "scene_deep": lambda log: scene_text(log, lambda text: "a = " + "[" * 15000 + "]" * 15000 + "\n" + text),
        "scene_base": lambda log: scene_text(log, lambda text: 'base = "/etc/passwd.toml"\n' + text),
        "scene_specimen": lambda log: scene_text(
            log, lambda text: 'specimen = "/dev/zero"\n' + text.replace("[specimen]", "[other]")
        ),
        "scene_tiny_step": lambda log: scene_text(log, lambda text: text.replace("step = 0.0", "step = 0.0000000000")),
        "version_compound": lambda log: replace_attribute(
            log, "format_version", np.zeros(2, dtype=[("a", "i4"), ("b", "f8")])
        ),
        "status_escape": lambda log: replace_attribute(log, "status", "failed: \x1b]0;owned\x07\x1b[31m\n\r x"),
        "revision_escape": lambda log: replace_attribute(log, "git_revision", "\x1b]0;owned\x07\x1b[31m"),
        "status_long": lambda log: replace_attribute(log, "status", "x" * 60000),
        "cpu_numbers": lambda log: replace_attribute(log, "cpu", np.arange(500)),
        "unit_array": lambda log: log["steps/kkt"].attrs.create("unit", np.arange(500)),
        "unit_empty": lambda log: log["steps/kkt"].attrs.create("unit", np.zeros(0, "S3")),
        "description_null": lambda log: log["steps/kkt"].attrs.create("description", h5py.Empty("f4")),
        "kkt_scalar": lambda log: put(log, "steps/kkt", 1.0),
        "eq6_scalar": lambda log: put(log, "steps/eq6", 1),
        "eq6_matrix": reshape("steps/eq6", lambda v: v[:, None] * np.ones(7, v.dtype)),
        "steps_short": lambda log: [
            put(log, f"steps/{name}", log[f"steps/{name}"][:1]) for name in list(log["steps"])
        ],
        "steps_no_rows": lambda log: log.__delitem__("steps/rows"),
        "steps_empty": lambda log: [
            put(log, f"steps/{name}", log[f"steps/{name}"][:0]) for name in list(log["steps"])
        ],
        "contacts_frame_scalar": lambda log: put(log, "contacts/frame", 1),
        "contacts_short": reshape("contacts/force", lambda v: v[: len(v) // 2]),
        "frame_scalar": lambda log: put(log, "trajectory/time", 0.0),
        "frames_none": lambda log: [
            put(log, f"{group}/{name}", log[f"{group}/{name}"][:0])
            for group in ("trajectory", "knot", "forces", "thigmotaxis", "diagnostics")
            for name in list(log[group])
        ],
        "time_nan": fill("trajectory/time", np.nan),
        "time_inf": lambda log: set_number(log, "trajectory/time", -1, np.inf),
        "time_falls": reshape("trajectory/time", lambda v: v[::-1]),
        "time_huge": fill("trajectory/time", 1e300),
        "q_nan": fill("trajectory/q", np.nan),
        "q_inf": fill("trajectory/q", np.inf),
        "q_huge": fill("trajectory/q", 1e300),
        "q_large": fill("trajectory/q", 1e9),
        "q_zero": fill("trajectory/q", 0.0),
        "q_coincident": fill("trajectory/q", 1e-300),
        "qdot_huge": fill("trajectory/qdot", 1e308),
        "qdot_next_huge": fill("trajectory/qdot_next", 1e308),
        "position_text": lambda log: put(log, "trajectory/position", np.array([b"abc"] * 5)),
        "position_compound": lambda log: put(log, "trajectory/position", np.zeros(5, dtype=[("x", "f8"), ("y", "i2")])),
        "step_extreme": lambda log: put(log, "trajectory/step", np.array([-(2**63)] + [2**63 - 1] * (len(log["trajectory/time"]) - 1))),
        "step_large": lambda log: put(log, "trajectory/step", log["trajectory/step"][()] + 2**62),
        "step_same": fill("trajectory/step", 7),
        "step_far": lambda log: set_number(log, "trajectory/step", 0, -(2**60)),
        "step_float": retype("trajectory/step", "f8"),
        "phase_wide": retype("trajectory/phase", "i8"),
        "phase_other": fill("trajectory/phase", 200),
        "hard_link_loop": lambda log: log["mjcf"].__setitem__("loop", log["/"]),
        "dataset_is_group": lambda log: (log.__delitem__("trajectory/q"), log.create_group("trajectory/q")),
        "group_is_dataset": lambda log: put(log, "trajectory", 1.0),
        "type_object": lambda log: log.__setitem__("trajectory_type", np.dtype("f8")),
        "q_is_type": lambda log: (log.__delitem__("trajectory/q"), log.__setitem__("trajectory/q", np.dtype("f8"))),
        "reference": lambda log: put(log, "trajectory/step", np.array([log.ref] * len(log["trajectory/time"]), h5py.ref_dtype)),
        "joint_name_fixed": lambda log: put(log, "model/joint_name", np.array([b"a" * 40] * 8)),
        "joint_name_numbers": lambda log: put(log, "model/joint_name", np.arange(8.0)),
        "dof_name_empty": lambda log: put(log, "model/dof_name", np.array([], object), dtype=h5py.string_dtype()),
        "mass_scalar": lambda log: put(log, "model/mass", 1.0),
        "mass_huge": lambda log: put(log, "model/mass", np.zeros(100000000), chunks=(1000000,), compression="gzip"),
        "bending_limit_text": lambda log: put(log, "model/bending_limit", np.array([b"abc"] * 8)),
        "diagnostics_short": lambda log: [
            put(log, f"diagnostics/{name}", log[f"diagnostics/{name}"][:1]) for name in list(log["diagnostics"])
        ],
        "diagnostics_none": lambda log: [
            put(log, f"diagnostics/{name}", log[f"diagnostics/{name}"][:0]) for name in list(log["diagnostics"])
        ],
        "wall_time_none": lambda log: put(log, "diagnostics/wall_time", np.zeros(0)),
        "knot_short": lambda log: [put(log, f"knot/{name}", log[f"knot/{name}"][:1]) for name in list(log["knot"])],
        "knot_extreme": fill("knot/determinant", 2**31 - 1),
        "knot_negative": fill("knot/v2", -(2**31)),
        "means_short": reshape("mean/forces/thigmotaxis", lambda v: v[:1]),
        "means_huge": fill("mean/forces/thigmotaxis", 1e308),
        "big_endian": retype("trajectory/q", ">f8"),
        "long_double": retype("trajectory/q", np.longdouble),
        "complex": retype("trajectory/q", "c16"),
        "half": retype("trajectory/q", "f2"),
        "array_type": lambda log: put(log, "trajectory/q", np.zeros(5, dtype=[("x", "f8", (14,))])),
        "vlen_numbers": lambda log: put(log, "trajectory/time", np.array([np.arange(3.0)] * 5, object), dtype=h5py.vlen_dtype(np.dtype("f8"))),
        "bytes_null": lambda log: log.attrs.create("title", b"a\0b"),
        "dimensions_32": lambda log: put(log, "trajectory/q", np.zeros((1,) * 32)),
        "large_chunk": lambda log: put(log, "trajectory/q", np.zeros((2, 14)), chunks=(2, 14), maxshape=(None, None)),
    }
    for name in ("body_a", "body_b"):
        for value in EXTREMES:
            cases[f"{name}_{value}"] = fill(f"thigmotaxis/{name}", value)
    for name in ("spline_a", "spline_b"):
        for value in (1e300, -1e300, np.inf, 1e10, -0.5):
            cases[f"thigmotaxis_{name}_{value:g}"] = fill(f"thigmotaxis/{name}", value)
    for value in EXTREMES:
        cases[f"contacts_frame_{value}"] = fill("contacts/frame", value)
        cases[f"solve_{value}"] = lambda log, v=value: put(log, "steps/solve", np.full(len(log["steps/kkt"]), v))
    for path in ("trajectory/time", "steps/kkt", "trajectory/q", "contacts/frame", "knot/determinant", "thigmotaxis/body_b"):
        for rows in (2**31, 2**40):
            cases[f"empty_{path.replace('/', '_')}_{rows}"] = empty_rows(path, rows)
    return cases


def changed_log(base, change, file):
    """Writes `base` with `change` as `file`; False where the change does not apply to this log."""
    shutil.copyfile(base, file)
    try:
        with h5py.File(file, "r+") as log:
            change(log)
    except (AttributeError, KeyError, ValueError, TypeError, IndexError, OSError, RuntimeError, OverflowError):
        os.remove(file)
        return False
    return True
