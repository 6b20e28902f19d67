"""The tables of pages of results are what the studies' scripts write, of runs made up here."""

import csv
import json
import re
import shutil
from pathlib import Path

import h5py
import numpy as np
import pytest

import accuracy
import audits
import benchmarks
import claim_map
import claim_row
import claims
import departures
import design
import few_numbers
import films
import haste
import knot_in_numbers
import knots
import leverage
import living
import reflex
import reflex_limits
import reflex_runs
import sliding_map
import slit
import stability
import sweep_columns
import thigmotaxis
import two_simulators
import tying
import world
from conftest import RESULTS
from sweep_columns import Cell, SweepTable
from tables import read_table


def read(folder, name):
    with (folder / "tables" / f"{name}.csv").open(newline="") as file:
        return list(csv.reader(file))


def test_each_table_of_a_page_is_written_by_a_script_beside_it():
    for table in RESULTS.glob("*/*.csv"):
        scripts = "\n".join(path.read_text(encoding="utf-8") for end in ("py", "sh") for path in table.parent.glob(f"*.{end}"))
        tail = table.stem.removeprefix(table.parent.name)
        stem, _, end = table.stem.rpartition("_")
        named = re.search(rf"\b{table.stem}\.csv|\"({table.stem}|{tail})\"", scripts)
        assert named or f'f"{stem}_{{' in scripts and re.search(rf'"{end}"|def {end}\b', scripts), table


def from_data(page, *names):
    """Gives a script the tables of a page that others are made of."""
    def copied(folder):
        (folder / "tables").mkdir()
        for name in names:
            shutil.copy(RESULTS / page / f"{name}.csv", folder / "tables")
        return folder
    return copied


MADE_AGAIN = {  # tables of pages by what makes them of other tables that are here, and how many there are
    "design": (lambda folder: design.main(folder, RESULTS / "design/design.csv"), 8),
    "reflex": (lambda folder: reflex.main(folder, RESULTS / "reflex/reflex.csv"), 16),
    "knot_in_numbers": (knot_in_numbers.main, 2),
    "leverage": (lambda folder: leverage.page(from_data("leverage", "leverage_runs", "leverage_time")(folder)), 4),
    "films": (lambda folder: films.write_summaries(from_data("films", *(f"films_{part.__name__}" for part in films.PARTS))(folder)), 8)}


@pytest.mark.parametrize("page", MADE_AGAIN)
def test_tables_say_what_those_say_that_they_are_made_of(tmp_path, page):
    make, count = MADE_AGAIN[page]
    make(tmp_path)
    tables = list((tmp_path / "tables").glob("*.csv"))
    assert len(tables) == count
    for made in tables:
        now, stated = read_table(made), read_table(RESULTS / page / made.name)
        assert (now.head, now.rows) == (stated.head, stated.rows), f"{made.name}: make it again: bash experiments/reproduce.sh {page}"


def test_sliding_by_speed_and_stiffness(tmp_path):
    place = lambda k, v, tied, passed, force: sliding_map.Place(k, v, 10, tied, tied, passed, np.full(3, force), np.full(3, 2 * force))
    places = [place(10, 2, 10, 9, 100.0), place(100, 2, 10, 10, 150.0), place(1000, 2, 3, 3, 300.0), place(2000, 2, 0, 0, np.nan)]
    sliding_map.write_tables(places, tmp_path)
    assert read(tmp_path, "sliding")[1:] == [["2", "23 of 40", "23 of 23", "96 %", "1e+02", "3.0", "3.0"], ["all", "23 of 40", "23 of 23", "96 %", "", "", ""]]
    assert read(tmp_path, "sliding_stiffness")[1:] == [["1e+03", "3 of 10"], ["2e+03", "0 of 10"]]


