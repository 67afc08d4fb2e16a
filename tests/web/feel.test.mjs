// Use of the page of `carom play`: screens, fingers, keys, words, sounds, and screen readers.
import assert from "node:assert/strict";
import {existsSync, readFileSync, writeFileSync} from "node:fs";
import * as path from "node:path";
import {after, afterEach, before, test} from "node:test";
import {pathToFileURL} from "node:url";
import {Player, folder, missing} from "./play_page.mjs";
import {SOURCE, sceneText} from "./support.mjs";

const skip = {skip: missing("chromium")}, player = new Player("chromium");
const AXE = path.join(SOURCE, "build/npm/node_modules/axe-core/axe.min.js");
const value = (expression) => player.value(expression), aim = () => value("caromPlay.scene().cue.aim_deg");
const says = () => value("document.querySelector('.says').textContent");
const EIGHT = {cue: [0.6, 0.7], 1: [0.9, 1.7], 3: [0.3, 2.0], 8: [0.5, 1.2], 10: [1, 2.2], 11: [0.9, 0.4],
  14: [0.2, 0.9]};
const SIZES = [[360, 640], [390, 844], [844, 390], [820, 1180], [1280, 800], [1920, 1080]];
let browser;

before(async () => {
  if (skip.skip) return;
  await player.start();
  ({browser} = player);
  await browser.media("light");
});
after(() => skip.skip ? null : player.end());
afterEach(() => skip.skip ? null
  : value("(() => { caromPlay.state.match = null; localStorage.clear(); })()"));

const choose = (box, name) => value(`(() => { const s = document.querySelector("${box}");
  s.value = "${name}"; s.onchange(); })()`);
/** The diameter of the struck ball [px]. */
const ballSize = () => value("(({view: {projection, dense}}, {radius}) => " +
  "2 * radius * projection.scale / dense)(caromPlay.state, caromPlay.state.struck())");
async function sized(width, height) {
  await browser.size(width, height, Math.min(width, height) < 500);
  for (let i = 0; i < 3; ++i) await player.settled();
}

test("play shows a line, a ghost ball and no more; the list fills while the balls move", skip, async () => {
  await player.open();
  const open = "[...document.querySelectorAll('.events li')].filter((item) => !item.hidden).length";
  await browser.until(`${open} > 3`);
  await player.press("Play");
  assert.equal(await value(open), 0);
  assert.match(await value("document.querySelector('.event-card h2').textContent"), /^Events$/);
  await player.press("Shoot");
  await browser.until(`${open} > 0`);
  await value("caromPlay.show(1e9)");
  await browser.until(`${open} === caromPlay.state.events().length`);
});

test("a locked exercise does not show its answer", skip, async () => {
  await player.open();
  const html = readFileSync(new URL(await value("location.href")), "utf8");
  const file = path.join(folder, "locked_play.html");
  const scene = JSON.stringify(sceneText("draw.toml")).replaceAll("<", "\\u003c");
  const locked = html.replace('"lock":[]', '"lock":["cue.speed"]').replace(/"scene":""/, `"scene":${scene}`);
  writeFileSync(file, locked);
  await player.open(pathToFileURL(file).href);
  assert.equal(await value("caromPlay.state.mode"), "play");
  const disabled = (text) => value(`[...document.querySelectorAll("button")]
    .find((b) => b.textContent === "${text}").disabled`);
  assert.equal(await disabled("Practise"), true);
  assert.equal(await value("document.querySelectorAll('.events li:not([hidden])').length"), 0);
  assert.ok(!await value("document.body.innerText.includes('Look for')"));
  assert.equal(await value("[...document.querySelectorAll('button')].find((b) => b.textContent === 'Hint')" +
    ".checkVisibility()"), false);
});

