// A model in today's MuJoCo, which npm has as @mujoco/mujoco, in WebAssembly: of the file mujoco.js and a folder of `hagfish mjcf`.
import { readFileSync, readdirSync } from "node:fs";
import { resolve } from "node:path";
import { pathToFileURL } from "node:url";

export const opened = async (library, mjcf) => {
  const mujoco = await (await import(pathToFileURL(resolve(library)))).default();
  mujoco.FS.mkdir("/mjcf");
  for (const file of readdirSync(mjcf)) mujoco.FS.writeFile(`/mjcf/${file}`, readFileSync(`${mjcf}/${file}`));
  const model = mujoco.MjModel.from_xml_path("/mjcf/hagfish.xml");
  return { mujoco, model, data: new mujoco.MjData(model) };
};
