// The page of `carom play` in headless Chromium.
import assert from "node:assert/strict";
import {existsSync, writeFileSync} from "node:fs";
import * as path from "node:path";
import {after, before, test} from "node:test";
import {pathToFileURL} from "node:url";
import {Player, folder, missing, pageUrl} from "./play_page.mjs";
import {native, sceneText, scenes, withoutProgram} from "./support.mjs";

const faults = [], skip = {skip: missing("chromium")}, withProgram = {skip: skip.skip || withoutProgram};
const player = new Player("chromium");
let browser, url = pageUrl;

/** Opens the page at an address; every message and every request counts as an error. */
async function open(fragment = "") {
  await browser.send("Page.navigate", {url: "about:blank"});
  await browser.send("Page.navigate", {url: url + fragment});
  await browser.until(`document.body?.dataset.ready === "true"`);
}
const value = (expression) => browser.value(expression);
const hash = () => value("caromPlay.shot().hash");
const press = (text) => value(`[...document.querySelectorAll("button")]
  .find((b) => b.textContent === ${JSON.stringify(text)}).click()`);
const settled = () => player.settled(), placeOf = (x, y) => player.onTable(x, y);
async function drag(from, to) {
  await browser.mouse("mousePressed", ...from);
  for (const share of [0.3, 0.6, 1])
    await browser.mouse("mouseMoved", ...from.map((x, k) => x + share * (to[k] - x)));
  await settled();
  await browser.mouse("mouseReleased", ...to);
  await settled();
}
const cueBall = `caromPlay.scene().balls.find((b) => b.id === caromPlay.scene().cue.ball)`;

before(async () => {
  if (skip.skip) return;
  await player.start();
  ({browser} = player);
  browser.listeners = [({method, params}) => {
    if (method === "Runtime.consoleAPICalled") faults.push(JSON.stringify(params.args.map((a) => a.value)));
    if (method === "Runtime.exceptionThrown")
      faults.push(params.exceptionDetails.exception?.description || params.exceptionDetails.text);
    if (method === "Log.entryAdded") faults.push(params.entry.text);
    if (method === "Network.requestWillBeSent" && !/^(about:|data:)/.test(params.request.url) &&
      params.request.url.split("#")[0] !== url) faults.push(`requests ${params.request.url}`);
  }];
  await browser.media("light");
  await browser.size(1400, 900);
  await open();
});
after(() => skip.skip ? null : player.end());

test("it fits every screen, and every control has a name", skip, async () => {
  const sizes = [[1400, 900, "wide"], [820, 1180, "tablet"], [390, 844, "phone"], [844, 390, "sideways"]];
  for (const [width, height, name] of sizes) {
    await browser.size(width, height, width < 900 && height < 900);
    await settled();
    await settled();
    await browser.picture(`play_${name}`);
    const wide = await value("document.documentElement.scrollWidth - document.documentElement.clientWidth");
    assert.ok(wide <= 0, `${name}: ${wide} pixels too wide`);
    const table = await value(`document.querySelector(".table").getBoundingClientRect().height`);
    assert.ok(table > 150, `${name}: the table is ${table} pixels high`);
  }
  await browser.size(1400, 900);
  const unnamed = await value(`[...document.querySelectorAll("button, input, select, textarea")].filter((e) =>
    !(e.getAttribute("aria-label") || e.textContent.trim() || e.labels?.length)).map((e) => e.outerHTML)`);
  assert.deepEqual(unnamed, []);
});

test("pointer and keys aim, and undo reverts them", skip, async () => {
  await open();
  const first = await hash(), ball = await value(cueBall);
  const at = await placeOf(ball.x, ball.y);
  await drag(await placeOf(ball.x + 0.3, ball.y + 0.3), await placeOf(ball.x + 0.2, ball.y + 0.5));
  const aim = await value("caromPlay.scene().cue.aim_deg");
  assert.ok(Math.abs(aim - Math.atan2(0.5, 0.2) * 180 / Math.PI) < 1, `the aim is ${aim}`);
  await value(`document.querySelector(".tables").focus()`);
  await browser.key("ArrowLeft");
  assert.ok(Math.abs(await value("caromPlay.scene().cue.aim_deg") - aim - 0.1) < 1e-6);
  await drag(at, await placeOf(ball.x - 0.1, ball.y - 0.1));
  const moved = await value(cueBall);
  assert.ok(Math.abs(moved.x - ball.x + 0.1) < 0.01 && Math.abs(moved.y - ball.y + 0.1) < 0.01);
  for (let i = 0; i < 10; ++i)
    await press("Undo");
  assert.equal(await hash(), first);
});

