// The state of the page to play on: every change is a shot, what fails changes nothing, and all is undone.
import assert from "node:assert/strict";
import {test} from "node:test";
import {put, refusal} from "../../../tools/carom/commands/play/place.js";
import {rangeOf, sectionOf, without} from "../../../tools/carom/commands/play/scene_text.js";
import {begin, change, takeBack} from "../../../tools/carom/commands/play/shots.js";
import {aimAt, nudge, wrapped} from "../../../tools/carom/commands/play/stroke.js";
import {reachable} from "../../../tools/carom/commands/play/tip.js";
import {START, freshState} from "./fakes.mjs";

function begun(lock) {
  const made = freshState(lock);
  begin(made.state, START);
  return made;
}

test("a change is a new scene and a new shot, and the old ones are freed", () => {
  const {state} = begun(), {scene, shot} = state;
  assert.ok(change(state, {"cue.speed": 4}));
  assert.equal(state.shot.duration, 4);
  assert.deepEqual([scene.freed, shot.freed], [true, true]);
  assert.deepEqual([state.scene.freed, state.shot.freed], [false, false]);
});

test("what carom refuses changes nothing and is said", () => {
  const {state, said} = begun(), {scene, shot} = state;
  assert.equal(change(state, {"cue.speed": 11}), false);
  assert.equal(change(state, {"cueball.speed": 1}), false);
  assert.deepEqual([state.scene, state.shot, state.past.length], [scene, shot, 0]);
  assert.deepEqual(said.slice(-2), ["the shot is too hard", "no key is called cueball.speed"]);
  assert.equal(begin(state, START.replace('"speed":3', '"speed":12')), false);
  assert.deepEqual([state.scene, state.past.length], [scene, 0]);
});

test("undo takes back changes one by one, other tables, and says when nothing is left", () => {
  const {state, said} = begun();
  change(state, {"cue.speed": 4});
  change(state, {"cue.speed": 5});
  change(state, {"cue.speed": 6}, {remember: false});
  begin(state, START.replace("0.25", "0.75"));
  const speeds = [];
  for (let i = 0; i < 4; ++i) {
    takeBack(state);
    speeds.push(state.scene.cue.speed);
  }
  assert.deepEqual(speeds, [6, 4, 3, 3]);
  assert.equal(said.at(-1), "There is nothing to undo.");
  assert.equal(state.scene.toml, START);
});

test("undo goes back two hundred steps", () => {
  const {state} = begun();
  for (let i = 1; i <= 250; ++i) change(state, {"cue.speed": i / 100});
  assert.equal(state.past.length, 200);
});

test("who follows the table hears of it with the new shot", () => {
  const {state} = freshState(), heard = [];
  state.on("table", () => heard.push(["table", state.shot.duration]));
  state.on("time", () => heard.push(["time", state.clock.now]));
  begin(state, START);
  change(state, {"cue.speed": 2});
  assert.deepEqual(heard, [["table", 3], ["time", 0], ["time", 0]]);
});

test("steps of the stroke", () => {
  assert.deepEqual([0, 180, 181, -181, 540, 720].map(wrapped), [0, -180, -179, 179, -180, 0]);
  assert.equal(aimAt({x: 0.5, y: 0.25}, 0.5, 1), 90);
  assert.equal(aimAt({x: 0, y: 0}, -1, -1), -135);
  const {state} = begun();
  nudge(state, "aim_deg", 90.1);
  assert.equal(state.scene.cue.aim_deg, -179.9);
  nudge(state, "speed", -5);
  assert.equal(state.scene.cue.speed, 0);
  const held = begun(["cue.speed"]).state;
  nudge(held, "speed", 1);
  assert.equal(held.scene.cue.speed, 3);
});

test("the tip stays where it does not slip off", () => {
  assert.deepEqual(reachable(0.1234, -0.2), [0.123, -0.2]);
  const [side, height] = reachable(3, -4);
  assert.ok(Math.abs(Math.hypot(side, height) - 0.5) < 2e-3 && Math.hypot(side, height) < 0.5);
  assert.ok(Math.abs(side / height + 0.75) < 0.01);
});

test("a locked page says which keys are fixed", () => {
  const {state} = begun(["ball", "cue.speed"]);
  const keys = ["ball", "balls", "ball.cue.position.x", "cue", "cue.speed"];
  assert.deepEqual(keys.map((key) => state.locked(key)), [true, false, true, false, true]);
  assert.match(refusal(state, "1", 0.5, 0.5), /fixed/);
  assert.equal(put(state, "1", 0.5, 0.5), false);
});

test("keys of a scene file are those of its sections", () => {
  const toml = '[table]\n  cloth = "club"\ncorners = [\n[0.5, 1],\n]\nwidth = 1 # m\n' +
    '[physics]\ncloth = "y"\ncushion_touch = "nose"\n';
  assert.equal(without(toml, "table.cloth"), toml.replace('  cloth = "club"\n', ""));
  assert.equal(without(toml, "physics.cushion"), toml);
  assert.equal(without('table.cloth = "club"\n', "table.cloth"), "");
  assert.deepEqual(sectionOf(toml, "table"), {cloth: '"club"', corners: "[", width: "1 # m"});
  assert.deepEqual(sectionOf(toml, "balls"), {});
  assert.equal(toml.slice(...rangeOf(toml, 6)), "width = 1 # m");
});
