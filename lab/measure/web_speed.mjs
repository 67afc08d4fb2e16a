#!/usr/bin/env node
// How much longer shots take in WebAssembly than in the native engine: batches of the same shots on one
// thread, in turn, in node and in the Python module, which calls the engine once per batch. The fewest
// seconds of CPU time per shot, and the median of the ratios.
//
//   lab/measure/web_speed.mjs [ROUNDS=15]     needs tools/web, and build/release/python
import {spawn} from "node:child_process";
import * as path from "node:path";
import * as readline from "node:readline";
import {SOURCE, carom, sceneText} from "../../tests/web/support.mjs";

const ROUNDS = Number(process.argv[2] || 15);
// Two balls, the default models; breaks.
const CASES = [["draw.toml", 4000], ["three_cushion.toml", 4000], ["nine_ball_break.toml", 60],
  ["eight_ball_break.toml", 40]];
const WORKER = `
import json, sys, time
import carom
scenes = {}
for line in sys.stdin:
    name, text, aims = json.loads(line)
    scene = scenes.get(name) or scenes.setdefault(name, carom.Scene.loads(text))
    start = time.thread_time()
    carom.simulate_many(scene, params={"cue.aim_deg": aims})
    print(time.thread_time() - start, flush=True)
`;

const python = process.env.CAROM_PYTHON || path.join(SOURCE, "build/python-env/bin/python");
const worker = spawn(python, ["-c", WORKER],
  {env: {...process.env, PYTHONPATH: path.join(SOURCE, "build/release/python")},
    stdio: ["pipe", "pipe", "inherit"]});
const answers = readline.createInterface({input: worker.stdout})[Symbol.asyncIterator]();
async function native(name, text, aims) {
  worker.stdin.write(JSON.stringify([name, text, [...aims]]) + "\n");
  return Number((await answers.next()).value);
}

await carom.init();
const median = (list) => list.sort((a, b) => a - b)[Math.floor(list.length / 2)];
console.log("scene                     native us  wasm us   ratio of least   median ratio");
for (const [name, shots] of CASES) {
  const text = sceneText(name), scene = carom.Scene.parse(text, name), aim = scene.cue.aim_deg;
  const aims = Float64Array.from({length: shots}, (_, i) => aim + (i / shots - 0.5));
  const times = {native: [], wasm: []}, ratios = [];
  for (let round = 0; round < ROUNDS + 2; ++round) {
    const one = await native(name, text, aims);
    const before = process.cpuUsage();
    carom.simulateMany(scene, {"cue.aim_deg": aims});
    const used = process.cpuUsage(before), two = (used.user + used.system) / 1e6;
    if (round < 2) continue;  // both are warm by then
    times.native.push(one);
    times.wasm.push(two);
    ratios.push(two / one);
  }
  const [a, b] = [Math.min(...times.native), Math.min(...times.wasm)];
  console.log(`${name.padEnd(24)}${(1e6 * a / shots).toFixed(2).padStart(11)}` +
    `${(1e6 * b / shots).toFixed(2).padStart(9)}${(b / a).toFixed(2).padStart(17)}` +
    `${median(ratios).toFixed(2).padStart(15)}`);
}
worker.stdin.end();
