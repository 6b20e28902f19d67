"""The page that runs the simulator, in node and in a headless Chromium, where there are these and the page is built.

Builds: HAGFISH_WEB=1 bash experiments/setup.sh; what it is compared with: cmake --build --preset portable --target live_digest.
"""

import functools
import json
import os
import re
import shutil
import subprocess
import threading
import time
import tomllib
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path

import pytest

import results
from browser import CHROMIUM, Browser
from program import ROOT, hagfish, logged

WEB = Path(os.environ.get("HAGFISH_WEB_BUILD", ROOT / "build/web"))
NATIVE = Path(os.environ.get("HAGFISH_LIVE_DIGEST", ROOT / "build/portable/experiments/live_digest"))
NODE = shutil.which("node")
PATIENCE = int(os.environ.get("HAGFISH_PATIENCE", 240))  # s, on a machine that draws by its processor and does much else

if not (WEB / "index.html").exists():
    pytest.skip(f"no page here: {WEB}/index.html is built by HAGFISH_WEB=1 bash experiments/setup.sh", allow_module_level=True)
needs_chromium = pytest.mark.skipif(CHROMIUM is None, reason="no chromium here")
needs_node = pytest.mark.skipif(NODE is None, reason="no node here")
needs_native = pytest.mark.skipif(not NATIVE.exists(), reason=f"no {NATIVE}: cmake --build --preset portable --target live_digest")


def digest_of(*command):
    text = subprocess.run([str(c) for c in command], check=True, capture_output=True, text=True, timeout=PATIENCE).stdout
    return re.fullmatch(r".*: ([0-9a-f]{16} of \d+ frames), .*", text.strip()).group(1)


@needs_node
@needs_native
@pytest.mark.parametrize("scene", ["table1", "living_overhand", "reflex_overhand"])
def test_q_at_every_frame_is_that_of_the_native_program_to_the_last_bit(scene):
    there = digest_of(NODE, ROOT / "experiments/live/digest.mjs", WEB / "hagfish.wasm", scene)
    assert there == digest_of(NATIVE, scene)
    changed = digest_of(NATIVE, scene, "time.duration=1", "drag.normal=9.4340")
    assert changed == digest_of(NATIVE, scene, "time.duration=1")  # the same double
    assert changed != digest_of(NATIVE, scene, "time.duration=1", "drag.normal=9.434000000000002")  # the next one


@needs_native
@pytest.mark.parametrize("scene", ["table1", "pull_overhand", "living_figure_eight time.rule=midpoint"])
def test_the_digest_noted_for_this_code_is_its_own(scene):
    noted = results.digests().get(results.motion_key(None))
    if noted is None:
        pytest.skip("not noted: bash experiments/reproduce.sh --digest")
    assert digest_of(NATIVE, *scene.split()).split()[0] == noted[scene]


DIGEST = """async ({ simulator, Digest }) => {
  const run = await simulator(), digest = new Digest();
  run.start({ name: "table1", text: run.builtin("table1.toml"), set: ["time.duration=1"] });
  run.calls.live_animal();
  const [step, interval] = run.array("clock"), steps = Math.round(interval / step);
  do { run.calls.live_frame(); digest.add(run.array("q")); } while (run.calls.live_advance(steps) === steps);
  return digest.text();
}"""


