// Matches on the page of `carom play`, against carom and between two people, in real browsers: by mouse,
// touch and keyboard.
import assert from "node:assert/strict";
import {after, before, describe, test} from "node:test";
import {Player, missing} from "./play_page.mjs";

const OVER = "caromPlay.state.verdict?.options[0].state.over === true && !caromPlay.state.clock.playing";
const YOURS = "caromPlay.state.free && caromPlay.state.level === ''";
// A whole shot of a quick match may pass between two looks, so shots are counted.
const STARTED = "caromPlay.state.turns.person + caromPlay.state.turns.carom";
const BALLS = {cue: [0.6, 0.7], 8: [0.9, 1.7], 9: [0.3, 2.0]};

async function pressByKeys(player, text) {
  // From the top: in headless Firefox, keys press nothing after Tab has left the page at its end.
  await player.value("document.querySelector('button').focus()");
  for (let i = 0; i < 90; ++i) {
    const begins = `document.activeElement.textContent.startsWith(${JSON.stringify(text)})`;
    if (await player.value(begins)) return player.browser.key("Enter");
    await player.browser.key("Tab");
  }
  throw new Error(`no key leads to ${text}`);
}

/** Requests a hint, uses the first one and shoots. */
async function takeHint(player, by) {
  const {browser} = player;
  const press = (what) => by === "keys" ? pressByKeys(player, what) : player.press(what, by);
  await press("Hint");
  await browser.until("caromPlay.state.hints.length > 0");
  const aim = await player.value("caromPlay.state.hints[0].cue.aim_deg");
  if (by === "keys") await pressByKeys(player, "1");
  else await player.press(".hint-list button", by);
  assert.ok(Math.abs(await player.value("caromPlay.scene().cue.aim_deg") - aim) < 1e-9);
  if (by === "keys") {
    await browser.key("ArrowUp");
    await player.value("document.activeElement.blur()");
    await browser.key(" ", "Space");
  } else {
    await press("Shoot");
  }
}

/** Plays a frame of nine-ball to its end. @returns the numbers of shots by the person and by carom */
async function playOut(player, by, level = "beginner") {
  await player.open();
  await player.value("void (Object.assign(caromPlay.state, {quick: true}).clock.speed = 8)");
  await player.frame("nine_ball", BALLS, {players: ["", level]});
  // A shot at nothing: carom then plays with ball in hand.
  const aim = await player.value("caromPlay.scene().cue.aim_deg");
  if (by === "keys") for (let i = 0; i < 5; ++i) await player.browser.key("ArrowLeft");
  else await player.drag([[1.0, 0.4], [1.1, 0.6]], by);
  assert.notEqual(await player.value("caromPlay.scene().cue.aim_deg"), aim);
  await player.value(`caromPlay.change({"cue.aim_deg": -90, "cue.speed": 0.5})`);
  await player.value(`(() => { const {state} = caromPlay, turns = state.turns = {person: 0, carom: 0};
    state.on("starts", () => {
      if (state.clock.now === 0) ++turns[state.level ? "carom" : "person"];
    }); })()`);
  if (by === "keys") await player.browser.key(" ", "Space");
  else await player.press("Shoot", by);
  await player.browser.until(`${STARTED} > 0`);
  for (let shots = 0; shots < 40; ++shots) {
    await player.browser.until(`(${OVER}) || (${YOURS})`, 2400);
    if (await player.value(OVER)) break;
    const before = await player.value(STARTED);
    await takeHint(player, by);
    await player.browser.until(`${STARTED} > ${before}`);
  }
  assert.ok(await player.value(OVER), "the match has no end");
  return player.value("caromPlay.state.turns");
}