def test_only_slides_by_both_ends_come_to_the_head():
    figures = {name: np.ones(3) for name in ("release_from_s", "tighten_from_s", "sliding_force_dyn", "work_thigmotaxis_erg", "slide_distance_cm")}
    table = SweepTable({sliding_map.STIFFNESS: ["10"] * 3, sliding_map.SPEED: ["2"] * 3}, {
        "slide": ["slides by both ends", "only grows", "slides by both ends"], "outcome": ["ok"] * 3, "unmet": [""] * 3}, figures)
    (place,) = sliding_map.places_of(table)
    assert (place.starts, place.tied, place.arrived) == (3, 3, 2)


def test_a_knot_that_grows_has_no_time_on_the_reflex_s_page():
    row = lambda **of: reflex_runs.Row("knockouts", "3_1", "clamped", "all", way=9.2, time=6.1, **of)
    runs = [row(held="yes", slid="yes", kind=sweep_columns.BOTH_ENDS), row(held="yes", slid="no", kind="only grows"),
            row(held="yes", slid="no", kind="does not slide"), row(held="no", slid="no")]
    assert [reflex.came(run) for run in runs] == ["9.2 in 6.1 s", "9.2: only grows", "9.2", "lost at 9.2"]


def test_few_numbers_know_in_what_circumstances_a_run_was():
    usual = {"start.noise_deg": "0.0", "time.step": "0.005", "model.bodies": "100", "mirror": "false"}
    other = [{}, {"start.noise_deg": "3.0"}, {"time.step": "0.002"}, {"model.bodies": "60"}, {"mirror": "true"}]
    assert [few_numbers.circumstance(usual | each) for each in other] == [
        "as found", "3 degrees of noise at the start", "h = 2 ms", "60 bodies", "mirrored"]


def test_few_numbers_slide_what_both_ends_of_the_knot_slide():
    cell = lambda unmet, share, outcome="ok": Cell({}, {"outcome": outcome, "unmet": unmet}, {"both_ends_percent": share, "slide_distance_cm": 9.0}, Path())
    good, grows, lost = cell("energy loss", 93.0), cell("slide of both ends", 20.0), cell("", 99.0, "lost")
    assert [each.slid for each in (good, grows, lost)] == [True, False, False]
    assert [few_numbers.share(each) for each in (good, grows, lost)] == [0.93, 0.2, 0.0]
    counts = {6: {("knot",): [good]}, 9: {("knot",): [good, grows]}, 12: {("knot",): [good]}, 18: {("knot",): [good, good]}}
    assert few_numbers.least(counts, ("knot",)) == "12" and few_numbers.told([good, grows]) == "1 of 2; 0.57, 0.20"


def test_claims_by_change():
    run = lambda reading, outcome, word, slide="slides by both ends": {
        "reading": reading, "change": "Table 1", "step": 0.005, "outcome": outcome, "slide": slide} | dict.fromkeys(
        claim_row.MEASURES, 0.1) | dict.fromkeys(claims.NAMES, "agrees") | {"near_over_far": 2.0, claims.NAMES[1]: word}
    runs = [run("box", "slid", "agrees"), run("box", "slid", "undecided"), run("cone", "jammed", "agrees"), run("cone", "slid", "agrees", "only grows")]
    assert claim_map.summary(runs)[0] == ["Table 1", "2 of 2", "2", "undecided", "0 of 2", "", "", "agrees", "0.1", "0.1", "agrees", "0.1", "agrees"]


def test_departures_of_one_title_share_a_row():
    run = lambda way, slide, outcome="ok": {"slide_distance_cm": way, "slide": slide, "outcome": outcome}
    way = lambda *runs: departures.shown(list(runs), "head end of the knot, cm")
    assert way(run("9.14", "slides"), run("8.96", "slides")) == "9.0 to 9.1"
    assert way(run("9.14", "slides")) == "9.1" and way(run("0", "", "limits")) == "-"
    assert [departures.became(run("", slide, outcome)) for slide, outcome in (("only grows", "ok"), ("", "limits"), ("", "knot lost"))] == ["only grows", "stopped: limits", "lost"]


