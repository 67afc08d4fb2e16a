// The package in bundles for browsers, by the common bundlers: none may look for modules of node.
import assert from "node:assert/strict";
import {execFileSync} from "node:child_process";
import {copyFileSync, cpSync, existsSync, mkdtempSync, readdirSync, rmSync, writeFileSync} from "node:fs";
import {tmpdir} from "node:os";
import * as path from "node:path";
import {after, test} from "node:test";
import {PACKAGE, SOURCE} from "./support.mjs";

const TOOLS = path.join(SOURCE, "build/npm/node_modules/.bin");
const folder = mkdtempSync(path.join(tmpdir(), "carom-bundle-"));
const APP = 'import {Scene, init, simulate} from "./carom/index.js";\n' +
  'await init();\nconsole.log(simulate(Scene.parse("[[ball]]\\n[cue]")).hash);\n';
const WEBPACK = `module.exports = {mode: "production", entry: "./app.mjs", target: "web",
  output: {path: "${path.join(folder, "webpack")}"}, experiments: {topLevelAwait: true}};`;

cpSync(PACKAGE, path.join(folder, "carom"), {recursive: true});
for (const [name, text] of [["app.mjs", APP], ["webpack.config.cjs", WEBPACK],
  ["index.html", '<script type="module" src="app.mjs"></script>']])
  writeFileSync(path.join(folder, name), text);
after(() => rmSync(folder, {recursive: true, force: true}));

const missing = (name) =>
  ({skip: existsSync(path.join(TOOLS, name)) ? false : `${name} is not installed; tools/web --test does it`});
const run = (name, ...args) =>
  execFileSync(path.join(TOOLS, name), args, {cwd: folder, encoding: "utf8", stdio: "pipe"});
const hasWasm = (where) => readdirSync(path.join(folder, where)).some((name) => name.endsWith(".wasm"));

test("esbuild: the bundle runs beside carom.wasm", missing("esbuild"), () => {
  run("esbuild", "app.mjs", "--bundle", "--format=esm", "--platform=browser", "--outfile=esbuild/app.mjs");
  copyFileSync(path.join(folder, "carom/carom.wasm"), path.join(folder, "esbuild/carom.wasm"));
  const node = (file) => execFileSync(process.execPath, [file], {cwd: folder, encoding: "utf8"});
  assert.match(node("esbuild/app.mjs"), /^[0-9a-f]{16}\n$/);
  assert.equal(node("esbuild/app.mjs"), node("app.mjs"));
});
test("webpack 5: the bundle includes carom.wasm", missing("webpack"), () => {
  assert.doesNotMatch(run("webpack", "--config", "webpack.config.cjs"), /ERROR|node:fs|Critical dependency/);
  assert.ok(hasWasm("webpack"));
});
test("vite: the bundle includes carom.wasm", missing("vite"), () => {
  run("vite", "build", "--target", "esnext", "--outDir", "vite");
  assert.ok(hasWasm("vite/assets"));
});