@needs_node
@pytest.mark.skipif(shutil.which("npm") is None, reason="no npm here")
def test_the_package_runs_where_its_tarball_is_installed(tmp_path):
    """In an empty folder, by node and, where there is one, in a page."""
    there = digest_of(NODE, ROOT / "experiments/live/digest.mjs", WEB / "hagfish.wasm", "table1", "time.duration=1")
    told = {"cwd": tmp_path, "check": True, "capture_output": True, "text": True}
    tarball = subprocess.run(["npm", "pack", WEB / "npm"], **told).stdout.strip()
    subprocess.run(["npm", "install", "--offline", tmp_path / tarball], **told)
    types = (WEB / "npm/hagfish.d.ts").read_text()  # name no function that the simulator lacks
    named = set(re.findall(r"^  (live_\w+)\(", types, re.MULTILINE))
    for call in re.findall(r"^  (?:text|lines)\(name: ([^,)]+)", types, re.MULTILINE):
        named |= {f"live_{name}" for name in re.findall(r'"(\w+)"', call)}
    (tmp_path / "has.mjs").write_text('import { simulator } from "hagfish"; console.log(Object.keys((await simulator()).calls).join());')
    assert len(named) > 10 and named <= set(subprocess.run([NODE, "has.mjs"], **told).stdout.strip().split(","))
    (tmp_path / "run.mjs").write_text(f'import * as hagfish from "hagfish"; console.log(await ({DIGEST})(hagfish));')
    assert subprocess.run([NODE, "run.mjs"], **told).stdout.strip() == there
    if CHROMIUM is None:
        return
    (tmp_path / "page.html").write_text("<!DOCTYPE html>")
    served = ThreadingHTTPServer(("127.0.0.1", 0), functools.partial(SimpleHTTPRequestHandler, directory=tmp_path))
    threading.Thread(target=served.serve_forever, daemon=True).start()
    browser = Browser(tmp_path)
    try:
        browser.open(f"http://127.0.0.1:{served.server_port}/page.html")
        assert browser.run(f'import("./node_modules/hagfish/hagfish.mjs").then({DIGEST})') == there
    finally:
        browser.close()
        served.shutdown()


class Live(Browser):
    """The page, asked by what it has of its own."""

    def wait(self, expression, what):
        end = time.monotonic() + PATIENCE
        while not self.run(expression):
            assert time.monotonic() < end, f"{what}: {self.message()}"
            time.sleep(0.1)

    def start(self, scene, settings=(), speed=1000):
        self.wait("window.page && page.log && page.log.frames > 0", "no first frame")
        before = self.run(f"page.wantsPlay = true, page.choose({json.dumps(scene)}, {json.dumps(list(settings))}), page.starts")
        self.wait(f"page.starts > {before} && page.log.frames > 0", scene)
        self.run(f"page.ask({{ kind: 'speed', value: {speed} }})")

    def until(self, condition, what):
        self.wait(f"(() => {{ const log = window.page && page.log, f = log ? log.frames - 1 : -1; return f >= 0 && ({condition}); }})()", what)

    def type(self, key, text):
        self.run(f"(() => {{ const input = document.querySelector('[data-key=\"{key}\"]'); input.value = {json.dumps(text)}; "
                 "input.dispatchEvent(new Event('change')); })()")

    def message(self):
        return self.run("element('message').hidden ? '' : element('message').textContent")


@pytest.fixture(scope="module")
def page(tmp_path_factory):
    if CHROMIUM is None:
        pytest.skip("no chromium here")
    browser = Live(tmp_path_factory.mktemp("live"), (1000, 700))
    browser.open(WEB / "index.html")
    yield browser
    browser.close()


@pytest.fixture(autouse=True)
def no_harm(request):
    """Whatever a test does, the page has no error and asks for nothing."""
    yield
    if "page" in request.fixturenames:
        browser = request.getfixturevalue("page")
        assert browser.errors == []
        assert [r for r in browser.requests if not r.startswith(("file:///", "blob:", "data:"))] == []
        assert len([r for r in browser.requests if r.startswith("file:///")]) <= 2


def test_it_begins_to_move_by_itself(page):
    page.until("log.last() > 0.1", "no motion")
    assert page.run("viewer.pictures") > 0


@needs_native
def test_a_run_in_the_page_ties_a_3_1_and_has_the_digest_of_the_native_program(page):
    page.start("living_overhand")
    page.until("page.over", "the run does not end")
    knots = page.run("(() => { const log = page.log; return Array.from({ length: log.frames }, (_, f) => log.phaseName(f) + ' ' + log.knotName(f)); })()")
    assert "slide overhand, 3_1" in knots and knots[-1] == "free no knot"
    assert page.run("page.digest") == digest_of(NATIVE, "living_overhand")


def test_a_link_makes_the_same_run(page):
    page.start("table1", ["controller.cap=900", "time.duration=2"])
    page.until("page.over", "the run does not end")
    digest, address = page.run("page.digest"), page.run("page.link()")
    assert "#" in address and "controller" not in address
    page.start("table1", ["time.duration=1"])
    page.until("page.over", "no other run")
    assert page.run("page.digest") != digest
    page.run(f"history.replaceState(null, '', '#'); location.hash = {json.dumps(address.split('#')[1])}")
    page.until("page.accepted.includes('controller.cap=900') && page.over", "the link does not run")
    assert page.run("page.digest") == digest


