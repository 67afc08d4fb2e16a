// The words of the pages.
import assert from "node:assert/strict";
import {readFileSync} from "node:fs";
import {test} from "node:test";
import {nameOf, withNames} from "../../../tools/carom/commands/play/players.js";
import {adviceWords, aimWords, isContact, named, speedWord, tipWords, verdictWords, withUnit}
  from "../../../tools/carom/commands/play/words.js";
import {sentence} from "../../../tools/carom/page/event_words.js";

const HEADER = new URL("../../../engine/include/carom/engine/record.h", import.meta.url);
/** The rows of kEventKinds: {type}. */
const KINDS = [...readFileSync(HEADER, "utf8")
  .matchAll(/\{EventType::k\w+, "(\w+)", EventPhase::k\w+(?:, Partner::k(\w+))?\}/g)]
  .map(([, type, meets = ""]) => ({type, meets}));

test("words and units", () => {
  assert.equal(sentence("cue meets 1, cut 31 deg, 2.1 m/s"), "Cue meets 1, cut 31°, 2.1 m/s");
  assert.equal(withUnit("inch", "length", 0.0254), "1.0 in");
  assert.deepEqual(["cue", "7", "black", "Z"].map((id) => named(id)), ["the cue ball", "the 7", "the black",
    "Z"]);
  assert.equal(named("12", "snooker_full"), "a red");
});

test("contacts are types of events", () => {
  const contacts = KINDS.filter((kind) => isContact(kind)).map(({type}) => type);
  assert.deepEqual(contacts, ["cue_strike", "ball_ball", "ball_cluster", "ball_cushion", "ball_jaw",
    "ball_pocket", "ball_out"]);
});

test("verdicts in a sentence", () => {
  assert.equal(verdictWords({fouls: [], points: 1}, {is_scored: true}), "Fair shot, 1 point.");
  assert.equal(verdictWords({fouls: [], points: 1}, {is_scored: false}), "Fair shot.");
  assert.equal(verdictWords({fouls: [{foul: "miss"}], points: 0, penalty: 4}, {is_scored: true}),
    "Foul: miss; 4 points to the other player.");
  assert.equal(verdictWords({fouls: [{foul: "no rail", rule: "6.3"}, {foul: "scratch"}], points: 2}, {}),
    "Foul: no rail (6.3), scratch.");
});

test("a stroke is described in players' terms", () => {
  assert.deepEqual([0.5, 2, 3, 9].map(speedWord), ["soft", "medium", "hard", "break"]);
  assert.equal(tipWords(0, 0), "centre");
  assert.equal(tipWords(0.3, -0.4), "full draw, half left English");
  assert.equal(tipWords(-0.1, 0.2), "half follow, a little right English");
  const met = (degrees, left = true) => ({id: "7", cut: degrees * Math.PI / 180, left});
  assert.equal(aimWords(met(0.2)), "the 7 full");
  assert.equal(aimWords(met(30, false)), "the 7 half ball, cut 30° right");
  assert.equal(aimWords(met(80)), "the 7 thin, cut 80° left");
  assert.equal(aimWords(undefined), "no ball");
  assert.equal(adviceWords("bank: 7 into p3 (foot-left corner pocket), cut 23 degrees left, slow"),
    "bank: the 7 into the foot-left corner pocket, cut 23° left, slow");
});

test("players have names", () => {
  const told = (...players) => [0, 1].map((k) => nameOf({match: {players}}, k));
  assert.deepEqual(told("", "club"), ["You", "carom, club"]);
  assert.deepEqual(told("", ""), ["Player 1", "Player 2"]);
  assert.deepEqual(told("club", "machine"), ["carom 1, club", "carom 2, machine"]);
  const names = (text, ...players) => withNames({match: {players}}, text);
  assert.equal(names("player 2 shoots, or player 1 wins", "", "club"), "carom shoots, or you win");
  assert.equal(names("Foul. Player 1 shoots.", "", "club"), "Foul. You shoot.");
  assert.equal(names("player 2 shoots", "", ""), "Player 2 shoots");
  assert.equal(withNames({match: null}, "player 2 shoots"), "player 2 shoots");
});
