// The interactive page's state: every change is a shot, failures change nothing, and everything can be
// undone.
import assert from "node:assert/strict";
import {test} from "node:test";
import {put, refusal} from "../../../tools/carom/commands/play/place.js";
import {firstContact, obviousCall, onCue} from "../../../tools/carom/commands/play/aids.js";
import {lookFor, rangeOf, sectionOf, titleOf, withBall, without, withoutBall}
  from "../../../tools/carom/commands/play/scene_text.js";
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

test("a change that carom refuses is reported and changes nothing", () => {
  const {state, said} = begun(), {scene, shot} = state;
  assert.equal(change(state, {"cue.speed": 11}), false);
  assert.equal(change(state, {"cueball.speed": 1}), false);
  assert.deepEqual([state.scene, state.shot, state.past.length], [scene, shot, 0]);
  assert.deepEqual(said.slice(-2), ["the shot is too hard", "no key is called cueball.speed"]);
  assert.equal(begin(state, START.replace('"speed":3', '"speed":12')), false);
  assert.deepEqual([state.scene, state.past.length], [scene, 0]);
});

test("undo reverts changes one by one, also of tables, and says when none is left", () => {
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

test("undo covers two hundred steps", () => {
  const {state} = begun();
  for (let i = 1; i <= 250; ++i) change(state, {"cue.speed": i / 100});
  assert.equal(state.past.length, 200);
});

test("listeners of the table hear of it with the new shot", () => {
  const {state} = freshState(), heard = [];
  state.on("table", () => heard.push(["table", state.shot.duration]));
  state.on("time", () => heard.push(["time", state.clock.now]));
  begin(state, START);
  change(state, {"cue.speed": 2});
  assert.deepEqual(heard, [["table", 3], ["time", 0], ["time", 0]]);
});

test("the stroke changes in steps", () => {
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

test("the tip stays within the miscue limit", () => {
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

test("a key is removed from its own section only", () => {
  const toml = '[table]\n  cloth = "club"\ncorners = [\n[0.5, 1],\n]\nwidth = 1 # m\n' +
    '[physics]\ncloth = "y"\ncushion_touch = "nose"\n';
  assert.equal(without(toml, "table.cloth"), toml.replace('  cloth = "club"\n', ""));
  assert.equal(without(toml, "physics.cushion"), toml);
  assert.equal(without('table.cloth = "club"\n', "table.cloth"), "");
  assert.deepEqual(sectionOf(toml, "table"), {cloth: '"club"', corners: "[", width: "1 # m"});
  assert.deepEqual(sectionOf(toml, "balls"), {});
  assert.equal(toml.slice(...rangeOf(toml, 6)), "width = 1 # m");
});

test("titles and hints are complete, and balls come and go", () => {
  const toml = "# A break at 9.5 m/s. Second.\n# Look for: the 1,\n# and the 2.5 m.\n[table]\n";
  assert.deepEqual([titleOf(toml), lookFor(toml)], ["A break at 9.5 m/s", "the 1, and the 2.5 m."]);
  assert.deepEqual(["# Draw shot: straight in.\n", "# as scene.toml raised\n", ""].map(titleOf),
    ["Draw shot", "as scene.toml raised", ""]);
  assert.equal(lookFor(""), "");
  const two = withBall(withBall("[table]\n", "1", [0.5, 1]), "2", [0.25, 1]);
  assert.equal(withoutBall(two, "1"), withBall("[table]\n", "2", [0.25, 1]));
});

/** A shot in which the ball "cue" hits half of the ball "1" at 1 s. */
function halfBall() {
  const [c, s] = [Math.cos(Math.PI / 6), 0.5];
  const piece = (start, state, r, v) =>
    ({start, state, duration: 1, r, v, w: [0, 0, 0], a: [0, 0], dw: [0, 0], spin_decay: 0});
  const moved = (id, r, v, before) =>
    ({id, radius: 0.03, segments: [before, piece(1, "sliding", r, v)]});
  const cue = moved("cue", [0, 1, 0.03], [-s * c, s * s, 0], piece(0, "sliding", [0, 0, 0.03], [0, 1, 0]));
  const at = [0.06 * s, 1 + 0.06 * c, 0.03];
  const one = moved("1", at, [s * c, c * c, 0], piece(0, "stationary", at, [0, 0, 0]));
  return {motion: {duration: 2, gravity: 9.81, tracks: [cue, one]}, events: [
    {time: 0, type: "cue_strike", ball: "cue"}, {time: 1, type: "ball_ball", ball: "1", other: "cue"}]};
}

test("the first contact: the ghost ball, the lines of both balls, and an obvious call", () => {
  const shot = halfBall(), {at, time, lines, met} = firstContact(shot, "cue");
  assert.deepEqual([at.map((x) => Math.round(x * 1e6) / 1e6), time, lines.length], [[0, 1, 0.03], 1, 2]);
  assert.deepEqual([met.id, met.left, Math.round(met.cut * 180 / Math.PI)], ["1", false, 30]);
  const pockets = [{id: "p1", center: [-1, 2]}, {id: "p2", center: [1, 1 + Math.sqrt(3)]}];
  assert.deepEqual(obviousCall(firstContact(shot, "cue"), pockets), {ball: "1", pocket: "p2"});
  assert.equal(obviousCall(firstContact(shot, "cue"), pockets.slice(0, 1)), null);
  assert.equal(firstContact({...shot, events: []}, "cue"), null);
});

test("the cue is hit where it is drawn", () => {
  const cue = {speed: 3, aim_deg: 90, elevation_deg: 0}, ball = {x: 0, y: 0, radius: 0.03};
  assert.deepEqual([[0, -0.5], [0, 0.5], [0.1, -0.5], [0, -3]].map((at) => onCue(cue, ball, at, 0.03)),
    [true, false, false, false]);
});

test("a person may aim for carom only after stopping it", () => {
  const {state} = begun();
  Object.assign(state, {game: {state: {turn: 1, over: false}}, match: {players: ["", "club"]}});
  assert.deepEqual([state.level, state.free], ["club", false]);
  assert.match(refusal(state, "cue", 0.5, 0.5), /carom's turn/);
  state.yielded = true;
  assert.deepEqual([state.level, state.free], ["", true]);
  state.game.state.turn = 0;
  assert.equal(state.free, true);
});
