// Pointers on the table: they move balls, aim, pull the cue and zoom. So do keys.

import {PULL, onCue, pulledBack, speedOf} from "./aids.js";
import {endReplay} from "./game.js";
import {put, refusal} from "./place.js";
import {letGo, setSpeed} from "./pull.js";
import {change, strike, takeBack} from "./shots.js";
import {aimAt, nudge, wrapped} from "./stroke.js";

const FINE = 0.1;  // of the turn of the pointer
const SIGHT_TURN = 0.07;  // [degrees] of aim per pixel in the view behind the cue ball
const HELD_FIRST = 250;  // [ms] A second finger that comes later makes the first one finer.

/** The target of a press at this event: {id}, a ball; {cue: true}; or {id: null}, the aim. */
export function heldAt(state, event) {
  const {view, shot, scene} = state, index = view.ballAt(event), {cue} = scene, struck = state.struck();
  const id = index < 0 ? null : shot.balls[index], ball = id === null ? undefined : state.ball(id);
  const inPlay = state.mode === "play" && id !== cue?.ball;
  if (ball && !inPlay && refusal(state, id, ball.x, ball.y) === null) return {id};
  const slop = Math.max(0.03, 16 * view.dense / view.projection.scale);
  if (cue && onCue(cue, struck, view.placeAt(event), slop) && !state.locked("cue.speed"))
    return {id: null, cue: true};
  return {id: null};
}

/** Distance of a place behind the ball along the cue [m]. */
function behind({scene: {cue}}, ball, [x, y]) {
  const angle = cue.aim_deg * Math.PI / 180;
  return (ball.x - x) * Math.cos(angle) + (ball.y - y) * Math.sin(angle);
}

/** Moves the held ball to the pointer, pulls the cue there, or aims there; finely, by a fraction of the
 * movement. Undo reverts a whole drag. */
function follow(state) {
  const {held, pointed, scene} = state;
  state.asked = false;
  if (held?.sight && pointed !== null) return followSight(state);
  if (held === null || pointed === null || !scene.cue && held.id === null) return;
  const how = {remember: !held.kept}, [x, y] = pointed, ball = state.struck();
  const made = (done) => { held.kept = done || held.kept; };
  if (held.id !== null) return made(put(state, held.id, x + held.dx, y + held.dy, how));
  // The hardest stroke is a pull of at least 200 pixels, even where the table is small.
  const share = Math.min(1, PULL * state.view.projection.scale / state.view.dense / 200);
  const pulled = () => speedOf(held.pulled + share * (behind(state, ball, pointed) - held.at));
  if (held.cue) return made(setSpeed(state, pulled(), how));
  if (state.locked("cue.aim_deg")) return;
  const aim = aimAt(ball, x, y), turned = wrapped(aim - (held.aim ?? aim));
  held.aim = aim;
  made(change(state, {"cue.aim_deg": held.fine ? wrapped(scene.cue.aim_deg + FINE * turned) : aim}, how));
}

/** In the view behind the cue ball, a press below the ball pulls the cue; any other one turns the aim. */
function pressSight(state, event) {
  const {view, sight, scene: {cue}} = state, [x, y] = view.pixelAt(event), [bx, by] = sight.ballAt();
  const pulls = y > by && Math.abs(x - bx) < 28 * view.dense && !state.locked("cue.speed");
  document.body.classList.add("held");
  state.held = {sight: true, cue: pulls, kept: false, fine: event.shiftKey, x, y, before: cue.speed,
    pulled: pulledBack(cue.speed)};
}
function followSight(state) {
  const {held, pointed: [x, y], view: {dense}, scene: {cue}} = state, how = {remember: !held.kept};
  const by = (held.fine ? FINE : 1) * SIGHT_TURN * (x - held.x) / dense;
  const pull = held.pulled + PULL * (y - held.y) / (200 * dense);
  const made = held.cue ? setSpeed(state, speedOf(pull), how)
    : !state.locked("cue.aim_deg") && change(state,
      {"cue.aim_deg": Math.round(1000 * wrapped(cue.aim_deg - by)) / 1000}, how);
  if (!held.cue) held.x = x;
  held.kept ||= made;
}

function press(state, event) {
  const {view} = state;
  if (!state.free || event.button !== 0) return;
  if (state.sight?.on) return state.scene.cue && pressSight(state, event);
  const [x, y] = view.placeAt(event), struck = state.struck();
  const held = {...heldAt(state, event), kept: false, fine: event.shiftKey, since: event.timeStamp};
  state.held = held;
  document.body.classList.add("held");
  if (held.id !== null) {
    const ball = state.ball(held.id);
    Object.assign(held, {dx: ball.x - x, dy: ball.y - y});
    state.placed = held.id;
    state.tell("placed");
  } else if (held.cue) {
    const {speed} = state.scene.cue;
    Object.assign(held, {before: speed, pulled: pulledBack(speed), at: behind(state, struck, [x, y])});
  } else {
    state.pointed = [x, y];
    if (held.fine && struck) held.aim = aimAt(struck, x, y);
    // The first of two fingers must not aim at once.
    else if (event.pointerType !== "touch") follow(state);
  }
}

