// The program in node equals the native one in texts, statuses, files and bits. Tested as npm installs it, by
// the node that runs this test, or by the command in CAROM_NODE (tools/slow: other versions, and Windows').
import assert from "node:assert/strict";
import {execFileSync, spawn, spawnSync} from "node:child_process";
import {closeSync, existsSync, mkdirSync, mkdtempSync, openSync, readFileSync, readdirSync, rmSync,
  writeFileSync} from "node:fs";
import {constants, tmpdir} from "node:os";
import * as path from "node:path";
import {after, before, test} from "node:test";
import {gunzipSync} from "node:zlib";
import {PACKAGE, PROGRAM, SOURCE, sceneText, scenes, withoutProgram} from "./support.mjs";

const skip = withoutProgram || (existsSync(path.join(PACKAGE, "bin/program.js")) ? false
  : "tools/web --test builds the program for node");
const NODE = (process.env.CAROM_NODE || process.execPath).split(" ");
const onWindows = NODE.at(-1).endsWith(".exe");
const folder = mkdtempSync(path.join(tmpdir(), "carom-npx-"));
const installed = path.join(folder, "node_modules/carom/bin/carom.mjs");

/** Each program has its own folder, so that both write the same names. Its streams are files, because node
 * cannot start threads with wine's pipes. */
function inFolder(which, command, args, {input = ""} = {}) {
  const cwd = path.join(folder, which), streams = ["in", "out", "err"].map((name) => path.join(folder, name));
  mkdirSync(cwd, {recursive: true});
  writeFileSync(streams[0], input);
  const stdio = streams.map((name, i) => openSync(name, i === 0 ? "r" : "w"));
  const {status, signal} = spawnSync(command, args, {cwd, stdio});
  stdio.forEach((fd) => closeSync(fd));
  const [out, err] = streams.slice(1).map((name) => readFileSync(name, "utf8"));
  return {status, signal, out, err};
}
const native = (args, options) => inFolder("native", PROGRAM, args, options);
const inNode = (args, options) => inFolder("node", NODE[0], [...NODE.slice(1), installed, ...args], options);
const put = (name, text) => {
  for (const which of ["native", "node"]) {
    mkdirSync(path.join(folder, which, path.dirname(name)), {recursive: true});
    writeFileSync(path.join(folder, which, name), text);
  }
};
const written = (which, name) => readFileSync(path.join(folder, which, name));

const started = (args, stdio) =>
  spawn(NODE[0], [...NODE.slice(1), installed, ...args], {cwd: path.join(folder, "node"), stdio});
const aMoment = () => new Promise((resolve) => setTimeout(resolve, 50));
/** The status as a shell sees it. */
const ended = (child) => new Promise((resolve) =>
  child.once("exit", (status, signal) => resolve(signal ? 128 + constants.signals[signal] : status)));

/** Both print the same, end with the same status, and write the same files. */
function same(args, files = [], options = {}) {
  const there = native(args, options), here = inNode(args, options);
  assert.deepEqual(here, there, args.join(" "));
  for (const name of files) {
    assert.ok(written("node", name).equals(written("native", name)), `${args.join(" ")}: ${name} differs`);
    assert.ok(!written("node", name).includes("\r"), name);
  }
  return here;
}

before(() => {
  if (skip) return;
  const [packed] = JSON.parse(execFileSync("npm", ["pack", "--json", "--pack-destination", folder],
    {cwd: PACKAGE, encoding: "utf8", stdio: ["ignore", "pipe", "ignore"]}));
  execFileSync("npm", ["install", "--silent", "--offline", "--no-audit", "--no-fund", "--prefix", folder,
    path.join(folder, packed.filename)]);
  for (const name of scenes) put(name, sceneText(name));
});
after(() => rmSync(folder, {recursive: true, force: true, maxRetries: 5}));

test("the help of every command", {skip}, () => {
  const {out} = same(["--help"]);
  same(["--version"]);
  const commands = [...out.matchAll(/^  ([a-z]+)  /gm)].map((found) => found[1]);
  assert.ok(commands.length >= 20, out);
  const folders = readdirSync(path.join(SOURCE, "tools/carom/commands"));
  for (const name of folders) assert.ok(commands.includes(name), name);
  for (const name of commands) same([name, "--help"]);
});