def test_stability_by_scene_and_start(tmp_path):
    cells = [{"scene": "whip", "level": level, "method": "default", "h_ms": h, "outcome": outcome}
             for level, h, outcome in (("as is", "1", "ok"), ("as is", "5", "limits"), ("seed 1", "1", "ok"), ("seed 2", "1", "ok"))]
    stability.write_tables(cells, tmp_path)
    assert read(tmp_path, "stability")[1][:2] == ["fast undamped whip", "1 (limits)"]
    assert read(tmp_path, "stability_starts")[1] == ["1", "2 of 2", ""]


def test_the_reflex_has_its_limit_where_one_end_stays_or_time_is_up(monkeypatch):
    class Log(dict):
        path, scene = Path(), lambda self: {"time": {"duration": 40.0}}

    monkeypatch.setattr(reflex_limits.audits, "audit", lambda path: [audits.Finding(name, "", "", "", met) for name, met in met_of.items()])
    ends = lambda time: reflex_limits.slides(Log({"/trajectory/time": [0.0, time]}))
    met_of = {"slide of both ends": True, "penetration": False}
    assert ends(5.0) and not ends(40.0) and not reflex_limits.slides(None)
    met_of["slide of both ends"] = False
    assert not ends(5.0)
    del met_of["slide of both ends"]  # not judged
    assert not ends(5.0)


def test_knots_are_counted_that_tie_hold_and_come_off():
    run = lambda unmet, outcome="ok": sweep_columns.Cell({}, {"outcome": outcome, "unmet": unmet}, {}, None)
    cells = [run(""), run("Eq. 6"), run("penetration"), run("knot held; unknot at end"), run("", "never tied")]
    assert knots.sure(cells) == "3 of 5 (2 within the penetration)" and knots.sure(cells[:2]) == "2 of 2"


def test_a_value_of_an_audit_is_that_of_its_criterion(tmp_path):
    (tmp_path / "a.csv").write_text("log,criterion,value,bound,unit,met\na,slide,9.1,2,cm,yes\na,slide of both ends,76.5,70,%,yes\na,hand,,,,yes\n")
    findings = audits.read_findings(tmp_path / "a.csv")
    assert audits.value_of(findings, "slide of both ends") == 76.5
    assert np.isnan(audits.value_of(findings, "hand")) and np.isnan(audits.value_of(findings, "reverse"))


def test_slides_are_counted_by_what_is_varied(tmp_path):
    def sweep(name, axis, cells):
        (tmp_path / name).mkdir()
        lines = [",".join(["cell", "scene", axis, *sweep_columns.TEXTS, *sweep_columns.FIGURES])]
        for k, (scene, value, outcome, slide, share, met, torque) in enumerate(cells):
            texts = {"outcome": outcome, "slide": slide}
            figures = {"both_ends_percent": share, "eq6_percent": met, "largest_torque_dyn_cm": torque}
            lines.append(",".join(map(str, [k, scene, value, *(texts.get(key, "") for key in sweep_columns.TEXTS), *(figures.get(key, "") for key in sweep_columns.FIGURES)])))
        (tmp_path / name / "table.csv").write_text("\n".join(lines) + "\n")
    both, grows = "slides by both ends", "only grows"
    sweep("meshes", "model.bodies", [("living_overhand", 60, "ok", both, 90, 99, 1e5), ("living_figure_eight_free", 60, "ok", grows, 10, 98, 2e5),
                                     ("living_overhand", 100, "capped", both, 80, 97, 1e5)])
    sweep("steps", "model.bodies,time.step", [("living_overhand", "100,0.005", "ok", both, 75, 100, 1e5)])
    sweep("speeds", "controller.slide_head.a", [("living_overhand", 0.5, "ok", both, 85, 100, 3e5)])
    sweep("starts", "start.seed", [("living_overhand", seed, "ok", both, 90 + seed, 100, 1e5) for seed in (1, 2)])
    assert thigmotaxis.change_rows(tmp_path, 2e5) == [
        ["bodies: 60", "1 of 2", "10", "50", "98", "1.00", "4_1 free 10 %"], ["bodies: 100", "0 of 1", "80", "80", "97", "0.50", "3_1 held 80 %"],
        ["time step, s: 0.005, 100 bodies", "1 of 1", "75", "75", "100", "0.50", ""], ["commanded speed, cm/s: 0.5", "1 of 1", "85", "85", "100", "1.50", ""],
        ["start with noise, numbers 1 to 2", "2 of 2", "91", "92", "100", "0.50", ""]]
    tightened = "controller.law,controller.tighten_time"
    sweep("laws", "controller.law,controller.eq6_at", [("living_overhand", "all_contacts,centreline", "ok", both, 90, 100, 1e5),
                                                       ("living_overhand", "paper,skin", "ok", grows, 0, 100, 1e5)])
    sweep("tightened", tightened, [("living_overhand", f"paper,{time}", "ok", grows, 20 - time, 100, 1e5) for time in (0.5, 2)])
    sweep("reflex", "controller.reflex.shift", [("reflex_overhand", 0.1, "ok", both, 80, 0, 1e5)])
    runs = thigmotaxis.runs_by_law(tmp_path)
    assert [row[:7] for row in thigmotaxis.law_rows(runs, 2e5)] == [
        ["two contacts", "spline", "0.5 s", "0 of 1", "20", "20", "100"], ["two contacts", "spline", "2 s", "0 of 1", "18", "18", "100"],
        ["two contacts", "skin", "no", "0 of 1", "0", "0", "100"], ["all contacts", "spline", "no", "1 of 1", "90", "90", "100"],
        ["reflex", "", "no", "1 of 1", "80", "80", ""]]
    assert list(thigmotaxis.compared(runs)) == ["two contacts, tightened", "all contacts", "reflex"]
    assert thigmotaxis.compared(runs)["two contacts, tightened"] == runs["two contacts", "spline", 2]


