"use strict";
// Plots over time with one cursor: the quantity along the body, knot and phase, Eq. 6, forces at the head, energy.

const LEFT = 76, RIGHT = 14, TOP = 8, BOTTOM = 22, INK = ["#0072b2", "#d55e00", "var(--ink)", "#cc79a7", "#e69f00", "#56b4e9"];
const DASHES = ["", "6 3", "2 3", "8 3 2 3", "1 3", "12 4"]; // so that no line is told by its colour alone
const PHASE_INK = { form: "#e8e8e8", tighten: "#c9dff0", slide: "#f6dfb5", release: "#dddddd", free: "#f4f4f4", reverse: "#e6d3e3", pull: "#f2c4bb" };

/** Stretches of frames with one name. */
function stretches(log, nameAt) {
  const found = [];
  for (let f = 0; f < log.frames; ++f) {
    const name = nameAt(f), last = found[found.length - 1];
    if (last && last.name === name) last.to = log.time[f];
    else {
      if (last) last.to = log.time[f];
      found.push({ name, from: log.time[f], to: log.time[f] });
    }
  }
  return found;
}

/** One strip of the page: words that wrap, and an SVG over a canvas, with the time axis that all share. */
class Plot {
  constructor(parent, heading, height, seek) {
    const box = parent.append("div").attr("class", "plot"), words = box.append("div").attr("class", "words");
    this.heading = words.append("span").attr("class", "heading").text(heading);
    this.reading = words.append("span").attr("class", "reading");
    this.names = box.append("div").attr("class", "line-names");
    const drawing = box.append("div").attr("class", "drawing").style("height", height + TOP + BOTTOM + "px");
    Object.assign(this, { box, height });
    this.canvas = drawing.append("canvas").node();
    this.svg = drawing.append("svg");
    this.inside = this.svg.append("g").attr("transform", `translate(${LEFT},${TOP})`);
    const clip = `plot-${Plot.count = (Plot.count || 0) + 1}`;
    this.clip = this.svg.append("clipPath").attr("id", clip).append("rect").attr("y", -TOP).attr("height", height + TOP);
    this.body = this.inside.append("g").attr("clip-path", `url(#${clip})`);
    this.axes = this.inside.append("g");
    this.cursor = this.inside.append("line").attr("class", "cursor").attr("y1", 0).attr("y2", height);
    const go = (event) => seek(this.x.invert(event.clientX - this.svg.node().getBoundingClientRect().left - LEFT));
    let held = false;
    this.svg.node().addEventListener("pointerdown", (event) => { held = true; this.svg.node().setPointerCapture(event.pointerId); go(event); });
    this.svg.node().addEventListener("pointermove", (event) => { if (held) go(event); });
    for (const end of ["pointerup", "pointercancel"]) this.svg.node().addEventListener(end, () => { held = false; });
  }

  /** Fits the strip to the page: `times` is the first and the last, s. */
  fit(width, times) {
    this.width = width - LEFT - RIGHT;
    this.svg.attr("width", width).attr("height", this.height + TOP + BOTTOM);
    this.clip.attr("width", this.width);
    this.names.selectAll("*").remove();
    this.x = d3.scaleLinear(times, [0, this.width]);
    this.body.selectAll("*").remove();
    this.axes.selectAll("*").remove();
    this.axes.append("g").attr("transform", `translate(0,${this.height})`).call(d3.axisBottom(this.x).ticks(Math.max(3, Math.min(12, this.width / 90))).tickFormat((t) => `${t} s`));
  }

  /** Sets the vertical axis. */
  scale(domain, label, ticks = 4) {
    this.y = d3.scaleLinear(domain, [this.height, 0]);
    this.axes.append("g").call(d3.axisLeft(this.y).ticks(ticks, Math.max(...domain.map(Math.abs)) >= 1e4 ? ".0e" : undefined));
    this.axes.append("text").attr("transform", `translate(${-60},${this.height / 2}) rotate(-90)`).attr("text-anchor", "middle").text(label);
  }

  /** Lines of the columns of `values` over a log's times, each named at the right; those of a second log thin. */
  lines(log, series, second) {
    series.forEach(({ name, values }, k) => {
      const path = d3.line().defined((v) => Number.isFinite(v)).x((v, f) => this.x(log.time[f])).y((v) => this.y(v));
      this.body.append("path").attr("d", path(Array.from(values))).style("stroke", INK[k % INK.length]).attr("stroke-dasharray", DASHES[k % DASHES.length]).style("stroke-width", second ? 0.7 : 1.4);
      if (!second) this.name(name, INK[k % INK.length], DASHES[k % DASHES.length]);
    });
  }