test("every screen: nothing is cut off, and fingers find their targets", skip, async () => {
  for (const scheme of ["light", "dark"]) for (const [width, height] of SIZES) {
    await browser.media(scheme);
    await sized(width, height);
    await player.open();
    await player.frame("eight_ball", EIGHT, {players: ["", "club"], more: {group: ["solids", "stripes"]}});
    // At the 1, and on into a corner.
    await player.value("caromPlay.change({'cue.aim_deg': 70.6})");
    await player.settled();
    await browser.picture(`screen_${width}x${height}_${scheme}`);
    const scrolls = await value("(({scrollWidth, scrollHeight}) => [scrollWidth, scrollHeight])" +
      "(document.documentElement)");
    assert.deepEqual(scrolls, [width, height]);
    const box = await value("(({width, height}) => [width, height])" +
      "(document.querySelector('.table').getBoundingClientRect())");
    if (width === 1920) assert.ok(box[0] > 1300, `the table is ${box[0]} px wide`);
    const ball = await ballSize(), pull = await value("(({width, height}) => 0.9 * Math.max(width, height))" +
      "(document.querySelector('.pull').getBoundingClientRect())");
    if (width === 390) assert.ok(ball >= 14, `a ball has ${ball} px`);
    if (width === 820) assert.ok(box[1] > 1000, `the table is ${box[1]} px high`);
    assert.ok(pull >= 200, `the power strip has ${pull} px`);
    if (width > 900) continue;
    const small = await value(`[...document.querySelectorAll("button, select, [role=slider]")]
      .filter((e) => e.checkVisibility()).map((e) => [e.textContent, e.getBoundingClientRect()])
      .filter(([, b]) => b.width < 44 || b.height < 44 || b.bottom > innerHeight + 1 ||
        b.right > innerWidth + 1)
      .map(([text, b]) => [text, b.width, b.height, b.bottom])`);
    assert.deepEqual(small, []);
  }
  await browser.media("light");
});

test("a finger on the table aims and does not scroll; beside it, it does not aim", skip, async () => {
  await sized(390, 844);
  await player.open();
  const before = await aim();
  await player.drag([[1.0, 1.8], [1.1, 1.0]], "touch");
  assert.notEqual(await aim(), before);
  assert.equal(await value("scrollY"), 0);
  const aimed = await aim();
  await browser.drag([await player.placeOf(".tip-ball"), [200, 500]], "touch");
  assert.equal(await aim(), aimed);
  // The cue in the bar is pulled back; in Play, releasing it strikes.
  const [left, middle] = await value("(({left, top, height}) => [left, top + height / 2])" +
    "(document.querySelector('.pull').getBoundingClientRect())");
  const pull = () => browser.drag([[left + 30, middle], [left + 220, middle]], "touch");
  await pull();
  assert.ok(await value("caromPlay.scene().cue.speed") > 5);
  assert.equal(await value("caromPlay.state.aiming"), true);
  await player.press("Play");
  await pull();
  await browser.until("!caromPlay.state.aiming");
  await player.press("More");
  assert.ok(await value("document.querySelector('.side').checkVisibility()"));
  await sized(1280, 800);
});

test("the strip aims by 0.02 degrees a pixel, and a snooker ball has 10 pixels", skip, async () => {
  await sized(390, 844);
  await player.open();
  const [x, y] = await player.placeOf(".fine"), first = await aim();
  await browser.drag([[x, y], [x + 50, y]], "touch");
  assert.ok(Math.abs(await aim() - first + 1) < 1e-6, `${await aim() - first}`);
  await value(`caromPlay.newGame("snooker")`);
  await player.settled();
  assert.ok(await ballSize() >= 10, `${await ballSize()}`);
  await sized(1280, 800);
});

test("snooker: the ball on, a nominated colour, the value of a foul", skip, async () => {
  await player.open();
  await value(`caromPlay.newGame("snooker", {players: ["", ""], hints: false, rules: {}})`);
  const text = () => value("document.querySelector('.game-text').textContent");
  assert.match(await text(), /On: a red \(1\)/);
  await value("void Object.assign(caromPlay.state.game.state, {on: 'colour', opening: false})");
  await value("caromPlay.state.tell('lists')");
  assert.match(await text(), /On: any colour; nominate it/);
  assert.deepEqual(await value("[...document.querySelector('[aria-label=\"Called ball\"]')].slice(1)" +
    ".map((o) => o.textContent).sort()"),
  ["black", "blue", "brown", "green", "pink", "yellow"].map((x) => `the ${x}`));
  await choose("[aria-label='Called ball']", "pink");
  await value(`caromPlay.change({"cue.aim_deg": -90, "cue.speed": 1})`);
  await player.press("Shoot");
  await value("caromPlay.show(1e9)");
  await browser.until("caromPlay.state.verdict?.fouls.length > 0 && !caromPlay.state.clock.playing");
  assert.match(await value("document.querySelector('.verdict').textContent"), /6 points to the other player/);
});