def test_what_became_of_a_robot_follows_its_slide(tmp_path):
    """A part of the sweep has the even cells, the other the odd ones."""
    folder = tmp_path / "robot"
    (folder / "logs").mkdir(parents=True)
    for part, names in enumerate((["slides by both ends", "", "only grows"], ["only grows"])):
        rows = "".join(f"{2 * k + part},{name}\n" for k, name in enumerate(names))
        (folder / f"table.{part + 1}-of-2.csv").write_text("cell,slide\n" + rows)
    for k, off in enumerate((True, True, False, False)):
        (folder / f"logs/{k}.json").write_text(json.dumps(dict.fromkeys(
            ("weight", "drag", "mass", "capacity", "stiffness", "way", "share", "torque", "penetration"), 1.0) | {"off": off}))
    world.robot(tmp_path)
    assert [row[5] for row in read(tmp_path, "world_robot")[1:]] == [
        "it ties; the knot slides by both ends, and comes off", "it ties; the knot only grows, and comes off", "it never ties", "it ties, and loses the knot"]


class Swept:
    def __init__(self, off, slid, share, torque):
        self.off, self.slid, self.share, self.torque = off, slid, share, {"form": torque}


def test_sweeps_of_living_animals():
    sweeps = {what: {"3_1": [], "4_1": []} for what in living.SWEEPS}
    sweeps["drag"] = {"3_1": [(1.0, Swept(True, True, 93, 2e5))], "4_1": [(1.0, Swept(True, False, 36, 1e5)), (1.0, Swept(False, False, 5, 1e5))]}
    assert living.came_off([run for runs in sweeps["drag"].values() for _, run in runs]) == "2; 1; 36"
    assert living.sweep_rows(sweeps) == [["drag, times that of the scenes: 1", "1 of 3", "36", "2e+05 to 2e+05"]]


def test_ratios_of_steps():
    part = lambda time: {25: time, 100: 4 * time}
    names = ["step_free:10", "step_knotted_active-set:10", "step_knotted_active-set:100", "step_midpoint:10", "qp_ipopt", "qp_active-set", "prescribe_all",
             "prescribe_nothing", "prescribe_head", "contact"]
    times = {("core", name): part(2.0) for name in names} | {("mujoco", name): part(10.0) for name in ("step_free:10", "step_knotted:10", "step_knotted:100")}
    quickest = {restart: {25: ("PGS", 1e-4), 100: ("CG", 1e-3)} for restart in benchmarks.RESTARTS}
    head, *rows = benchmarks.ratios(times, quickest)
    table = {first: cells for first, *cells in rows}
    assert head == ["bodies", "25", "100"]
    assert table["knotted step: MuJoCo over core, 100 steps a start"] == ["5.0", "5.0"]
    assert table["knotted step, over 100 bodies"] == ["0.25", "1.00"]
    assert len(table) == len(rows)


