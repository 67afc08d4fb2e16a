// carom for node and browsers: `import {init, Scene, simulate} from "carom"; await init();`
import {start} from "./core.js";

export {CaromError, STATES, STATUSES, Scene, Shot, Verdict, games, simulate, simulateMany, version}
  from "./core.js";

let starting = null;

/** Loads carom.wasm, once. `source`: its bytes, a compiled WebAssembly.Module, a Response or a URL; without
 * it, the file beside this one. Needs WebAssembly with SIMD. */
export function init(source = new URL("carom.wasm", import.meta.url)) {
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
  const here = import.meta.url, url = new URL(source, here);
  // node's fetch does not read files.
  if (url.protocol === "file:" && typeof process !== "undefined") {
    // Bundlers for browsers have no such module, and must not look for it.
    const files = "node:fs/promises";
    const {readFile} = await import(/* webpackIgnore: true */ /* @vite-ignore */ files);
    return readFile(url);
  }
  const answer = await fetch(url);
  if (!answer.ok) throw new Error(`carom: ${url}: ${answer.status} ${answer.statusText}`);
  return answer.arrayBuffer();
}
