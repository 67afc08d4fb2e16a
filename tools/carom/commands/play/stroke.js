// The stroke: power and tip with their description in words, and all its numbers.

import {make} from "../../page/dom.js";
import {HARDEST, firstContact} from "./aids.js";
import {pullStrip} from "./pull.js";
import {change} from "./shots.js";
import {TipPicture} from "./tip.js";
import {UNITS, aimWords} from "./words.js";

/** An angle from -180 to 180 degrees. */
export const wrapped = (angle) => angle - 360 * Math.round(angle / 360);
const rounded = (x) => Math.round(1000 * x) / 1000;
/** The aim in degrees from a ball to a place. */
export const aimAt = (ball, x, y) => rounded(Math.atan2(y - ball.y, x - ball.x) * 180 / Math.PI);

/** Changes a number of the cue by a step. */
export function nudge(state, key, by) {
  const {scene: {cue}} = state;
  if (state.clock.now > 0 || !cue || state.locked(`cue.${key}`)) return;
  const value = rounded(cue[key] + by);
  change(state, {[`cue.${key}`]: key === "speed" ? Math.min(Math.max(0, value), HARDEST) : wrapped(value)});
}

/** A number of the cue with a text field and a slider. `unit()`: [SI units in one of these, name]. */
function numberField(state, label, key, {unit, shown = (x) => x, ...limits}, digits) {
  const attributes = {...limits, disabled: state.locked(`cue.${key}`) ? "" : null};
  const write = (input) => {
    if (!state.free) return;
    const wanted = Number(input.value) / unit()[0], value = Math.min(Math.max(wanted, limits.min),
      limits.max);
    const made = change(state, {[`cue.${key}`]: value});
    if (made && value !== wanted)
      state.say(`${label}: ${shown(value * unit()[0]).toFixed(digits)} ${unit()[1]}, the limit.`, true);
  };
  const slide = make("input", {type: "range", ...attributes, "aria-label": `${label}, ${unit()[1]}`,
    oninput: () => write(slide)});
  const type =
    make("input", {type: "number", ...attributes, "aria-label": label, onchange: () => write(type)});
  const name = make("span", {});
  state.on("stroke", () => {
    if (!state.scene.cue) return;
    const value = shown(state.scene.cue[key]) * unit()[0];
    name.textContent = `${label} [${unit()[1]}]`;
    slide.value = String(value);
    if (document.activeElement !== type) type.value = value.toFixed(digits);
  });
  return make("label", {class: "field"}, name, type, slide);
}

/** The stroke in numbers. */
export function strokeCard(state) {
  const degrees = () => [1, "°"], speed = () => UNITS[state.units].speed;
  const card = make("section", {class: "card stroke"}, make("h2", {}, "Stroke"),
    numberField(state, "Speed", "speed", {min: 0, max: HARDEST, step: 0.01, unit: speed}, 2),
    numberField(state, "Aim", "aim_deg", {min: -180, max: 180, step: 0.01, unit: degrees, shown: wrapped}, 2),
    numberField(state, "Cue raised", "elevation_deg", {min: 0, max: 85, step: 0.5, unit: degrees}, 1));
  state.on("stroke", () => { card.hidden = state.scene.cue === null; });
  return card;
}

const FINE = 0.02;  // [degrees] of aim per pixel

/** A strip that turns the aim finely; `words` lie on it. */
function fineStrip(state, words) {
  const element = make("div", {class: "fine", role: "slider", tabindex: "0", "aria-label": "Fine aim",
    "aria-valuemin": "-180", "aria-valuemax": "180"}, words);
  let hold = null;
  element.onpointerdown = (event) => {
    if (!state.free || !state.scene.cue || state.locked("cue.aim_deg") || event.button !== 0) return;
    element.setPointerCapture(event.pointerId);
    hold = {x: event.clientX, aim: state.scene.cue.aim_deg, kept: false};
  };
  element.onpointermove = (event) => {
    if (!hold || !state.free) return;
    const aim = wrapped(hold.aim - FINE * (event.clientX - hold.x));
    hold.kept = change(state, {"cue.aim_deg": rounded(aim)}, {remember: !hold.kept}) || hold.kept;
  };
  element.onpointerup = element.onpointercancel = () => { hold = null; };
  element.onkeydown = (event) => {
    const step = {ArrowLeft: FINE, ArrowRight: -FINE}[event.key];
    if (!step || !state.free) return;
    event.preventDefault();
    event.stopPropagation();
    nudge(state, "aim_deg", step);
  };
  state.on("stroke", () => {
    const aim = state.scene.cue?.aim_deg ?? 0;
    element.style.setProperty("--turned", `${-aim / FINE % 10}px`);
    element.setAttribute("aria-valuenow", String(aim));
    element.setAttribute("aria-valuetext", `${aim.toFixed(2)} degrees, ${words.textContent}`);
  });
  return element;
}

/** The player's tools: {tip, parts}: the cue ball for the tip, the cue to pull, and the fine aim. */
export function strokeParts(state) {
  const tip = new TipPicture((side, height) => {
    if (state.free && !state.locked("cue.offset"))
      change(state, {"cue.offset.side": side, "cue.offset.height": height});
  });
  const words = make("p", {class: "stroke-words"}), parts = [tip.element, pullStrip(state), fineStrip(state,
    words)];
  state.on("stroke", () => {
    const {cue} = state.scene;
    parts.forEach((part) => { part.hidden = cue === null; });
    if (!cue) return;
    tip.show(cue.side, cue.height);
    const raised = cue.elevation_deg >= 0.5 ? [`cue raised ${cue.elevation_deg.toFixed(0)}°`] : [];
    const aim = aimWords(firstContact(state.shot, cue.ball)?.met, state.scene.table.preset);
    words.textContent = [aim.charAt(0).toUpperCase() + aim.slice(1), tip.words, ...raised].join(" · ");
  });
  return {tip, parts};
}
