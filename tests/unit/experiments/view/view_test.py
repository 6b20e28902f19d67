"""`hagfish view`: what the page holds against the log, and the page in a headless Chromium, where there is one."""

import base64
import csv
import json
import shutil

import h5py
import numpy as np
import pytest

from animal import spans, total_bend
from browser import CHROMIUM, Browser
from program import hagfish, logged, phases, refused, sets

TYPES = {"f4": "<f4", "i2": "<i2", "u1": "u1", "u4": "<u4"}
PLACE = 1e-4  # cm, of the log's
needs_chromium = pytest.mark.skipif(CHROMIUM is None, reason="no chromium here")


def decoded(packed):
    kind = next(name for name in TYPES if name in packed)
    values = np.frombuffer(base64.b64decode(packed[kind]), TYPES[kind])
    return np.where(values == -32768, np.nan, values * packed["scale"]) if kind == "i2" else values


def logs_of(page):
    text = page.read_text()
    start = text.index("const LOGS=") + len("const LOGS=")
    return json.JSONDecoder().raw_decode(text, start)[0]


def shown(page, name, frames):
    return decoded(page["quantities"][name]["values"]).reshape(frames, -1)


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    folder = tmp_path_factory.mktemp("view")
    logged(folder, "table1", "--preset", "quick")
    logged(folder, "living_overhand", "--preset", "quick", *sets("time.duration=3", "expect.types=[]"), out="b.h5")
    hagfish(folder, "view", "a.h5", "--out", "a.html")
    hagfish(folder, "view", "a.h5", "b.h5", "--out", "both.html")
    return folder


def test_a_log_without_moments_shows_torques_of_hinges_by_name(run):
    shutil.copy(run / "a.h5", run / "early.h5")
    with h5py.File(run / "early.h5", "r+") as log:
        del log["mean/moments"]
        torques = np.nan_to_num(log["mean/forces/thigmotaxis"][:, 6:])
        names = log["model/dof_name"].asstr()[6:]
    hagfish(run, "view", "early.h5", "--out", "early.html")
    (page,) = logs_of(run / "early.html")
    values = np.hypot(*(torques[:, [name.endswith(axis) for name in names]] for axis in ("_y", "_z")))
    assert page["quantities"]["thigmotaxis"]["label"] == "f_thigmo, bending (torques of hinges)"
    np.testing.assert_allclose(shown(page, "thigmotaxis", len(values)), values, atol=values.max() / 60000)


def test_the_page_holds_what_the_log_holds(run):
    (page,), log = logs_of(run / "a.html"), h5py.File(run / "a.h5")
    places, own = log["trajectory/position"][()], decoded(page["position"])
    np.testing.assert_allclose(own, places.ravel(), atol=PLACE)
    assert [page["phases"][k] for k in decoded(page["phase"])] == phases(log)
    assert np.all((np.array(page["knots"])[decoded(page["knot"])] == "overhand, 3_1") == (log["knot/determinant"][()] == 3))
    # Some of the six are 0 but for rounding.
    head = log["mean/forces/head"][:, :6]
    np.testing.assert_allclose(decoded(page["head"]), head.ravel(), rtol=1e-6, atol=1e-30)
    series = {"trajectory/time": page["time"], "thigmotaxis/command": page["eq6"]["command"], "forces/tip": page["tip"],
              **{f"mean/thigmotaxis/{name}": page["eq6"][name] for name in ("speed", "slack", "lambda")},
              **{f"knot/{end}": page[end] for end in ("head_end", "tail_end")},
              **{f"diagnostics/{name}": values for name, values in page["energy"].items()}}
    for path, packed in series.items():
        np.testing.assert_allclose(decoded(packed), log[path][()].ravel(), rtol=1e-6, err_msg=path)
    np.testing.assert_allclose(decoded(page["plate_force"]), log["mean/forces/wall"][:, 0], rtol=1e-6)