function move(state, event) {
  const {view, held} = state;
  if (held === null) return;
  if (event.shiftKey && !held.fine && held.id === null) held.fine = true;
  state.pointed = held.sight ? view.pixelAt(event) : view.placeAt(event);
  if (state.asked) return;
  state.asked = true;
  requestAnimationFrame(() => follow(state));
}

function release(state, event) {
  const {held} = state;
  if (held && state.asked) follow(state);
  if (held && !held.sight && event.type === "pointerup" && event.pointerType === "touch" && !held.kept)
    follow(state);
  state.held = state.pointed = null;
  document.body.classList.remove("held");
  state.later();
  if (held?.cue && held.kept && event.type === "pointerup") letGo(state, held.before);
}

/** Two fingers: the distance between them, and their middle [canvas px]. */
function pinchOf(view, fingers) {
  const [a, b] = [...fingers.values()].map((event) => view.pixelAt(event));
  return {apart: Math.hypot(a[0] - b[0], a[1] - b[1]), middle: [(a[0] + b[0]) / 2, (a[1] + b[1]) / 2]};
}

/** Lets pointers work on a new table. */
export function followPointer(state) {
  const {view} = state, {over} = view, fingers = new Map();
  let pinch = null;
  over.onpointerdown = (event) => {
    over.setPointerCapture(event.pointerId);
    fingers.set(event.pointerId, event);
    const {held} = state;
    if (fingers.size === 1) return press(state, event);
    if (held?.kept || held && event.timeStamp - held.since > HELD_FIRST) held.fine = true;
    else if (fingers.size === 2 && !state.sight?.on) {
      state.held = state.pointed = null;
      pinch = pinchOf(view, fingers);
    }
  };
  over.onpointermove = (event) => {
    const first = fingers.keys().next().value;
    if (fingers.has(event.pointerId)) fingers.set(event.pointerId, event);
    if (pinch && fingers.size === 2) {
      const {apart, middle} = pinchOf(view, fingers);
      view.look(apart / Math.max(pinch.apart, 1), pinch.middle, middle);
      pinch = {apart, middle};
      state.clock.refresh();
    } else if (state.held && event.pointerId === first) move(state, event);
    else if (fingers.size === 0) over.style.cursor = !state.free ? "default" : cursorOf(heldAt(state, event));
  };
  over.onpointerup = over.onpointercancel = (event) => {
    const first = fingers.keys().next().value;
    fingers.delete(event.pointerId);
    if (pinch && fingers.size < 2) pinch = null;
    else if (state.held && event.pointerId === first) release(state, event);
  };
  over.onwheel = (event) => {
    event.preventDefault();
    if (event.shiftKey && state.free && state.scene.cue && !state.locked("cue.aim_deg"))
      return nudge(state, "aim_deg", -Math.sign(event.deltaY || event.deltaX) * 0.02);
    if (state.sight?.on) return;
    const at = view.pixelAt(event);
    view.look(1.2 ** -Math.sign(event.deltaY), at, at);
    state.clock.refresh();
  };
}
const cursorOf = ({id, cue}) => id !== null || cue ? "grab" : "crosshair";

export function lookAtAll({view, clock}) {
  view.look(0);
  clock.refresh();
}

/** The keys of the page, unless they are needed elsewhere. */
export function followKeys(state, tip) {
  const {clock} = state, turn = (by) => () => nudge(state, "aim_deg", by);
  const push = (by) => () => nudge(state, "speed", by), moveTip = (x, y) => () => tip.step(x, y);
  const frame = (by) => () => clock.show(clock.now + by / 60), jump = (way) => () => clock.jump(way);
  const watching = {arrowleft: frame(-1), arrowright: frame(1), arrowup: jump(-1), arrowdown: jump(1)};
  document.addEventListener("keydown", (event) => {
    const {tagName, role} = event.target, open = document.querySelector("dialog[open]") !== null;
    const typing = ["INPUT", "TEXTAREA", "SELECT"].includes(tagName) || role === "slider" || open;
    const key = event.key.toLowerCase(), {shiftKey, altKey} = event, control = event.ctrlKey || event.metaKey;
    const step = altKey ? 0.01 : shiftKey ? 1 : 0.1;
    const aiming = {arrowleft: turn(step), arrowright: turn(-step), arrowup: push(step),
      arrowdown: push(-step), a: moveTip(0.02, 0), d: moveTip(-0.02, 0), w: moveTip(0, 0.02),
      s: moveTip(0, -0.02)};
    let action = null;
    if (key === "escape" && !open) action = () => {
      if (state.replayed) endReplay(state);
      else if (!state.counts || state.aiming) clock.go(0);
    };
    else if (key === "z" && control && !typing) action = () => { if (!state.counts) takeBack(state); };
    else if (key === " " && (!typing || role === "slider") && tagName !== "BUTTON" && tagName !== "SUMMARY")
      action = () => {
        if (state.free) strike(state);
        else if (!state.aiming) clock.run(!clock.playing);
      };
    else if (key === "v" && !typing && !control) action = () => state.switchSight?.();
    else if (key === "0" && !typing) action = () => lookAtAll(state);
    else if (!typing && !control) action = (clock.now > 0 ? watching : state.free ? aiming : {})[key];
    if (!action) return;
    event.preventDefault();
    action();
  });
}
