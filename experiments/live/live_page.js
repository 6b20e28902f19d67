"use strict";
// The panel and what happens at the start.

const MOST_FRAMES = 20000; // some 4 kB each
const PATIENCE = 20000; // ms that the simulator may take to answer
const FIRST_SCENE = "reflex_overhand";
const SPEED_ROWS = ["slide_head", "slide_tail"].flatMap((end) => ["a", "b"].map((strand) => `controller.${end}.${strand}`));
const LAWS = ["paper", "all_contacts", "knot_speed", "muscles", "reflex", "reflex_muscles"];

const reflexive = (v) => /^"reflex/.test(v["controller.law"]); // without rows of Eq. 6

/**
 * What can be changed: the key of the scene that is shown, and what a typed value sets. `again`: the scene has to start
 * again, since it is of another number of bodies.
 */
const FIELDS = [
  { group: "Body" },
  { key: "model.bending_stiffness", words: "stiffness, bending", unit: "dyn cm²", when: (v) => v["model.passive"] === '"scene"' },
  { key: "model.twist_stiffness", words: "stiffness, twist", unit: "dyn cm²", when: (v) => v["model.passive"] === '"scene"' },
  { key: "specimen.passive.bending_stiffness", words: "stiffness, bending", unit: "dyn cm²", list: true, when: (v) => v["model.passive"] !== '"scene"' },
  { key: "specimen.length", words: "length", unit: "cm" },
  { key: "specimen.circumference", words: "girth, where thickest", unit: "cm", list: true },
  { key: "model.limit_scale", words: "joint limits, times" },
  { key: "model.bodies", words: "bodies (starts again)", again: true },
  { group: "Water" },
  { key: "drag.normal", words: "drag, across", unit: "g/(s cm)" },
  { key: "drag.tangential", words: "drag, along", unit: "g/(s cm)" },
  { group: "What it does" },
  { key: "controller.law", words: "control law", choices: LAWS },
  { key: "controller.reflex.shift", words: "reflex: Δ", unit: "cm", when: reflexive },
  { key: "controller.slide_head.a", words: "sliding speed", unit: "cm/s", sets: SPEED_ROWS, when: (v) => !reflexive(v) },
  { key: "controller.cap", words: "largest sliding force at a contact", unit: "dyn", when: (v) => !reflexive(v) },
  { key: "controller.contact_patch", words: "width of a contact (0: a point)", unit: "cm", when: (v) => !reflexive(v) },
  { key: "active.stiffness", words: "muscles' stiffness", unit: "dyn cm²" },
  { key: "active.capacity", words: "muscles' largest torque", unit: "dyn cm" },
  { group: "Time" },
  { key: "time.step", words: "time step", unit: "s" },
  { key: "time.duration", words: "end", unit: "s" },
];

const number = (text) => { const x = Number(text); return Number.isFinite(x) ? x : NaN; };
/** The largest of an array of numbers in TOML. */
const largestOf = (text) => Math.max(...text.slice(1, -1).split(",").map(Number));

class Page {
  /** `make` makes a worker, `bytes` is the simulator. */
  constructor(make, bytes) {
    Object.assign(this, { make, bytes });
    this.settings = new Map();
    this.accepted = [];
    this.renew();
    setInterval(() => this.watch(), 1000);
    this.heard = {
      ready: (data) => this.ready(data),
      started: (data) => this.started(data),
      changed: (data) => this.changed(data),
      frames: (data) => this.frames(data),
      playing: ({ on }) => this.playing(on),
      refused: (data) => this.refused(data),
    };
  }

  ask(message) {
    if (message.kind === "start" || message.kind === "change") this.pending = performance.now();
    this.worker.postMessage(message);
  }

  /** A fresh worker in place of the one that there was. */
  renew() {
    if (this.worker) this.worker.terminate();
    this.worker = this.make();
    this.worker.onmessage = ({ data }) => {
      if (["started", "changed", "refused"].includes(data.kind)) this.pending = 0;
      this.heard[data.kind](data);
    };
    this.worker.onerror = (event) => this.say(`the simulator cannot run here: ${event.message || "no worker, or no WebAssembly with vector instructions"}`);
    const bytes = this.bytes.slice();
    this.worker.postMessage({ kind: "begin", bytes }, [bytes.buffer]);
  }

  /** Some settings make a step that takes for ever: then a fresh simulator starts, the second time without them. */
  watch() {
    if (!this.pending || performance.now() - this.pending < PATIENCE) return;
    this.pending = 0;
    if (this.late) {
      this.settings.clear();
      Object.assign(this, { name: FIRST_SCENE, text: this.texts[FIRST_SCENE], files: {} });
    }
    this.late = !this.late;
    this.renew();
  }

