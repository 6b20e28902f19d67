"""`hagfish export`: every column against the log, read and recomputed here."""

import tomllib

import h5py
import numpy as np
import pytest

from animal import axes_along, spans, spline_point, total_bend
from program import hagfish, logged, phases, sets, table

DIGITS = 1e-8  # of a column's largest: nine digits are written
FILES = ("midline", "curvature", "knot", "contacts", "torques", "joints", "eq6", "head", "energy", "moments", "phases", "skin", "summary")
KINDS = ("active", "thigmotaxis", "contact", "limit", "wall")
SI = {"cm2": ("m2", 1e-4), "cm": ("m", 1e-2), "dyn": ("N", 1e-5), "dyn_cm": ("N_m", 1e-7), "dyn_cm_s": ("N_m_s", 1e-7),
      "erg": ("J", 1e-7), "g": ("kg", 1e-3), "cm_per_s": ("m_per_s", 1e-2), "rad_per_cm": ("rad_per_m", 1e2)}


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    """A whole run: contacts, limits, plate and thigmotaxis all bear."""
    folder = tmp_path_factory.mktemp("export")
    log = logged(folder, "table1", "--preset", "quick")
    hagfish(folder, "export", "a.h5", "--out", "cgs")
    hagfish(folder, "export", "a.h5", "--out", "si", "--si")
    return folder, h5py.File(log), {name: table(folder / "cgs" / f"{name}.csv") for name in FILES}


def same(found, wanted):
    found, wanted = np.asarray(found, float), np.asarray(wanted, float)
    np.testing.assert_array_equal(np.isnan(found), np.isnan(wanted))
    np.testing.assert_allclose(found, wanted, rtol=0, atol=DIGITS * np.nanmax(np.abs(wanted), initial=1e-300))


def vectors(columns, name, unit):
    return np.stack([columns[f"{name}{axis}_{unit}"] for axis in "xyz"], axis=1)


def hinges_of(log):
    return list(log["model/dof_name"].asstr()[6:])


def test_midline(run):
    _, log, tables = run
    t, length, time = tables["midline"], log["model/length"][()], log["trajectory/time"][()]
    shape = (len(time), len(length) + 2)
    places = vectors(t, "", "cm").reshape(*shape, 3)
    same(places[:, 1:-1], log["trajectory/position"][()])
    same(places[:, 0], log["trajectory/q"][:, :3])
    # The ends are as far from the outermost centres as half a body is long.
    away = np.linalg.norm(places[:, [0, -1]] - places[:, [1, -2]], axis=2)
    np.testing.assert_allclose(away, length[[0, -1]] / 2 + np.zeros_like(away), atol=1e-6)  # nine digits of some 40 cm
    same(t["s_cm"].reshape(shape)[0], np.r_[0, np.cumsum(length) - length / 2, length.sum()])
    same(t["time_s"], np.repeat(time, shape[1]))
    same(t["radius_cm"].reshape(shape)[3, 1:-1], log["model/radius"][()])


def test_curvature(run):
    _, log, tables = run
    t, span = tables["curvature"], spans(log)
    angle = dict(zip(hinges_of(log), log["trajectory/q"][:, 7:].T))
    for joint in (1, 37, 99):
        at = t["joint"] == joint
        y, z = (angle[f"j{joint:02d}_bend_{axis}"] for axis in "yz")
        same(t["bend_y_rad_per_cm"][at], y / span[joint])
        same(t["bend_z_rad_per_cm"][at], z / span[joint])
        same(t["curvature_rad_per_cm"][at], total_bend(y, z) / span[joint])
        beside = [k for k in (joint - 1, joint + 1) if 1 <= k < len(span)]
        same(t["twist_rad_per_cm"][at], sum(angle[f"j{k:02d}_twist"] for k in beside) / sum(span[k] for k in beside))