function matches(player, name) {
  for (const by of ["mouse", "touch", "keys"])
    test(`a match against carom to its end, by ${by}`, async (t) => {
      const turns = await playOut(player, by);
      t.diagnostic(`${turns.person} shots of the person, ${turns.carom} of carom`);
      assert.ok(turns.person >= 1 && turns.carom >= 1);
      assert.match(await player.value("document.querySelector('.over').textContent"), /win/);
    });

  for (const level of ["beginner", "club", "league", "professional", "machine"])
    test(`a match against ${level} to its end, by touch on a phone`, async () => {
      await player.browser.size(390, 844, true);
      await playOut(player, "touch", level);
      assert.match(await player.value("document.querySelector('.over').textContent"), /win/);
      await player.browser.picture(`${name}_phone_${level}`);
      await player.browser.size(1400, 900);
    });

  test("carom thinks visibly, can be stopped, and continues", async () => {
    await player.open();
    await player.settled();
    await player.press("New game");
    await player.browser.until("document.querySelector('dialog[open]') !== null");
    await player.value(`(() => { const [game, ...players] = ["Game", "First player", "Second player"]
      .map((name) => document.querySelector("dialog[open] select[aria-label='" + name + "']"));
      game.value = "ten_ball"; game.onchange(); players[0].value = "machine"; })()`);
    await player.press("Start");
    assert.equal(await player.value("document.body.classList.contains('thinking')"), true);
    assert.match(await player.value("document.querySelector('.says').textContent"), /machine.* is thinking/);
    await player.browser.picture(`${name}_thinks`);
    await player.press("Stop");
    assert.match(await player.value("caromPlay.state.said"), /^Stopped/);
    assert.equal(await player.value("caromPlay.state.free"), true);
    await player.press("Let carom shoot");
    await player.browser.until(`/^carom \\(machine\\): .*break/.test(caromPlay.state.said)`, 2400);
    assert.equal(await player.value("caromPlay.state.clock.playing"), false, "it strikes before it is read");
    await player.browser.until("caromPlay.state.clock.playing");
  });
}

function survivals(player) {
  test("a match survives a reload, and starts again", async () => {
    await player.open();
    await player.value("caromPlay.state.quick = true");
    await player.frame("nine_ball", BALLS, {players: ["", ""], more: {turn: 1}});
    await player.value(`caromPlay.change({"cue.aim_deg": -90, "cue.speed": 0.5})`);
    await player.press("Shoot");
    await player.browser.until("!caromPlay.state.aiming");
    await player.value("caromPlay.show(1e9)");
    await player.browser.until("caromPlay.state.aiming && caromPlay.state.game.state.turn === 0", 1200);
    await player.settled();
    // The cue ball is in hand: the rules need the previous shot.
    const ball = await player.value("(({x, y}) => [x, y])(caromPlay.state.struck())");
    await player.drag([ball, [0.9, 0.5]]);
    const moved = await player.value("(({x, y}) => [x, y])(caromPlay.state.struck())");
    assert.ok(Math.abs(moved[0] - 0.9) < 0.02 && Math.abs(moved[1] - 0.5) < 0.02, String(moved));
    await player.browser.until(`JSON.parse(localStorage["carom.match"]).toml === caromPlay.scene().toml`);
    const before = await player.value("[caromPlay.shot().hash, caromPlay.state.game.state]");
    await player.open();
    assert.deepEqual(await player.value("[caromPlay.shot().hash, caromPlay.state.game.state]"), before);
    assert.match(await player.value("caromPlay.state.said"), /continues/);
    await player.drag([moved, [0.5, 0.6]]);
    assert.ok(Math.abs(await player.value("caromPlay.state.struck().x") - 0.5) < 0.02);
    await player.press("Start again");
    assert.equal(await player.value("caromPlay.scene().balls.length"), 10);
    await player.value("localStorage.clear()");
  });

}

function strictness(player) {
  test("a shot counts from the moment it is struck", async () => {
    await player.open();
    await player.frame("nine_ball", BALLS, {players: ["", ""], match: {race: 2}});
    await player.value(`caromPlay.change({"cue.aim_deg": -90, "cue.speed": 1})`);
    const hash = await player.value("caromPlay.shot().hash");
    await player.press("Shoot");
    await player.browser.until("caromPlay.state.clock.now > 0.1");
    await player.browser.key("Escape");
    await player.press("[aria-label='Pause (space)']");
    await player.value("caromPlay.state.clock.go(0)");
    assert.equal(await player.value("caromPlay.state.aiming"), false,
      "the start of the slider undoes it");
    assert.equal(await player.value("[...document.querySelectorAll('.modes button')][0].disabled"), true);
    await player.open();
    await player.browser.until("!caromPlay.state.aiming");
    assert.equal(await player.value("caromPlay.shot().hash"), hash, "a reload undoes it");
    await player.value("void (caromPlay.state.quick = true, caromPlay.show(1e9))");
    await player.browser.until("caromPlay.state.aiming && caromPlay.state.game.state.turn === 1", 1200);
    // The last shot can be seen again, and the match continues after it.
    const next = await player.value("caromPlay.shot().hash");
    await player.press("Replay");
    assert.equal(await player.value("caromPlay.shot().hash"), hash);
    await player.value("caromPlay.show(1e9)");
    await player.browser.until("caromPlay.state.aiming");
    assert.equal(await player.value("caromPlay.shot().hash"), next);
    // A match ends only after a question.
    await player.value("void (window.declines = true)");
    await player.press("Start again");
    assert.deepEqual(await player.value("[window.asked.length, caromPlay.shot().hash]"), [1, next]);
    await player.value("void (localStorage.clear(), caromPlay.state.match = null)");
  });

}