def test_without_the_reflex_the_knot_stays(page):
    slid = {}
    for shift in ("1e-9", "0.0106"):
        page.start("reflex_overhand", ["time.duration=13.5"])
        page.until("page.over", "it does not come to slide")
        assert page.run("page.log.phaseName(page.log.frames - 1)") == "slide"
        page.run(f"page.set([['controller.reflex.shift', '{shift}'], ['time.duration', '15.5']])")
        page.wait("page.accepted.includes('time.duration=15.5')", "no change")
        page.run("page.ask({ kind: 'play', on: true })")
        page.until("log.last() > 15.4 && page.over", "it does not go on")
        ends = page.run("(() => { const log = page.log, at = (t) => log.head_end[log.frameAt(t)]; return [at(12.5), at(13.5), at(14.5), at(15.5)]; })()")
        assert ends[0] - ends[1] > 0.2, ends
        slid[shift] = ends[2] - ends[3]  # in the second second after the change
    assert slid["0.0106"] > 0.2 and abs(slid["1e-9"]) < 0.1 * slid["0.0106"], slid


def test_a_reflex_has_no_patch_of_eq_6(page):
    there = """getComputedStyle(document.querySelector('[data-key="controller.contact_patch"]').parentElement).display"""
    for scene, hidden in (("table1", False), ("reflex_overhand", True)):
        page.start(scene)
        assert (page.run(there) == "none") is hidden


def test_the_first_guided_step_names_the_time_of_the_knot(page):
    page.start("living_overhand", ["time.duration=10"])
    page.until("page.over", "the run does not end")
    tied = page.run("page.log.time[page.log.knot.findIndex((one) => page.log.knots[one] === 'overhand, 3_1')]")
    assert f"at about {tied:.0f} s" in page.run("TRIES[0].first"), tied


def test_a_plate_has_its_hole(page):
    page.start("hole_overhand")
    plate, rim = tomllib.loads((ROOT / "data/hole_overhand.toml").read_text())["obstacle"]
    square, tube = page.run("page.log.obstacles")
    assert square["point"] == pytest.approx(plate["point"]) and square["hole"] == pytest.approx(rim["inner_radius"] + rim["radius"])
    assert tube["radius"] == rim["radius"] and tube["ring"] is False and tube["closed"] is True
    assert page.run("viewer.bodies[0].obstacles.length") == 2


def test_a_change_while_it_runs_goes_on_from_where_it_was(page):
    page.start("table1", speed=4)
    page.until("log.last() > 0.5", "no motion")
    page.type("specimen.length", "45")
    page.until("Math.abs(log.animal.length - 45) < 1e-9", "no change")
    then = page.run("page.log.last()")
    page.until(f"log.last() > {then} + 0.2", "it does not go on")
    assert page.run("page.log.frames") > 25 and page.message() == ""
    page.type("model.bodies", "60")  # starts again
    page.until("log.bodies === 60 && log.last() > 0.1", "no start with other bodies")


def test_a_wrong_number_shows_its_line_and_the_run_goes_on(page):
    page.start("table1", speed=4)
    page.until("log.last() > 0.2", "no motion")
    page.type("controller.cap", "-5")
    page.wait("!element('message').hidden", "no message")
    assert page.message() == "table1: --set controller.cap=-5: must be positive"
    page.type("controller.cap", "0,5")
    page.wait("element('message').textContent.includes('comma')", "no word of the comma")
    assert page.run("document.querySelector('[data-key=\"controller.cap\"]').getAttribute('aria-invalid')") == "true"
    then = page.run("page.log.last()")
    page.until(f"log.last() > {then} + 0.5", "it does not go on")
    page.type("controller.cap", "800")
    page.wait("page.values['controller.cap'] === '800.0'", "no right number after a wrong one")
    assert page.message() == ""


def test_a_step_that_cannot_be_taken_is_told_and_a_fresh_start_runs(page):
    page.start("table1", ["guard.speed=1"])
    page.wait("!element('message').hidden", "no failure")
    assert "speed" in page.message() and page.run("element('play').textContent") == "Play"
    page.start("table1")
    page.until("log.last() > 0.2", "no fresh start")


