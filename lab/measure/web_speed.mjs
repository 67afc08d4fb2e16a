#!/usr/bin/env node
// Compares the speed of shots in WebAssembly and in the native engine: batches of the same shots on one
// thread, in turn, in the Python module, which calls the engine once per batch, in node, and in headless
// Chromium. Prints the fewest microseconds of the thread's CPU time per shot, and ratios; the last column is
// simulate() in node, which a page calls for each change. CAROM_NPM names another package, such as one
// without SIMD.
//
//   lab/measure/web_speed.mjs [ROUNDS=15]     needs tools/web, build/release/python, chromium
import {spawn} from "node:child_process";
import {mkdtempSync, rmSync} from "node:fs";
import {tmpdir} from "node:os";
import * as path from "node:path";
import * as readline from "node:readline";
import {pathToFileURL} from "node:url";
import {Browser} from "../../tests/tools/view/chromium.mjs";
import {SOURCE, carom, native as program, sceneText} from "../../tests/web/support.mjs";

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

const folder = mkdtempSync(path.join(tmpdir(), "carom-speed-")), page = path.join(folder, "play.html");
program(["play", "-o", page]);
const browser = new Browser({profile: path.join(folder, "profile")});
await browser.open();
await browser.send("Page.navigate", {url: pathToFileURL(page).href});
await browser.until(`document.body?.dataset.ready === "true"`);
await browser.send("Performance.enable", {timeDomain: "threadTicks"});
async function busy() {
  const {metrics} = await browser.send("Performance.getMetrics");
  return metrics.find(({name}) => name === "TaskDuration").value;
}
async function inChromium(text, shots) {
  await browser.value(`(() => {
    const {carom} = caromPlay.state, scene = carom.Scene.parse(${JSON.stringify(text)}), shots = ${shots};
    const aim = scene.cue.aim_deg;
    window.batch = [scene, {"cue.aim_deg": Float64Array.from({length: shots},
      (_, i) => aim + (i / shots - 0.5))}];
  })()`);
  const before = await busy();
  await browser.value("caromPlay.state.carom.simulateMany(...batch).shots");
  return await busy() - before;
}

await carom.init();
const median = (list) => list.sort((a, b) => a - b)[Math.floor(list.length / 2)];
const least = (list) => Math.min(...list);
console.log(`${"scene".padEnd(24)}native us  node us  Chromium us   ratios of the least   median ratios` +
  "   alone us");
for (const [name, shots] of CASES) {
  const text = sceneText(name), scene = carom.Scene.parse(text, name), aim = scene.cue.aim_deg;
  const aims = Float64Array.from({length: shots}, (_, i) => aim + (i / shots - 0.5));
  const times = [[], [], []];
  for (let round = 0; round < ROUNDS + 2; ++round) {
    const here = await native(name, text, aims);
    const before = process.cpuUsage();
    carom.simulateMany(scene, {"cue.aim_deg": aims});
    const {user, system} = process.cpuUsage(before), there = await inChromium(text, shots);
    if (round < 2) continue;  // warm-up
    [here, (user + system) / 1e6, there].forEach((seconds, k) => times[k].push(seconds));
  }
  let alone = Infinity;
  for (let round = 0; round < ROUNDS; ++round) {
    const before = process.cpuUsage();
    for (let i = 0; i < shots; ++i) carom.simulate(scene).free();
    const {user, system} = process.cpuUsage(before);
    alone = Math.min(alone, (user + system) / shots);
  }
  const us = times.map((list) => (1e6 * least(list) / shots).toFixed(2));
  const ratio = (k) => (least(times[k]) / least(times[0])).toFixed(2);
  const middle = (k) => median(times[k].map((t, i) => t / times[0][i])).toFixed(2);
  console.log(`${name.padEnd(24)}${us[0].padStart(9)}${us[1].padStart(9)}${us[2].padStart(13)}` +
    `${ratio(1).padStart(15)}${ratio(2).padStart(7)}${middle(1).padStart(10)}${middle(2).padStart(6)}` +
    `${alone.toFixed(1).padStart(11)}`);
}
worker.stdin.end();
browser.process.kill();
await new Promise((resolve) => browser.process.once("exit", resolve));
rmSync(folder, {recursive: true, force: true, maxRetries: 5});