def test_the_page_colours_the_body_by_what_the_log_holds(run):
    (page,), log = logs_of(run / "a.html"), h5py.File(run / "a.h5")
    frames, length, span = len(log["trajectory/time"]), log["model/length"][0], spans(log)
    axes = np.array([name.split("_")[-1] for name in log["model/dof_name"].asstr()[6:]])
    moment, angle = np.nan_to_num(log["mean/moments/thigmotaxis"][()]), log["trajectory/q"][:, 7:]
    odd, even = np.arange(1, len(span), 2), np.arange(2, len(span), 2)
    wanted = {"thigmotaxis": np.hypot(moment[:, odd, 1], moment[:, odd, 2]),
              "thigmotaxis-twist": np.abs(moment[:, even, 0]),
              "twist": np.abs(angle[:, axes == "twist"]) / span[even],
              "curvature": total_bend(angle[:, axes == "y"], angle[:, axes == "z"]) / span[odd]}
    for name, values in wanted.items():
        own = page["quantities"][name]
        np.testing.assert_allclose(shown(page, name, frames), values, atol=values.max() / 60000)
        np.testing.assert_allclose(own["arc"], (even if "twist" in name else odd) * length)
        above = np.sort(values[values > 0])
        assert own["scale"] == pytest.approx(above[int(0.99 * (len(above) - 1))], rel=1e-3)
    assert "active" not in page["quantities"]
    # Contacts, spread along the body, keep their sum: twice each, for its two strands.
    strands = np.where(np.isnan(log["contacts/spline_b"][()]), 1, 2)
    sums = np.bincount(log["contacts/frame"][()], log["contacts/force"][()] * strands, frames)
    inside = np.flatnonzero((sums > 0) & np.isin(phases(log), ("tighten", "slide")))  # of the tail's end some falls off
    np.testing.assert_allclose(shown(page, "contact", frames)[inside].sum(axis=1) * length, sums[inside], rtol=0.02)
    first, contacts = decoded(page["contacts"]["first"]), decoded(page["contacts"]["values"]).reshape(-1, 9)
    np.testing.assert_array_equal(np.diff(first), np.bincount(log["contacts/frame"][()], minlength=frames))
    np.testing.assert_allclose(np.sort(contacts[:, 6]), np.sort(log["contacts/force"][()]), rtol=1e-6)
    np.testing.assert_allclose(np.linalg.norm(contacts[:, 3:6], axis=1), 1, rtol=1e-6)


def test_the_slide_as_it_ended_is_that_of_the_check(run):
    """The head end's way, and the share of both ends."""
    hagfish(run, "check", "--fast", "a.h5", "--csv", "a.csv")
    with (run / "a.csv").open(newline="") as file:
        found = {row["criterion"]: row["value"] for row in csv.DictReader(file)}
    slide = decoded(logs_of(run / "a.html")[0]["slide"]).reshape(-1, 4)
    leads, trails, asked, travel = slide[-1]
    assert leads == pytest.approx(float(found["slide"]), abs=1e-4)
    share = min(trails / asked, travel / min(leads, trails))
    assert 100 * share == pytest.approx(float(found["slide of both ends"]), rel=1e-4)
    assert np.isnan(slide[0, 0])  # none before it


def test_it_is_one_file_that_asks_for_nothing(run):
    text = (run / "a.html").read_text()
    assert len(text) < 5e6
    assert "default-src 'none'" in text
    for tag in ("<script src", "<link rel=\"stylesheet", "<img", "@import", "<iframe"):
        assert tag not in text, tag


def test_texts_of_a_log_stay_texts(tmp_path):
    title = "</script><script>document.title=1</script>"
    logged(tmp_path, "table1", "--preset", "quick", *sets("time.duration=0.1", f'title="{title}"'))
    hagfish(tmp_path, "view", "a.h5")
    assert "document.title=1</script>" not in (tmp_path / "replay.html").read_text()
    assert logs_of(tmp_path / "replay.html")[0]["title"] == title