def test_the_body_is_pulled(page):
    page.start("table1", ["script.kind=\"none\""], speed=4)
    page.until("log.last() > 0.1", "no motion")
    x, y, before = page.run("""(() => {
      const box = viewer.renderer.domElement.getBoundingClientRect(), seen = viewer.centre(70).project(viewer.camera);
      return [box.left + (seen.x + 1) / 2 * box.width, box.top + (1 - seen.y) / 2 * box.height, viewer.centre(70).toArray()];
    })()""")
    page.call("Input.dispatchMouseEvent", type="mousePressed", x=x, y=y, button="left", clickCount=1)
    page.call("Input.dispatchMouseEvent", type="mouseMoved", x=x, y=y - 120, button="left", buttons=1)
    page.until("Math.hypot(log.hand[3 * f], log.hand[3 * f + 1], log.hand[3 * f + 2]) > 10", "no pull")
    page.wait("element('now').textContent.includes('you pull with')", "its force is not shown")
    page.until(f"viewer.centre(70).distanceTo(new THREE.Vector3(...{before})) > 1", "no motion")
    page.call("Input.dispatchMouseEvent", type="mouseReleased", x=x, y=y - 120, button="left", clickCount=1)
    page.until("log.hand[3 * f] === 0", "it is not let go")


def test_a_saved_scene_is_one_of_the_program_and_passes_its_check(page, tmp_path):
    page.start("table1", ["drag.normal=9.5"])
    page.until("log.last() > 0.1", "no motion")
    (tmp_path / "saved.toml").write_text(page.run("page.toml"))
    logged(tmp_path, "saved.toml")
    hagfish(tmp_path, "check", "a.h5")


def test_tables_and_the_replay_page_hold_the_run(page, tmp_path):
    page.start("table1", ["time.duration=1"])
    page.until("page.over", "the run does not end")
    frames = page.run("page.log.frames")  # those of a log, and before the speed was set some between them
    rows = page.run("runTable(page.log, 'si')").strip().split("\n")
    assert rows[0].startswith("time (s),phase,knot,head end of the knot (m)") and len(rows) == 1 + frames
    times = [float(row.split(",")[0]) for row in rows[1:]]
    assert times == sorted(set(times)) and {round(0.02 * k, 2) for k in range(51)} <= {round(time, 6) for time in times}
    assert all(len(row.split(",")) == len(rows[0].split(",")) for row in rows)
    assert len(page.run("shapeTable(page.log, 'cgs')").strip().split("\n")) == 1 + frames * 100
    (tmp_path / "replay.html").write_text(page.run("page.log.rescale(), replayPage(page.log)"))
    other = Live(tmp_path, (900, 700))
    try:
        other.open(tmp_path / "replay.html")
        assert other.run("viewer.logs[0].frames") == frames and other.errors == []
        there = page.run("Array.from(page.log.position.slice(-3))")
        assert other.run("Array.from(viewer.logs[0].position.slice(-3))") == there
    finally:
        other.close()


def test_files_of_ones_own_are_taken_and_bad_ones_refused(page):
    give = lambda name, text: page.run(f"page.open(new File([{json.dumps(text)}], {json.dumps(name)}))")
    page.start("table1")
    give("mine.toml", "base = \"table1\"\ntitle = \"My own\"\n[model]\nbodies = 40\n")
    page.until("log.title === 'My own' && log.bodies === 40 && log.last() > 0.1", "no scene of one's own")
    give("animal.toml", (ROOT / "data/specimens/pacific_hagfish.toml").read_text().replace("length = 42.4", "length = 50.0"))
    page.until("Math.abs(log.animal.length - 50) < 1e-9", "no specimen of one's own")
    give("broken.toml", "base = \"table1\"\n[model\n")
    page.wait("!element('message').hidden", "no message")
    assert page.message().startswith("broken.toml:2: not valid TOML")
    page.start("living_overhand")
    give("mine.csv", (ROOT / "data/programs/overhand.csv").read_text())
    page.until("page.settings.get('script.program') === '\"mine.csv\"' && log.last() > 0.1", "no program of one's own")


