// How fast Table 1 runs in node: the first run of a module, which the engine compiles meanwhile, and the ones after it.
//   node experiments/results/live/live_speed.mjs build/web/hagfish.wasm
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";

const { Simulator } = createRequire(import.meta.url)("../../live/simulator.js");
const compiled = new WebAssembly.Module(readFileSync(process.argv[2]));

async function run() {
  const simulator = await Simulator.create(compiled, () => performance.now() / 1e3);
  simulator.start({ name: "table1", text: simulator.builtin("table1.toml"), set: [] });
  simulator.calls.live_animal();
  const [step, interval] = simulator.array("clock"), steps = Math.round(interval / step), begin = performance.now();
  do simulator.calls.live_frame(); while (simulator.calls.live_advance(steps) === steps);
  return simulator.array("time")[0] / ((performance.now() - begin) / 1e3);
}

console.log('"Table 1 at 5 ms in node","times real time"');
const first = await run(), later = [];
for (let k = 0; k < 9; ++k) later.push(await run());
console.log(`"first run","${first.toFixed(1)}"`);
console.log(`"median of nine more","${later.sort((a, b) => a - b)[4].toFixed(1)}"`);
