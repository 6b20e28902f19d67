"""`hagfish export`: every column against the log, read and recomputed here."""

from __future__ import annotations

import sys
import tomllib
from pathlib import Path

import h5py
import numpy as np
import pytest

sys.dont_write_bytecode = True
sys.path.insert(0, str(Path(__file__).parents[3] / "support"))

from program import hagfish, refused, table  # noqa: E402

DIGITS = 1e-8  # of a column's largest: nine digits are written
FILES = ("midline", "curvature", "knot", "contacts", "torques", "joints", "eq6", "head", "energy", "moments", "phases", "skin", "summary")
SI = {"cm2": 1e-4, "cm": 1e-2, "dyn": 1e-5, "dyn_cm": 1e-7, "dyn_cm_s": 1e-7, "erg": 1e-7, "g": 1e-3, "cm_per_s": 1e-2, "rad_per_cm": 1e2}
SI_NAME = {"cm2": "m2", "cm": "m", "dyn": "N", "dyn_cm": "N_m", "dyn_cm_s": "N_m_s", "erg": "J", "g": "kg", "cm_per_s": "m_per_s", "rad_per_cm": "rad_per_m"}


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    """A whole run: contacts, limits, plate and thigmotaxis all bear."""
    folder = tmp_path_factory.mktemp("export")
    hagfish(folder, "run", "table1", "--preset", "quick", "--quiet", "--out", "a.h5")
    hagfish(folder, "export", "a.h5", "--out", "cgs")
    hagfish(folder, "export", "a.h5", "--out", "si", "--si")
    return folder, h5py.File(folder / "a.h5"), {name: table(folder / "cgs" / f"{name}.csv") for name in FILES}


def same(found, wanted):
    found, wanted = np.asarray(found, float), np.asarray(wanted, float)
    np.testing.assert_array_equal(np.isnan(found), np.isnan(wanted))
    scale = np.nanmax(np.abs(wanted), initial=1e-300)
    np.testing.assert_allclose(found, wanted, rtol=0, atol=DIGITS * scale)


def spans(log):
    """Length of body that each joint stands for (core/chain/model.hpp), by the joint."""
    n, length = len(log["model/length"]), log["model/length"][0]
    return {j: ((n if j + 2 >= n else j + 1) - (0 if j <= 2 else j - 1)) * length for j in range(1, n)}


def test_midline(run):
    _, log, tables = run
    t, n = tables["midline"], len(log["model/length"])
    frames = len(log["trajectory/time"])
    places = np.stack([t[f"{axis}_cm"] for axis in "xyz"], axis=1).reshape(frames, n + 2, 3)
    same(places[:, 1:-1], log["trajectory/position"][()])
    same(places[:, 0], log["trajectory/q"][:, :3])
    # The ends are as far from the outermost centres as half a body is long.
    for end, beside, body in ((0, 1, 0), (-1, -2, -1)):
        away = np.linalg.norm(places[:, end] - places[:, beside], axis=1)
        np.testing.assert_allclose(away, log["model/length"][body] / 2, atol=1e-6)  # nine digits of some 40 cm
    s = t["s_cm"].reshape(frames, n + 2)[0]
    same(s, np.r_[0, np.cumsum(log["model/length"][()]) - log["model/length"][()] / 2, log["model/length"][()].sum()])
    same(t["time_s"], np.repeat(log["trajectory/time"][()], n + 2))
    same(t["radius_cm"].reshape(frames, n + 2)[3, 1:-1], log["model/radius"][()])


def test_curvature(run):
    _, log, tables = run
    t, q, span = tables["curvature"], log["trajectory/q"][()], spans(log)
    names = list(log["model/dof_name"].asstr()[()])
    angle = lambda name: q[:, names.index(name) + 1]
    for joint in (1, 37, 99):
        at = t["joint"] == joint
        y, z = angle(f"j{joint:02d}_bend_y"), angle(f"j{joint:02d}_bend_z")
        same(t["bend_y_rad_per_cm"][at], y / span[joint])
        same(t["bend_z_rad_per_cm"][at], z / span[joint])
        # 1 - cos of the total bend, without what cancels.
        total = 2 * np.arcsin(np.sqrt(np.sin(y / 2) ** 2 + np.cos(y) * np.sin(z / 2) ** 2))
        same(t["curvature_rad_per_cm"][at], total / span[joint])
        beside = [k for k in (joint - 1, joint + 1) if 1 <= k < len(log["model/length"])]
        same(t["twist_rad_per_cm"][at], sum(angle(f"j{k:02d}_twist") for k in beside) / sum(span[k] for k in beside))


