// The view behind the cue ball: the picture of the rendered frames, by WebGL2.
import assert from "node:assert/strict";
import {readFileSync, writeFileSync} from "node:fs";
import * as path from "node:path";
import {after, before, test} from "node:test";
import {Player, folder, missing} from "./play_page.mjs";
import {native, sceneText, withoutProgram} from "./support.mjs";

const skip = {skip: missing("chromium")}, withProgram = {skip: skip.skip || withoutProgram};
const player = new Player("chromium"), value = (expression) => player.value(expression);
const SIZE = [640, 360], VIEW = "View behind the cue ball";

before(async () => { if (!skip.skip) await player.start(); });
after(() => skip.skip ? null : player.end());

async function turned() {
  await player.browser.until(`!document.querySelector("[aria-label='${VIEW}']").hidden`);
  await player.press(VIEW);
  await player.browser.until("caromPlay.state.sight.share === 1");
}

/** The differences of all channels between the page's picture and a frame: the mean, the share above 32. */
const differences = (png, at, [eye, target]) => value(`(async () => {
  const {sight} = caromPlay.state, camera = {eye: [${eye}], target: [${target}], up: [0, 0, 1], fov: 45};
  const bytes = Uint8Array.from(atob("${png}"), (c) => c.charCodeAt(0));
  const frame = await createImageBitmap(new Blob([bytes])), [width, height] = [${SIZE}];
  const pixels = (draw) => {
    const context = Object.assign(document.createElement("canvas"), {width, height}).getContext("2d");
    draw(context);
    return context.getImageData(0, 0, width, height).data;
  };
  caromPlay.show(${at});
  const mine = pixels((context) => {
    sight.draw(${at}, camera, ${JSON.stringify(SIZE)});
    context.drawImage(sight.gl.canvas, 0, 0);
  }), theirs = pixels((context) => context.drawImage(frame, 0, 0));
  let sum = 0, far = 0;
  mine.forEach((x, i) => {
    const away = Math.abs(x - theirs[i]);
    sum += away;
    far += Number(away > 32);
  });
  return [sum / (0.75 * mine.length), far / (0.75 * mine.length)]; })()`);

const CAMERAS = {rolling: [[0.3, -0.4, 0.7], [0.6, 1.3, 0]], low: [[1.6, 0.3, 0.25], [0.6, 1.0, 0.03]],
  high: [[0.635, 0.2, 0.95], [0.64, 1.27, 0]]};
for (const [scene, at] of [["eight_ball_break.toml", 1.5], ["snooker_break.toml", 1.5]])
  test(`its pixels are those of carom render: ${scene}`, withProgram, async (t) => {
    await player.open();
    await value(`caromPlay.begin(${JSON.stringify(sceneText(scene))})`);
    await turned();
    const file = path.join(folder, scene);
    writeFileSync(file, sceneText(scene));
    for (const [name, places] of Object.entries(CAMERAS)) {
      const png = path.join(folder, `${name}.png`), [eye, target] = places.map(String);
      native(["render", file, "--at", String(at), "--eye", eye, "--target", target, "--size", SIZE.join("x"),
        "-o", png]);
      const [mean, far] = await differences(readFileSync(png).toString("base64"), at, places);
      t.diagnostic(`${name}: mean ${mean.toFixed(3)} of 255, ${(100 * far).toFixed(3)} % above 32`);
      assert.ok(mean < 0.3 && far < 0.002, `${name}: ${mean}, ${far}`);
    }
  });

test("a drag turns the aim, a pull strikes, V returns, and a lost context is no end", skip, async () => {
  await player.open();
  await turned();
  const [x, y, width, height] = await value("(({left, top, width, height}) => [left, top, width, height])" +
    "(document.querySelector('.table').getBoundingClientRect())");
  const aim = () => value("caromPlay.scene().cue.aim_deg"), first = await aim();
  await player.browser.drag([[x + 0.2 * width, y + 0.3 * height], [x + 0.2 * width + 50, y + 0.3 * height]]);
  assert.ok(Math.abs(await aim() - first + 3.5) < 0.01, `${await aim() - first}`);
  const speed = await value("caromPlay.scene().cue.speed"), below = [x + width / 2, y + 0.9 * height];
  await player.browser.drag([below, [below[0], below[1] + 30]]);
  assert.ok(await value("caromPlay.scene().cue.speed") > speed);
  await player.browser.until("!caromPlay.state.aiming");
  await player.browser.key("Escape");
  await player.browser.key("v");
  await player.browser.until("caromPlay.state.sight.share === 0");
  assert.equal(await value("caromPlay.state.sight.gl.canvas.hidden"), true);
  await turned();
  await value("void caromPlay.state.sight.gl.getExtension('WEBGL_lose_context').loseContext()");
  await player.browser.until("caromPlay.state.sight.gl === null");
  assert.match(await value("caromPlay.state.said"), /lost the view/);
  await turned();
  assert.equal(await value("caromPlay.state.sight.share"), 1);
});

test("without WebGL2 there is no button", skip, async () => {
  const source = `(() => { const {prototype} = HTMLCanvasElement, whole = prototype.getContext;
    prototype.getContext = function(kind, ...more) {
      return kind === "webgl2" ? null : whole.call(this, kind, ...more);
    }; })()`;
  const {identifier} = await player.browser.send("Page.addScriptToEvaluateOnNewDocument", {source});
  await player.open();
  await new Promise((done) => setTimeout(done, 600));
  assert.equal(await value(`document.querySelector("[aria-label='${VIEW}']").hidden`), true);
  await player.browser.send("Page.removeScriptToEvaluateOnNewDocument", {identifier});
});

test("timings are reported", skip, async (t) => {
  await player.open();
  await value(`caromPlay.begin(${JSON.stringify(sceneText("eight_ball_break.toml"))})`);
  await turned();
  const [rest, aims] = await value(`(async () => { const {state} = caromPlay, {sight} = state, {gl} = sight;
    const median = async (act) => { const times = [];
      for (let i = 0; i < 15; ++i) { const begin = performance.now(); act(i);
        gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4));
        times.push(performance.now() - begin); await new Promise((done) => setTimeout(done, 1)); }
      return times.sort((a, b) => a - b)[7].toFixed(1); };
    const size = [1280, 720], camera = sight.camera(), turned = (i) => ({...camera,
      fov: camera.fov + 0.01 * i});
    sight.coarse = false;
    return [await median(() => sight.draw(0.5, camera, size)),
      await median((i) => sight.draw(0, turned(i), size, true))]; })()`);
  const software = await value("caromPlay.state.sight.software");
  t.diagnostic(`1280x720, software: ${software}: ${rest} ms at rest, ${aims} ms with a moving camera`);
});
