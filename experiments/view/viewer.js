"use strict";
// The page: one time, one camera, the controls.

const BARS = [0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50, 100], LONGEST_BAR = 150; // cm, px
const SPEEDS = [0.1, 0.25, 0.5, 1, 2, 4, 8];
const element = (id) => document.getElementById(id);

class Viewer {
  constructor(logs) {
    this.logs = logs;
    this.time = logs[0].time[0];
    this.playing = false;
    this.first = Math.min(...logs.map((log) => log.time[0]));
    this.last = Math.max(...logs.map((log) => log.time[log.frames - 1]));
    const two = logs.length > 1;
    this.renderer = new THREE.WebGLRenderer({ canvas: element("scene"), antialias: true });
    this.setBackground();
    // A driver that starts anew has lost all but what three.js makes again.
    element("scene").addEventListener("webglcontextrestored", () => { this.setBackground(); this.ask(); });
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => { this.setBackground(); this.ask(); });
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio || 1, 2));
    this.camera = new THREE.PerspectiveCamera(30, 1, 0.5, 2000);
    this.camera.up.set(0, 0, 1);
    this.scenes = logs.map(() => this.emptyScene());
    this.bodies = logs.map((log, k) => new Body(log, false));
    this.ghost = two ? new Body(logs[1], true) : null;
    this.bodies.forEach((body, k) => this.scenes[k].add(body.group));
    if (two) {
      this.ghost.plate.visible = false;
      this.ghost.obstacles.forEach((mesh) => { mesh.visible = false; });
      this.scenes[0].add(this.ghost.group);
    }
    this.scene_names = logs.map((log) => {
      const div = element("names").appendChild(document.createElement("div"));
      div.textContent = log.name;
      return div;
    });
    this.orbit = new THREE.OrbitControls(this.camera, this.renderer.domElement);
    this.orbit.addEventListener("change", () => this.ask());
    this.plots = new Plots(logs, (time) => this.seek(time));
    this.addControls();
    this.resetView();
    this.resize();
    window.addEventListener("resize", () => this.resize());
  }

  /** The stage's colour, light or dark. */
  setBackground() { this.renderer.setClearColor(getComputedStyle(document.documentElement).getPropertyValue("--stage").trim()); }

  emptyScene() {
    const scene = new THREE.Scene();
    scene.add(new THREE.HemisphereLight(0xffffff, 0x9aa4ae, 0.75));
    const key = new THREE.DirectionalLight(0xffffff, 0.55);
    key.position.set(-20, -50, 60);
    scene.add(key);
    return scene;
  }

  addControls() {
    const { logs } = this;
    element("title").textContent = logs.map((log) => log.title).join(" | ");
    element("about").textContent = logs.map((log) => `${log.name}: ${log.specimen}, ${d3.format(".3~g")(log.animal.length)} cm, ${log.bodies} bodies, ${log.frames} frames, ${log.status}`).join(" | ");
    document.title = `hagfish ${this.kind()}: ${logs.map((log) => log.name).join(", ")}`;
    element("layout-label").style.display = logs.length > 1 ? "" : "none";
    for (const speed of this.speeds()) element("speed").add(new Option(`${speed} x`, speed, speed === 1, speed === 1));
    element("colour").add(new Option("none", ""));
    this.quantities = quantitiesOf(logs);
    for (const [name, { label }] of Object.entries(this.quantities)) element("colour").add(new Option(label, name));
    const wanted = ["active", "thigmotaxis", "curvature"].find((name) => logs.every((log) => log.quantities[name]));
    element("colour").value = wanted || "";
    this.nameArrows();
    element("scrub").max = this.longest().frames - 1;
    element("scrub").addEventListener("input", () => this.seek(this.longest().time[element("scrub").value]));
    element("play").addEventListener("click", () => this.play(!this.playing));
    element("colour").addEventListener("change", () => this.recolour());
    for (const id of ["arrows", "layout"]) element(id).addEventListener("change", () => this.resize());
    element("reset").addEventListener("click", () => this.resetView());
    element("help").addEventListener("click", () => { element("keys").hidden = !element("keys").hidden; });
    document.addEventListener("keydown", (event) => this.key(event));
  }

  /** What the arrows that there are stand for. */
  nameArrows() {
    element("arrow-words").textContent = "";
    for (const [kind, words] of Object.entries(ARROW_WORDS)) {
      if (!this.bodies.some((body) => body.largest[kind] > 1e-6)) continue;
      const line = element("arrow-words").appendChild(document.createElement("div"));
      const arrow = line.appendChild(document.createElement("b"));
      arrow.textContent = "→ ";
      arrow.style.color = "#" + ARROWS[kind].toString(16).padStart(6, "0");
      line.append(words);
    }
  }

  kind() { return "replay"; }
  speeds() { return SPEEDS; }

  /** The log that goes on the longest: its frames are those of the slider. */
  longest() { return this.logs.reduce((a, b) => (b.time[b.frames - 1] > a.time[a.frames - 1] ? b : a)); }

  key(event) {
    if (event.ctrlKey || event.altKey || event.metaKey) return;
    const own = event.target.tagName, log = this.longest(), frame = log.frameAt(this.time);
    if (own === "SELECT" || (own === "BUTTON" && event.key === " ")) return;
    const to = (f) => this.seek(log.time[Math.min(Math.max(f, 0), log.frames - 1)]);
    const next = (id, by) => {
      const select = element(id), count = select.options.length;
      select.selectedIndex = id === "speed" ? Math.min(Math.max(select.selectedIndex + by, 0), count - 1) : (select.selectedIndex + by) % count;
    };
    const sense = event.key === "ArrowRight" ? 1 : -1;
    const keys = {
      " ": () => this.play(!this.playing),
      ArrowLeft: () => (event.shiftKey ? this.seek(this.time + sense) : to(frame + sense)),
      Home: () => to(0),
      End: () => to(log.frames - 1),
      ArrowUp: () => next("speed", 1),
      ArrowDown: () => next("speed", -1),
      c: () => { next("colour", 1); this.recolour(); },
      a: () => { element("arrows").checked = !element("arrows").checked; this.resize(); },
      o: () => { element("layout").selectedIndex = 1 - element("layout").selectedIndex; this.resize(); },
      r: () => this.resetView(),
      "?": () => element("help").click(),
    };
    keys.ArrowRight = keys.ArrowLeft;
    if (!keys[event.key]) return;
    event.preventDefault();
    keys[event.key]();
  }

  /** The whole of what the animals do in sight, from the side and above. */
  resetView() {
    const toward = new THREE.Vector3(-0.12, -0.62, 0.78).normalize(), skin = 0.3 + d3.max(this.logs, (log) => d3.max(log.animal.radius));
    const right = new THREE.Vector3().crossVectors(this.camera.up, toward).normalize(), up = new THREE.Vector3().crossVectors(toward, right);
    const points = [], place = (axis, p) => p.dot(axis);
    for (const log of this.logs) {
      const { position, bodies } = log, add = (b) => points.push(new THREE.Vector3(position[3 * b], position[3 * b + 1], position[3 * b + 2]));
      for (let b = 0; b < position.length / 3; b += 10) add(b);
      for (let b = bodies - 1; b < position.length / 3; b += bodies) add(b); // the tail goes furthest
      // A floor may end out of sight.
      for (const { points: along, point, floor } of log.obstacles) if (!floor) for (const p of along || [point]) points.push(new THREE.Vector3(...p));
      if (log.plate) for (const y of [-2.6, 2.6]) for (const z of [-2.6, 2.6]) points.push(new THREE.Vector3(0, y, z));
    }
    const middle = (axis) => { const [low, high] = d3.extent(points, (p) => place(axis, p)); return (low + high) / 2; };
    const centre = [right, up, toward].map((axis) => [axis, middle(axis)]);
    this.orbit.target.set(0, 0, 0);
    for (const [axis, at] of centre) this.orbit.target.addScaledVector(axis, at);
    const half = Math.tan(Math.PI / 180 * this.camera.fov / 2), wide = half * this.aspect(), [[, x], [, y], [, z]] = centre;
    const away = d3.max(points, (p) => place(toward, p) - z + Math.max((Math.abs(place(right, p) - x) + skin) / wide, (Math.abs(place(up, p) - y) + skin) / half));
    this.camera.position.copy(this.orbit.target).addScaledVector(toward, away);
    this.orbit.update();
    this.camera.updateMatrixWorld(); // what asks where bodies are seen may come before the next picture
    this.ask();
  }

  beside() { return this.logs.length > 1 && element("layout").value === "beside"; }
  aspect() {
    const canvas = this.renderer.domElement;
    return canvas.clientWidth / (this.beside() ? 2 : 1) / Math.max(canvas.clientHeight, 1);
  }

  resize() {
    const canvas = this.renderer.domElement;
    this.renderer.setSize(canvas.parentElement.clientWidth, canvas.parentElement.clientHeight, false);
    this.camera.aspect = this.aspect();
    this.camera.updateProjectionMatrix();
    if (this.ghost) this.ghost.group.visible = !this.beside();
    this.scene_names.forEach((div, k) => {
      div.style.display = this.logs.length > 1 ? "" : "none";
      div.style.left = this.beside() ? `calc(${50 * k}% + 10px)` : "10px";
      div.style.top = this.beside() ? "8px" : `${8 + 34 * k}px`;
      div.textContent = this.logs[k].name + (!this.beside() && k ? " (pale)" : "");
    });
    this.recolour();
  }

  recolour() {
    this.quantity = element("colour").value;
    const mapped = this.quantity || Object.keys(this.quantities)[0] || "none";
    this.scale = scaleOf(this.logs, mapped);
    const { label, unit } = this.quantities[mapped] || { label: "nothing to show", unit: "" };
    this.plots.draw(mapped, this.scale, label, unit);
    element("legend").style.display = this.quantity ? "" : "none";
    element("legend-title").textContent = `${label}, ${unit}`;
    element("legend-low").textContent = "0";
    element("legend-high").textContent = "≥ " + d3.format(".3~g")(this.scale);
    const context = element("legend-bar").getContext("2d");
    d3.range(160).forEach((x) => {
      context.fillStyle = d3.interpolateViridis(x / 159);
      context.fillRect(x, 0, 1, 10);
    });
    this.seek(this.time);
  }

  play(on) {
    this.playing = on;
    if (on && this.time >= this.last) this.time = this.first;
    element("play").textContent = on ? "Pause" : "Play";
    this.before = null;
    if (on) requestAnimationFrame((now) => this.tick(now));
  }

  tick(now) {
    if (!this.playing) return;
    if (this.before !== null) this.seek(this.time + 1e-3 * (now - this.before) * element("speed").value);
    this.before = now;
    if (this.time >= this.last) this.play(false);
    else requestAnimationFrame((later) => this.tick(later));
  }

  /** Goes to a time, s. */
  seek(time) {
    this.time = Math.min(Math.max(time, this.first), this.last);
    this.shown = this.logs.map((log) => log.frameAt(this.time));
    const arrows = element("arrows").checked;
    element("arrow-words").style.display = arrows ? "" : "none";
    const show = (body, k, ghost) => {
      body.pose(this.shown[k]);
      body.paint(this.shown[k], this.quantity && !ghost ? this.logs[k].field(this.quantity) : null, this.scale);
      body.drawForces(this.shown[k], arrows && !ghost);
    };
    this.bodies.forEach((body, k) => { if (k === 0 || this.beside()) show(body, k, false); });
    if (this.ghost && !this.beside()) show(this.ghost, 1, true);
    element("scrub").value = this.longest().frameAt(this.time);
    element("now").textContent = this.words();
    this.plots.move(this.time);
    this.ask();
  }

  words() {
    const log = this.logs[0], f = this.shown[0], ends = [log.head_end[f], log.tail_end[f]];
    const knot = log.knotName(f), span = knot !== "no knot" && ends.every(Number.isFinite) ? `, ${ends[0].toFixed(1)} to ${ends[1].toFixed(1)} cm` : "";
    const [leads, trails, asked, travel] = Array.from(log.slide.slice(4 * f, 4 * f + 4), (cm) => cm.toFixed(1));
    const slid = Number.isFinite(log.slide[4 * f]) ? `; slide: head end ${leads} cm, tail end ${trails} of ${asked} that taper asks, curvature ${travel}` : "";
    return `t = ${log.time[f].toFixed(2)} s, ${log.phaseName(f)}, ${knot}${span}${slid}`;
  }

  /** Draws at the next chance: only what has changed is drawn. */
  ask() {
    if (this.asked) return;
    this.asked = true;
    requestAnimationFrame(() => this.render());
  }

  /** A bar as long as so many cm are seen in the middle of the view. */
  drawBar() {
    const away = this.camera.position.distanceTo(this.orbit.target), half = Math.tan(Math.PI / 180 * this.camera.fov / 2);
    const perCm = this.renderer.domElement.clientHeight / (2 * away * half), long = BARS.filter((cm) => cm * perCm <= LONGEST_BAR).pop() || BARS[0];
    element("bar").style.width = `${long * perCm}px`;
    element("bar").textContent = `${long} cm`;
  }

  render() {
    this.asked = false;
    this.drawBar();
    const canvas = this.renderer.domElement, width = canvas.clientWidth, height = canvas.clientHeight, parts = this.beside() ? 2 : 1;
    this.renderer.setScissorTest(false);
    this.renderer.clear();
    this.renderer.setScissorTest(true);
    for (let k = 0; k < parts; ++k) {
      this.renderer.setViewport(k * width / parts, 0, width / parts, height);
      this.renderer.setScissor(k * width / parts, 0, width / parts, height);
      this.renderer.render(this.scenes[k], this.camera);
    }
  }
}
