// The page of `carom play` in headless Chromium: it plays, shares, and refuses damaged addresses. Skipped
// without the browser, or with a program that was built without WebAssembly.
import assert from "node:assert/strict";
import {spawn, spawnSync} from "node:child_process";
import {existsSync, mkdtempSync, rmSync} from "node:fs";
import {tmpdir} from "node:os";
import * as path from "node:path";
import {after, before, test} from "node:test";
import {pathToFileURL} from "node:url";
import {SOURCE, native} from "./support.mjs";

const folder = mkdtempSync(path.join(tmpdir(), "carom-play-")), file = path.join(folder, "play.html");
const scene = path.join(SOURCE, "scenes/three_cushion.toml");
native(["play", scene, "-o", file]);
const skip = !existsSync(file) ? "the program has no WebAssembly; run tools/web and build it again"
  : spawnSync("chromium", ["--version"]).status !== 0 ? "chromium is missing" : false;
const address = pathToFileURL(file).href, faults = [];
let browser;

/** A browser with two pipes, file descriptors 3 and 4: messages are JSON, each followed by a 0. */
class Browser {
  #waiting = new Map();
  #next = 0;
  async open() {
    this.process = spawn("chromium", ["--headless=new", "--no-sandbox", "--disable-gpu", "--no-first-run",
      "--remote-debugging-pipe", "--host-resolver-rules=MAP * ~NOTFOUND", "--disable-background-networking",
      `--user-data-dir=${path.join(folder, "profile")}`, "about:blank"],
    {stdio: ["ignore", "ignore", "ignore", "pipe", "pipe"]});
    let text = "";
    this.process.stdio[4].setEncoding("utf8").on("data", (data) => {
      text += data;
      for (let end; (end = text.indexOf("\0")) >= 0; text = text.slice(end + 1))
        this.#receive(JSON.parse(text.slice(0, end)));
    });
    const {targetId} = await this.send("Target.createTarget", {url: "about:blank"});
    this.session = (await this.send("Target.attachToTarget", {targetId, flatten: true})).sessionId;
    for (const domain of ["Page", "Runtime", "Log"]) await this.send(`${domain}.enable`);
    await this.send("Emulation.setDeviceMetricsOverride",
      {width: 1400, height: 900, deviceScaleFactor: 1, mobile: false});
  }
  #receive(message) {
    if (message.id) {
      this.#waiting.get(message.id)(message.result);
      this.#waiting.delete(message.id);
    } else if (message.method === "Runtime.exceptionThrown") {
      const {exception, text} = message.params.exceptionDetails;
      faults.push(exception?.description || text);
    } else if (message.method === "Log.entryAdded") {
      faults.push(message.params.entry.text);
    }
  }
  send(method, params = {}) {
    const id = ++this.#next;
    this.process.stdio[3].write(JSON.stringify({id, method, params, sessionId: this.session}) + "\0");
    return new Promise((resolve) => this.#waiting.set(id, resolve));
  }
  async value(expression) {
    const {result, exceptionDetails} =
      await this.send("Runtime.evaluate", {expression, returnByValue: true, awaitPromise: true});
    if (exceptionDetails) throw new Error(exceptionDetails.exception?.description || exceptionDetails.text);
    return result.value;
  }
  async show(url) {
    await this.send("Page.navigate", {url: "about:blank"});
    await this.send("Page.navigate", {url});
    for (let i = 0; i < 400; ++i) {
      if (await this.value("document.body?.dataset.ready === 'true'")) return;
      await new Promise((resolve) => setTimeout(resolve, 50));
    }
    throw new Error(`${url} is never ready`);
  }
  async drag(from, to) {
    const move = (type, [x, y]) => this.send("Input.dispatchMouseEvent",
      {type, x, y, button: "left", buttons: type === "mouseReleased" ? 0 : 1, clickCount: 1});
    await move("mousePressed", from);
    for (let k = 1; k <= 5; ++k)
      await move("mouseMoved", from.map((x, i) => x + (to[i] - x) * k / 5));
    await this.value("new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))");
    await move("mouseReleased", to);
  }
}

const hash = () => browser.value("document.body.dataset.hash");
const said = () => browser.value("document.querySelector('.says').textContent");

before(async () => {
  if (skip) return;
  browser = new Browser();
  await browser.open();
});
after(() => {
  browser?.process.kill();
  try { rmSync(folder, {recursive: true, force: true}); } catch { /* the browser still writes its profile */ }
});

test("the page plays the scene with the program's bits", {skip}, async () => {
  await browser.show(address);
  assert.equal(await hash(), native(["simulate", scene, "--hash"]).trim());
  await browser.value("caromPlay.run(true)");
  await browser.value("caromPlay.show(1e9)");
  assert.ok(await browser.value("caromPlay.shot().events.length > 5"));
});

test("a drag aims, and an address brings the same bits", {skip}, async () => {
  await browser.show(address);
  const before = await hash();
  const [left, top, width, height] = await browser.value(`(() => {
    const box = document.querySelector(".table").getBoundingClientRect();
    return [box.left, box.top, box.width, box.height]; })()`);
  await browser.drag([left + 0.7 * width, top + 0.3 * height], [left + 0.7 * width, top + 0.7 * height]);
  const aimed = await hash();
  assert.notEqual(aimed, before);
  await browser.value("caromPlay.share()");
  const fragment = await browser.value("document.body.dataset.shared");
  await browser.show(address + fragment);
  assert.equal(await hash(), aimed);
  assert.match(await said(), /The same bits/);
});

test("damaged addresses are refused with a sentence", {skip}, async () => {
  const begin = "#h=0123456789abcdef&s=";
  for (const fragment of [`${begin}AAAA`, "#s=<script>", begin + "A".repeat(70000)]) {
    await browser.show(address + fragment);
    assert.match(await said(), /^The address .*\.$/);
  }
});

test("every game begins, and its next shot follows", {skip}, async () => {
  await browser.show(address);
  for (const game of ["eight_ball", "nine_ball", "three_cushion"]) {
    await browser.value(`caromPlay.newGame("${game}")`);
    assert.match(await browser.value("document.querySelector('.game-text').textContent"), /Player 1 shoots/);
    await browser.value("caromPlay.run(true); caromPlay.show(1e9)");
    await browser.value("new Promise((done) => setTimeout(done, 100))");
    await browser.value(`[...document.querySelectorAll("button")]
      .find((button) => button.textContent === "Next shot").click()`);
    assert.ok(await browser.value("document.querySelector('.game-text').textContent !== ''"));
  }
});

test("nothing was thrown and nothing was loaded", {skip}, () => assert.deepEqual(faults, []));
