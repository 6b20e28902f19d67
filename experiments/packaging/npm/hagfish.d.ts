/** A scene to run. Units are cm, g, s and rad. */
export interface Scene {
  /** Stands for the scene in errors. */
  name: string;
  /** Its file, in TOML. */
  text: string;
  /** Files that it names, by name. */
  files?: Record<string, string>;
  /** Settings on it, as KEY=VALUE. */
  set: string[];
}

/** The functions of the WebAssembly module. */
export interface Calls {
  /** Takes up to `steps` time steps, fewer where the scene is over. Gives how many. */
  live_advance(steps: number): number;
  /** Makes the arrays of the present state. */
  live_frame(): void;
  /** Makes the arrays of the animal: length, radius, arc, clock (time step, time between frames, end). */
  live_animal(): void;
  /** Until live_let_go(), pulls a body towards x, y, z by a spring (dyn/cm) of `most` dyn at most. */
  live_pull(body: number, x: number, y: number, z: number, stiffness: number, most: number): void;
  live_let_go(): void;
}

/** One scene after another. An error is one line, and ends the instance. */
export class Simulator {
  /** An instance of a compiled module. `clock` gives seconds. */
  static create(module: WebAssembly.Module, clock: () => number): Promise<Simulator>;
  readonly calls: Calls;
  start(scene: Scene): void;
  /** Goes on in another scene of as many bodies. */
  change(scene: Scene): void;
  /** A built-in file, as "table1.toml"; empty where there is none. */
  builtin(file: string): string;
  lines(name: "scenes" | "phases"): string[];
  /** Of the scene that runs: all of it as TOML, its title, its animal, warnings since the last call. */
  text(name: "toml" | "title" | "specimen" | "warnings"): string;
  /** A knot as people call it, of the two numbers of the array "knot". */
  text(name: "knot_words", determinant: number, v2: number): string;
  /** An array of the frame or the animal, good until the next call; empty where there is none of that name. */
  array(name: string): Float64Array;
}

/** 16 hexadecimal digits that any bit of any array changes. */
export class Digest {
  add(array: Float64Array): void;
  text(): string;
}

/** A simulator, in node or in a page. `wasm`: the address of hagfish.wasm, which is beside the module. */
export function simulator(wasm?: URL): Promise<Simulator>;
