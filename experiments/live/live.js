"use strict";
// The page: a worker runs the scene, the viewer draws what comes, the panel changes it.

const QUANTITIES = { // name: what the colours mean, where along the body
  thigmotaxis: ["f_thigmo, bending", "dyn cm", "bending"],
  active: ["active torque, bending", "dyn cm", "bending"],
  curvature: ["curvature", "rad/cm", "bending"],
  twist: ["twist", "rad/cm", "twisting"],
  contact: ["contact force per length", "dyn/cm", "arc"],
};
const ENERGY = ["kinetic_energy", "elastic_energy", "work_tip", "work_active", "work_thigmotaxis", "dissipated"];
const LARGE_SHARE = 0.99; // of positive values are within the scale of the colours
const REDRAW = 400; // ms between two drawings of the plots while the scene runs
// Where the processor draws, it also steps: a picture that takes longer than LONG (ms) is followed by a rest of so many times that, unless the
// scene keeps up with its speed.
const LONG = 60, REST = 3, LONGEST_REST = 1000;

/** Numbers that grow in number: `values` is those so far. */
class Growing {
  constructor() { this.all = new Float32Array(1024); this.size = 0; this.values = this.all.subarray(0, 0); }
  add(more) {
    if (this.size + more.length > this.all.length) {
      const larger = new Float32Array(2 * (this.size + more.length));
      larger.set(this.all);
      this.all = larger;
    }
    this.all.set(more, this.size);
    this.size += more.length;
    this.values = this.all.subarray(0, this.size);
  }
}

/** A log, as the viewer has it, that grows as the scene runs. */
class LiveLog {
  constructor({ scene, animal, layout, obstacles, title, specimen, phases }) {
    Object.assign(this, { name: scene.name, obstacles, title, specimen, phases, layout, status: "runs" });
    this.frames = 0;
    this.bodies = animal.radius.length;
    this.animal = { length: animal.length[0], radius: animal.radius, arc: animal.arc, station: animal.station };
    this.plate = animal.wall[0] > 0;
    [this.step, this.interval, this.duration] = animal.clock;
    this.store = {};
    for (const [name] of layout) this.store[name] = new Growing();
    for (const name of ["head_end", "tail_end", "held", ...ENERGY]) this.store[name] = new Growing();
    this.touching = new Growing();
    this.first = [0];
    this.knots = ["no knot"];
    this.knot = [];
    this.quantities = {};
    for (const [name, [label, unit, along]] of Object.entries(QUANTITIES)) this.quantities[name] = { label, unit, arc: animal[along], scale: 1, values: [] };
    this.renew();
  }

  /** Adds frames as the worker sends them; `held` is the body that is pulled. */
  add({ count, frames, touching, counts, names }, held) {
    let at = 0;
    for (let f = 0; f < count; ++f) {
      for (const [name, size] of this.layout) {
        const row = frames.subarray(at, at + size);
        at += size;
        this.store[name].add(row);
        if (name === "knot") this.addKnot(names[row.join()]);
        if (name === "ends") { this.store.head_end.add([row[0]]); this.store.tail_end.add([row[1]]); }
        if (name === "energy") ENERGY.forEach((term, k) => this.store[term].add([row[k]]));
      }
      this.store.held.add([held]);
      this.first.push(this.first[this.first.length - 1] + counts[f]);
    }
    this.touching.add(touching);
    this.frames += count;
    this.renew();
  }

  addKnot(name) {
    if (!this.knots.includes(name)) this.knots.push(name);
    this.knot.push(this.knots.indexOf(name));
  }

  /** Shows what has come in under the names that a log has. */
  renew() {
    const of = (name) => this.store[name].values;
    for (const name of ["time", "position", "phase", "clamped", "head", "tip", "hand", "held", "head_end", "tail_end", "slide", "penetration"]) this[name] = of(name);
    this.plate_force = of("plate");
    this.eq6 = { speed: of("speed"), slack: of("slack"), lambda: of("lambda"), command: of("command") };
    this.energy = Object.fromEntries(ENERGY.map((name) => [name, of(name)]));
    this.contacts = { first: this.first, values: this.touching.values };
    for (const [name, quantity] of Object.entries(this.quantities)) quantity.values = of(name);
  }

  /** Sets the largest colour's value of each quantity. */
  rescale() {
    for (const quantity of Object.values(this.quantities)) {
      const some = [], { values } = quantity, stride = Math.max(1, Math.floor(values.length / 20000));
      for (let k = 0; k < values.length; k += stride) if (values[k] > 0) some.push(values[k]);
      some.sort((a, b) => a - b);
      quantity.scale = some.length ? some[Math.floor(LARGE_SHARE * (some.length - 1))] : 1;
    }
  }