def test_torques_add_up(run):
    _, log, tables = run
    t, names = tables["torques"], list(log["model/dof_name"].asstr()[()])
    hinges = len(names) - 6
    columns = {kind: t[f"{kind}_dyn_cm"].reshape(-1, hinges) for kind in
               ("spring", "active", "thigmotaxis", "contact", "limit", "wall")}
    for kind in ("active", "thigmotaxis", "contact", "limit", "wall"):
        same(columns[kind], log[f"mean/forces/{kind}"][:, 6:])
        assert kind == "active" or np.nanmax(np.abs(columns[kind])) > 0
    total = sum(columns[kind] for kind in ("active", "thigmotaxis", "contact", "limit", "wall"))
    same(total + log["mean/forces/head"][:, 6:], log["mean/forces/net"][:, 6:])
    scene, span = tomllib.loads(log.attrs["scene"]), spans(log)
    stiffness = [scene["model"]["twist_stiffness" if name.endswith("twist") else "bending_stiffness"] / span[int(name[1:3])]
                 for name in names[6:]]
    same(columns["spring"], -np.array(stiffness) * log["trajectory/q"][:, 7:])
    same(t["angle_rad"].reshape(-1, hinges), log["trajectory/q"][:, 7:])
    assert [f"j{int(joint):02d}_{axis}" for joint, axis in zip(t["joint"][:hinges], t["axis"][:hinges])] == names[6:]


def test_moments(run):
    _, log, tables = run
    t, joints = tables["moments"], len(log["model/length"]) - 1
    place = {axis: k for k, axis in enumerate("xyz")}
    for axis, k in place.items():
        same(t[f"turn_{axis}_rad_per_cm"].reshape(-1, joints), log["trajectory/curvature"][:, 1:, k])
        for kind in ("active", "thigmotaxis", "contact", "limit", "wall"):
            same(t[f"{kind}_{axis}_dyn_cm"].reshape(-1, joints), log[f"mean/moments/{kind}"][:, 1:, k])
            assert kind == "active" or np.nanmax(np.abs(log[f"mean/moments/{kind}"])) > 0
    same(t["joint"][:joints], 1 + np.arange(joints))


def spline_point(centres, lengths, s):
    """Where the uniform Catmull-Rom spline is at arc length s, written down once more."""
    parameter = (s - lengths[0] / 2) / lengths[0]
    i = min(int(parameter), len(centres) - 2)
    t, p = parameter - i, np.vstack([2 * centres[0] - centres[1], centres, 2 * centres[-1] - centres[-2]])[i:i + 4]
    return 0.5 * np.array([-t + 2 * t**2 - t**3, 2 - 5 * t**2 + 3 * t**3, t + 4 * t**2 - 3 * t**3, t**3 - t**2]) @ p


def test_contacts(run):
    _, log, tables = run
    t, centres, lengths = tables["contacts"], log["trajectory/position"][()], log["model/length"][()]
    bears = t["force_dyn"] > 0
    by_size = lambda frame, force: force[np.lexsort((force, frame))]
    same(by_size(t["frame"][bears], t["force_dyn"][bears]), by_size(log["contacts/frame"][()], log["contacts/force"][()]))
    same(np.sort(t["frame"][bears]), np.sort(log["contacts/frame"][()]))
    plate = t["kind"] == "plate"
    assert plate.any() and not plate.all() and not bears.all()
    for k in range(0, len(bears), 17):
        frame, normal = int(t["frame"][k]), np.array([t[f"normal_{axis}"][k] for axis in "xyz"])
        place = np.array([t[f"{axis}_cm"][k] for axis in "xyz"])
        body = lambda s: np.interp(s, np.cumsum(lengths) - lengths / 2, log["model/radius"][()])
        a = spline_point(centres[frame], lengths, t["s_a_cm"][k])
        if plate[k]:
            same(t["gap_cm"][k], a[0] - body(t["s_a_cm"][k]))
            b, radius = np.array([0, a[1], a[2]]), 0
        else:
            b, radius = spline_point(centres[frame], lengths, t["s_b_cm"][k]), body(t["s_b_cm"][k])
            np.testing.assert_allclose(t["gap_cm"][k], np.linalg.norm(a - b) - radius - body(t["s_a_cm"][k]), atol=1e-7)
        np.testing.assert_allclose(place, b + (radius + t["gap_cm"][k] / 2) * normal, atol=1e-6)
    # What presses the plate is what the plate gives back.
    of_frame = np.bincount(t["frame"][plate].astype(int), t["force_dyn"][plate], len(centres))
    same(of_frame[:-1], log["forces/wall"][:-1, 0])  # at the end no step begins


