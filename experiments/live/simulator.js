"use strict";
// The simulator in WebAssembly: an instance of it for one scene after another. Also run by node (digest.mjs).

const encoder = new TextEncoder();

/** What a scene is made of: { name, text, files: { name: text }, set: ["KEY=VALUE"] }. */
class Simulator {
  /** An instance of a compiled module. `clock` gives seconds. */
  static async create(module, clock) {
    const simulator = new Simulator();
    const decode = (at, size) => new TextDecoder().decode(new Uint8Array(simulator.memory.buffer, at, size));
    const live = {
      failed: (at, size) => {
        simulator.error = decode(at, size);
        throw new Error(simulator.error);
      },
    };
    // Of the system, the simulator asks for the time, to say how long its QPs take.
    const system = new Proxy({}, {
      get: (_, name) => (name === "clock_time_get"
        ? (_id, _precision, at) => { new DataView(simulator.memory.buffer).setBigUint64(at, BigInt(Math.round(1e9 * clock())), true); return 0; }
        : () => 0),
    });
    const needed = {};
    for (const { module: from, name } of WebAssembly.Module.imports(module)) {
      needed[from] = needed[from] || {};
      needed[from][name] = (from === "live" ? live : system)[name];
    }
    const instance = await WebAssembly.instantiate(module, needed);
    simulator.calls = instance.exports;
    simulator.memory = instance.exports.memory;
    simulator.calls._initialize();
    return simulator;
  }

  /** Calls `live_name` with a text, which may be empty. */
  give(name, text) {
    const bytes = encoder.encode(text);
    const at = this.calls.live_text(bytes.length);
    new Uint8Array(this.memory.buffer, at, bytes.length).set(bytes);
    return this.calls["live_" + name]();
  }

  read(at) {
    const bytes = new Uint8Array(this.memory.buffer, at);
    return new TextDecoder().decode(bytes.subarray(0, bytes.indexOf(0)));
  }

  /** The text that a call gives. */
  text(name, ...numbers) { return this.read(this.calls["live_" + name](...numbers)); }
  builtin(file) { return this.read(this.give("builtin", file)); }
  lines(name) { return this.text(name).trim().split("\n"); }

  /** Sets the scene: `live_start` or `live_change` takes it. */
  scene({ name, text, files, set }) {
    this.give("name", name);
    this.give("base", text);
    for (const [file, content] of Object.entries(files || {})) {
      this.give("file_name", file);
      this.give("file", content);
    }
    for (const one of set) this.give("set", one);
  }

  start(scene) { this.scene(scene); this.calls.live_start(); }
  change(scene) { this.scene(scene); this.calls.live_change(); }

  /** A view of an array, good until the next call. */
  array(name) {
    const at = this.give("array", name);
    return new Float64Array(this.memory.buffer, at, this.calls.live_array_size());
  }
}

/** A number of 64 bits that any bit of any frame changes: of 32-bit words, in order. digest.cpp has the same. */
class Digest {
  constructor() { this.a = 2166136261; this.b = 374761393; this.frames = 0; }
  add(array) {
    ++this.frames;
    const words = new Uint32Array(array.buffer, array.byteOffset, array.byteLength / 4);
    for (const word of words) {
      this.a = Math.imul(this.a ^ word, 16777619);
      this.b = Math.imul(this.b ^ word, 2246822519);
      this.b = (this.b << 13) | (this.b >>> 19);
    }
  }
  text() { return [this.a, this.b].map((x) => (x >>> 0).toString(16).padStart(8, "0")).join("") + ` of ${this.frames} frames`; }
}

if (typeof module !== "undefined") module.exports = { Simulator, Digest };