test("practice warns while aiming, hides events with the paths, and clamps typed values", skip, async () => {
  await player.open();
  const help = () => value("document.querySelector('.help').textContent");
  await value(`caromPlay.begin(${JSON.stringify(sceneText("draw.toml"))})`);
  await value(`caromPlay.change({"ball.cue.position.x": 0.1, "cue.aim_deg": 0})`);
  assert.match(await help(), /^Warning: the cue reaches into the cushion; raise it/);
  await choose("[aria-label='Predicted paths']", "off");
  await browser.until("[...document.querySelectorAll('.events li')].every((item) => item.hidden)");
  await value("(() => { const i = document.querySelector('.stroke [aria-label=\"Speed\"]'); " +
    "i.value = '50'; i.onchange(); })()");
  assert.equal(await value("caromPlay.scene().cue.speed"), 12);
  assert.match(await says(), /^Speed: 12.00 m\/s, the limit/);
});

test("a rack is known to be broken, and a safety has no share of wins", skip, async () => {
  await player.open();
  await choose("[aria-label='Rack']", "eight_ball");
  await player.press("Hint");
  await browser.until("caromPlay.state.hints.length > 0");
  assert.equal(await value("caromPlay.state.hints[0].kind"), "break");
  await value(`(() => { const {state} = caromPlay, [hint] = state.hints;
    state.hints = [{...hint, kind: "safety", words: "safety: soft", makes: {value: 0}, fouls: {value: 0.1}}];
    state.tell("hints"); })()`);
  assert.match(await value("document.querySelector('.hint-list button').textContent"),
    /safety: soft: 90 % fair/);
});

test("zoom, fine aim, and the cue pulled back", skip, async () => {
  await player.open();
  await player.press("Play");
  const scale = () => value("caromPlay.state.view.projection.scale"), whole = await scale();
  const wheel = async (at, deltaY, modifiers = 0) => {
    await browser.send("Input.dispatchMouseEvent",
      {type: "mouseWheel", x: at[0], y: at[1], deltaX: 0, deltaY, modifiers});
    await player.settled();
  };
  const at = await player.onTable(0.5, 1.5);
  await wheel(at, -100);
  await wheel(at, -100);
  assert.ok(Math.abs(await scale() / whole - 1.44) < 1e-6);
  const kept = await player.onTable(0.5, 1.5);
  assert.ok(Math.hypot(kept[0] - at[0], kept[1] - at[1]) < 1, "the place under the pointer stays");
  await browser.key("0");
  assert.equal(await scale(), whole);
  const first = await aim();
  await wheel(at, -100, 8);
  assert.ok(Math.abs(await aim() - first - 0.02) < 1e-6);
  // Two fingers apart.
  const fingers = (type, ...points) => browser.send("Input.dispatchTouchEvent", {type,
    touchPoints: points.map(([x, y], id) => ({x, y, id, radiusX: 5, radiusY: 5, force: 1}))});
  await fingers("touchStart", [at[0] - 20, at[1]]);
  await fingers("touchStart", [at[0] - 20, at[1]], [at[0] + 20, at[1]]);
  await fingers("touchMove", [at[0] - 40, at[1]], [at[0] + 40, at[1]]);
  await fingers("touchEnd");
  await player.settled();
  assert.ok(Math.abs(await scale() / whole - 2) < 0.05, `${await scale() / whole}`);
  await browser.key("0");
  // Pulling the cue back from its tip sets the power; releasing it strikes.
  const pulled = await value(`(() => { const {cue} = caromPlay.scene(), b = caromPlay.state.struck(),
    a = cue.aim_deg * Math.PI / 180, at = (d) => [b.x - d * Math.cos(a), b.y - d * Math.sin(a)];
    return [at(0.4), at(0.5)]; })()`);
  const speed = await value("caromPlay.scene().cue.speed");
  await player.drag(pulled);
  assert.ok(await value("caromPlay.scene().cue.speed") > speed + 0.5);
  await browser.until("!caromPlay.state.aiming");
});

test("arrows do not scroll after a click on a button, and one line says what a drag does", skip, async () => {
  await player.open();
  await player.press("Undo");
  await player.press("Sound");
  const before = await aim();
  await browser.key("ArrowDown");
  await browser.key("ArrowLeft");
  assert.ok(Math.abs(await aim() - before - 0.1) < 1e-6);
  assert.equal(await value("scrollY"), 0);
  assert.match(await value("document.querySelector('.help').textContent"), /^Drag the cloth: aim/);
});