function races(player, name) {
  test("a race to two racks: the next rack, the end, and a rematch", async () => {
    await player.open();
    await player.value("void (caromPlay.state.quick = true)");
    for (const [racks, button, after] of [[[0, 0], "Next rack", [1, 0]], [[1, 0], "Rematch", [0, 0]]]) {
      await player.frame("nine_ball", {cue: [0.3, 0.3], 9: [0.15, 0.15]}, {players: ["", ""],
        match: {race: 2, racks}});
      await player.value("caromPlay.change({'cue.aim_deg': -135, 'cue.speed': 1, " +
        "'cue.offset.height': -0.3})");
      await player.press("Shoot");
      await player.browser.until("!caromPlay.state.aiming");
      await player.value("caromPlay.show(1e9)");
      await player.browser.until("document.querySelector('.game.end .over') !== null");
      assert.match(await player.value("document.querySelector('.over').textContent"),
        /^Player 1 wins the (rack|match)/);
      await player.browser.picture(`${name}_end_${racks[0]}`);
      await player.press(button);
      const now = "(({match, game}) => [match.racks, game.state.turn, window.asked.length])(caromPlay.state)";
      assert.deepEqual(await player.value(now), [after, 1, 0]);
      assert.equal(await player.value("caromPlay.scene().balls.length"), 10);
    }
    await player.value("void (localStorage.clear(), caromPlay.state.match = null)");
  });

  test("a person's hand errs as chosen, and the score names it", async () => {
    for (const errors of ["beginner", ""]) {
      await player.open();
      await player.frame("nine_ball", BALLS, {match: {errors}});
      await player.value(`caromPlay.change({"cue.aim_deg": -90, "cue.speed": 1})`);
      assert.match(await player.value("document.querySelector('.score').textContent"),
        errors ? /beginner hand/ : /exact hand/);
      await player.press("Shoot");
      const aim = await player.value("caromPlay.scene().cue.aim_deg");
      assert.equal(aim === -90, errors === "", `the aim is ${aim}`);
      await player.value("void (caromPlay.run(false), localStorage.clear(), caromPlay.state.match = null)");
    }
  });

}

function scratches(player) {
  test("after a scratch without rules the cue ball is in hand", async () => {
    await player.open();
    await player.frame("nine_ball", {cue: [1.0, 2.27], 9: [0.3, 0.4]});
    await player.value("void Object.assign(caromPlay.state, {game: null, match: null})");
    await player.value(`caromPlay.change({"cue.aim_deg": 45, "cue.speed": 2})`);
    await player.press("Shoot");
    await player.browser.until("!caromPlay.state.aiming");
    await player.value("caromPlay.run(false)");
    await player.value("caromPlay.show(1e9)");
    const cue = "caromPlay.shot().outcome.balls.find(({id}) => id === 'cue')";
    assert.ok(await player.value(`${cue}.pocket !== ""`));
    await player.press("Next shot");
    assert.deepEqual(await player.value("caromPlay.scene().balls.map(({id}) => id).sort()"), ["9", "cue"]);
    assert.match(await player.value("document.querySelector('.says').textContent"), /in hand/);
    assert.equal(await player.value("caromPlay.state.free"), true);
  });
}

for (const name of ["chromium", "firefox-esr"]) describe(name, {skip: missing(name)}, () => {
  const player = new Player(name);
  before(() => player.start());
  after(() => player.end());
  matches(player, name);
  survivals(player);
  strictness(player);
  races(player, name);
  scratches(player);
});
