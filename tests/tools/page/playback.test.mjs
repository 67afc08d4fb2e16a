// The pages' clock, driven by the test's frames.
import assert from "node:assert/strict";
import {beforeEach, test} from "node:test";
import {Playback, eventBefore} from "../../../tools/carom/page/playback.js";

const EVENTS = [0, 1, 1, 2.5].map((time) => ({time}));
let frames, log;

beforeEach(() => {
  [frames, log] = [[], []];
  globalThis.requestAnimationFrame = (draw) => frames.push(draw);
});

const made = (more = {}) => new Playback({end: () => 3, events: () => EVENTS,
  show: (...about) => log.push(["show", ...about]), label: () => log.push(["label"]),
  starts: () => log.push(["starts"]), ended: () => log.push(["ended"]), ...more});
/** Lets `ms` pass. @returns the time then shown */
function pass(clock, ms) {
  const draw = frames.shift();
  draw(clock.drawn + ms);
  return clock.now;
}

test("an instant outside the shot shows its start or end", () => {
  const clock = made();
  for (const [t, now] of [[-1, 0], [1.5, 1.5], [9, 3]]) {
    clock.show(t, "about");
    assert.equal(clock.now, now);
  }
  assert.deepEqual(log, Array(3).fill(["show", "about"]));
});

test("time runs at its speed, and a long frame is not made up for", () => {
  const clock = made();
  clock.run(true);
  assert.ok(Math.abs(pass(clock, 50) - 0.05) < 1e-9);
  clock.speed = 4;
  assert.ok(Math.abs(pass(clock, 50) - 0.25) < 1e-9);
  assert.ok(Math.abs(pass(clock, 60000) - 0.65) < 1e-9);
  clock.run(false);
  assert.equal(pass(clock, 50), clock.now);
  assert.deepEqual(frames, []);
});

test("it stops at the end, and starts again from there", () => {
  const clock = made();
  clock.show(2.99);
  clock.run(true);
  assert.equal(pass(clock, 90), 3);
  assert.equal(clock.playing, false);
  assert.deepEqual(log.at(-1), ["ended"]);
  clock.run(true);
  assert.equal(clock.now, 0);
  assert.deepEqual(log.at(-1), ["starts"]);
});

test("it jumps from event to event, and to the ends", () => {
  const clock = made(), times = (direction) => [...Array(4)].map(() => (clock.jump(direction), clock.now));
  assert.deepEqual(times(1), [1, 2.5, 3, 3]);
  assert.deepEqual(times(-1), [2.5, 1, 0, 0]);
  assert.deepEqual([-1, 0, 0.5, 1, 9].map((t) => eventBefore(EVENTS, t)), [-1, 0, 0, 2, 3]);
});

test("reduced motion shows stills", () => {
  const clock = made({still: (ms) => (ms < 900 ? null : clock.eventTime(1))});
  clock.run(true);
  const {drawn} = clock;
  assert.equal(pass(clock, 500), 0);
  assert.equal(clock.drawn, drawn);
  assert.equal(pass(clock, 901), 1);
  assert.equal(pass(clock, 901), 2.5);
});
