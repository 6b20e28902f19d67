// Runs a scene in node as the page does: its frames, a digest of q at all of them, and how fast it went.
//   node experiments/live/digest.mjs build/web/hagfish.wasm table1 [KEY=VALUE]... [--q FILE]
// --q writes q at every frame, as doubles.
import { readFileSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";

const { Simulator, Digest } = createRequire(import.meta.url)("./simulator.js");
const [wasm, name, ...rest] = process.argv.slice(2);
const at = rest.indexOf("--q"), file = at < 0 ? null : rest.splice(at, 2)[1];
const compiled = new WebAssembly.Module(readFileSync(wasm));
const simulator = await Simulator.create(compiled, () => performance.now() / 1e3);
const digest = new Digest(), states = [];
try {
  simulator.start({ name, text: simulator.builtin(name + ".toml"), set: rest });
  simulator.calls.live_animal();
  const [step, interval] = simulator.array("clock"), steps = Math.round(interval / step);
  const begin = process.cpuUsage();
  for (let more = true; more;) {
    simulator.calls.live_frame();
    const q = simulator.array("q");
    digest.add(q);
    if (file) states.push(...q);
    more = simulator.calls.live_advance(steps) === steps;
  }
  const used = process.cpuUsage(begin), seconds = (used.user + used.system) / 1e6, [time] = simulator.array("time");
  console.log(`${name}: ${digest.text()}, ${time.toFixed(2)} s in ${seconds.toFixed(2)} s of the processor, ${(time / seconds).toFixed(1)} x real time`);
} catch (error) {
  console.error(error.message);
  process.exitCode = 1;
}
if (file) writeFileSync(file, Buffer.from(new Float64Array(states).buffer));