def test_what_the_log_has_is_as_the_log_has_it(run):
    _, log, tables = run
    knot, eq6, head, energy = (tables[name] for name in ("knot", "eq6", "head", "energy"))
    for name in ("determinant", "v2", "agreement", "head_end", "tail_end"):
        same(knot[name + ("_cm" if name.endswith("end") else "")], log[f"knot/{name}"][()])
    same(knot["span_cm"], log["knot/tail_end"][()] - log["knot/head_end"][()])
    words = {value: word for word, value in h5py.check_enum_dtype(log["trajectory/phase"].dtype).items()}
    assert list(knot["phase"]) == [words[int(p)] for p in log["trajectory/phase"]]
    assert set(knot["knot"][log["knot/determinant"][()] == 3]) == {"3_1"}
    for column, path in (("command", "thigmotaxis/command"), ("speed", "mean/thigmotaxis/speed"),
                         ("shortfall", "mean/thigmotaxis/slack")):
        same(eq6[f"{column}_cm_per_s"].reshape(-1, 4), log[path][()])
    same(eq6["multiplier_dyn"].reshape(-1, 4), log["mean/thigmotaxis/lambda"][()])
    same(np.stack([head[f"force_{a}_dyn"] for a in "xyz"] + [head[f"torque_{a}_dyn_cm"] for a in "xyz"], axis=1),
         log["mean/forces/head"][:, :6])
    same(head["plate_force_x_dyn"], log["mean/forces/wall"][:, 0])
    for name in energy:
        if name.endswith("_erg"):
            same(energy[name], log["diagnostics/" + name.removesuffix("_erg")][()])


def test_joints_are_the_torques_a_column_a_hinge(run):
    _, log, tables = run
    names = list(log["model/dof_name"].asstr()[()])[6:]
    assert list(tables["joints"]) == ["frame", "time_s", *(f"{name}_dyn_cm" for name in names)]
    made = log["mean/forces/active"][:, 6:] + log["mean/forces/thigmotaxis"][:, 6:]
    same(np.stack([tables["joints"][f"{name}_dyn_cm"] for name in names], axis=1), made)


def test_phases(run):
    _, log, tables = run
    t, names = tables["phases"], list(log["model/dof_name"].asstr()[()])
    words = {value: word for word, value in h5py.check_enum_dtype(log["trajectory/phase"].dtype).items()}
    of_frame, time = [words[int(p)] for p in log["trajectory/phase"]], log["trajectory/time"][()]
    assert list(t["phase"]) == list(dict.fromkeys(of_frame))
    same(t["to_s"][:-1], t["from_s"][1:])
    same([t["from_s"][0], t["to_s"][-1]], time[[0, -1]])
    # Works and losses of the phases add up to the run's.
    for name in ("work_tip", "work_active", "work_thigmotaxis", "dissipated"):
        same(t[f"{name}_erg"].sum(), tables["summary"][f"{name}_erg"][0])
    force, spans_of = np.abs(log["mean/forces/thigmotaxis"][:, 6:]), spans(log)
    share = np.array([spans_of[int(name[1:3])] for name in names[6:]]) / log["model/length"][()].sum()
    for row, phase in enumerate(t["phase"]):
        own = [f + 1 for f, each in enumerate(of_frame[:-1]) if each == phase]  # the mean that ends a frame began in the phase before it
        same(t["largest_thigmotaxis_dyn_cm"][row], force[own].max())
        if force[own].max() > 0:
            frame, hinge = np.unravel_index(force[own].argmax(), force[own].shape)
            assert t["largest_thigmotaxis_at"][row] == names[6 + hinge]
            same(t["largest_thigmotaxis_time_s"][row], time[own[frame]])
        same(t["effort_dyn_cm_s"][row], (force[own] @ share * np.diff(time)[np.array(own) - 1]).sum())
    same(t["largest_thigmotaxis_dyn_cm"].max(), tables["summary"]["largest_thigmotaxis_dyn_cm"][0])
    assert "slide" in t["phase"] and np.isnan(t["muscle"]).all()  # empty: it has none


