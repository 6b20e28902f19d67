// The simulator's positions, M and bias against those of today's MuJoCo, in WebAssembly, in states of the Table 1 run.
//   npm install @mujoco/mujoco        in any folder: this study alone needs it
//   hagfish mjcf table1 --out MJCF
//   build/release/experiments/mechanics states >STATES.json
//   node experiments/results/live/live_mirror.mjs STATES.json FOLDER/node_modules/@mujoco/mujoco/mujoco.js MJCF
// Prints CSV: the largest differences of all states, each over its scale as `hagfish compare` has it; fails past 1e-11.
import { readFileSync } from "node:fs";
import { opened } from "../mujoco.mjs";

const BOUND = 1e-11;
const [logged, library, mjcf] = process.argv.slice(2);
const { length, states } = JSON.parse(readFileSync(logged));
const { mujoco, model, data } = await opened(library, mjcf);
const nv = model.nv, full = new mujoco.DoubleBuffer(nv * nv);
const worst = { position: 0, M: 0, bias: 0 };
const note = (name, off) => { worst[name] = Math.max(worst[name], off); };
for (const state of states) {
  data.qpos.set(state.q);
  data.qvel.set(state.qdot);
  mujoco.mj_forward(model, data);
  state.place.forEach((x, i) => note("position", Math.abs(x - data.xpos[i + 3]) / length)); // the world is body 0
  mujoco.mj_fullM(model, data, full);
  const mass = full.GetView(), scale = Array.from({ length: nv }, (_, i) => Math.sqrt(mass[i * nv + i]));
  for (let i = 0; i < nv; ++i) for (let j = 0; j < nv; ++j) note("M", Math.abs(mass[i * nv + j] - state.mass[i * nv + j]) / (scale[i] * scale[j]));
  const largest = Math.max(...state.bias.map((b, i) => Math.abs(b) / scale[i]));
  state.bias.forEach((b, i) => note("bias", Math.abs(b - data.qfrc_bias[i]) / scale[i] / largest));
}
console.log("largest difference of its scale,MuJoCo,states,required,measured");
for (const [name, off] of Object.entries(worst)) console.log([name, mujoco.mj_versionString(), states.length, BOUND.toExponential(0), off.toExponential(0)].join(","));
process.exitCode = Object.values(worst).every((off) => off <= BOUND) ? 0 : 1;