  last() { return this.frames ? this.time[this.frames - 1] : 0; }
}
for (const name of ["frameAt", "phaseName", "knotName", "field"]) LiveLog.prototype[name] = Log.prototype[name];

class LiveViewer extends Viewer {
  constructor(log, ask) {
    super([log]);
    this.askWorker = ask;
    this.following = true;
    this.drawn = 0;
    this.pictures = 0;
    this.orbit.addEventListener("start", () => { this.turned = true; });
    element("speed").addEventListener("change", () => this.setSpeed());
    this.addPull();
  }

  kind() { return "live"; }
  speeds() { return [0.1, 0.25, 0.5, 1, 2, 4, 8, 20]; }
  setSpeed() { this.askWorker({ kind: "speed", value: Number(element("speed").value) }); }
  play(on) { this.askWorker({ kind: "play", on }); }

  key(event) {
    const { target } = event;
    if ((target.tagName === "INPUT" && target.type !== "range" && target.type !== "checkbox") || event.ctrlKey || event.altKey || event.metaKey) return;
    const own = { s: () => element("step").click(), n: () => element("restart").click(), p: () => this.pullTail() }[event.key];
    if (own && target.tagName !== "SELECT") { event.preventDefault(); own(); return; }
    const speed = element("speed").value;
    super.key(event);
    if (element("speed").value !== speed) this.setSpeed();
  }

  seek(time) {
    super.seek(time);
    this.following = this.time >= this.last - 1e-6;
  }

  /** Another scene. */
  adopt(log) {
    this.logs[0] = log;
    this.embody();
    this.first = this.last = this.time = 0;
    this.following = true;
    this.drawn = 0;
    this.tell();
    this.fresh = true;
  }

  /** Puts a body of the log as it is now in place of the one that there was. */
  embody() {
    const before = this.bodies[0];
    this.scenes[0].remove(before.group);
    before.geometry.dispose();
    this.bodies[0] = new Body(this.logs[0], false);
    this.scenes[0].add(this.bodies[0].group);
  }

  /** What changes with the animal's size. */
  remake() {
    this.embody();
    this.recolour();
  }

  tell() {
    const [log] = this.logs;
    element("title").textContent = log.title;
    element("about").textContent = `${log.specimen}, ${d3.format(".3~g")(log.animal.length)} cm, ${log.bodies} bodies, a step of ${d3.format(".3~g")(1e3 * log.step)} ms`;
    document.title = `hagfish live: ${log.title}`;
  }

  /** More frames have come. */
  grow(behind = false) {
    const [log] = this.logs;
    this.last = log.last();
    element("scrub").max = log.frames - 1;
    this.bodies[0].measure();
    if (this.fresh || !(this.turned || this.inSight())) this.resetView();
    this.fresh = false;
    if (this.following) this.time = this.last;
    const slow = behind && this.took > LONG;
    if (!slow) this.drawSoon();
    else if (!this.rest) this.rest = setTimeout(() => this.drawSoon(), Math.min(REST * this.took, LONGEST_REST));
  }

  drawSoon() {
    clearTimeout(this.rest);
    this.rest = 0;
    if (this.waiting) return;
    this.waiting = true;
    requestAnimationFrame(() => { this.waiting = false; this.showNow(); });
  }

  /** Whether the whole animal is, with its skin, in its last frame. */
  inSight() {
    const [log] = this.logs, perCm = 1 / Math.tan(Math.PI / 180 * this.camera.fov / 2);
    return log.animal.radius.every((radius, body) => {
      const place = this.centre(body), high = radius * perCm / place.distanceTo(this.camera.position), { x, y } = place.project(this.camera);
      return Math.abs(x) + high / this.camera.aspect <= 1 && Math.abs(y) + high <= 1;
    });
  }

  resetView() {
    super.resetView();
    this.turned = false;
  }

  /** A window of another shape shows the whole animal too, unless the view was turned. */
  resize() {
    const before = this.camera.aspect;
    super.resize();
    if (this.logs[0].frames && !this.turned && this.camera.aspect !== before) this.resetView();
  }

