// Advice from carom in a worker, so that the page stays responsive. The same script runs on both sides: a
// page that is opened from a file has no address from which a worker could load.

/** In the worker: responds to {id, wasm, toml, state, options} with {id, advice} or {id, error}. */
async function answer({data}) {
  const {id, wasm, toml, state, options} = data, core = globalThis.modules["core.js"];
  try {
    await core.start(wasm);
    const scene = core.Scene.parse(toml), begin = performance.now();
    const advice = core.games.advise(state, scene, options);
    scene.free();
    globalThis.postMessage({id, advice, ms: performance.now() - begin});
  } catch (error) {
    globalThis.postMessage({id, error: error.reason || error.message});
  }
}
if (typeof WorkerGlobalScope !== "undefined") globalThis.onmessage = answer;

/** The page's own script of this name. */
const scriptOf = (name) =>
  [...document.scripts].find(({text}) => text.includes(`(globalThis.modules ??= {})["${name}"]`)).text;

export class Thinker {
  /** `wasm`: the bytes of carom.wasm. */
  constructor(wasm) { Object.assign(this, {wasm, worker: null, waiting: null, asked: 0, ms: 0}); }

  /** @returns the advice, or null if it is stopped. @throws Error with a sentence */
  advise(toml, state, options) {
    this.stop();
    const id = ++this.asked;
    return new Promise((resolve, reject) => {
      this.waiting = resolve;
      this.worker ??= this.made();
      this.worker.onmessage = ({data}) => {
        if (data.id !== id) return;
        this.waiting = null;
        this.ms = data.ms;
        if (data.error) reject(new Error(data.error));
        else resolve(data.advice);
      };
      this.worker.onerror = (event) =>
        reject(new Error(`This browser cannot run the player: ${event.message}`));
      this.worker.postMessage({id, wasm: this.wasm, toml, state, options});
    });
  }
  made() {
    const source = new Blob(["core.js", "thinker.js"].map(scriptOf), {type: "text/javascript"});
    const url = URL.createObjectURL(source), worker = new Worker(url);
    URL.revokeObjectURL(url);
    return worker;
  }
  /** Stops the current search. */
  stop() {
    if (!this.waiting) return;
    this.worker.terminate();
    this.worker = null;
    this.waiting(null);
    this.waiting = null;
  }
}
