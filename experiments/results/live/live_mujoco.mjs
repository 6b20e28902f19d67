// A step of the simulator and one of today's MuJoCo, both in WebAssembly, from the same states of Table 1's slide.
//   npm install @mujoco/mujoco        in any folder: this study alone needs it
//   hagfish mjcf table1 --out MJCF
//   node experiments/results/live/live_mujoco.mjs build/web/hagfish.wasm FOLDER/node_modules/@mujoco/mujoco/mujoco.js MJCF
// Prints CSV: for each way to step, the time it takes and how far places end from those at the tightest tolerance.
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { opened } from "../mujoco.mjs";

const { Simulator } = createRequire(import.meta.url)("../../live/simulator.js");
const [wasm, library, mjcf] = process.argv.slice(2);
const STEP = 0.002; // s, of both
const STARTS = [12.6, 13.4, 14.2, 15.0, 15.8]; // s, of the slide
const FREE = 1.0; // s, before anything touches
const STEPS = 10, REPEATS = 30;
const median = (values) => values.sort((a, b) => a - b)[values.length >> 1];
const micros = (steps, run) => { const begin = performance.now(); run(); return 1e3 * (performance.now() - begin) / steps; };

// Ours: on from each start, by as many steps again as MuJoCo is given. The first round is not counted: the engine compiles meanwhile.
const compiled = new WebAssembly.Module(readFileSync(wasm));
let states, own;
const round = async () => {
  const simulator = await Simulator.create(compiled, () => performance.now() / 1e3);
  simulator.start({ name: "table1", text: simulator.builtin("table1.toml"), set: [`time.step=${STEP}`] });
  states = [], own = { knotted: [], free: [] };
  let taken = 0;
  for (const [kind, starts] of [["free", [FREE]], ["knotted", STARTS]]) {
    for (const start of starts) {
      const steps = Math.round(start / STEP) - taken;
      simulator.calls.live_advance(steps);
      simulator.calls.live_frame();
      states.push({ kind, qpos: Array.from(simulator.array("q")) });
      for (let k = 0; k < REPEATS; ++k) own[kind].push(micros(STEPS, () => simulator.calls.live_advance(STEPS)));
      taken += steps + STEPS * REPEATS;
    }
  }
};
await round();
await round();
const row = (...cells) => console.log(cells.map((cell) => `"${cell}"`).join(","));
row("simulator, integrator, solver, tolerance", "step without contact, µs", "knotted step, µs", "off by at most, rad or cm");
row("this one, Euler, active set", median(own.free).toFixed(1), median(own.knotted).toFixed(1), "");

// MuJoCo: from the same places at rest, so that each setting takes the same steps.
const { mujoco, model, data } = await opened(library, mjcf);
model.opt.timestep = STEP;
const begin = (state) => { mujoco.mj_resetData(model, data); data.qpos.set(state.qpos); };
const advance = () => { for (let k = 0; k < STEPS; ++k) mujoco.mj_step(model, data); };
const SOLVERS = ["PGS", "CG", "Newton"], INTEGRATORS = { Euler: 0, implicitfast: 3, discrete: 4 };
for (const [integrator, number] of Object.entries(INTEGRATORS)) {
  model.opt.integrator = number;
  model.opt.solver = 2;
  Object.assign(model.opt, { tolerance: 1e-12, iterations: 1000 });
  const right = states.map((state) => { begin(state); advance(); return Array.from(data.qpos); });
  for (const [solver, name] of SOLVERS.entries()) {
    for (const tolerance of [1e-4, 1e-8]) {
      Object.assign(model.opt, { solver, tolerance, iterations: 1000 });
      const times = { knotted: [], free: [] };
      let off = 0;
      states.forEach((state, at) => {
        for (let k = 0; k < REPEATS; ++k) {
          begin(state);
          times[state.kind].push(micros(STEPS, advance));
        }
        data.qpos.forEach((q, i) => { off = Math.max(off, Math.abs(q - right[at][i])); });
      });
      row(`MuJoCo ${mujoco.mj_versionString()}, ${integrator}, ${name}, ${tolerance}`, median(times.free).toFixed(1), median(times.knotted).toFixed(1), off.toExponential(1));
    }
  }
}