def test_builds_beside_mujoco(tmp_path):
    """Steps here of 2 µs for each hundred bodies and half of that without contact; MuJoCo's of 20 and 3, and in WebAssembly of 7 and 5."""
    entry = lambda name, bodies, time, residual=0.0: {"aggregate_name": "median", "run_name": f"{name}/{bodies}", "cpu_time": time, "residual": residual}
    measured = [entry(*of) for n in (100, 400) for of in (
        ("core/step_knotted_active-set:10", n, n / 50), ("core/step_free:10", n, n / 100), ("mujoco/step_knotted:newton:10", n, n / 5),
        ("mujoco/step_knotted:pgs:10", n, n / 10, 0.5), ("mujoco/step_free:10", n, 3 * n / 100))]
    assert benchmarks.native_rows("here", measured) == [["here", "100", "2", "10.0", "newton", "1", "3.0"], ["here", "400", "8", "10.0", "newton", "4", "3.0"]]
    name = "simulator, integrator, solver, tolerance"
    (tmp_path / "live.csv").write_text(f'"{name}","step without contact, µs","knotted step, µs"\nours,1,2\nslow,4,80\nquick,5,14\n')
    assert benchmarks.web_row(tmp_path / "live.csv") == ["both in WebAssembly", "100", "2", "7.0", "quick", "1", "5.0"]


def test_a_swimmers_speed_is_that_of_whole_waves(monkeypatch):
    time = np.linspace(0, 10, 1001)
    middle = np.stack([2 * time + np.sin(2 * np.pi * time / 0.7), np.cos(2 * np.pi * time / 0.7), 0 * time], axis=1)
    log = {"/trajectory/time": time, "/trajectory/position": middle[:, None] + [[[0, 1, 0]], [[0, -1, 0]]][0]}
    monkeypatch.setattr(slit, "HagfishLog", lambda path: log)
    assert slit.swims("any", 0.7) == pytest.approx(2, abs=1e-3)


def test_how_fast_an_animal_could_tie(tmp_path, monkeypatch):
    """All tie at twice their speed and none at four times, where strong muscles help the smallest alone."""
    outcome = ["ok" if of <= 2 or length == 25 and of == 4 and haste.HELPS[helps][1] > 1 else "failed" for _, length, of, helps in haste.CELLS]
    monkeypatch.setattr(haste, "read_sweep", lambda path: type("Sweep", (), {"texts": {"outcome": outcome}}))
    haste.make_table(tmp_path)
    rows = read(tmp_path, "knot_in_numbers_haste")[1:]
    lasts = haste.program_of(next(iter(haste.plots.SCENES)))[-1, 0]
    assert rows[0][1:] == ["25", f"{lasts / 2:.3g}", f"{lasts / 4:.3g}", "muscles ten times as strong"]
    assert rows[1][1:] == ["42", f"{lasts / 2:.3g}", f"{lasts / 4:.3g}", "neither"] and [row[0] for row in rows[-3:]] == ["all"] * 3


def test_morays_tie_knots_in_the_order_of_the_body_that_they_take():
    said = next(row[3] for row in read_table(RESULTS / "knot_in_numbers/knot_in_numbers_observed.csv").rows if row[0] == "knots of morays")
    bodies = [float(body) for body in re.findall(r"([\d.]+) cm", said)]
    assert said.startswith("the same order") and len(bodies) == 4 and bodies == sorted(bodies)


def test_muscles_are_too_weak_for_most_frames_of_each_pull():
    frames = next(row for row in read_table(RESULTS / "muscles/muscles.csv").rows if row[0] == "pulling: frames in which a muscle is too weak, %")
    assert len(frames) == 5 and all(float(share) > 50 for share in frames[1:])