def rotations(q, bodies):
    """Of each body to the world: the root's, then Y and Z of odd joints, in turn which of them first, and X of even ones."""
    w, x, y, z = q[3:7]
    turns = [np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                       [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                       [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]])]
    about = lambda axis, angle: np.roll(np.roll([[1, 0, 0], [0, np.cos(angle), -np.sin(angle)], [0, np.sin(angle), np.cos(angle)]], axis, 0), axis, 1)
    angles = list(q[7:])
    for j in range(1, bodies):
        turn = np.eye(3)
        for axis in ([0], [2, 1], [0], [1, 2])[j % 4]:
            turn = turn @ about(axis, angles.pop(0))
        turns.append(turns[-1] @ turn)
    return turns


def test_skin(run):
    """What touched while the knot was tied, by round patches on a skin that is rolled out here."""
    _, log, tables = run
    t, lengths, radii, centres = tables["skin"], log["model/length"][()], log["model/radius"][()], log["trajectory/position"][()]
    bodies = len(lengths)
    same(t["area_cm2"].sum(), (2 * np.pi * radii * lengths).sum())
    since = np.full(len(t["s_cm"]), np.nan)
    at_cell = radii[np.minimum((t["s_cm"] / lengths[0]).astype(int), bodies - 1)]
    turns_of = {}
    tied = np.isin(log["trajectory/phase"][()], (1, 2))  # tighten, slide
    for frame, a, b in zip(*(log[f"contacts/{name}"][()] for name in ("frame", "spline_a", "spline_b"))):
        if np.isnan(b) or not tied[frame]:
            continue
        if frame not in turns_of:
            turns_of[frame] = rotations(log["trajectory/q"][frame], bodies)
        turns = turns_of[frame]
        arcs = [(one + 0.5) * lengths[0] for one in (a, b)]
        points = [spline_point(centres[frame], lengths, arc) for arc in arcs]
        thick = [np.interp(arc, np.cumsum(lengths) - lengths / 2, radii) for arc in arcs]
        gap = max(0, np.linalg.norm(points[0] - points[1]) - sum(thick))
        reach = np.sqrt(2 * thick[0] * max(0, 0.05 - gap))  # controller.contact_gap
        for arc, way in zip(arcs, (points[1] - points[0], points[0] - points[1])):
            local = turns[min(int(arc / lengths[0]), bodies - 1)].T @ way
            round_ = (t["side_rad"] - np.arctan2(local[2], local[1]) + np.pi) % (2 * np.pi) - np.pi
            near = np.hypot(t["s_cm"] - arc, at_cell * round_) <= reach
            since[near & np.isnan(since)] = log["trajectory/time"][frame]
    assert 100 < np.isfinite(since).sum() < 0.5 * len(since)
    same_time = np.isclose(since, t["since_s"], rtol=0, atol=1e-6, equal_nan=True)
    assert np.mean(~same_time) < 0.002  # cells at the very edge of a patch
    row = {name: column[0] for name, column in tables["summary"].items()}
    swept = ~np.isnan(t["since_s"])
    same(row["swept_cm2"], t["area_cm2"][swept].sum())
    same(row["swept_percent"], 100 * row["swept_cm2"] / t["area_cm2"].sum())