def test_a_thousand_random_inputs_never_break_it(page):
    page.start("table1", ["time.duration=1e6"], speed=0.1)
    told = sum(page.run("""(async () => {
      let seed = %d, refused = 0;
      const random = (n) => { seed = (Math.imul(seed, 1103515245) + 12345) >>> 0; return Math.floor(seed / 4294967296 * n); };
      const some = ["", "-1", "0", "1e308", "1e-308", "NaN", "inf", "-inf", "0x10", "1,5", "\\"", "\\\\", "]", "[1]", "{", "=", "#", "\\n", "\\u0000", "\\ud800",
        "é", "true", "paper", "1e9999", "0.1 L", "9".repeat(400), "'''", "<b>", "400", "2", "3", "1e-9", "100", "50", "1", "0.002"];
      const inputs = Array.from(document.querySelectorAll("[data-key]")).filter((input) => input.tagName === "INPUT");
      const answered = () => new Promise((done) => {
        const { changed, started, refused: no } = page.heard, back = () => Object.assign(page.heard, { changed, started, refused: no });
        page.heard.changed = (data) => { back(); changed(data); done(); };
        page.heard.started = (data) => { back(); started(data); done(); };
        page.heard.refused = (data) => { back(); ++refused; no(data); done(); };
      });
      for (let k = 0; k < 2; ++k) {
        const input = inputs[random(inputs.length)], answer = answered();
        input.value = random(2) ? some[random(some.length)] : String.fromCharCode(...Array.from({ length: 1 + random(12) }, () => 1 + random(126)));
        input.dispatchEvent(new Event("change"));
        await answer;
      }
      return refused;
    })()""" % (7919 * seed)) for seed in range(500))
    assert 500 < told < 1000
    page.start("table1")
    page.until("log.last() > 0.2", "it is broken")


def test_the_whole_animal_stays_in_view_until_the_view_is_turned(page):
    seen = """Math.max(...Array.from({ length: page.log.position.length / 3 }, (_, b) => {
      const at = new THREE.Vector3(...page.log.position.subarray(3 * b, 3 * b + 3)).project(viewer.camera);
      return Math.max(Math.abs(at.x), Math.abs(at.y));
    }))"""
    page.call("Emulation.setDeviceMetricsOverride", width=1400, height=850, deviceScaleFactor=1, mobile=False)
    page.start("table1", ["time.duration=10"])
    page.until("page.over", "the run does not end")
    assert page.run(seen) < 1
    page.call("Emulation.setDeviceMetricsOverride", width=240, height=850, deviceScaleFactor=1, mobile=False)
    page.wait("viewer.camera.aspect < 1", "no narrow window")
    page.wait(f"{seen} < 1", "cut off in a narrow window")
    page.call("Emulation.setDeviceMetricsOverride", width=1400, height=850, deviceScaleFactor=1, mobile=False)
    page.wait(f"viewer.camera.aspect > 2 && {seen} > 0.8", "small in a wide window")
    page.start("table1", ["time.duration=10"], speed=1)
    page.run("viewer.orbit.dispatchEvent({ type: 'start' }), page.ask({ kind: 'speed', value: 1000 })")
    page.until("page.over", "the run does not end")
    assert page.run(seen) > 1


def test_the_stage_is_light_or_dark_as_the_page_is(page):
    for theme in ["dark", "light"]:
        page.call("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": theme}])
        page.wait("getComputedStyle(element('stage')).backgroundColor === viewer.renderer.getClearColor().getStyle().replaceAll(',', ', ')", theme)


@pytest.mark.parametrize("width", [1400, 400])
def test_nothing_is_cut_off(page, width):
    page.call("Emulation.setDeviceMetricsOverride", width=width, height=850, deviceScaleFactor=1, mobile=False)
    page.start("table1")
    page.until("log.last() > 0.5", "no motion")
    wide = page.run("""Array.from(document.querySelectorAll("button, select, input, #now, #message")).filter((e) => {
      const box = e.getBoundingClientRect();
      return box.width > 0 && (box.right > innerWidth + 1 || box.left < -1);
    }).map((e) => e.id || e.textContent)""")
    assert wide == []
    assert page.run("document.documentElement.scrollWidth <= innerWidth")