def test_errors_while_tying(tmp_path):
    """Of made-up motions whose errors are of first order in the step and of second in the length of a body."""
    rows = []
    for knot in tying.KNOTS.values():
        for bodies in tying.SIZES:
            mesh = 100 / bodies**2
            rows.append(dict(zip(tying.HEAD, [knot, "euler", "active-set", bodies, 0.0, "", mesh, 1.0, 0.0])))
            for rule in ("euler", "midpoint"):
                rows += [dict(zip(tying.HEAD, [knot, rule, "active-set", bodies, step, 1 / step, mesh + step, 1.0, step])) for step in (10.0, 5.0)]
            rows.append(dict(zip(tying.HEAD, [knot, "euler", "ipopt", bodies, 10.0, 0.5, mesh + 10, 1.0, 10.0])))
    one = tying.one(rows, knot="3_1", rule="midpoint", bodies=50, step_ms=5.0)
    one["place_by_step_cm"] = ""
    tying.runs_table(rows, tmp_path)
    assert read(tmp_path, "speed_accuracy_tying")[3:5] == [["3_1", "50", "0.04", "euler", "10", "5", "0.1", "5"], ["3_1", "50", "0.04", "midpoint", "10", "stopped", "0.1", ""]]
    tying.presets_table(rows, tmp_path)
    assert read(tmp_path, "speed_accuracy_presets")[1] == ["quick", "3_1", "euler, 100 bodies, 10 ms", "0.1", "10", "1", "10"]


def test_a_motion_is_off_by_what_it_is_moved():
    at = lambda x: {"place_cm": np.full((2, 3, 3), [1 + x, 0, 0]), "torque_percent": np.full((2, 9), 1 + x), "force_percent": np.zeros(3)}
    assert accuracy.apart(at(0.1), at(0.0)) == pytest.approx({"place_cm": 0.1, "torque_percent": 10})
    assert accuracy.apart(accuracy.beyond(at(0.2), at(0.1)), at(0.0)) == pytest.approx({"place_cm": 0, "torque_percent": 0}, abs=1e-12)


def test_one_animal_in_two_simulators(tmp_path):
    """MuJoCo's head end comes half as far as the log's between restarts, and a quarter as far without f_thigmo; its tail ends half as far as these."""
    time = np.linspace(0, 2, 51)
    with h5py.File(tmp_path / "compare.h5", "w") as file:
        for head in two_simulators.HEADS:
            for name in two_simulators.QUANTITIES:
                file[f"states/{head}/{name}"], file[f"states/{head}/{name}_bound"] = [1e-14, 3e-14], [1e-11]
            file[f"rollout/{head}/velocity"], file[f"rollout/{head}/velocity_bound"] = [1e-13, 2e-13], [1e-10]
    with h5py.File(tmp_path / "playback.h5", "w") as file:
        file["time"], file["head_end"], file["tail_end"] = time, 9 - time, 30 - 2 * time
        for interval in two_simulators.INTERVALS:
            since = np.arange(50) % round(float(interval) / 0.04) + 1
            for force, share in (("thigmotaxis", 0.5), ("none", 0.25)):
                file[f"{force}_{interval}s/head_end"] = 9 - time[1:] + (1 - share) * 0.04 * since
                file[f"{force}_{interval}s/tail_end"] = 30 - 2 * time[1:] + (2 - share) * 0.04 * since
            for what in ("drift", "capsule_penetration"):
                file[f"thigmotaxis_{interval}s/{what}"] = 0.01 * since
    two_simulators.main(tmp_path / "compare.h5", tmp_path / "playback.h5", tmp_path)
    assert read(tmp_path, "two_simulators")[1::5] == [["positions", "1e-11", "3e-14", "3e-14"], ["q̇ along a run by the same rule", "1e-10", "2e-13", "2e-13"]]
    shares = [set(row[1:]) for row in read(tmp_path, "two_simulators_playback")[1:5]]
    assert shares == [{"50"}, {"25"}, {"25"}, {"12"}]