test("sounds play if enabled, louder for harder impacts", skip, async () => {
  await player.open();
  await player.press("Shoot");
  await browser.until("caromPlay.state.clock.now > 0.3");
  assert.equal(await value("caromPlay.sound.played"), 0);
  await browser.key("Escape");
  await player.press("Sound");
  await player.press("Shoot");
  await browser.until("caromPlay.sound.played > 2");
  const loud = (closing) =>
    value(`modules["sound.js"].soundOf({type: "ball_ball", closing: ${closing}}).loudness`);
  assert.ok(await loud(0.5) < await loud(2));
});

test("the words of the game", skip, async () => {
  await player.open();
  await value(`caromPlay.change({"cue.offset.side": 0.3, "cue.offset.height": -0.4, "cue.speed": 2})`);
  const words = await value("document.querySelector('.stroke-words').textContent");
  assert.match(words, /full draw, half left English/);
  assert.match(words, /^The 1 (thin|[\w-]+ ball|full), cut \d+° (left|right)/);
  assert.match(await value("document.querySelector('.pull-words').textContent"), /^medium, cue 2.00 m\/s$/);
  assert.equal(await value("document.querySelector('[aria-label=\"Speed\"]').max"), "12");
});

test("messages concern this shot and include the engine's warnings", skip, async () => {
  await player.open();
  await value(`caromPlay.begin(${JSON.stringify(sceneText("masse.toml"))})`);
  await player.press("Shoot");
  await browser.until("!caromPlay.state.aiming");
  await value("caromPlay.show(1e9)");
  await browser.until("document.querySelector('.says').textContent.startsWith('At rest')");
  assert.match(await says(), /Warning: .*elevat/);
  await player.press("Next shot");
  assert.equal(await says(), "");
});

test("every game begins with its table, its balls and its score", skip, async () => {
  await player.open();
  const names = await value("caromPlay.state.page.games.map(({name}) => name)");
  assert.equal(names.length, 11);
  for (const name of names) {
    await value(`caromPlay.newGame("${name}", {players: ["", ""], hints: false, rules: {}})`);
    await player.settled();
    assert.equal(await value("caromPlay.state.game.state.game"), name);
    assert.match(await value("document.querySelector('.game-text').textContent"), /Player 1 shoots/, name);
    assert.equal(await value("document.querySelectorAll('.player').length"), 2);
    await browser.picture(`game_${name}`);
  }
});

test("balls are added, removed and racked, and potted ones are in the tray", skip, async () => {
  await player.open();
  const ids = () => value("caromPlay.scene().balls.map(({id}) => id)"), first = await ids();
  await value("document.querySelector('.setup').open = true");
  const click = (text) => value(`[...document.querySelectorAll("button")]
    .find((b) => b.textContent === "${text}").click()`);
  await click("Add a ball");
  assert.equal((await ids()).length, first.length + 1);
  await click("Remove it");
  assert.deepEqual(await ids(), first);
  await choose("[aria-label='Rack']", "nine_ball");
  assert.equal((await ids()).length, 10);
  await player.frame("eight_ball", {cue: [1.0, 1.0], 9: [1.1, 2.4], 1: [0.4, 0.6], 8: [0.6, 1.8]});
  await value("caromPlay.state.set.push({id: '2', style: {color: [0, 0, 1], pattern: 'solid', number: 2}})");
  await value("caromPlay.state.tell('time')");
  assert.deepEqual(await value("[...document.querySelectorAll('.tray .chip')].map((c) => c.title)"), ["2"]);
});

test("the cue is raised over a ball behind it", skip, async () => {
  await player.open();
  await player.frame("nine_ball", {cue: [0.6, 1.2], 8: [0.6, 0.9], 9: [0.3, 2.0]});
  await value("void Object.assign(caromPlay.state, {game: null, match: null, mode: 'practise'})");
  await value(`caromPlay.change({"cue.aim_deg": 90})`);
  assert.ok(await value("caromPlay.scene().cue.elevation_deg") > 3);
  assert.equal(await value("caromPlay.scene().cue.in"), "");
  await value(`caromPlay.change({"cue.aim_deg": 20})`);
  assert.equal(await value("caromPlay.scene().cue.elevation_deg"), 0);
});

test("titles are complete, and a scene has its hint", skip, async () => {
  await player.open();
  const titles = await value("[...document.querySelector('select.open').options].map((o) => o.textContent)");
  assert.ok(titles.some((title) => title.includes("eight_ball_break.toml with the cue raised by 5 degrees")));
  await choose("select.open", "draw.toml");
  assert.match(await says(), /^Look for: the other ball falls into the corner pocket/);
});

