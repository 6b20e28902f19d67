"use strict";
// A log as typed arrays; what the skin can be coloured by, and how.

const TYPES = { f4: Float32Array, u1: Uint8Array, u4: Uint32Array, i2: Int16Array };

/** The numbers of an array of view_page.hpp. */
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
    this.quantities = this.quantities || {};
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

  /** Values of a quantity over frames and stations: { arc: of the stations, cm; values }; 0 where the log has none of it. */
  field(name) { return this.quantities[name] || { arc: [0, this.animal.length], values: new Float32Array(2 * this.frames) }; }
}

/** { name: { label, unit } } of all that some of the logs have. */
function quantitiesOf(logs) { return Object.assign({}, ...logs.map((log) => log.quantities)); }

/** The largest colour's value for all logs. */
const scaleOf = (logs, name) => d3.max(logs, (log) => log.quantities[name] ? log.quantities[name].scale : 0) || 1;

/** 256 colours, told apart with any colour vision; red, green, blue from 0 to 1. */
const COLOURS = d3.range(256).map((k) => {
  const { r, g, b } = d3.rgb(d3.interpolateViridis(k / 255));
  return [r / 255, g / 255, b / 255];
});

function colourOf(value, scale) {
  const k = Math.round(255 * value / scale);
  return COLOURS[k > 0 ? Math.min(255, k) : 0];
}
