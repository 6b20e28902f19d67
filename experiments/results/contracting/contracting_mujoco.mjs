// Today's MuJoCo, in WebAssembly: a tied knot slides by the reflex in closed loop, without water.
//   node experiments/results/contracting/contracting_mujoco.mjs FOLDER/node_modules/@mujoco/mujoco/mujoco.js MJCF TIED.toml RULE STEP OUT.json
// RULE: Euler, implicitfast, discrete. The law is that of core/control/reflex.hpp, as mujoco_ref/closed_loop.cpp has it.
import { readFileSync, readdirSync, writeFileSync } from "node:fs";
import { opened } from "../mujoco.mjs";

const [library, mjcf, tied, rule, stepText, out] = process.argv.slice(2);
const STEP = Number(stepText), DURATION = 3.8, FRAME = 0.1; // s
const MUSCLE = 5e5, BODY = { bend: 2e5, twist: 1.3e5 }; // dyn cm^2, of data/living_overhand.toml and its specimen
const CAPACITY = 2.7e5, LENGTH = 42.4, SHIFT = 2.5e-4 * LENGTH; // dyn cm, cm
const CONTACT = 0.005; // s, the time constant of contacts and limits

const { mujoco, model, data } = await opened(library, mjcf);
const start = JSON.parse(/^q = (\[.*\])$/m.exec(readFileSync(tied, "utf8"))[1]);
const names = [...readdirSync(mjcf).sort().flatMap((file) => [...readFileSync(`${mjcf}/${file}`, "utf8").matchAll(/joint name="j(\d+)_(\w+)"/g)])]
  .map(([, body, kind]) => ({ body: Number(body), kind })).sort((a, b) => a.body - b.body);
const bodies = 1 + names[names.length - 1].body, count = names.length;
if (model.nv !== count) throw new Error(`MuJoCo's model has ${model.nv} velocities, the animal ${count} hinges`);

// Every hinge: where it is, what it stands for, and the two of its kind beside it.
const passive = Array.from(model.dof_damping), stiffness = Array.from(model.jnt_stiffness);
const hinges = names.map(({ body, kind }, k) => {
  const ofKind = names.map((other, i) => (other.kind === kind ? i : -1)).filter((i) => i >= 0);
  return { arc: (LENGTH * body) / bodies, span: BODY[kind.split("_")[0]] / stiffness[k], next: ofKind[ofKind.indexOf(k) + 1] ?? -1 };
});
const copied = (angles, k) => {
  const { arc, span, next } = hinges[k];
  const here = angles[k] / span, there = next < 0 ? 0 : angles[next] / hinges[next].span;
  const spacing = next < 0 ? (2 * LENGTH) / bodies : hinges[next].arc - arc;
  return span * (here + ((there - here) * SHIFT) / spacing);
};

const INTEGRATORS = { Euler: mujoco.mjtIntegrator.mjINT_EULER.value, implicitfast: mujoco.mjtIntegrator.mjINT_IMPLICITFAST.value,
                      discrete: mujoco.mjtIntegrator.mjINT_DISCRETE?.value };
Object.assign(model.opt, { timestep: STEP, integrator: INTEGRATORS[rule], solver: 2, jacobian: 0 });
for (const solref of [model.geom_solref, model.jnt_solref]) for (let i = 0; i < solref.length; i += 2) { solref[i] = CONTACT; solref[i + 1] = 1; }
mujoco.mj_resetData(model, data);
data.qpos.set(start.slice(7));

const own = new Float64Array(count), places = [];
const frame = () => { mujoco.mj_kinematics(model, data); places.push(Array.from({ length: bodies }, (_, b) => Array.from(data.xipos.subarray(3 * (b + 1), 3 * (b + 2))))); };
const springs = rule === "discrete" ? 0 : STEP; // what a spring at the step's end adds to damping, where MuJoCo does not see to it
const step = () => {
  const q = data.qpos, v = data.qvel, damping = model.dof_damping, force = data.qfrc_applied;
  for (let k = 0; k < count; ++k) own[k] = q[k] + STEP * v[k];
  for (let k = 0; k < count; ++k) {
    const muscle = MUSCLE / hinges[k].span, rest = copied(own, k);
    const value = muscle * (rest - q[k]) + stiffness[k] * rest, expected = value - STEP * muscle * v[k];
    const free = Math.abs(expected) <= CAPACITY;
    force[k] = free ? value : Math.sign(expected) * CAPACITY;
    damping[k] = passive[k] + springs * stiffness[k] + (free ? STEP * muscle : 0);
  }
  mujoco.mj_step(model, data);
};
const each = Math.round(FRAME / STEP), begin = process.cpuUsage();
for (let i = 0; i < Math.round(DURATION / STEP); ++i) {
  step();
  if ((i + 1) % each === 0) frame();
}
const { user, system } = process.cpuUsage(begin);
writeFileSync(out, JSON.stringify({ version: mujoco.mj_versionString(), rule, step: STEP, cpu: 1e-6 * (user + system), places }));
