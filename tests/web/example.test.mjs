// The page of examples/web, served by this test, in headless Chromium.
import assert from "node:assert/strict";
import {spawnSync} from "node:child_process";
import {mkdtempSync, readFileSync, rmSync} from "node:fs";
import {createServer} from "node:http";
import {tmpdir} from "node:os";
import * as path from "node:path";
import {test} from "node:test";
import {Browser} from "../tools/view/chromium.mjs";
import {PACKAGE, SOURCE} from "./support.mjs";

const TYPES = {".html": "text/html", ".js": "text/javascript", ".wasm": "application/wasm"};

/** Serves only the example and the package. */
function answer(request, response) {
  const asked = path.posix.normalize(request.url), own = "/examples/web/", package_ = "/build/wasm/npm/";
  const file = asked === own ? path.join(SOURCE, own, "index.html")
    : asked.startsWith(package_) ? path.join(PACKAGE, path.basename(asked)) : null;
  try {
    const body = readFileSync(file);
    response.writeHead(200, {"Content-Type": TYPES[path.extname(file)] ?? "text/plain"}).end(body);
  } catch {
    response.writeHead(404).end();
  }
}

const skip = spawnSync("chromium", ["--version"]).status !== 0 ? "chromium is missing" : false;

test("the example shows the shot, and another one for another aim", {skip}, async () => {
  const folder = mkdtempSync(path.join(tmpdir(), "carom-example-"));
  const server = createServer(answer);
  await new Promise((resolve) => server.listen(0, "127.0.0.1", resolve));
  const browser = new Browser({profile: folder, pictures: process.env.CAROM_VIEW_PICTURES,
    server: "127.0.0.1"});
  try {
    await browser.open();
    await browser.size(900, 640);
    await browser.send("Page.navigate", {url: `http://127.0.0.1:${server.address().port}/examples/web/`});
    await browser.until(`document.body?.dataset.ready === "true"`);
    const words = () => browser.value(`document.querySelector("p").textContent`);
    const first = await words();
    assert.match(first, /^[\d.]+ s, .*hash [0-9a-f]{16}$/);
    await browser.value(`(() => { const aim = document.querySelector("input");
      aim.value = 80; aim.oninput(); })()`);
    assert.match(await words(), /hash [0-9a-f]{16}$/);
    assert.notEqual(await words(), first);
    await browser.picture("example");
  } finally {
    browser.process.kill();
    await new Promise((resolve) => browser.process.once("exit", resolve));
    server.close();
    rmSync(folder, {recursive: true, force: true, maxRetries: 5});
  }
});