  async ready({ names, texts }) {
    if (this.texts) { // a fresh worker
      this.restart();
      this.say("the simulator did not answer for too long, and was started again");
      return;
    }
    this.texts = texts;
    for (const name of names) element("scenes").add(new Option(name, name));
    this.addControls();
    const given = location.hash.length > 1 ? await sceneOf(location.hash.slice(1), texts) : null;
    if (given) this.take(given);
    else this.choose(FIRST_SCENE, []);
    if (location.hash.length > 1 && !given) this.say("the address holds no scene that can be read: here is the first one instead");
  }

  /** A built-in scene. */
  choose(name, set) { this.take({ name, text: this.texts[name], files: {}, set }); }

  /** Any scene. */
  take({ name, text, files, set }) {
    Object.assign(this, { name, text, files });
    this.settings = new Map(set.map((one) => { const at = one.indexOf("="); return [one.slice(0, at), one.slice(at + 1)]; }));
    this.restart();
  }

  scene() { return { name: this.name, text: this.text, files: this.files, set: Array.from(this.settings, ([key, value]) => `${key}=${value}`) }; }
  restart() {
    this.silent();
    this.ask({ kind: "start", scene: this.scene() });
  }

  started(data) {
    this.log = new LiveLog(data);
    this.late = this.over = false;
    this.starts = (this.starts || 0) + 1;
    this.remember(data);
    if (!this.viewer) {
      this.log.add(EMPTY_FRAME(this.log), 0);
      this.viewer = new LiveViewer(this.log, (message) => this.ask(message));
      window.viewer = this.viewer;
      this.log = new LiveLog(data);
    }
    this.viewer.running = false;
    // Of an animal without muscles, what the paper shows.
    if (this.name !== this.coloured) element("colour").value = number(this.values["active.stiffness"]) > 0 ? "active" : "thigmotaxis";
    this.coloured = this.name;
    this.viewer.adopt(this.log);
    this.viewer.strength = number(this.values["controller.cap"]);
    this.viewer.setSpeed();
    const found = Array.from(element("scenes").options).some((one) => one.value === this.name);
    if (!found) element("scenes").add(new Option(this.name, this.name));
    element("scenes").value = this.name;
    element("play").disabled = false;
    this.begun = performance.now();
    if (this.wantsPlay === undefined) this.wantsPlay = !matchMedia("(prefers-reduced-motion: reduce)").matches;
    if (this.wantsPlay) this.ask({ kind: "play", on: true });
  }

  changed(data) {
    this.silent();
    this.remember(data);
    const log = this.viewer.logs[0], { animal } = data;
    Object.assign(log.animal, { length: animal.length[0], radius: animal.radius, arc: animal.arc });
    for (const [name, [, , along]] of Object.entries(QUANTITIES)) log.quantities[name].arc = animal[along];
    [log.step, log.interval, log.duration] = animal.clock;
    this.viewer.strength = number(this.values["controller.cap"]);
    this.viewer.remake();
    this.viewer.tell();
  }

  remember({ scene, toml }) {
    this.toml = toml;
    this.values = valuesOf(toml);
    this.accepted = scene.set;
    this.showFields();
  }

  frames(data) {
    this.log.add(data, this.viewer.held ? this.viewer.held.body : 0);
    this.ask({ kind: "got" });
    this.digest = data.digest;
    this.over = data.over;
    if (data.warnings) this.say(data.warnings.trim().split("\n").pop());
    this.viewer.grow(data.behind);
    if (this.log.frames > MOST_FRAMES) {
      this.ask({ kind: "play", on: false });
      this.say(`${MOST_FRAMES} frames are kept, and no more: save what you need, and restart`);
    }
    if (this.trying) this.trying.watch();
  }

  playing(on) {
    if (!this.viewer) return;
    this.viewer.running = on;
    this.viewer.playing = on;
    element("play").textContent = on ? "Pause" : "Play";
    if (!on && this.log.frames) this.viewer.grow();
  }

  say(text) {
    element("message").textContent = text;
    element("message").hidden = false;
  }
  silent() { element("message").hidden = true; }

  /** A line of the simulator's. What was running goes on where a setting was refused. */
  refused({ what, text }) {
    this.say(what === "setting" ? text : `${text}. Restart, or change something and restart.`);
    if (what !== "setting") return;
    this.bad = true;
    for (const input of element("fields").querySelectorAll("[data-typed]")) input.setAttribute("aria-invalid", "true");
    this.settings = new Map(this.accepted.map((one) => { const at = one.indexOf("="); return [one.slice(0, at), one.slice(at + 1)]; }));
  }

  /** Sets keys of the scene to texts in TOML. */
  set(pairs, again = false) {
    for (const [key, value] of pairs) this.settings.set(key, value);
    this.silent();
    this.ask({ kind: again ? "start" : "change", scene: this.scene() });
  }