def test_torques_add_up(run):
    _, log, tables = run
    t, names, scene, span = tables["torques"], hinges_of(log), tomllib.loads(log.attrs["scene"]), spans(log)
    columns = {kind: t[f"{kind}_dyn_cm"].reshape(-1, len(names)) for kind in KINDS}
    for kind, values in columns.items():
        same(values, log[f"mean/forces/{kind}"][:, 6:])
        assert kind == "active" or np.nanmax(np.abs(values)) > 0
    same(sum(columns.values()) + log["mean/forces/head"][:, 6:], log["mean/forces/net"][:, 6:])
    model, joint = scene["model"], np.array([int(name[1:3]) for name in names])
    twists = np.array([name.endswith("twist") for name in names])
    stiffness = np.where(twists, model["twist_stiffness"], model["bending_stiffness"]) / span[joint]
    same(t["spring_dyn_cm"].reshape(-1, len(names)), -stiffness * log["trajectory/q"][:, 7:])
    same(t["angle_rad"].reshape(-1, len(names)), log["trajectory/q"][:, 7:])
    assert [f"j{int(joint):02d}_{axis}" for joint, axis in zip(t["joint"], t["axis"])][:len(names)] == names
    # The joints' torques, a column a hinge.
    assert list(tables["joints"]) == ["frame", "time_s", *(f"{name}_dyn_cm" for name in names)]
    made = columns["active"] + columns["thigmotaxis"]
    same(np.stack([tables["joints"][f"{name}_dyn_cm"] for name in names], axis=1), made)


def test_moments(run):
    _, log, tables = run
    t, joints = tables["moments"], len(log["model/length"]) - 1
    same(vectors(t, "turn_", "rad_per_cm").reshape(-1, joints, 3), log["trajectory/curvature"][:, 1:])
    for kind in KINDS:
        moments = log[f"mean/moments/{kind}"][()]
        same(vectors(t, f"{kind}_", "dyn_cm").reshape(-1, joints, 3), moments[:, 1:])
        assert kind == "active" or np.nanmax(np.abs(moments)) > 0
    same(t["joint"][:joints], 1 + np.arange(joints))


def test_contacts(run):
    _, log, tables = run
    t, centres, lengths = tables["contacts"], log["trajectory/position"][()], log["model/length"][()]
    bears, plate = t["force_dyn"] > 0, t["kind"] == "plate"
    in_order = lambda frame, force: np.array([frame, force])[:, np.lexsort((force, frame))]
    for own, wanted in zip(in_order(t["frame"][bears], t["force_dyn"][bears]),
                           in_order(log["contacts/frame"][()], log["contacts/force"][()])):
        same(own, wanted)
    assert plate.any() and not plate.all() and not bears.all()
    normals, places = np.stack([t[f"normal_{axis}"] for axis in "xyz"], axis=1), vectors(t, "", "cm")
    radius_at = lambda s: np.interp(s, np.cumsum(lengths) - lengths / 2, log["model/radius"][()])
    for k in range(0, len(bears), 17):
        bodies = centres[int(t["frame"][k])]
        a, thick = spline_point(bodies, lengths[0], t["s_a_cm"][k]), radius_at(t["s_a_cm"][k])
        if plate[k]:
            b, radius = a * (0, 1, 1), 0
        else:
            b, radius = spline_point(bodies, lengths[0], t["s_b_cm"][k]), radius_at(t["s_b_cm"][k])
        np.testing.assert_allclose(t["gap_cm"][k], np.linalg.norm(a - b) - radius - thick, atol=1e-7)
        np.testing.assert_allclose(places[k], b + (radius + t["gap_cm"][k] / 2) * normals[k], atol=1e-6)
    # What presses the plate is what the plate gives back.
    of_frame = np.bincount(t["frame"][plate].astype(int), t["force_dyn"][plate], len(centres))
    same(of_frame[:-1], log["forces/wall"][:-1, 0])  # at the end no step begins


