// The power of the stroke as a cue that is pulled back, by a pointer or keys. Where a shot counts, letting go
// strikes.

import {make} from "../../page/dom.js";
import {HARDEST, PULL, pulledBack, speedOf} from "./aids.js";
import {change, strike} from "./shots.js";
import {speedWord, withUnit} from "./words.js";

const TAP = 10;  // [px] a pointer that moves less sets the power without a pull
const STEPS = {ArrowUp: 0.1, ArrowRight: 0.1, ArrowDown: -0.1, ArrowLeft: -0.1, PageUp: 1, PageDown: -1};
const LEAST = 0.05;  // [m/s] the cue is back at the ball, and does not strike

/** Sets the speed while the cue is pulled; `how`: as in change(). @returns whether it was changed */
export const setSpeed = (state, speed, how) => !state.locked("cue.speed") &&
  change(state, {"cue.speed": Math.round(Math.min(Math.max(speed, 0), HARDEST) * 100) / 100}, how);

/** Strikes if the cue was pulled; otherwise restores the previous speed. */
export function letGo(state, before) {
  if (state.scene.cue.speed >= LEAST) strike(state);
  else setSpeed(state, before, {remember: false});
}

export function pullStrip(state) {
  const cue = make("i", {class: "pulled"}), words = make("span", {class: "pull-words"});
  const element = make("div", {class: "pull", role: "slider", tabindex: "0",
    "aria-label": "Power: pull the cue back", "aria-valuemin": "0", "aria-valuemax": String(HARDEST)},
  cue, words);
  let hold = null;
  const follow = (event) => {
    const box = element.getBoundingClientRect();
    // In landscape on a phone, the strip is upright.
    const [at, size] = box.height > box.width ? [event.clientY - box.top, box.height]
      : [event.clientX - box.left, box.width];
    const way = PULL * (at - 0.06 * size) / (0.9 * size);
    hold.from ??= at;
    hold.moved ||= Math.abs(at - hold.from) > TAP;
    hold.kept = setSpeed(state, speedOf(way), {remember: !hold.kept}) || hold.kept;
  };
  element.onpointerdown = (event) => {
    if (!state.free || !state.scene.cue || event.button !== 0) return;
    element.setPointerCapture(event.pointerId);
    hold = {moved: false, kept: false, before: state.scene.cue.speed};
    follow(event);
  };
  element.onpointermove = (event) => { if (hold) follow(event); };
  element.onpointerup = element.onpointercancel = (event) => {
    const {moved, before} = hold ?? {};
    hold = null;
    if (moved && event.type === "pointerup" && state.mode === "play") letGo(state, before);
  };
  element.onkeydown = (event) => {
    const step = STEPS[event.key];
    if (!step || !state.free || !state.scene.cue) return;
    event.preventDefault();
    event.stopPropagation();
    setSpeed(state, state.scene.cue.speed + step);
  };
  state.on("stroke", () => {
    const speed = state.scene.cue?.speed ?? 0;
    element.style.setProperty("--pull", `${6 + 90 * pulledBack(speed) / PULL}%`);
    words.textContent = `${speedWord(speed)}, cue ${withUnit(state.units, "speed", speed)}`;
    element.setAttribute("aria-valuenow", String(speed));
    element.setAttribute("aria-valuetext", words.textContent);
  });
  return element;
}