  /** How a line looks, above the strip. */
  name(text, ink, dash) {
    const one = this.names.append("span");
    one.append("svg").attr("width", 26).attr("height", 8).append("line").attr("x2", 26).attr("y1", 4).attr("y2", 4).style("stroke", ink).attr("stroke-dasharray", dash).attr("stroke-width", 2);
    one.append("span").text(text);
  }

  /** Named bands between two heights. */
  bands(found, top, high, ink) {
    for (const { name, from, to } of found) {
      const wide = this.x(to) - this.x(from);
      this.body.append("rect").attr("x", this.x(from)).attr("width", Math.max(wide, 1)).attr("y", top).attr("height", high).attr("fill", ink(name)).attr("stroke", "#fff");
      if (wide > 8 * name.length) this.body.append("text").attr("class", "band").attr("x", this.x(from) + wide / 2).attr("y", top + high / 2 + 4).attr("text-anchor", "middle").text(name);
    }
  }

  move(time, reading) {
    this.cursor.attr("x1", this.x(time)).attr("x2", this.x(time));
    this.reading.text(reading || "");
  }
}

/** Largest and smallest finite value of all, with 0 among them. */
function rangeOf(lists) {
  let low = 0, high = 1e-12;
  for (const list of lists) for (const v of list) { if (v < low) low = v; if (v > high) high = v; }
  return [low, low === 0 && high === 1e-12 ? 1 : high];
}

/** Without what the release does: its spikes would flatten all that comes before it. */
function untilRelease(log, values) {
  const kept = values.filter((_, f) => !["release", "free"].includes(log.phaseName(f)));
  return kept.length ? kept : values;
}

const column = (values, width, k) => d3.range(values.length / width).map((f) => values[f * width + k]);
const EQ6 = ["first, t_a", "first, t_b", "last, t_a", "last, t_b"];
const short = (v, unit) => (Number.isFinite(v) ? `${d3.format(".4~g")(v)} ${unit}` : "");

class Plots {
  constructor(logs, seek) {
    this.logs = logs;
    const parent = d3.select("#plots"), of = (log) => (logs.length > 1 ? `, ${log.name}` : "");
    this.maps = logs.map((log) => new Plot(parent, "", 150, seek));
    this.stages = logs.map((log) => new Plot(parent, `Phase and knot type${of(log)}`, 44, seek));
    this.eq6 = new Plot(parent, "Eq. 6: speed along each tangent, means from frame to frame (as commanded: thin; cut where the release is faster)", 100, seek);
    this.head = new Plot(parent, "Force at the head, means from frame to frame (cut where the release is larger)", 90, seek);
    this.energy = new Plot(parent, "Energy and work so far", 110, seek);
    this.all = [...this.maps, ...this.stages, this.eq6, this.head, this.energy];
  }

  /** Draws all anew, the maps by quantity `name` up to `scale`. */
  draw(name, scale, label, unit) {
    Object.assign(this, { quantity: name, label, unit });
    this.headForce = this.logs.map((log) => d3.range(log.frames).map((f) => Math.hypot(log.head[6 * f], log.head[6 * f + 1], log.head[6 * f + 2])));
    const width = Math.max(280, document.getElementById("plots").clientWidth - 28);
    const times = [d3.min(this.logs, (log) => log.time[0]), d3.max(this.logs, (log) => log.time[log.frames - 1])];
    for (const plot of this.all) plot.fit(width, times);
    this.logs.forEach((log, k) => {
      this.drawMap(this.maps[k], log, name, scale);
      this.stages[k].bands(stretches(log, (f) => log.phaseName(f)), 0, 20, (phase) => PHASE_INK[phase] || "#eee");
      this.stages[k].bands(stretches(log, (f) => log.knotName(f)), 23, 20, (knot) => (knot === "no knot" ? "#f4f4f4" : "#bfe3d6"));
    });
    const speeds = this.logs.map((log) => EQ6.map((row, k) => ({ name: row, values: column(log.eq6.speed, 4, k) })));
    const before = (lists) => this.logs.flatMap((log, k) => lists[k].map((values) => untilRelease(log, Array.from(values))));
    this.eq6.scale(rangeOf([...before(speeds.map((own) => own.map((s) => s.values))), ...this.logs.map((log) => log.eq6.command)]), "cm/s", 4);
    this.eq6.box.style("display", this.logs.some((log) => log.eq6.speed.some(Number.isFinite)) ? "" : "none");
    this.logs.forEach((log, k) => {
      this.eq6.lines(log, speeds[k], k > 0);
      this.eq6.lines(log, EQ6.map((row, i) => ({ name: row, values: column(log.eq6.command, 4, i) })), true);
    });
    this.head.scale(rangeOf(before(this.logs.map((log, k) => [this.headForce[k], log.plate_force]))), "dyn", 4);
    this.logs.forEach((log, k) => this.head.lines(log, [{ name: "clamp", values: this.headForce[k] }, { name: "head plate", values: log.plate_force }], k > 0));
    const terms = this.logs.map((log) => Object.entries(log.energy).filter(([, values]) => values.some((v) => v !== 0)).map(([key, values]) => ({ name: key.replace("_energy", "").replace("work_", "work, "), values })));
    this.energy.scale(rangeOf(terms.flat().map((t) => t.values)), "erg", 4);
    this.logs.forEach((log, k) => this.energy.lines(log, terms[k], k > 0));
  }

