"use strict";
// In a worker of the page: runs the scene, and sends what is to be drawn. After simulator.js.

/** Arrays of a frame that the page gets, in one row of 32-bit floats; `contacts`, of any number, apart. */
const SENT = ["time", "position", "phase", "knot", "clamped", "ends", "slide", "penetration", "head", "plate", "tip", "hand", "speed", "slack", "lambda",
  "command", "energy", "thigmotaxis", "active", "curvature", "twist", "contact"];
const ANIMAL = ["length", "radius", "arc", "bending", "twisting", "station", "wall", "clock"];
const SLICE = 0.02; // s for which it steps before it looks at what the page asks
const BATCH = 8; // steps between two looks at the clock
const LONG_FRAME = 1000; // steps to the next frame for which a change does not wait
const PICTURE = 1 / 60; // s from one picture to the next: at low speeds, frames come as often
const next = new MessageChannel(); // a timer of no time waits 4 ms all the same
next.port1.onmessage = ({ data }) => { if (data === turn) loop(); };
const clock = () => performance.now() / 1e3;

let compiled, runner, checker, scene, digest;
let playing = false, over = false, behind = false, speed = 1, due = 0, before = 0, taken = 0, timer = 0, turn = 0;
let sent = false; // and the page has not taken it yet
let rows = [], contacts = [], counts = [], names = {};

const stepsPerFrame = () => { const [step, interval] = runner.array("clock"); return Math.round(interval / step); };

/** Puts the present state among what is sent next. */
function takeFrame() {
  runner.calls.live_frame();
  over = runner.array("over")[0] > 0;
  if (taken % stepsPerFrame() === 0) digest.add(runner.array("q"));
  for (const name of SENT) rows.push(new Float32Array(runner.array(name)));
  const type = Array.from(runner.array("knot"));
  if (!names[type.join()]) names[type.join()] = runner.text("knot_words", ...type);
  const own = new Float32Array(runner.array("contacts"));
  contacts.push(own);
  counts.push(own.length / 9);
}

function joined(parts) {
  const all = new Float32Array(parts.reduce((size, part) => size + part.length, 0));
  let at = 0;
  for (const part of parts) { all.set(part, at); at += part.length; }
  return all;
}

/** Sends the frames so far. Of an instance that has ended nothing is asked. */
function send(ended = false) {
  if (!counts.length || (sent && !ended)) return;
  sent = true;
  const frames = joined(rows), touching = joined(contacts), warnings = ended ? "" : runner.text("warnings");
  postMessage({ kind: "frames", count: counts.length, frames, touching, counts, names, digest: digest.text(), over, behind, warnings }, [frames.buffer, touching.buffer]);
  rows = []; contacts = []; counts = [];
}

/** Takes `count` steps and then a frame; fewer where the scene is over, or there is no time left before `end` (s). */
function advance(count, end = Infinity) {
  let done = 0;
  while (done < count) {
    const wanted = Math.min(BATCH, count - done), some = runner.calls.live_advance(wanted);
    done += some;
    if (some < wanted) break;
    if (clock() > end) break;
  }
  taken += done;
  if (done > 0) takeFrame();
  return done;
}

/** Whether a scene can be: on an instance of its own, which an error ends. */
async function check(wanted) {
  try {
    checker = checker || await Simulator.create(compiled, clock);
    checker.start(wanted);
    return true;
  } catch (error) {
    refuse("setting", checker, error);
    checker = null;
    return false;
  }
}

function refuse(what, simulator, error) {
  postMessage({ kind: "refused", what, text: (simulator && simulator.error) || `the simulator ended: ${error.message}` });
}