test("the hash of every scene", {skip}, () => {
  for (const name of scenes) assert.match(same(["simulate", name, "--hash"]).out, /^[0-9a-f]{16}\n$/);
});

test("reports and files of a shot", {skip}, () => {
  same(["simulate", "eight_ball_break.toml", "--verify", "-o", "break.json"], ["break.json"]);
  same(["simulate", "three_cushion.toml", "--measure", "route", "--measure", "1000*cushions_before_first"]);
  // It also names the processor's instruction sets.
  const checked = (run) => run(["check", "masse.toml"]).out.replace(/^isa .*$/m, "");
  assert.equal(checked(inNode), checked(native));
  same(["view", "break.json", "-o", "break.html"], ["break.html"]);
  // The program in node compresses the balls' pictures by other code, without libpng.
  const exported = (run) => run(["export", "three_cushion.toml", "-o", "shot.glb"]).out.replace(/\d+ kB/, "");
  assert.equal(exported(inNode), exported(native));
  same(["compare", "draw.toml", "follow.toml"]);
  same(["sensitivity", "draw.toml"]);
  same(["judge", "break.json", "--game", "eight_ball"]);
  same(["describe", "games"]);
  same(["describe", "man"]);
});

test("the interactive page is the same except for the compression of carom.wasm", {skip}, () => {
  for (const {status, err} of [native(["play", "draw.toml"]), inNode(["play", "draw.toml"])])
    assert.equal(status, 0, err);
  const parts = (which) => {
    const html = String(written(which, "play.html")), [wasm] = /H4sI[\w+/=]{99999,}/.exec(html);
    return [html.replace(wasm, ""), gunzipSync(Buffer.from(wasm, "base64"))];
  };
  const [here, wasm] = parts("node"), [there, nativeWasm] = parts("native");
  assert.equal(here, there);
  assert.ok(wasm.equals(nativeWasm));
});

test("sweeps, breaks and solutions", {skip}, () => {
  const sweep = ["sweep", "draw.toml", "--vary", "cue.aim_deg=normal(0.5)",
    "--vary", "cue.speed=uniform(1,4)", "--measure", "1000*cushions_before_first", "--count", "1000", "-o"];
  const timeless = ({status, out, err}) => [status, out.replace(/[\d.]+ (shots|ms|s|us)\b.*/g, ""), err];
  for (const jobs of ["1", "2", "0"]) {
    const file = `jobs${jobs}.csv`, args = [...sweep, file, "--jobs", jobs];
    assert.deepEqual(timeless(inNode(args)), timeless(native(args)));
    assert.ok(written("node", file).equals(written("native", file)), file);
  }
  same(["break", "nine_ball", "--shots", "4000", "--best", "1", "-o", "best.toml"], ["best.toml"]);
  same(["advise", "draw.toml", "--game", "nine_ball", "--best", "2"]);
});

test("impacts, line by line", {skip}, () => {
  const line = JSON.stringify({a: {v: [1, 0, 0]}, normal: [1, 0, 0]});
  same(["impact"], [], {input: `${line}\r\n\r\n${line}\nnot JSON\n`});
});

test("bad usage and bad scenes", {skip}, () => {
  put("bad.toml", '[table]\r\npreset = "nine_fot"\r\n');
  for (const args of [[], ["simulat"], ["simulate"], ["simulate", "none.toml"], ["simulate", "bad.toml"],
    ["sweep", "draw.toml", "--vary", "cue.sped=normal(1)", "-o", "x.csv"],
    ["simulate", "draw.toml", "--untl", "3"], ["simulate", "."],
    ["view", "draw.toml", "-o", "none/x.html"], ["view", "draw.toml", "-o", "x.pdf"]])
    assert.notEqual(same(args).status, 0);
});

test("commands that need OpenGL or cairo say so in one sentence", {skip}, () => {
  for (const args of [["render", "draw.toml"], ["render", "draw.toml", "-o", "x.mp4"],
    ["margin", "draw.toml"], ["diagram", "draw.toml", "-o", "x.svg"]]) {
    const {status, out, err} = inNode(args);
    assert.ok(status === 1 || status === 2, args.join(" "));
    assert.equal(out, "");
    assert.match(err, /^carom: this build of carom has no [^\n]*\n$/);
  }
});