  addControls() {
    element("scenes").addEventListener("change", () => { this.stopTrying(); this.choose(element("scenes").value, []); });
    element("step").addEventListener("click", () => this.ask({ kind: "step" }));
    element("restart").addEventListener("click", () => this.restart());
    element("play").addEventListener("click", () => { this.wantsPlay = element("play").textContent === "Play"; });
    element("unset").addEventListener("click", () => { this.settings.clear(); this.restart(); });
    this.makeFields();
    this.makeTries();
    const stem = () => this.name.replace(/\.toml$/, "");
    element("save-scene").addEventListener("click", () => download(`${stem()}_live.toml`, this.toml, "application/toml"));
    element("save-run").addEventListener("click", () => download(`${stem()}_run.csv`, runTable(this.log, element("units").value), "text/csv"));
    element("save-shape").addEventListener("click", () => download(`${stem()}_shape.csv`, shapeTable(this.log, element("units").value), "text/csv"));
    element("save-replay").addEventListener("click", () => { this.log.rescale(); download(`${stem()}.html`, replayPage(this.log), "text/html"); });
    element("save-picture").addEventListener("click", () => {
      this.viewer.render();
      this.viewer.renderer.domElement.toBlob((blob) => download(`${stem()}.png`, blob));
    });
    element("link").addEventListener("click", () => this.link());
    element("file").addEventListener("change", () => this.open(element("file").files[0]));
    document.addEventListener("dragover", (event) => { event.preventDefault(); document.body.classList.add("dropping"); });
    document.addEventListener("dragleave", () => document.body.classList.remove("dropping"));
    document.addEventListener("drop", (event) => {
      event.preventDefault();
      document.body.classList.remove("dropping");
      if (event.dataTransfer.files.length) this.open(event.dataTransfer.files[0]);
    });
    addEventListener("hashchange", async () => {
      const given = await sceneOf(location.hash.slice(1), this.texts);
      if (given) this.take(given);
      else if (location.hash.length > 1) this.say("the address holds no scene that can be read");
    });
  }

  async link() {
    history.replaceState(null, "", "#" + await addressOf(this.scene(), this.texts));
    element("address-label").hidden = false;
    element("address").value = location.href;
    element("address").select();
    if (navigator.clipboard) navigator.clipboard.writeText(location.href).catch(() => {});
    return location.href;
  }

  /** A scene, a specimen or a program. */
  async open(file) {
    if (!file) return;
    if (file.size > 1 << 20) { this.say(`${file.name}: is larger than 1 MiB`); return; }
    const text = await file.text(), name = file.name;
    this.stopTrying();
    if (name.endsWith(".csv")) {
      this.files = { ...this.files, [name]: text };
      this.set([["script.kind", '"curvature"'], ["script.program", literal(name)]], true);
    } else if (/^\s*circumference\s*=/m.test(text) && !/^\s*\[specimen\]/m.test(text)) {
      this.files = { ...this.files, [name]: text };
      this.set([["specimen", literal(name)]], true);
    } else {
      this.take({ name, text, files: {}, set: [] });
    }
  }

  makeFields() {
    const form = element("fields");
    form.addEventListener("submit", (event) => event.preventDefault());
    for (const field of FIELDS) {
      if (field.group) {
        const heading = form.appendChild(document.createElement("div"));
        heading.className = "group";
        heading.textContent = field.group;
        continue;
      }
      const label = form.appendChild(document.createElement("label")), words = label.appendChild(document.createElement("span"));
      words.textContent = field.words;
      const input = label.appendChild(document.createElement(field.choices ? "select" : "input"));
      if (field.choices) for (const one of field.choices) input.add(new Option(one, one));
      else { input.type = "text"; input.inputMode = "decimal"; input.autocomplete = "off"; }
      input.dataset.key = field.key;
      label.appendChild(document.createElement("span")).textContent = field.unit || "";
      label.lastChild.className = "unit";
      input.addEventListener("change", () => this.typed(field, input));
      Object.assign(field, { input, label });
    }
  }

  /** The present values, but for one that was refused. */
  showFields() {
    for (const field of FIELDS) {
      if (!field.input) continue;
      const own = this.values[field.key], there = own !== undefined && (!field.when || field.when(this.values));
      field.label.style.display = there ? "contents" : "none";
      if (!there) continue;
      const shown = field.list ? String(largestOf(own)) : own.replace(/^"|"$/g, "");
      field.input.value = /^[\d.e+-]+$/.test(shown) ? String(Number(shown)) : shown;
      field.input.removeAttribute("aria-invalid");
      delete field.input.dataset.typed;
      field.label.firstChild.className = (field.sets || [field.key]).some((key) => this.settings.has(key)) ? "set" : "";
    }
  }