/** A step that could not be taken ends the instance. */
function fail(error) {
  play(false);
  send(true);
  refuse("run", runner, error);
  runner = null;
}
async function start(wanted) {
  play(false);
  if (!await check(wanted)) return;
  scene = wanted;
  runner = await Simulator.create(compiled, clock);
  runner.start(scene);
  taken = 0; due = 0; over = sent = false;
  digest = new Digest();
  rows = []; contacts = []; counts = [];
  runner.calls.live_animal();
  runner.calls.live_frame();
  const animal = Object.fromEntries(ANIMAL.map((name) => [name, Array.from(runner.array(name))]));
  postMessage({ kind: "started", scene, animal, layout: SENT.map((name) => [name, runner.array(name).length]), obstacles: JSON.parse(runner.text("obstacles")), title: runner.text("title"), specimen: runner.text("specimen"), phases: runner.lines("phases"), toml: runner.text("toml") });
  takeFrame();
  send();
}

/** Goes on with other settings, from the next frame on. */
async function change(wanted) {
  if (!await check(wanted)) return;
  if (!runner) { start(wanted); return; }
  try {
    const rest = (stepsPerFrame() - taken % stepsPerFrame()) % stepsPerFrame();
    if (rest > LONG_FRAME) { await start(wanted); return; }
    if (rest) advance(rest);
    const [step] = runner.array("clock"), time = taken * step;
    runner.change(wanted);
    runner.calls.live_animal();
    taken = Math.round(time / runner.array("clock")[0]);
    over = false;
    scene = wanted;
    send();
    postMessage({ kind: "changed", scene, toml: runner.text("toml"), animal: Object.fromEntries(ANIMAL.map((name) => [name, Array.from(runner.array(name))])) });
  } catch (error) { fail(error); }
}

/** Steps as many as the clock and the speed ask for, as far as there is time. */
function loop() {
  timer = 0;
  if (!playing || !runner) return;
  try {
    const now = clock(), [step] = runner.array("clock");
    // What cannot be kept up with is left out.
    due += (now - before) * speed;
    behind = due > speed * 0.1 + 0.02;
    if (behind) due = speed * 0.1 + 0.02;
    before = now;
    const whole = stepsPerFrame(), most = Math.max(1, Math.min(whole, Math.round(speed * PICTURE / step)));
    while (due >= step && clock() - now < SLICE && !over) {
      // On to the next frame at most, so that frames stay where they are.
      const count = Math.min(most, whole - taken % whole);
      if (due < Math.min(count, BATCH) * step) break;
      due -= step * advance(count, now + SLICE);
    }
    send();
    if (over) { play(false); return; }
    if (due >= step * most) next.port2.postMessage(turn);
    else timer = setTimeout(loop, 1e3 * PICTURE / 2);
  } catch (error) { fail(error); }
}

function play(on) {
  playing = on && runner && !over;
  if (timer) clearTimeout(timer);
  timer = 0;
  ++turn;
  behind = false;
  postMessage({ kind: "playing", on: Boolean(playing) });
  if (playing) { before = clock(); due = 0; timer = setTimeout(loop, 0); }
}

const asked = {
  got: () => { sent = false; if (!playing && runner) send(); },
  start: ({ scene: wanted }) => start(wanted),
  change: ({ scene: wanted }) => change(wanted),
  play: ({ on }) => play(on),
  speed: ({ value }) => { speed = value; due = 0; },
  step: () => {
    play(false);
    if (!runner || over) return;
    try { advance(1); send(); } catch (error) { fail(error); }
  },
  pull: ({ body, to, stiffness, most }) => { if (runner) runner.calls.live_pull(body, ...to, stiffness, most); },
  letGo: () => { if (runner) runner.calls.live_let_go(); },
};

// One after another, as some take time.
let queue = Promise.resolve();
onmessage = ({ data }) => {
  if (data.kind === "begin") {
    queue = queue.then(async () => {
      compiled = await WebAssembly.compile(data.bytes);
      checker = await Simulator.create(compiled, clock);
      const names = checker.lines("scenes");
      postMessage({ kind: "ready", names, texts: Object.fromEntries(names.map((name) => [name, checker.builtin(name + ".toml")])) });
    });
    return;
  }
  queue = queue.then(() => asked[data.kind](data)).catch((error) => refuse("run", runner, error));
};
