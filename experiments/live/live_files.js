"use strict";
// What goes out of the page and comes in: scene files, tables, pictures, replays, links.

/** Values of a scene file as the simulator writes it: { "table.key": text }. */
function valuesOf(toml) {
  const values = {};
  let table = "", open = null;
  for (const line of toml.split("\n")) {
    if (open) { // an array over several lines
      values[open] += line;
      if (line === "]") open = null;
      continue;
    }
    const heading = /^\[([^[\]]+)\]$/.exec(line), pair = /^([A-Za-z0-9_]+) = (.*)$/.exec(line);
    if (heading) table = heading[1] + ".";
    else if (line.startsWith("[[")) table = line + ".";
    else if (pair) {
      values[table + pair[1]] = pair[2];
      if (pair[2] === "[") open = table + pair[1];
    }
  }
  return values;
}

/** What was typed as TOML: a number as it is, anything else in quotes. */
function literal(typed) {
  const text = typed.trim();
  if (/^[+-]?(\d+(\.\d*)?|\.\d+)([eE][+-]?\d+)?$/.test(text) && Number.isFinite(Number(text))) return String(Number(text));
  if (text === "true" || text === "false") return text;
  return JSON.stringify(text).replace(/[\u007f-\uffff]/g, (c) => "\\u" + c.charCodeAt(0).toString(16).padStart(4, "0").replace(/^d[89a-f]../i, "fffd"));
}

async function through(bytes, stream) {
  return new Uint8Array(await new Response(new Blob([bytes]).stream().pipeThrough(stream)).arrayBuffer());
}
const base64 = (bytes) => {
  let text = "";
  for (let k = 0; k < bytes.length; k += 0x8000) text += String.fromCharCode(...bytes.subarray(k, k + 0x8000));
  return btoa(text);
};
const bytesOf = (text) => Uint8Array.from(atob(text), (c) => c.charCodeAt(0));

/** A scene as the part of an address after #; its text only where it is no built-in one. */
async function addressOf({ name, text, files, set }, texts) {
  const own = { n: name, s: set };
  if (texts[name] !== text) own.t = text;
  if (Object.keys(files).length) own.f = files;
  const packed = await through(new TextEncoder().encode(JSON.stringify(own)), new CompressionStream("deflate-raw"));
  return base64(packed).replace(/\+/g, "-").replace(/\//g, "_").replace(/=+$/, "");
}

/** The reverse; null where the address holds no scene. */
async function sceneOf(address, texts) {
  try {
    const packed = bytesOf(address.replace(/-/g, "+").replace(/_/g, "/"));
    const own = JSON.parse(new TextDecoder().decode(await through(packed, new DecompressionStream("deflate-raw"))));
    const text = own.t === undefined ? texts[own.n] : own.t, set = own.s, files = own.f || {};
    const texty = (list) => list.every((one) => typeof one === "string");
    if (!texty([own.n, text]) || !Array.isArray(set) || !texty(set) || !texty(Object.values(files))) return null;
    return { name: own.n, text, files, set };
  } catch (error) {
    return null;
  }
}

function download(name, content, type) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(content instanceof Blob ? content : new Blob([content], { type }));
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}

const UNITS = { cgs: { cm: [1, "cm"], dyn: [1, "dyn"], erg: [1, "erg"] }, si: { cm: [1e-2, "m"], dyn: [1e-5, "N"], erg: [1e-7, "J"] } };
const csv = (rows) => rows.map((row) => row.map((cell) => (typeof cell === "number" ? (Number.isFinite(cell) ? String(cell) : "") : cell)).join(",")).join("\n") + "\n";

/** The symbol of a knot in words, 0_1 of none. */
const symbolOf = (words) => (words === "no knot" ? "0_1" : words.split(", ").pop());

