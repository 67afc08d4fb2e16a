// The pointer on the table: it moves balls, and aims. Keys on the table do the same.

import {put} from "./place.js";
import {change, takeBack} from "./shots.js";
import {aimAt, nudge} from "./stroke.js";

/** Moves the held ball to the pointer, or aims there. Undo takes back a whole drag. */
function follow(state) {
  const {held, pointed, scene} = state;
  state.asked = false;
  if (held === null || pointed === null) return;
  const how = {remember: !held.kept}, [x, y] = pointed;
  if (held.id !== null) held.kept = put(state, held.id, x + held.dx, y + held.dy, how) || held.kept;
  else if (scene.cue && !state.locked("cue.aim_deg"))
    held.kept = change(state, {"cue.aim_deg": aimAt(state.struck(), x, y)}, how) || held.kept;
}

function press(state, event) {
  const {view, shot} = state;
  if (!state.aiming || event.button !== 0) return;
  view.over.setPointerCapture(event.pointerId);
  const at = view.ballAt(event), ball = at >= 0 ? state.ball(shot.balls[at]) : undefined;
  const [x, y] = view.placeAt(event);
  state.held = ball ? {id: ball.id, dx: ball.x - x, dy: ball.y - y, kept: false} : {id: null, kept: false};
  if (ball) {
    state.placed = ball.id;
    state.tell("placed");
  } else {
    state.pointed = [x, y];
    follow(state);
  }
}

function move(state, event) {
  const {view, held, clock} = state;
  if (held === null) {
    view.over.style.cursor = clock.now > 0 ? "default" : view.ballAt(event) >= 0 ? "grab" : "crosshair";
    return;
  }
  state.pointed = view.placeAt(event);
  if (state.asked) return;
  state.asked = true;
  requestAnimationFrame(() => follow(state));
}

/** Lets the pointer move balls and aim on a new table. */
export function followPointer(state) {
  const {over} = state.view;
  over.onpointerdown = (event) => press(state, event);
  over.onpointermove = (event) => move(state, event);
  over.onpointerup = over.onpointercancel = () => {
    state.held = state.pointed = null;
    state.later();
  };
  over.addEventListener("wheel", (event) => {
    if (state.clock.now > 0 || !state.scene.cue || state.locked("cue.aim_deg")) return;
    event.preventDefault();
    nudge(state, "aim_deg", Math.sign(event.deltaY) * (event.shiftKey ? 0.01 : 0.1));
  }, {passive: false});
}

/** The keys on the table `box`, and those of the whole page. */
export function followKeys(state, box, tip) {
  const {clock} = state, turn = (by) => () => nudge(state, "aim_deg", by);
  const push = (by) => () => nudge(state, "speed", by), moveTip = (x, y) => () => tip.step(x, y);
  box.addEventListener("keydown", (event) => {
    const step = event.altKey ? 0.01 : event.shiftKey ? 1 : 0.1;
    if (event.ctrlKey || event.metaKey) return;
    const aiming = {arrowleft: turn(step), arrowright: turn(-step),
      arrowup: push(step), arrowdown: push(-step), a: moveTip(0.02, 0), d: moveTip(-0.02, 0),
      w: moveTip(0, 0.02), s: moveTip(0, -0.02)};
    const watching = {arrowleft: () => clock.show(clock.now - 1 / 60),
      arrowright: () => clock.show(clock.now + 1 / 60), arrowup: () => clock.jump(-1),
      arrowdown: () => clock.jump(1)};
    const action = (clock.now > 0 ? watching : aiming)[event.key.toLowerCase()];
    if (!action) return;
    event.preventDefault();
    action();
  });
  document.addEventListener("keydown", (event) => {
    const {tagName} = event.target, open = document.querySelector("dialog[open]") !== null;
    const typing = ["INPUT", "TEXTAREA", "SELECT"].includes(tagName) || open;
    if (event.key === " " && !typing && tagName !== "BUTTON") {
      event.preventDefault();
      clock.run(!clock.playing);
    } else if (event.key === "Escape" && !open) {
      clock.go(0);
    } else if (event.key.toLowerCase() === "z" && (event.ctrlKey || event.metaKey) && !typing) {
      event.preventDefault();
      takeBack(state);
    }
  });
}