test("names with spaces, other letters and backslashes, and lines that end with CR LF", {skip}, () => {
  put("a b/żółw ü.toml", sceneText("draw.toml").replaceAll("\n", "\r\n"));
  const [hash] = native(["simulate", "draw.toml", "--hash"]).out.split("\n");
  const {out} = same(["simulate", "a b/żółw ü.toml", "--hash"]);
  assert.equal(out, `${hash}\n`);
  same(["simulate", "./a b/../a b/żółw ü.toml", "-o", "a b/ß.json"], ["a b/ß.json"]);
  if (!onWindows) return;
  for (const start of ["a b\\", `Z:${folder.replaceAll("/", "\\")}\\node\\a b\\`]) {
    assert.equal(inNode(["simulate", `${start}żółw ü.toml`, "--hash"]).out, out);
    for (let again = 0; again < 2; ++again)
      assert.equal(inNode(["simulate", `${start}żółw ü.toml`, "-o", `${start}日本.json`]).status, 0);
    const events = (which, name) => JSON.parse(written(which, name)).events;
    assert.deepEqual(events("node", "a b/日本.json"), events("native", "a b/ß.json"));
    rmSync(path.join(folder, "node/a b/日本.json"));
  }
});

test("the output may go to a pipe that closes", {skip: skip || onWindows}, () => {
  const shell = `"$@" | head -c 1; exit "\${PIPESTATUS[0]}"`;
  // More than a pipe holds: a shorter record may be written before the reader is gone.
  const args = ["simulate", "eight_ball_break.toml", "-o", "/dev/stdout"];
  assert.equal(inFolder("node", "bash", ["-c", shell, "bash", ...NODE, installed, ...args]).status,
    inFolder("native", "bash", ["-c", shell, "bash", PROGRAM, ...args]).status);
});

test("Ctrl-C keeps a sweep's finished rows", {skip}, async () => {
  const args = ["sweep", "eight_ball_break.toml", "--vary", "cue.aim_deg=normal(0.5)",
    "--count", "10000", "-o", "stopped.csv"];
  const cwd = path.join(folder, "node"), said = path.join(folder, "err"), err = openSync(said, "w");
  const child = started(args, ["ignore", "ignore", err]);
  const parts = () => readdirSync(cwd).filter((name) => name.endsWith(".parts"))
    .flatMap((name) => readdirSync(path.join(cwd, name))).filter((name) => name.endsWith(".csv"));
  while (parts().length < 2 && child.exitCode === null) await aMoment();
  child.kill("SIGINT");
  const status = await ended(child);
  closeSync(err);
  assert.equal(status, 130, readFileSync(said, "utf8"));
  assert.match(readFileSync(said, "utf8"),
    /stopped; run the same command to continue with .*stopped\.csv\.[0-9a-f]{16}\.parts/);
  assert.match(inNode(args).err, /continuing with .*: \d+ of 10000 shots are done/);
  native(args);
  assert.ok(written("node", "stopped.csv").equals(written("native", "stopped.csv")));
});

test("a signal ends a program waiting for input", {skip: skip || onWindows}, async () => {
  const child = started(["impact"], ["pipe", "pipe", "inherit"]);
  child.stdin.write("{}\n");
  await new Promise((resolve) => child.stdout.once("data", resolve));
  child.kill("SIGINT");
  assert.equal(await ended(child), 130);
});

test("one lock, one process", {skip: skip || onWindows}, async () => {
  const args = ["sweep", "eight_ball_break.toml", "--vary", "cue.aim_deg=normal(1)",
    "--count", "100000", "-o", "locked.csv"];
  const cwd = path.join(folder, "node");
  const child = started(args, "ignore");
  // The third one continues with a part of the first.
  const parts = () => readdirSync(cwd).filter((name) => name.startsWith("locked.csv."))
    .flatMap((name) => readdirSync(path.join(cwd, name))).filter((name) => name.endsWith(".csv"));
  while (parts().length === 0) await aMoment();
  const second = inNode(args);
  assert.match(second.err, /lock: another program is writing the files that this lock protects/);
  assert.equal(second.status, 1);
  // A killed one leaves its lock, which blocks nobody.
  child.kill("SIGKILL");
  await ended(child);
  const third = started(args, ["ignore", "ignore", "pipe"]);
  const said = await new Promise((resolve) => third.stderr.once("data", (text) => resolve(String(text))));
  third.kill("SIGTERM");
  assert.equal(await ended(third), 143);
  assert.match(said, /continuing with|stopped/);
});
