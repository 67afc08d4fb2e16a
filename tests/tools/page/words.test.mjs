// Every event of the engine is told in words, and meets the part of the table that it should.
import assert from "node:assert/strict";
import {readFileSync} from "node:fs";
import {test} from "node:test";
import {eventWords, isContact, verdictWords, withUnit} from "../../../tools/carom/commands/play/words.js";
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
  // Those of resting contacts are only in the list of all events, under their names.
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

test("an event meets the part that the engine says", () => {
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