  typed(field, input) {
    input.dataset.typed = "yes";
    if (/\d,\d/.test(input.value)) { // in some languages decimals, in others thousands
      this.heard.refused({ what: "setting", text: `${field.words} ${input.value}: has a comma; decimals follow a point, as in 0.5` });
      return;
    }
    let value = literal(input.value);
    if (field.list && !value.startsWith('"')) { // the whole list by one factor; of nothing but 0 the same everywhere
      const before = this.values[field.key], largest = largestOf(before);
      value = `[${before.slice(1, -1).split(",").map((x) => literal(String(largest > 0 ? Number(x) * (Number(value) / largest) : Number(value)))).join(", ")}]`;
    }
    this.set((field.sets || [field.key]).map((key) => [key, value]), field.again);
  }

  // Guided steps.
  makeTries() {
    TRIES.forEach((one, k) => {
      const button = element("tries").appendChild(document.createElement("li")).appendChild(document.createElement("button"));
      button.textContent = one.words;
      button.addEventListener("click", () => this.tryOut(k, button));
    });
  }

  stopTrying() {
    this.trying = null;
    for (const button of element("tries").querySelectorAll("button")) button.removeAttribute("aria-current");
    element("try-words").textContent = "";
  }

  tryOut(k, button) {
    this.stopTrying();
    button.setAttribute("aria-current", "true");
    this.wantsPlay = true;
    const one = TRIES[k], words = (text) => { element("try-words").textContent = text; };
    const tied = () => this.log.frames > 0 && this.log.phaseName(this.log.frames - 1) === "slide";
    const act = () => { if (one.act) one.act(this); words(one.then); };
    element("speed").value = String(one.speed);
    if (one.goesOn && this.name === one.scene && tied() && !this.over) {
      this.viewer.setSpeed();
      act();
      this.ask({ kind: "play", on: true });
      return;
    }
    words(one.first);
    this.choose(one.scene, one.set || []);
    if (!one.goesOn) return;
    const page = this;
    this.trying = { watch() { if (tied()) { page.trying = null; act(); } } };
  }
}

const TRIES = [
  { words: "1. A knot ties itself", scene: "living_overhand", speed: 4,
    first: "The animal's own torques bend it into an overhand knot. Watch “no knot” become “overhand, 3_1” at about 9 s. Then the knot slides: both of its ends and the bends of the body go to the head." },
  { words: "2. Slide it by one number", scene: "reflex_overhand", speed: 4, goesOn: true,
    first: "First it ties the knot. Then every joint copies the bend of its neighbour, a little behind it.",
    then: "Now only the reflex acts: each joint copies the bend Δ behind it, and the knot slides to the head. Δ is now twice what it was.",
    act: (page) => page.set([["controller.reflex.shift", literal(String(2 * number(page.values["controller.reflex.shift"])))]]) },
  { words: "3. Knock the reflex out", scene: "reflex_overhand", speed: 4, goesOn: true,
    first: "First it ties the knot. Then the reflex is taken away.",
    then: "Δ is now next to nothing: no joint copies its neighbour. The knot slips back a little, and then stays where it is.",
    act: (page) => page.set([["controller.reflex.shift", "1e-9"]]) },
  { words: "4. Make the neck stiffer", scene: "reflex_overhand", speed: 4, goesOn: true,
    first: "First it ties the knot. Then the first fifth of the body becomes four times as stiff.",
    then: "The first fifth of the body is now four times as stiff. The knot slides on, but the joints near the head need more torque. A message tells where it is more than the muscles have.",
    act: (page) => {
      const list = page.values["specimen.passive.bending_stiffness"].slice(1, -1).split(",").map(Number);
      page.set([["specimen.passive.bending_stiffness", `[${list.map((x, k) => literal(String(k === 0 ? 4 * x : x))).join(", ")}]`]]);
    } },
  { words: "5. Pull it off", scene: "table1", speed: 1, goesOn: true,
    first: "First the script ties the knot, at the speed of the film.",
    then: "Pull now: drag the body with the mouse or a finger, or press p to pull the tail. The arrow shows your spring's force." },
];

/** One frame of nothing, for the viewer to begin with. */
function EMPTY_FRAME(log) {
  const size = log.layout.reduce((sum, [, own]) => sum + own, 0), frames = new Float32Array(size);
  return { count: 1, frames, touching: new Float32Array(0), counts: [0], names: { "0,0": "no knot" } };
}

/** The part of the page that is neither script nor style: what the worker runs, and the simulator itself. */
async function begin() {
  const code = element("worker").textContent;
  const address = URL.createObjectURL(new Blob([code], { type: "text/javascript" }));
  const bytes = await through(bytesOf(element("simulator").textContent), new DecompressionStream("gzip"));
  window.page = new Page(() => new Worker(address), bytes);
}
begin().catch((error) => {
  element("about").textContent = `This browser cannot run the simulator: ${error.message}`;
});
