"use strict";
// A log as typed arrays, and what the skin can be coloured by: values over frames and stations along the body.

const TYPES = { f4: Float32Array, u1: Uint8Array, u4: Uint32Array, i2: Int16Array };

/** The numbers of an array of view_data.hpp. */
function decode(packed) {
  const type = Object.keys(TYPES).find((name) => name in packed);
  const bytes = Uint8Array.from(atob(packed[type]), (c) => c.charCodeAt(0));
  const values = new TYPES[type](bytes.buffer);
  return type === "i2" ? Float32Array.from(values, (v) => (v === -32768 ? NaN : v * packed.scale)) : values;
}

/** Decodes every array of a log. */
function decodeAll(item) {
  if (item === null || typeof item !== "object" || Array.isArray(item)) return item;
  if (Object.keys(TYPES).some((name) => name in item)) return decode(item);
  return Object.fromEntries(Object.entries(item).map(([key, value]) => [key, decodeAll(value)]));
}

/** A log ready to be shown. */
class Log {
  constructor(raw) {
    Object.assign(this, decodeAll(raw));
    this.frames = this.time.length;
    this.bodies = this.animal.radius.length;
    this.hinges = this.animal.hinge_axis.length;
    this.made = new Map();
  }

  /** The frame nearest to a time, s. */
  frameAt(time) {
    const k = d3.bisectLeft(this.time, time);
    if (k <= 0) return 0;
    if (k >= this.frames) return this.frames - 1;
    return time - this.time[k - 1] < this.time[k] - time ? k - 1 : k;
  }

  phaseName(frame) { return this.phases[this.phase[frame]]; }
  knotName(frame) { return this.knots[this.knot[frame]]; }

  /** Values of a quantity: { arc: of its stations, cm; values: frames x stations }. */
  field(name) {
    if (!this.made.has(name)) this.made.set(name, QUANTITIES[name].of(this));
    return this.made.get(name);
  }
}

/** Size of what hinges have on each joint: bends about Y and Z together, or twist; over its length where `perLength`. */
function ofJoints(log, rows, twist, perLength) {
  const { hinge_axis: axis, hinge_arc: arc, hinge_span: span } = log.animal;
  const joints = [];
  for (let k = 0; k < log.hinges; ++k) {
    const last = joints[joints.length - 1];
    if ((axis[k] === 0) !== twist) continue;
    if (last && arc[last[0]] === arc[k]) last.push(k);
    else joints.push([k]);
  }
  const values = new Float32Array(log.frames * joints.length);
  for (let f = 0; f < log.frames; ++f) {
    joints.forEach((own, j) => {
      const size = Math.hypot(...own.map((k) => rows[f * log.hinges + k] || 0));
      values[f * joints.length + j] = perLength ? size / span[own[0]] : size;
    });
  }
  return { arc: joints.map((own) => arc[own[0]]), values };
}

const SPREAD = 0.5; // cm of body over which a contact's force is spread to be seen, standard deviation

/** Forces of contacts along the body, dyn/cm. */
function ofContacts(log) {
  const { first, values: contacts } = log.contacts;
  const arc = log.animal.arc, values = new Float32Array(log.frames * log.bodies);
  for (let f = 0; f < log.frames; ++f) {
    for (let c = first[f]; c < first[f + 1]; ++c) {
      for (const place of [contacts[9 * c + 7], contacts[9 * c + 8]]) {
        if (Number.isNaN(place)) continue; // the plate has no arc
        for (let b = 0; b < log.bodies; ++b) {
          const away = (arc[b] - place) / SPREAD;
          if (Math.abs(away) < 4) values[f * log.bodies + b] += contacts[9 * c + 6] * Math.exp(-away * away / 2) / (SPREAD * Math.sqrt(2 * Math.PI));
        }
      }
    }
  }
  return { arc: Array.from(arc), values };
}

const QUANTITIES = {
  thigmotaxis: { label: "f_thigmo, bending", unit: "dyn cm", of: (log) => ofJoints(log, log.thigmotaxis, false, false) },
  thigmotaxis_twist: { label: "f_thigmo, twisting", unit: "dyn cm", of: (log) => ofJoints(log, log.thigmotaxis, true, false) },
  active: { label: "active torque, bending", unit: "dyn cm", of: (log) => ofJoints(log, log.active || new Float32Array(log.frames * log.hinges), false, false) },
  curvature: { label: "curvature", unit: "rad/cm", of: (log) => ofJoints(log, log.angle, false, true) },
  twist: { label: "twist", unit: "rad/cm", of: (log) => ofJoints(log, log.angle, true, true) },
  contact: { label: "contact force per length", unit: "dyn/cm", of: ofContacts },
};

/** Quantities that some of the logs have. */
function quantitiesOf(logs) {
  return Object.keys(QUANTITIES).filter((name) => name !== "active" || logs.some((log) => log.active));
}

/** 0 to the value that one in a hundred of those above 0 exceeds, in all logs. */
function scaleOf(logs, name) {
  const some = [];
  for (const log of logs) {
    const { values } = log.field(name), stride = Math.max(1, Math.floor(values.length / 50000));
    for (let k = 0; k < values.length; k += stride) if (values[k] > 0) some.push(values[k]);
  }
  return some.length ? d3.quantile(Float64Array.from(some).sort(), 0.99) : 1;
}

/** 256 colours, told apart with any colour vision; red, green, blue from 0 to 1. */
const COLOURS = d3.range(256).map((k) => {
  const { r, g, b } = d3.rgb(d3.interpolateViridis(k / 255));
  return [r / 255, g / 255, b / 255];
});

function colourOf(value, scale) {
  const k = Math.round(255 * value / scale);
  return COLOURS[k > 0 ? Math.min(255, k) : 0];
}