def test_summary(run):
    _, log, tables = run
    row = {name: column[0] for name, column in tables["summary"].items()}
    slide = np.flatnonzero(log["trajectory/phase"][()] == 2)
    head_end, time = log["knot/head_end"][()], log["trajectory/time"][()]
    same(row["slide_distance_cm"], head_end[slide[0]] - head_end[slide[-1]])
    same(row["slide_speed_cm_per_s"], row["slide_distance_cm"] / (time[slide[-1]] - time[slide[0]]))
    sums = np.sort(log["mean/thigmotaxis/sum"][slide[1:]])
    same(row["sliding_force_dyn"], sums[len(sums) // 2])
    same(row["largest_thigmotaxis_dyn_cm"], np.nanmax(np.abs(log["mean/forces/thigmotaxis"][:, 6:])))
    same(row["penetration_cm"], log["steps/penetration"][()].max())
    assert row["knot"] == "3_1" and row["bodies"] == 100 and row["status"] == "complete"
    same([row["length_cm"], row["mass_g"], row["step_s"]], [42.4, 80, 0.01])
    same(row["slide_from_s"], time[slide[0]])
    same(row["duration_s"], log["steps/time"][-1] + row["step_s"])


def test_si_is_the_same_in_other_units(run):
    folder, _, tables = run
    for name, columns in tables.items():
        other = table(folder / "si" / f"{name}.csv")
        for column, values in columns.items():
            unit = next((u for u in sorted(SI, key=len, reverse=True) if column.endswith("_" + u)), None)
            renamed = column.removesuffix(unit) + SI_NAME[unit] if unit else column
            if values.dtype.kind == "f":
                same(other[renamed], values * SI.get(unit, 1))
            else:
                assert list(other[renamed]) == list(values)


def test_the_dictionary_has_every_column(run):
    folder, _, _ = run
    for units in ("cgs", "si"):
        words = table(folder / units / "dictionary.csv")
        told = list(zip(words["file"], words["column"]))
        assert told == [(f"{name}.csv", column) for name in FILES for column in table(folder / units / f"{name}.csv")]
        assert all(words["meaning"]) and all(words["unit"])
        for column, unit in zip(words["column"], words["unit"]):
            assert unit == "1" or column.endswith("_" + unit.replace("/", "_per_").replace(" ", "_"))


def test_bad_input_is_one_line(run, tmp_path):
    folder, _, _ = run
    refused(folder, "export", "none.h5", "--out", "x", parts=("none.h5", "no such file"))
    refused(folder, "export", "a.h5", "--out", "cgs", parts=("midline.csv", "--force"))
    refused(folder, "export", "a.h5", "--out", "/proc/x", parts=("/proc/x",))
    with h5py.File(tmp_path / "b.h5", "w") as cut, h5py.File(folder / "a.h5") as whole:
        for name, value in whole.attrs.items():
            cut.attrs[name] = value
        for group in whole:
            if group != "mean":
                whole.copy(group, cut)
    refused(tmp_path, "export", "b.h5", "--out", "x", parts=("b.h5", "/mean/forces/"))
    (tmp_path / "half.h5").write_bytes((folder / "a.h5").read_bytes()[:100_000])
    refused(tmp_path, "export", "half.h5", "--out", "x", parts=("half.h5",))


def test_muscles(tmp_path):
    """Of a scene that has them, beside the other tables; the force is what the log's activation makes of the largest."""
    hagfish(tmp_path, "run", "muscles", "--set", "time.step=0.02", "--set", "time.duration=0.2", "--set",
            "specimen.muscle.stress=2e4", "--quiet", "--out", "a.h5")
    hagfish(tmp_path, "export", "a.h5", "--out", "t")
    assert {path.stem for path in (tmp_path / "t").iterdir()} == {*FILES, "muscles", "dictionary"}
    log, t = h5py.File(tmp_path / "a.h5"), table(tmp_path / "t" / "muscles.csv")
    activation, most = log["muscle/activation"][()], log["model/muscle_force"][()]
    same(t["activation"], activation.ravel())
    same(t["force_dyn"], (activation * most).ravel())
    names = log["model/muscle_name"].asstr()[()]
    joint = np.array([int(name[1:].split("_")[0]) for name in names])
    same(t["s_cm"], np.tile(joint * log["model/length"][0], len(activation)))
    # Muscles a fiftieth as strong fall short, by what is on a joint's hinges.
    lacks = np.abs(log["muscle/residual"][()])
    dofs = log["model/dof_name"].asstr()[()]
    of_joint = [[k for k, dof in enumerate(dofs) if dof.startswith(f"j{j:02d}_")] for j in joint]
    same(t["shortfall_dyn_cm"], np.stack([lacks[:, hinges].max(axis=1) for hinges in of_joint], axis=1).ravel())
    assert np.nanmax(lacks) > 100
    # The most loaded muscle, with its name, its time, and what it rests on.
    phases = table(tmp_path / "t" / "phases.csv")
    frame, muscle = np.unravel_index(np.nanargmax(activation), activation.shape)
    assert (phases["muscle"][0], phases["muscle_basis"][0]) == (names[muscle], "guess")
    same([phases["muscle_activation"][0], phases["muscle_time_s"][0]], [activation[frame, muscle], log["trajectory/time"][frame]])
