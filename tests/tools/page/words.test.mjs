// Every event of the engine has a sentence and meets the correct part of the table.
import assert from "node:assert/strict";
import {readFileSync} from "node:fs";
import {test} from "node:test";
import {nameOf, withNames} from "../../../tools/carom/commands/play/players.js";
import {adviceWords, aimWords, eventWords, isContact, speedWord, tipWords, verdictWords, withUnit}
  from "../../../tools/carom/commands/play/words.js";
import {partner} from "../../../tools/carom/page/event_words.js";

const HEADER = new URL("../../../engine/include/carom/engine/record.h", import.meta.url);
/** The rows of kEventKinds: {type, partner}. */
const KINDS = [...readFileSync(HEADER, "utf8")
  .matchAll(/\{EventType::k\w+, "(\w+)", EventPhase::k\w+(?:, Partner::k(\w+))?\}/g)]
  .map(([, type, meets = ""]) => ({type, meets}));

const event = (type, more = {}) => ({type, ball: "cue", other: "1", otherName: "head rail", speed: 2,
  closing: 1, cut: 0.5, diamond: 1.25, balls: ["cue", "1"], ...more});

test("every type of event has its own words", () => {
  assert.equal(KINDS.length, 19);
  const told = KINDS.map(({type}) => eventWords(event(type), "metric"));
  assert.equal(new Set(told).size, KINDS.length);
  // Events of resting contacts appear only in the list of all events, by their names.
  const named = KINDS.filter(({type}, i) => told[i] === `The cue ball: ${type.replaceAll("_", " ")} 1`);
  assert.deepEqual(named, KINDS.filter(({type}) => /_(hold|release)$/.test(type)));
});

test("words and units", () => {
  assert.equal(eventWords(event("ball_ball"), "metric"), "The cue ball hits the 1 at 1.00 m/s, cut 29°");
  assert.equal(eventWords(event("ball_cushion"), "inch"),
    "The cue ball bounces off the head rail at diamond 1.3: 4.5 mph");
  assert.equal(eventWords(event("ball_cushion", {speed: null, diamond: null}), "metric"),
    "The cue ball bounces off the head rail: ");
  assert.equal(withUnit("inch", "length", 0.0254), "1.0 in");
});

test("contacts are types of events", () => {
  const contacts = KINDS.filter((kind) => isContact(kind)).map(({type}) => type);
  assert.deepEqual(contacts, ["cue_strike", "ball_ball", "ball_cluster", "ball_cushion", "ball_jaw",
    "ball_pocket", "ball_out"]);
});

test("an event meets the part named by the engine", () => {
  const record = {tracks: [{id: "Ball"}], table: {jaws: [{id: "Jaw"}], pockets: [{id: "Pocket"}],
    cushions: [{id: "Cushion"}]}};
  for (const {type, meets} of KINDS)
    assert.equal(partner(record, {type, b: meets === "" ? -1 : 0}), meets, type);
});

test("verdicts in a sentence", () => {
  assert.equal(verdictWords({fouls: [], points: 1}), "Fair shot, 1 point.");
  assert.equal(verdictWords({fouls: [], points: 0}), "Fair shot.");
  assert.equal(verdictWords({fouls: [{foul: "no rail", rule: "6.3"}, {foul: "scratch"}], points: 2}),
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
  assert.equal(names("player 2 shoots, or Player 1 wins", "", "club"), "carom shoots, or You win");
  assert.equal(names("player 2 shoots", "", ""), "Player 2 shoots");
  assert.equal(withNames({match: null}, "player 2 shoots"), "player 2 shoots");
});