def test_three_logs_are_refused(run):
    refused(run, "view", "a.h5", "b.h5", "a.h5", "--out", "x.html")


@pytest.fixture(scope="module")
def browser(tmp_path_factory):
    one = Browser(tmp_path_factory.mktemp("browser"))
    yield one
    one.close()


COLOURS_ON_CANVAS = """(() => {
  viewer.render();
  const gl = viewer.renderer.getContext(), w = gl.drawingBufferWidth, h = gl.drawingBufferHeight, px = new Uint8Array(4 * w * h);
  gl.readPixels(0, 0, w, h, gl.RGBA, gl.UNSIGNED_BYTE, px);
  const seen = new Set();
  for (let k = 0; k < px.length; k += 4) seen.add((px[k] << 16) | (px[k + 1] << 8) | px[k + 2]);
  return seen.size;
})()"""


@needs_chromium
def test_the_page_replays_the_log(run, browser):
    log = h5py.File(run / "a.h5")
    browser.open(run / "a.html")
    own = (run / "a.html").as_uri()
    assert [url for url in browser.requests if url != own and not url.startswith("data:")] == []
    assert browser.errors == []
    assert browser.run(COLOURS_ON_CANVAS) > 100
    time, knotted = log["trajectory/time"][()], log["knot/determinant"][()] == 3
    for frame in (0, int(np.flatnonzero(knotted)[5]), len(time) - 1):
        browser.run(f"(() => {{ const s = document.getElementById('scrub'); s.value = {frame}; s.dispatchEvent(new Event('input')); }})()")
        now = browser.run("document.getElementById('now').textContent")
        assert f"t = {time[frame]:.2f} s" in now
        assert ("overhand, 3_1" if knotted[frame] else "no knot") in now
        # What is drawn is where the log has it: the skin's rings are about the spline's points.
        centre = browser.run("(() => { const b = viewer.bodies[0], p = b.geometry.attributes.position.array, m = [0, 0, 0], k = CAP_RINGS + 2 * 30;"
                             "for (let s = 0; s < SIDES; ++s) for (let i = 0; i < 3; ++i) m[i] += p[3 * (k * SIDES + s) + i] / SIDES; return m; })()")
        np.testing.assert_allclose(centre, log["trajectory/position"][frame, 30], atol=PLACE)
    browser.press("Home")
    assert browser.run("viewer.shown[0]") == 0
    browser.press("ArrowRight")
    assert browser.run("viewer.shown[0]") == 1
    for _ in range(len(browser.run("Array.from(document.getElementById('colour').options).map(o => o.value)"))):
        browser.press("c")
        assert browser.run(COLOURS_ON_CANVAS) > 50
    browser.press(" ")
    # However slowly this machine draws, it comes to the next frames.
    browser.run("new Promise(done => { const look = () => viewer.shown[0] > 1 ? done() : setTimeout(look, 50); look(); })")
    browser.press(" ")
    assert browser.run("viewer.playing") is False
    assert browser.errors == []


@needs_chromium
def test_a_bar_tells_the_scale(run, browser):
    browser.open(run / "a.html")
    browser.run("viewer.render()")
    # A stick of the bar's length in the middle, across the view, is as long on the screen.
    bar, stick = browser.run("""(() => {
      const across = new THREE.Vector3(1, 0, 0).applyQuaternion(viewer.camera.quaternion), long = parseFloat(element("bar").textContent);
      const end = viewer.orbit.target.clone().addScaledVector(across, long).project(viewer.camera);
      return [element("bar").getBoundingClientRect().width, end.x / 2 * viewer.renderer.domElement.clientWidth];
    })()""")
    assert bar == pytest.approx(stick, rel=0.01) and 20 < bar <= 150