def test_what_the_log_has_is_as_the_log_has_it(run):
    _, log, tables = run
    knot, eq6, head, energy = (tables[name] for name in ("knot", "eq6", "head", "energy"))
    for name in ("determinant", "v2", "agreement", "head_end", "tail_end"):
        same(knot[name + ("_cm" if name.endswith("end") else "")], log[f"knot/{name}"][()])
    same(knot["span_cm"], log["knot/tail_end"][()] - log["knot/head_end"][()])
    assert list(knot["phase"]) == phases(log)
    assert set(knot["knot"][log["knot/determinant"][()] == 3]) == {"3_1"}
    paths = {"command_cm_per_s": "thigmotaxis/command", "speed_cm_per_s": "mean/thigmotaxis/speed",
             "shortfall_cm_per_s": "mean/thigmotaxis/slack", "multiplier_dyn": "mean/thigmotaxis/lambda"}
    for column, path in paths.items():
        same(eq6[column].reshape(-1, 4), log[path][()])
    acts = np.hstack([vectors(head, "force_", "dyn"), vectors(head, "torque_", "dyn_cm")])
    same(acts, log["mean/forces/head"][:, :6])
    same(head["plate_force_x_dyn"], log["mean/forces/wall"][:, 0])
    for name in energy:
        if name.endswith("_erg"):
            same(energy[name], log["diagnostics/" + name.removesuffix("_erg")][()])


def test_phases(run):
    _, log, tables = run
    t, names, of_frame, time = tables["phases"], hinges_of(log), phases(log), log["trajectory/time"][()]
    assert list(t["phase"]) == list(dict.fromkeys(of_frame))
    same(t["to_s"][:-1], t["from_s"][1:])
    same([t["from_s"][0], t["to_s"][-1]], time[[0, -1]])
    # Works and losses of the phases add up to the run's.
    for name in ("work_tip", "work_active", "work_thigmotaxis", "dissipated"):
        same(t[f"{name}_erg"].sum(), tables["summary"][f"{name}_erg"][0])
    force = np.abs(log["mean/forces/thigmotaxis"][:, 6:])
    share = np.array([spans(log)[int(name[1:3])] for name in names]) / log["model/length"][()].sum()
    for row, phase in enumerate(t["phase"]):
        # The mean that ends a frame began in the phase before it.
        own = np.array([f + 1 for f, each in enumerate(of_frame[:-1]) if each == phase])
        same(t["largest_thigmotaxis_dyn_cm"][row], force[own].max())
        if force[own].max() > 0:
            frame, hinge = np.unravel_index(force[own].argmax(), force[own].shape)
            assert t["largest_thigmotaxis_at"][row] == names[hinge]
            same(t["largest_thigmotaxis_time_s"][row], time[own[frame]])
        same(t["effort_dyn_cm_s"][row], (force[own] @ share * np.diff(time)[own - 1]).sum())
    same(t["largest_thigmotaxis_dyn_cm"].max(), tables["summary"]["largest_thigmotaxis_dyn_cm"][0])
    assert "slide" in t["phase"] and np.isnan(t["muscle"]).all()  # empty: it has none


def root_axes(q):
    """Axes of the first body in the world, as columns, from its quaternion."""
    w, x, y, z = q[3:7]
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                     [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                     [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]])


def test_skin(run):
    """What touched while the knot was tied, by round patches on a skin that is rolled out here."""
    _, log, tables = run
    t, lengths, radii = tables["skin"], log["model/length"][()], log["model/radius"][()]
    length, last = lengths[0], len(lengths) - 1
    same(t["area_cm2"].sum(), (2 * np.pi * radii * lengths).sum())
    since = np.full(len(t["s_cm"]), np.nan)
    at_cell = radii[np.minimum((t["s_cm"] / length).astype(int), last)]
    touches = np.column_stack([log[f"contacts/{name}"][()] for name in ("frame", "spline_a", "spline_b")])
    tied = [frame for frame, phase in enumerate(phases(log)) if phase in ("tighten", "slide")]
    for frame in tied:
        q, centres = log["trajectory/q"][frame], log["trajectory/position"][frame]
        axes = axes_along(q[7:], hinges_of(log))[0] @ root_axes(q).T
        for a, b in touches[(touches[:, 0] == frame) & ~np.isnan(touches[:, 2])][:, 1:]:
            arcs = [(one + 0.5) * length for one in (a, b)]
            points = [spline_point(centres, length, arc) for arc in arcs]
            thick = np.interp(arcs, np.cumsum(lengths) - lengths / 2, radii)
            gap = max(0, np.linalg.norm(points[0] - points[1]) - sum(thick))
            reach = np.sqrt(2 * thick[0] * max(0, 0.05 - gap))  # controller.contact_gap
            for arc, way in zip(arcs, (points[1] - points[0], points[0] - points[1])):
                local = axes[min(int(arc / length), last)] @ way
                round_ = (t["side_rad"] - np.arctan2(local[2], local[1]) + np.pi) % (2 * np.pi) - np.pi
                near = np.hypot(t["s_cm"] - arc, at_cell * round_) <= reach
                since[near & np.isnan(since)] = log["trajectory/time"][frame]
    assert 100 < np.isfinite(since).sum() < 0.5 * len(since)
    same_time = np.isclose(since, t["since_s"], rtol=0, atol=1e-6, equal_nan=True)
    assert np.mean(~same_time) < 0.002  # cells at the very edge of a patch
    row = {name: column[0] for name, column in tables["summary"].items()}
    same(row["swept_cm2"], t["area_cm2"][~np.isnan(t["since_s"])].sum())
    same(row["swept_percent"], 100 * row["swept_cm2"] / t["area_cm2"].sum())