  drawMap(plot, log, name, scale) {
    const { label, unit } = this, { arc, values } = log.field(name), n = arc.length, length = log.animal.length;
    plot.heading.text(`Along the body: ${label}, ${unit}${this.logs.length > 1 ? ", " + log.name : ""}`);
    plot.scale([0, length], "cm from the head", 4);
    const image = new ImageData(log.frames, n);
    for (let f = 0; f < log.frames; ++f) {
      for (let j = 0; j < n; ++j) {
        const at = 4 * ((n - 1 - j) * log.frames + f);
        colourOf(values[f * n + j], scale).forEach((c, i) => { image.data[at + i] = 255 * c; });
        image.data[at + 3] = 255;
      }
    }
    const small = document.createElement("canvas");
    small.width = log.frames;
    small.height = n;
    small.getContext("2d").putImageData(image, 0, 0);
    const ratio = window.devicePixelRatio || 1, { canvas } = plot;
    canvas.width = (LEFT + plot.width) * ratio;
    canvas.height = (plot.height + TOP) * ratio;
    canvas.style.width = LEFT + plot.width + "px";
    canvas.style.height = plot.height + TOP + "px";
    const context = canvas.getContext("2d"), half = length / n / 2;
    context.scale(ratio, ratio);
    context.imageSmoothingEnabled = false;
    const top = TOP + plot.y(Math.min(length, arc[n - 1] + half)), bottom = TOP + plot.y(Math.max(0, arc[0] - half));
    const left = LEFT + plot.x(log.time[0]);
    context.drawImage(small, left, top, LEFT + plot.x(log.time[log.frames - 1]) - left, bottom - top);
    for (const [end, dash, word] of [["head_end", "", "knot, head end"], ["tail_end", "5 3", "knot, tail end"]]) {
      const path = d3.line().defined((v) => Number.isFinite(v)).x((v, f) => plot.x(log.time[f])).y((v) => plot.y(v))(Array.from(log[end]));
      plot.body.append("path").attr("d", path).attr("stroke", "#000").style("stroke-width", 3.2);
      plot.body.append("path").attr("d", path).attr("stroke", "#fff").attr("stroke-dasharray", dash).style("stroke-width", 1.6);
      plot.name(word, "var(--ink)", dash);
    }
  }

  /** Puts the cursor at a time, and what each plot says there. */
  move(time) {
    const frames = this.logs.map((log) => log.frameAt(time)), log = this.logs[0], f = frames[0];
    this.logs.forEach((own, k) => {
      const { arc, values } = own.field(this.quantity), row = values.subarray(frames[k] * arc.length, (frames[k] + 1) * arc.length);
      this.maps[k].move(time, `largest ${short(d3.max(row), this.unit)}`);
      this.stages[k].move(time, `${own.phaseName(frames[k])}, ${own.knotName(frames[k])}`);
    });
    const speeds = d3.range(4).map((k) => short(log.eq6.speed[4 * f + k], "").trim());
    this.eq6.move(time, speeds.every((s) => s) ? speeds.join(", ") + " cm/s" : "");
    this.head.move(time, short(this.headForce[0][f], "dyn"));
    this.energy.move(time, `kinetic ${short(log.energy.kinetic_energy[f], "erg")}, elastic ${short(log.energy.elastic_energy[f], "erg")}`);
  }
}