test("a shot is played, stepped and followed by the next", skip, async () => {
  await open();
  await value(`caromPlay.change({"cue.speed": 2})`);
  await browser.key(" ", "Space");
  await browser.until(`!document.body.classList.contains("aiming")`);
  await browser.key(" ", "Space");
  await browser.picture("play_watching");
  const rest = await value("caromPlay.shot().outcome.balls.map(({position}) => position.slice(0, 2))");
  await value("caromPlay.show(1e9)");
  await press("Next shot");
  await settled();
  assert.deepEqual(await value("caromPlay.scene().balls.map(({x, y}) => [x, y])"),
    rest.slice(0, (await value("caromPlay.scene().balls.length"))));
});

test("games are played by their rules", skip, async () => {
  for (const game of ["eight_ball", "nine_ball", "three_cushion", "straight_pool", "free_pyramid",
    "four_ball", "snooker", "sum_to_three"]) {
    await open();
    await value(`caromPlay.newGame("${game}")`);
    await settled();
    await browser.picture(`play_${game}`);
    for (let shots = 0; shots < 3; ++shots) {
      await value("caromPlay.run(true)");
      await value("caromPlay.show(1e9)");
      const options = `[...document.querySelectorAll(".game .verdict button")]
        .filter((b) => /player/i.test(b.textContent))`;
      const won = `/player . wins/i.test(document.querySelector(".game").textContent)`;
      await browser.until(`${options}.length > 0 || ${won}`);
      if (await value(won)) break;
      await browser.picture(`play_${game}_${shots}`);
      await value(`${options}[0].click()`);
      await settled();
      assert.equal(await value("document.querySelector('.says').classList.contains('error')"), false,
        await value("document.querySelector('.says').textContent"));
    }
  }
});

test("an address contains the shot: the same bits in another tab and in the program", skip, async () => {
  await open();
  await value(`caromPlay.change({"cue.speed": 3.21, "cue.aim_deg": 77.7})`);
  await value("caromPlay.share()");
  const [here, fragment] = [await hash(), await value("document.body.dataset.shared")];
  await open(fragment);
  assert.equal(await hash(), here);
  assert.match(await value(`document.querySelector(".says").textContent`), /same bits/);
  if (withoutProgram) return;
  const file = path.join(folder, "shared.toml");
  writeFileSync(file, await value("caromPlay.scene().toml"));
  assert.equal(native(["simulate", file, "--hash"]).trim(), here);
});

test("a bad address is refused with a sentence", skip, async () => {
  const begin = "#h=0123456789abcdef&s=";
  for (const fragment of [`${begin}AAAA`, "#s=<script>", begin + "A".repeat(70000)]) {
    await open(fragment);
    assert.match(await value(`document.querySelector(".says").textContent`), /^The address .*\.$/);
  }
});

test("a locked page allows changing only the rest", withProgram, async () => {
  const page = path.join(folder, "locked.html"), scene = path.join(folder, "draw.toml");
  writeFileSync(scene, sceneText("draw.toml"));
  native(["play", scene, "--lock", "cue.speed,ball,balls,table,physics", "-o", page]);
  if (!existsSync(page)) return;  // CAROM_PLAY_PAGE: the program has no WebAssembly
  const kept = url;
  url = pathToFileURL(page).href;
  try {
    await open();
    const ball = await value(cueBall), at = await placeOf(ball.x, ball.y);
    await drag(at, [at[0] + 60, at[1] + 20]);
    assert.deepEqual(await value(cueBall), ball);
    const disabled = (name) => value(`document.querySelector("[aria-label='${name}']").disabled`);
    for (const name of ["Speed", "Table", "New game"]) assert.ok(await disabled(name), name);
    assert.equal(await disabled("Aim"), false);
    await press("All values …");
    const enabled = `[...document.querySelectorAll(".key input, .key select")].filter((i) => !i.disabled)`;
    assert.equal(await value(`${enabled}.length`), 0);
  } finally {
    url = kept;
  }
});

test("every shipped scene opens with its hash", withProgram, async () => {
  await open();
  for (const name of scenes) {
    await value(`(() => { const s = document.querySelector("select[aria-label='Open a scene']");
      s.value = ${JSON.stringify(name)}; s.onchange(); })()`);
    const file = path.join(folder, name);
    writeFileSync(file, sceneText(name));
    assert.equal(await hash(), native(["simulate", file, "--hash"]).trim(), name);
  }
});

