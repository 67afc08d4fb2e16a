// carom in WebAssembly: the classes of the package, for a module that is loaded already. index.js loads it.
// Units are SI; keys of scenes are those of scene files, with their units (docs/reference/scene_format.md).

/** An error: `kind` is "scene", "simulation", "argument", "limit" or "memory". A mistake in a scene
 * has a place: file, line and column, which also begin the message. */
export class CaromError extends Error {
  constructor({kind, message, file, line, column}) {
    super(line > 0 ? `${file}:${line}:${column}: ${message}` : file ? `${file}: ${message}` : message);
    Object.assign(this, {name: "CaromError", kind, file, line, column, reason: message});
  }
}

/** How balls move, in the order of the numbers in `states`. */
export const STATES = ["stationary", "spinning", "sliding", "rolling", "pocketed", "falling", "airborne",
  "out", "colliding"];

/** How shots of simulateMany end, in the order of the numbers in `status`. */
export const STATUSES = ["at_rest", "time", "events", "endless", "invalid", "failed"];

let wasm = null;
/** Whether the module's last result has an object without an owner. */
let unclaimed = false;

/** The name of a value of a wrong type in messages. */
function told(value) {
  if (typeof value === "string") return `the text ${JSON.stringify(value.slice(0, 40))}`;
  if (Array.isArray(value)) return "a list";
  if (typeof value === "function") return "a function";
  if (value === null || typeof value !== "object") return String(value);
  return `an object ${value.constructor?.name ?? ""}`.trim();
}

/** Unchecked, a number would become a pointer in the module.
 * @throws TypeError with the argument's name */
function expect(holds, name, value, wanted) {
  if (!holds) throw new TypeError(`${name} is ${told(value)}; expected ${wanted}`);
}
const expectText = (name, value) => expect(typeof value === "string", name, value, "a text");
const expectNumber = (name, value) =>
  expect(typeof value === "number" && !Number.isNaN(value), name, value, "a number");
const expectWhole = (name, value) =>
  expect(Number.isInteger(value) && value >= 0 && value < 2 ** 31, name, value, "a whole number, 0 or more");
const expectTruth = (name, value) => expect(typeof value === "boolean", name, value, "true or false");
const expectObject = (name, value) =>
  expect(value !== null && typeof value === "object" && !Array.isArray(value) && !ArrayBuffer.isView(value),
    name, value, "an object");
const expectOf = (Class, name, value) =>
  expect(value instanceof Class, name, value, `an object ${Class.name} of this package`);

/** A list of numbers as Float64Array. @param mayBeNaN  a shot with such a number has the status "invalid" */
function numbersOf(name, list, mayBeNaN) {
  expect(Array.isArray(list) || (ArrayBuffer.isView(list) && !(list instanceof DataView)), name, list,
    "a list of numbers");
  for (let i = 0; i < list.length; ++i)
    if (typeof list[i] !== "number" || (!mayBeNaN && Number.isNaN(list[i])))
      expect(false, `${name}[${i}]`, list[i], "a number");
  return Float64Array.from(list);
}

/** The few system functions that the module needs: a clock, and no files. */
function system() {
  const BAD_FILE = 8, OK = 0;
  const now = () => BigInt(Math.round(performance.now() * 1e6));
  const none = (counts, sizes) => {
    const view = new DataView(wasm.memory.buffer);
    view.setUint32(counts, 0, true);
    view.setUint32(sizes, 0, true);
    return OK;
  };
  const known = {
    clock_time_get: (id, precision, out) => {
      new DataView(wasm.memory.buffer).setBigUint64(out, now(), true);
      return OK;
    },
    environ_sizes_get: none,
    args_sizes_get: none,
    environ_get: () => OK,
    args_get: () => OK,
    proc_exit: (code) => { throw new Error(`carom.wasm ended with status ${code}`); },
    emscripten_notify_memory_growth: () => {},
  };
  // The module reads and writes no files, so every other function fails.
  return new Proxy({}, {get: (_, name) => known[name] || (() => BAD_FILE)});
}

/** Makes the classes work. `source`: the bytes of carom.wasm, or a compiled WebAssembly.Module. */
export async function start(source) {
  if (wasm !== null) return;
  const module = source instanceof WebAssembly.Module ? source : await WebAssembly.compile(source);
  const functions = system(), imports = {};
  for (const {module: from, name} of WebAssembly.Module.imports(module))
    (imports[from] ||= {})[name] = functions[name];
  const instance = await WebAssembly.instantiate(module, imports);
  wasm = instance.exports;
  wasm._initialize();
}

