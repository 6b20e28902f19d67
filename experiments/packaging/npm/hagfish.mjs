
/** A simulator, in node or in a page. `wasm`: the address of hagfish.wasm, which is beside this file. */
export async function simulator(wasm = new URL("hagfish.wasm", import.meta.url)) {
  const bytes = wasm.protocol === "file:" ? await (await import("node:fs/promises")).readFile(wasm) : await (await fetch(wasm)).arrayBuffer();
  return Simulator.create(await WebAssembly.compile(bytes), () => performance.now() / 1e3);
}
export { Digest, Simulator };