def test_summary(run):
    _, log, tables = run
    row = {name: column[0] for name, column in tables["summary"].items()}
    slide = [frame for frame, phase in enumerate(phases(log)) if phase == "slide"]
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
            renamed, size = (column.removesuffix(unit) + SI[unit][0], SI[unit][1]) if unit else (column, 1)
            if values.dtype.kind == "f":
                same(other[renamed], values * size)
            else:
                assert list(other[renamed]) == list(values)


@pytest.mark.parametrize("units", ["cgs", "si"])
def test_the_dictionary_has_every_column(run, units):
    folder = run[0] / units
    words = table(folder / "dictionary.csv")
    columns = {f"{name}.csv": (folder / f"{name}.csv").open().readline().strip().split(",") for name in FILES}
    assert list(zip(words["file"], words["column"])) == [(name, each) for name in columns for each in columns[name]]
    assert all(words["meaning"]) and all(words["unit"])
    for column, unit in zip(words["column"], words["unit"]):
        assert unit == "1" or column.endswith("_" + unit.replace("/", "_per_").replace(" ", "_"))


def test_muscles(tmp_path):
    """Of a scene that has them, beside the other tables; the force is what the activation makes of the largest."""
    weak = sets("time.step=0.02", "time.duration=0.2", "specimen.muscle.stress=2e4")
    log = h5py.File(logged(tmp_path, "muscles", *weak))
    hagfish(tmp_path, "export", "a.h5", "--out", "t")
    assert {path.stem for path in (tmp_path / "t").iterdir()} == {*FILES, "muscles", "dictionary"}
    t, activation = table(tmp_path / "t" / "muscles.csv"), log["muscle/activation"][()]
    same(t["activation"], activation.ravel())
    same(t["force_dyn"], (activation * log["model/muscle_force"][()]).ravel())
    names = log["model/muscle_name"].asstr()[()]
    joint = np.array([int(name[1:].split("_")[0]) for name in names])
    same(t["s_cm"], np.tile(joint * log["model/length"][0], len(activation)))
    # Muscles a fiftieth as strong fall short, by what is on a joint's hinges.
    lacks, dofs = np.abs(log["muscle/residual"][()]), log["model/dof_name"].asstr()[()]
    of_joint = [[k for k, dof in enumerate(dofs) if dof.startswith(f"j{j:02d}_")] for j in joint]
    same(t["shortfall_dyn_cm"], np.stack([lacks[:, hinges].max(axis=1) for hinges in of_joint], axis=1).ravel())
    assert np.nanmax(lacks) > 100
    # The most loaded muscle, with its name, its time, and what it rests on.
    row = {name: column[0] for name, column in table(tmp_path / "t" / "phases.csv").items()}
    frame, muscle = np.unravel_index(np.nanargmax(activation), activation.shape)
    assert (row["muscle"], row["muscle_basis"]) == (names[muscle], "guess")
    same([row["muscle_activation"], row["muscle_time_s"]], [activation[frame, muscle], log["trajectory/time"][frame]])