const encoder = new TextEncoder(), decoder = new TextDecoder();

/** Copies into the module's memory while `use` runs. Texts become a pointer and a size. */
function lend(values, use) {
  const taken = [], args = [];
  try {
    for (const value of values) {
      if (typeof value !== "string" && !ArrayBuffer.isView(value)) {
        args.push(value);
        continue;
      }
      const bytes = typeof value === "string" ? encoder.encode(value)
        : new Uint8Array(value.buffer, value.byteOffset, value.byteLength);
      const at = wasm.carom_allocate(bytes.length + 1);
      if (at === 0) throw new CaromError({kind: "memory", message: "out of memory", file: "", line: 0});
      taken.push(at);
      new Uint8Array(wasm.memory.buffer, at, bytes.length).set(bytes);
      args.push(at);
      if (typeof value === "string") args.push(bytes.length);
    }
    return use(args);
  } finally {
    for (const at of taken) wasm.carom_release(at);
  }
}

const lastBytes = () => new Uint8Array(wasm.memory.buffer, wasm.carom_text(), wasm.carom_text_size());
const lastText = () => decoder.decode(lastBytes());

/** Calls a function of the module. @returns its text, converted by `read`. @throws CaromError */
function call(name, ...values) { return callFor(lastText, name, ...values); }
function callFor(read, name, ...values) {
  if (wasm === null) throw new Error("carom: call init() first, and await it");
  unclaimed = lend(values, (args) => wasm[name](...args)) === 0;
  if (unclaimed) return read();
  throw new CaromError(JSON.parse(lastText() || '{"kind": "memory", "message": "out of memory"}'));
}

/** Frees the module's memory of a lost object. */
const lost = new FinalizationRegistry(([free, handle]) => wasm[free](handle));