/** A row a frame: phase, knot, Eq. 6, forces, energy. */
function runTable(log, system) {
  const { cm, dyn, erg } = UNITS[system];
  const heading = ["time (s)", "phase", "knot", `head end of the knot (${cm[1]})`, `tail end (${cm[1]})`,
    ...EQ6.map((row) => `speed ${row.replace(",", "")} (${cm[1]}/s)`), ...EQ6.map((row) => `commanded ${row.replace(",", "")} (${cm[1]}/s)`),
    `clamp (${dyn[1]})`, `head plate (${dyn[1]})`, `your pull (${dyn[1]})`, ...ENERGY.map((name) => `${name} (${erg[1]})`)];
  const size = (values, f) => Math.hypot(values[f], values[f + 1], values[f + 2]);
  return csv([heading, ...d3.range(log.frames).map((f) => [log.time[f], log.phaseName(f), symbolOf(log.knotName(f)), cm[0] * log.head_end[f], cm[0] * log.tail_end[f],
    ...d3.range(4).map((k) => cm[0] * log.eq6.speed[4 * f + k]), ...d3.range(4).map((k) => cm[0] * log.eq6.command[4 * f + k]),
    dyn[0] * size(log.head, 6 * f), dyn[0] * log.plate_force[f], dyn[0] * size(log.hand, 3 * f), ...ENERGY.map((name) => erg[0] * log.energy[name][f])])]);
}

/** A row a frame and body: where its centre is. */
function shapeTable(log, system) {
  const [factor, unit] = UNITS[system].cm, rows = [["time (s)", "body", `x (${unit})`, `y (${unit})`, `z (${unit})`]];
  for (let f = 0; f < log.frames; ++f) {
    for (let b = 0; b < log.bodies; ++b) rows.push([log.time[f], b, ...d3.range(3).map((i) => factor * log.position[3 * (f * log.bodies + b) + i])]);
  }
  return csv(rows);
}

/** A page of `hagfish view` that replays the run so far. */
function replayPage(log) {
  const f4 = (values) => { const own = Float32Array.from(values); return { f4: base64(new Uint8Array(own.buffer)) }; };
  const u1 = (values) => ({ u1: base64(Uint8Array.from(values)) });
  const quantities = Object.fromEntries(Object.entries(log.quantities).filter(([, { values }]) => values.some((v) => v > 0))
    .map(([name, q]) => [name, { label: q.label, unit: q.unit, scale: q.scale, arc: q.arc, values: f4(q.values) }]));
  const data = {
    name: log.name, title: log.title, specimen: log.specimen, status: "run in a browser", plate: log.plate, obstacles: log.obstacles,
    animal: { length: log.animal.length, station: log.animal.station, radius: f4(log.animal.radius), arc: f4(log.animal.arc) },
    time: f4(log.time), phases: log.phases, knots: log.knots, phase: u1(log.phase), knot: u1(log.knot), clamped: u1(log.clamped),
    head_end: f4(log.head_end), tail_end: f4(log.tail_end), slide: f4(log.slide), position: f4(log.position), quantities,
    contacts: { first: { u4: base64(new Uint8Array(Uint32Array.from(log.first).buffer)) }, values: f4(log.contacts.values) },
    tip: f4(log.tip), hand: f4(log.hand), held: f4(log.held), head: f4(log.head), plate_force: f4(log.plate_force),
    eq6: Object.fromEntries(Object.entries(log.eq6).map(([name, values]) => [name, f4(values)])),
    energy: Object.fromEntries(Object.entries(log.energy).map(([name, values]) => [name, f4(values)])),
  };
  const script = (text) => `<script>${text}</` + "script>\n", parts = JSON.parse(REPLAY);
  const scripts = Array.from(document.querySelectorAll("script.replay"), (one) => script(one.textContent)).join("")
    + script("const LOGS=" + JSON.stringify([data]).replace(/</g, "\\u003c") + ";const viewer = new Viewer(LOGS.map((raw) => new Log(raw)));");
  return parts["page.html"].split("/*STYLE*/").join(parts["style.css"]).split("<!" + "--SCRIPTS-->").join(scripts);
}