test("a downloaded page begins with the shot", skip, async () => {
  await player.open();
  await value(`caromPlay.change({"cue.aim_deg": 77.7, "cue.speed": 2.5})`);
  const [hash, html] = await value("[caromPlay.shot().hash, caromPlay.download()]");
  const file = path.join(folder, "shot.html");
  writeFileSync(file, `<!doctype html>\n${html}`);
  await player.open(pathToFileURL(file).href);
  assert.equal(await value("caromPlay.shot().hash"), hash);
});

const missed = existsSync(AXE) ? false : "axe-core is not installed; tools/web --test does it";
const withAxe = {skip: skip.skip || missed};
test("axe finds nothing serious", withAxe, async () => {
  const axe = readFileSync(AXE, "utf8"), bad = [];
  const check = async (what) => {
    await value(`(() => { ${axe}; return true; })()`);
    bad.push(...await value(`axe.run().then(({violations}) => violations
      .filter(({impact}) => ["serious", "critical"].includes(impact))
      .map(({id, nodes}) => "${what}: " + id + " " + nodes.map((n) => n.html.slice(0, 90)).join(" | ")))`));
  };
  for (const scheme of ["light", "dark"]) for (const [width, height] of [[1280, 800], [390, 844]]) {
    await browser.media(scheme);
    await sized(width, height);
    await player.open();
    await check(`${scheme} ${width}`);
    await player.frame("eight_ball", EIGHT, {players: ["", "club"]});
    await player.settled();
    await check(`a game, ${scheme} ${width}`);
    if (width < 500) await player.press("More");
    await player.press("New game");
    await check(`dialog, ${scheme} ${width}`);
    await value("document.querySelector('dialog[open]').close()");
    await value("(() => { caromPlay.state.match = null; localStorage.clear(); })()");
  }
  await browser.media("light");
  assert.deepEqual(bad, []);
});

test("timings are reported", skip, async (t) => {
  await sized(1920, 1080);
  await player.open();
  const usable = await value("performance.getEntriesByName('usable')[0].startTime.toFixed(0)");
  t.diagnostic(`usable ${usable} ms after opening`);
  await value("localStorage.clear()");
  const aims = (scene) => value(`(async () => { const times = [];
    ${scene}; const {cue} = caromPlay.scene();
    for (let i = 0; i < 60; ++i) { const begin = performance.now();
      caromPlay.change({"cue.aim_deg": cue.aim_deg + 0.01 * i});
      caromPlay.state.view.over.getContext("2d").getImageData(0, 0, 1, 1);
      times.push(performance.now() - begin); await new Promise((done) => setTimeout(done)); }
    times.sort((a, b) => a - b); return [times[30], times[0]]; })()`);
  const told = ([median, least]) => `${median.toFixed(1)} ms (at best ${least.toFixed(1)})`;
  for (const mode of ["Practise", "Play"]) {
    await player.press(mode);
    const two = await aims(`caromPlay.begin(${JSON.stringify(sceneText("draw.toml"))})`);
    const breaks = await aims(`caromPlay.begin(${JSON.stringify(sceneText("eight_ball_break.toml"))})`);
    t.diagnostic(`${mode}, 1920x1080: an aim in ${told(two)} for two balls, ${told(breaks)} for a break`);
  }
  const frames = await value(`(async () => { const times = []; caromPlay.show(0); caromPlay.run(true);
    let last = performance.now();
    while (caromPlay.state.clock.now < 2.5) { await new Promise((done) => requestAnimationFrame(done));
      const now = performance.now(); times.push(now - last); last = now; }
    caromPlay.run(false); return times.sort((a, b) => a - b); })()`);
  const frame = (share) => `${frames[Math.floor(share * frames.length)].toFixed(1)} ms`;
  t.diagnostic(`16 balls roll, 1920x1080: ${frame(0.5)} a frame (median), ${frame(0.1)} at best, ` +
    `${frame(0.95)} for 95 %`);
  await player.frame("eight_ball", EIGHT, {players: ["", ""]});
  const [ms] = await value(`(async () => { const {thinker, scene, game} = caromPlay.state, times = [];
    for (let seed = 1; seed < 7; ++seed) {
      const options = {skill: "professional", seed, best: 1, shots: 0};
      await thinker.advise(scene.toml, game.state, options);
      times.push(thinker.ms);
    }
    return times.sort((a, b) => a - b); })()`);
  t.diagnostic(`a decision of a professional in WebAssembly, about 4000 shots: ${ms.toFixed(0)} ms at best`);
});