/** An object in the module's memory. */
class Held {
  #handle;
  #free;
  constructor(free) {
    if (!unclaimed)
      throw new TypeError("carom's objects cannot be constructed; call Scene.parse() or simulate()");
    unclaimed = false;
    this.#handle = wasm.carom_handle();
    this.#free = free;
    lost.register(this, [free, this.#handle], this);
  }
  get handle() {
    if (this.#handle === 0) throw new Error("carom: this object has been freed");
    return this.#handle;
  }
  /** Frees its memory now instead of at garbage collection. */
  free() {
    if (this.#handle === 0) return;
    lost.unregister(this);
    wasm[this.#free](this.#handle);
    this.#handle = 0;
  }
}

/** Throws for a value that a scene file cannot express. */
function expectValue(key, value) {
  if (Array.isArray(value)) {
    value.forEach((part, i) => expectValue(`${key}[${i}]`, part));
    return;
  }
  expect(["number", "boolean", "string"].includes(typeof value), key, value, "a value of a scene file");
  // A slider or a division gives it; JSON would write null.
  if (typeof value === "number" && !Number.isFinite(value))
    throw new CaromError({kind: "argument", message: `${key} is ${value}; expected a finite number`, file: "",
      line: 0, column: 0});
}

/** {cue: {speed: 4}} as {"cue.speed": 4}: the keys of a scene file, with dots. */
function flat(changes, before = "", out = {}) {
  const DEEPEST = 20;
  for (const [key, value] of Object.entries(changes)) {
    const nested = value !== null && typeof value === "object" && !Array.isArray(value);
    if (!nested) expectValue(before + key, out[before + key] = value);
    else if (before.split(".").length > DEEPEST) throw new TypeError(`${before}${key} is nested too deep`);
    else flat(value, `${before}${key}.`, out);
  }
  return out;
}

export function version() {
  return call("carom_version");
}

// The C++ library of WebAssembly writes numbers with 17 digits; most need fewer to be read back to the bit.
const TEXTS_AND_NUMBERS = /'[^'\n]*'|"(?:[^"\\\n]|\\.)*"|#.*|-?\d+\.\d{14,}(?:e[+-]?\d+)?/g;
const shortened = (toml) =>
  toml.replace(TEXTS_AND_NUMBERS, (found) => /^[-\d]/.test(found) ? String(Number(found)) : found);

/** A scene: table, balls, cue. It never changes; with() makes another one. */
export class Scene extends Held {
  #described = null;
  constructor() { super("carom_free_scene"); }

  static parse(toml, name = "scene.toml") {
    expectText("toml", toml);
    expectText("name", name);
    call("carom_scene_parse", toml, name);
    return new Scene();
  }
  with(changes) {
    expectObject("changes", changes);
    call("carom_scene_change", this.handle, JSON.stringify(flat(changes)));
    return new Scene();
  }
  get toml() { return shortened(call("carom_scene_source", this.handle)); }
  get everything() { return call("carom_scene_text", this.handle); }
  describe() { return this.#described ??= JSON.parse(call("carom_scene_describe", this.handle)); }
  get balls() { return this.describe().balls; }
  get cue() { return this.describe().cue; }
  get table() { return this.describe().table; }
  look() { return JSON.parse(call("carom_scene_look", this.handle)); }
  verify(recordJson) {
    expectText("recordJson", recordJson);
    return call("carom_verify", this.handle, recordJson) || null;
  }
  mesh() {
    const bytes = callFor(() => lastBytes().slice(), "carom_scene_mesh", this.handle), ATLAS = 192 * 288;
    const numbers = new Float32Array(bytes.buffer, 0, (bytes.length - ATLAS) / 4);
    return {origin: [...numbers.subarray(0, 2)], ends: [...numbers.subarray(2, 12)],
      vertices: numbers.subarray(12), atlas: bytes.subarray(-ATLAS)};
  }
}

/** The record's motion from its numbers: of the shot, then of each ball and its segments. */
function motionOf(numbers, ids) {
  let at = 0;
  const next = (count) => Array.from(numbers.subarray(at, at += count));
  const [duration, gravity] = next(2), tracks = ids.map((id) => {
    const [pocket, radius, mass, count] = next(4), segments = [];
    for (let i = 0; i < count; ++i) {
      const [start, lasts, state, held] = next(4), [r, v, w] = [next(3), next(3), next(3)];
      segments.push({start, duration: lasts === Infinity ? null : lasts, state: STATES[state],
        held: held === 1, r, v, w, a: next(2), dw: next(2), spin_decay: next(1)[0]});
    }
    return {id, pocket, radius, mass, segments};
  });
  return {duration, gravity, tracks};
}

/** A simulated shot. */
export class Shot extends Held {
  #hash = null;
  #outcome = null;
  #recordText = null;
  #record = null;
  #events = null;
  #motion = null;
  constructor(brief, scene) {
    super("carom_free_shot");
    const [duration, eventCount, warnings] = JSON.parse(brief);
    Object.assign(this, {scene, duration, eventCount, warnings});
  }
  get hash() { return this.#hash ??= call("carom_shot_hash", this.handle); }
  get outcome() { return this.#outcome ??= JSON.parse(call("carom_shot_outcome", this.handle)); }
  get balls() { return this.outcome.balls.map((ball) => ball.id); }
  get recordJson() { return this.#recordText ??= call("carom_shot_record", this.handle); }
  get record() { return this.#record ??= JSON.parse(this.recordJson); }
  get motion() {
    const read = () => new Float64Array(lastBytes().slice().buffer);
    return this.#motion ??= motionOf(callFor(read, "carom_shot_motion", this.handle),
      this.scene.balls.map(({id}) => id));
  }
  get events() { return this.#events ??= JSON.parse(call("carom_shot_events", this.handle)); }
  story({inches = false} = {}) {
    expectTruth("inches", inches);
    return JSON.parse(call("carom_shot_story", this.handle, inches ? 1 : 0));
  }

  states(times) {
    const list = typeof times === "number" ? numbersOf("times", [times]) : numbersOf("times", times);
    const count = list.length * this.balls.length;
    const numbers = wasm.carom_allocate(72 * count + 8), states = wasm.carom_allocate(count + 8);
    try {
      call("carom_shot_states", this.handle, list.length, list, numbers, states);
      const all = new Float64Array(wasm.memory.buffer, numbers, 9 * count).slice();
      return {balls: this.balls.length, numbers: all,
        states: new Uint8Array(wasm.memory.buffer, states, count).slice()};
    } finally {
      wasm.carom_release(numbers);
      wasm.carom_release(states);
    }
  }
  stateAt(ball, time) {
    expect(typeof ball === "string" || Number.isInteger(ball), "ball", ball, "the id or the index of a ball");
    expectNumber("time", time);
    const i = typeof ball === "string" ? this.balls.indexOf(ball) : ball;
    if (!(i >= 0 && i < this.balls.length)) throw new RangeError(`no ball is called ${ball}`);
    const {numbers, states} = this.states(time);
    const at = (k) => Array.from(numbers.subarray(9 * i + k, 9 * i + k + 3));
    return {state: STATES[states[i]], position: at(0), velocity: at(3), spin: at(6)};
  }
  measure(expression, {game = ""} = {}) {
    expectText("expression", expression);
    expectText("game", game);
    return JSON.parse(call("carom_shot_measure", this.handle, expression, game));
  }
  after() {
    call("carom_shot_after", this.handle);
    return new Scene();
  }
}

export function simulate(scene, {until = -1, seconds = 60, events = 1e6} = {}) {
  expectOf(Scene, "scene", scene);
  expectNumber("until", until);
  expectNumber("seconds", seconds);
  expectNumber("events", events);
  return new Shot(call("carom_simulate", scene.handle, until, seconds, events), scene);
}

const TYPES = {uint8: Uint8Array, int32: Int32Array, int64: BigInt64Array, uint64: BigUint64Array,
  float64: Float64Array};

export function simulateMany(scene, columns, {hash = false} = {}) {
  expectOf(Scene, "scene", scene);
  expectObject("columns", columns);
  expectTruth("hash", hash);
  const keys = Object.keys(columns), lists = keys.map((key) => numbersOf(key, columns[key], true));
  const shots = keys.length > 0 ? lists[0].length : 0;
  const values = new Float64Array(keys.length * shots);
  keys.forEach((key, i) => {
    if (lists[i].length !== shots)
      throw new RangeError(`${key} has ${lists[i].length} values, and ${keys[0]} has ${shots}`);
    values.set(lists[i], i * shots);
  });
  const {arrays, ...result} = JSON.parse(
    call("carom_simulate_many", scene.handle, JSON.stringify(keys), shots, values, hash ? 1 : 0));
  const batch = new Held("carom_free_batch");
  for (const {name, type, at, count} of arrays)
    result[name] = new TYPES[type](wasm.memory.buffer, at, count).slice();
  batch.free();
  return {...result, ids: scene.balls.map((ball) => ball.id)};
}

/** A verdict on a shot, and the options for continuing the game. */
export class Verdict extends Held {
  #shot;
  constructor(json, shot) {
    super("carom_free_verdict");
    Object.assign(this, JSON.parse(json));
    this.#shot = shot;
  }
  mayPlace(x, y, option = 0) {
    expectNumber("x", x);
    expectNumber("y", y);
    expectWhole("option", option);
    return call("carom_game_may_place", this.#shot.handle, this.handle, option, x, y) === "true";
  }
  choose(skill = "professional") {
    expectText("skill", skill);
    return Number(call("carom_game_choose", this.#shot.handle, this.handle, skill));
  }
  next({option = 0, place = null} = {}) {
    expectWhole("option", option);
    expect(place === null || place.length === 2, "place", place, "[x, y] or null");
    const [x, y] = place === null ? [NaN, NaN] : numbersOf("place", place);
    call("carom_game_next", this.#shot.handle, this.handle, option, x, y);
    return new Scene();
  }
}

/** Rules of games. */
export const games = {
  start(game, {first = 0, target = 0, rules = {}} = {}) {
    expectText("game", game);
    expectWhole("first", first);
    expectWhole("target", target);
    expectObject("rules", rules);
    const chosen = Object.entries(rules).map(([key, value]) => `${key}=${value}`);
    const options = JSON.stringify({turn: first, target, rules: chosen});
    return JSON.parse(call("carom_game_new", game, options));
  },
  list() { return JSON.parse(call("carom_games")); },
  legal(state, scene) {
    expectObject("state", state);
    expectOf(Scene, "scene", scene);
    return JSON.parse(call("carom_game_legal", JSON.stringify(state), scene.handle));
  },
  advise(state, scene, {skill = "professional", seed = 1, best = 3, shots = 400, seconds = 1e9} = {}) {
    expectObject("state", state);
    expectOf(Scene, "scene", scene);
    expectText("skill", skill);
    for (const [key, value] of Object.entries({seed, best, shots})) expectWhole(key, value);
    expectNumber("seconds", seconds);
    const options = JSON.stringify({skill, seed, best, shots, seconds});
    return JSON.parse(call("carom_game_advise", JSON.stringify(state), scene.handle, options));
  },
  strike(scene, {skill = "professional", seed = 1} = {}) {
    expectOf(Scene, "scene", scene);
    expectText("skill", skill);
    expectWhole("seed", seed);
    return JSON.parse(call("carom_game_strike", scene.handle, seed, skill));
  },
  judge(state, shot, announced = {}) {
    expectObject("state", state);
    expectOf(Shot, "shot", shot);
    expectObject("announced", announced);
    return new Verdict(
      call("carom_game_judge", shot.handle, JSON.stringify(state), JSON.stringify(announced)), shot);
  },
};