test("a mistake in a scene is shown at its line", skip, async () => {
  await open();
  const before = await hash();
  await press("Scene file …");
  await value(`(() => { const t = document.querySelector("textarea");
    t.value = '[table]\\npreset = "nine_foot"\\n[[ball]]\\nid = "cue"\\npositon = [0.5, 0.5]\\n'; })()`);
  await press("Use this scene");
  const said = await value(`document.querySelector("dialog[open] .error").textContent`);
  assert.match(said, /^Line 5: .*positon/);
  assert.equal(await value(`(() => { const t = document.querySelector("textarea");
    return t.value.slice(t.selectionStart, t.selectionEnd); })()`), "positon = [0.5, 0.5]");
  await browser.picture("play_mistake");
  await value(`document.querySelector("dialog[open]").close()`);
  assert.equal(await hash(), before);
});

test("every value of table, balls and physics can be set, and a wrong one is refused", skip, async () => {
  await open();
  await press("All values …");
  await browser.picture("play_values");
  const put = (id, text) => value(`(() => { const i = document.getElementById("${id}");
    i.value = "${text}"; i.onchange();
    return document.querySelector("dialog[open] .error").textContent; })()`);
  const before = await hash();
  assert.equal(await put("key-balls-mu_r", "0.02"), "");
  assert.notEqual(await hash(), before);
  assert.match(await put("key-balls-e_b", "1.5"), /out of range/);
  assert.match(await put("key-balls-e_b", "much"), /expected a number/);
  assert.equal(await put("key-physics-clusters", "sequential"), "");
  assert.match(await value("caromPlay.scene().everything"), /clusters = "sequential"/);
  await value(`document.querySelector("dialog[open]").close()`);
});

test("a thousand damaged addresses: refused or played, no script, no hang", skip, async (t) => {
  await open();
  await value("caromPlay.share()");
  const whole = await value("document.body.dataset.shared");
  const hostile = ["<script>document.body.dataset.harmed=1</script>", "%00", "A", "&s=", "'\"", "\u{1f3b1}"];
  // The browser allows 200 addresses in some seconds, so most go straight to the reading function.
  const [refused, played] = await value(`(async () => {
    const whole = ${JSON.stringify(whole)}, hostile = ${JSON.stringify(hostile)};
    let seed = 11, refused = 0, played = 0;
    const random = (n) => {
      seed = (Math.imul(seed, 1103515245) + 12345) & 0x7fffffff;
      return (seed >> 8) % n;
    };
    for (let i = 0; i < 1000; ++i) {
      const at = random(whole.length), put = hostile[random(hostile.length)];
      const damaged = whole.slice(0, at) + (i % 3 === 0 ? "" : put + whole.slice(at + random(5)));
      if (i % 20 === 0) {
        location.hash = damaged;
        await new Promise((done) => setTimeout(done, 10));
        continue;
      }
      try {
        const found = await modules["share.js"].sceneInFragment(damaged);
        if (found !== null) caromPlay.begin(found.toml);
        ++played;
      } catch (error) {
        if (!(error.message.length > 10)) throw error;
        ++refused;
      }
    }
    return [refused, played]; })()`);
  t.diagnostic(`${refused} refused, ${played} played or without a scene, 50 opened as addresses`);
  assert.equal(await value("document.body.dataset.harmed ?? ''"), "");
  assert.ok(await value(`caromPlay.change({"cue.speed": 1.5})`));
  assert.match(await hash(), /^[0-9a-f]{16}$/);
});

test("a script from elsewhere does not run, and nothing is loaded", skip, async () => {
  assert.deepEqual(faults.splice(0), []);
  const broken = await value(`new Promise((done) => {
    document.addEventListener("securitypolicyviolation", (e) => done(e.effectiveDirective));
    const s = document.createElement("script"); s.textContent = "document.body.dataset.harmed = 1";
    document.body.append(s); setTimeout(() => done("nothing"), 2000); })`);
  assert.equal(broken, "script-src-elem");
  faults.splice(0);
});

test("printing shows the shot on white", skip, async () => {
  await open();
  await browser.send("Emulation.setEmulatedMedia", {media: "print"});
  await value(`dispatchEvent(new Event("beforeprint"))`);
  await settled();
  await browser.picture("play_print");
  assert.ok(await value(`document.querySelectorAll(".paper svg circle").length`) > 10);
  assert.equal(await value(`getComputedStyle(document.querySelector(".play")).display`), "none");
  assert.match(await value(`document.querySelector(".paper p").textContent`), /hash [0-9a-f]{16}/);
  await browser.send("Emulation.setEmulatedMedia", {media: ""});
  await browser.media("dark");
  await settled();
  await browser.picture("play_dark");
  await browser.media("light");
});