@needs_chromium
def test_a_lost_picture_comes_back(run, browser):
    browser.open(run / "a.html")
    browser.run("""(async () => {
      const lose = viewer.renderer.getContext().getExtension("WEBGL_lose_context"), canvas = element("scene");
      const comes = (name) => new Promise((done) => canvas.addEventListener(name, () => setTimeout(done, 100), { once: true }));
      const lost = comes("webglcontextlost"), back = comes("webglcontextrestored");
      lose.loseContext();
      await lost;
      lose.restoreContext();
      await back;
    })()""")
    stage = browser.run("getComputedStyle(element('stage')).backgroundColor.match(/[0-9]+/g).map(Number)")
    assert browser.run(COLOURS_ON_CANVAS) > 100
    assert browser.run("""(() => { viewer.render(); const gl = viewer.renderer.getContext(), px = new Uint8Array(4);
      gl.readPixels(2, gl.drawingBufferHeight - 3, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, px); return Array.from(px.slice(0, 3)); })()""") == stage


# What a ray against X meets of the obstacles at a place (y, z), the nearest first: their x.
MET = """((y, z) => { viewer.scenes[0].updateMatrixWorld();
  return new THREE.Raycaster(new THREE.Vector3(30, y, z), new THREE.Vector3(-1, 0, 0)).intersectObjects(viewer.bodies[0].obstacles, true).map((hit) => hit.point.x); })"""


@needs_chromium
def test_a_plate_has_its_hole(tmp_path, browser):
    logged(tmp_path, "hole_overhand", *sets("time.duration=0.1", "expect.types=[]"))
    hagfish(tmp_path, "view", "a.h5", "--out", "a.html")
    browser.open(tmp_path / "a.html")
    for y, z in ((0, 0), (0.9, 0), (0, -0.9), (3, 0)):
        assert browser.run(f"{MET}({y}, {z})") == []
    for y, z in ((2, 0), (2.5, 2.5), (0, -2)):
        assert browser.run(f"{MET}({y}, {z})")[0] == pytest.approx(2, abs=1e-6)
    assert browser.run(f"{MET}(1.3, 0)")[0] == pytest.approx(2, abs=0.01)  # the rim's nearest
    assert browser.errors == []


@needs_chromium
def test_two_logs_beside_and_over_each_other(run, browser):
    browser.open(run / "both.html")
    browser.run("viewer.seek(2)")
    assert browser.run(COLOURS_ON_CANVAS) > 100
    assert browser.run("viewer.shown.map((f, k) => viewer.logs[k].time[f])") == pytest.approx([2, 2])
    assert browser.run("viewer.ghost.group.visible") is False
    browser.press("o")
    assert browser.run("viewer.ghost.group.visible") is True
    assert browser.run(COLOURS_ON_CANVAS) > 100
    assert browser.errors == []


@needs_chromium
@pytest.mark.parametrize("width", [390, 420])
def test_it_fits_a_phone(run, tmp_path, width):
    phone = Browser(tmp_path, (width, 844))
    phone.open(run / "a.html")
    assert phone.run("document.documentElement.scrollWidth") <= width
    # No words lie on others, and the whole animal is in sight at the start.
    assert phone.run("""(() => {
      const boxes = [...document.querySelectorAll('.plot .heading, .plot .reading, .plot .line-names > span, .plot .drawing')].map((e) => e.getBoundingClientRect()).filter((b) => b.width > 0);
      let over = 0;
      boxes.forEach((a, i) => boxes.slice(i + 1).forEach((b) => { if (a.left < b.right - 1 && b.left < a.right - 1 && a.top < b.bottom - 1 && b.top < a.bottom - 1) ++over; }));
      return over;
    })()""") == 0
    places = phone.run("""(() => { const p = viewer.logs[0].position, n = viewer.logs[0].bodies, found = [];
      for (const b of [0, n - 1]) { const v = new THREE.Vector3(p[3 * b], p[3 * b + 1], p[3 * b + 2]).project(viewer.camera); found.push(v.x, v.y); } return found; })()""")
    assert np.abs(places).max() < 1
    phone.close()