  /** Draws what there is: the body each time, the plots as often as leaves time for it. A scene that has only begun has nothing. */
  showNow() {
    if (!this.logs[0].frames) return;
    const begin = performance.now();
    if (this.running && begin - this.drawn < Math.max(REDRAW, 5 * (this.cost || 0))) {
      this.seek(this.following ? this.last : this.time);
      return;
    }
    this.logs[0].rescale();
    this.nameArrows();
    this.recolour();
    this.drawn = performance.now();
    this.cost = this.drawn - begin;
  }

  recolour() { if (this.logs[0].frames) super.recolour(); }

  /** Draws, and takes note of the time until the next picture could be: the drawing itself goes on elsewhere. */
  render() {
    const begin = performance.now();
    super.render();
    ++this.pictures;
    requestAnimationFrame(() => requestAnimationFrame(() => { this.took = performance.now() - begin; }));
  }

  words() {
    const [log] = this.logs, f = this.shown[0], hand = Math.hypot(log.hand[3 * f], log.hand[3 * f + 1], log.hand[3 * f + 2]);
    return super.words() + (hand > 0 ? `, you pull with ${d3.format(".3~g")(hand)} dyn` : "");
  }

  // A spring from the body to where the mouse or finger is, in the plane that faces the viewer.
  addPull() {
    const canvas = this.renderer.domElement;
    canvas.addEventListener("pointerdown", (event) => {
      const body = event.button === 0 && event.isPrimary ? this.bodyAt(event) : -1;
      if (body < 0) return;
      this.orbit.enabled = false;
      this.held = { body, at: this.centre(body) };
      canvas.setPointerCapture(event.pointerId);
      this.pullTo(event);
    }, true);
    canvas.addEventListener("pointermove", (event) => {
      if (this.held && !this.held.by) this.pullTo(event);
      else if (event.pointerType === "mouse" && !event.buttons) canvas.style.cursor = this.bodyAt(event) >= 0 ? "grab" : "";
    });
    for (const end of ["pointerup", "pointercancel"]) canvas.addEventListener(end, () => { if (this.held && !this.held.by) this.letGo(); });
  }

  centre(body) {
    const [log] = this.logs, at = 3 * (log.bodies * (log.frames - 1) + body);
    return new THREE.Vector3(log.position[at], log.position[at + 1], log.position[at + 2]);
  }

  /** The body nearest to the viewer under the pointer, or -1. */
  bodyAt(event) {
    const canvas = this.renderer.domElement, box = canvas.getBoundingClientRect(), [log] = this.logs;
    if (!log.frames || !this.following) return -1;
    const perCm = box.height / 2 / Math.tan(Math.PI / 180 * this.camera.fov / 2);
    let found = -1, nearest = Infinity;
    for (let body = 0; body < log.bodies; ++body) {
      const place = this.centre(body), away = place.distanceTo(this.camera.position);
      const seen = place.project(this.camera), x = box.left + (seen.x + 1) / 2 * box.width, y = box.top + (1 - seen.y) / 2 * box.height;
      const reach = Math.max(event.pointerType === "touch" ? 18 : 8, perCm / away * log.animal.radius[body]);
      if (Math.hypot(event.clientX - x, event.clientY - y) <= reach && away < nearest) { found = body; nearest = away; }
    }
    return found;
  }

  pullTo(event) {
    const canvas = this.renderer.domElement, box = canvas.getBoundingClientRect();
    const pointer = new THREE.Vector2(2 * (event.clientX - box.left) / box.width - 1, 1 - 2 * (event.clientY - box.top) / box.height);
    const ray = new THREE.Raycaster(), facing = new THREE.Plane();
    ray.setFromCamera(pointer, this.camera);
    facing.setFromNormalAndCoplanarPoint(this.camera.getWorldDirection(new THREE.Vector3()), this.held.at);
    const to = ray.ray.intersectPlane(facing, new THREE.Vector3());
    if (to) this.pull(this.held.body, to.toArray());
  }

  pull(body, to) {
    // As hard as the animal is strong: the largest force of a row of Eq. 6.
    const most = this.strength || 1000;
    this.held = Object.assign(this.held || {}, { body });
    this.askWorker({ kind: "pull", body, to, stiffness: most / 3, most });
    if (!this.running) this.play(true);
  }

  letGo() {
    this.held = null;
    this.orbit.enabled = true;
    this.askWorker({ kind: "letGo" });
  }

  /** By the keyboard: pulls the tail away from the head, or lets go. */
  pullTail() {
    if (this.held) { this.letGo(); return; }
    const [log] = this.logs, body = log.bodies - 1, tail = this.centre(body);
    this.held = { body, by: "key" };
    this.pull(body, tail.add(tail.clone().sub(this.centre(0)).setLength(6)).toArray());
  }
}
