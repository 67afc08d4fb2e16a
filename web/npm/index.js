// carom for node and browsers: `import {init, Scene, simulate} from "carom"; await init();`
import {start} from "./core.js";

export {CaromError, STATES, STATUSES, Scene, Shot, Verdict, games, simulate, simulateMany, version}
  from "./core.js";

let starting = null;

/** A module whose only function splats a number into a vector. */
const SPLAT = Uint8Array.of(0, 97, 115, 109, 1, 0, 0, 0, 1, 5, 1, 96, 0, 1, 123, 3, 2, 1, 0, 10, 8, 1, 6, 0,
  65, 0, 253, 15, 11);

/** Without SIMD a break takes twice as long; the bits are the same. */
const beside = () =>
  new URL(WebAssembly.validate(SPLAT) ? "carom.wasm" : "carom-plain.wasm", import.meta.url);

/** Loads carom.wasm, once. `source`: its bytes, a compiled WebAssembly.Module, a Response or a URL; without
 * it, the file beside this one, or carom-plain.wasm if this machine has no SIMD. */
export function init(source = beside()) {
  return starting ??= load(source).then(start).catch((error) => {
    starting = null;
    throw error;
  });
}

async function load(given) {
  const source = await given;
  if (source instanceof WebAssembly.Module || ArrayBuffer.isView(source) || source instanceof ArrayBuffer)
    return source;
  if (typeof Response !== "undefined" && source instanceof Response) return source.arrayBuffer();
  const url = new URL(source, import.meta.url);
  // node's fetch knows no files.
  if (url.protocol === "file:" && typeof process !== "undefined") {
    const {readFile} = await import("node:fs/promises");
    return readFile(url);
  }
  const answer = await fetch(url);
  if (!answer.ok) throw new Error(`carom: ${url}: ${answer.status} ${answer.statusText}`);
  return answer.arrayBuffer();
}
