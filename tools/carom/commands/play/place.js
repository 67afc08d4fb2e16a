// Places for balls.

import {button, make, optionsOf, select} from "../../page/dom.js";
import {withBall, withoutBall} from "./scene_text.js";
import {begin, change} from "./shots.js";
import {UNITS} from "./words.js";

/** The free place nearest to a place, for a ball with the radius R; null if there is none near it. */
function freePlace({balls}, [x, y], R) {
  const free = ([u, v]) => balls.every((b) => Math.hypot(b.x - u, b.y - v) > R + b.radius + 1e-4);
  const spiral = (k) => [x + R * Math.sqrt(k) * Math.cos(2.4 * k), y + R * Math.sqrt(k) * Math.sin(2.4 * k)];
  return Array.from({length: 80}, (_, k) => spiral(k)).find(free) ?? null;
}
const headSpot = ({corner: [x, y], width, length}) => [x + width / 2, y + length / 4];

/** The scene with a ball that has left it, near the head spot, and its cue; null if there is no room.
 * `before`: a scene with that ball. */
export function inHand(carom, after, before, id) {
  const {radius} = before.balls.find((ball) => ball.id === id), {speed, aim_deg: aim} = before.cue;
  const place = freePlace(after, headSpot(after.table), radius);
  return place && carom.Scene.parse(`${withBall(after.toml, id, place)}[cue]\nball = "${id}"\n` +
    `speed = ${speed}\naim_deg = ${aim}\n`);
}

/** Adds a ball with the first free name to the table. */
export function addBall(state) {
  const {scene, set} = state, radius = scene.balls[0]?.radius ?? 0.0286;
  const names = ["cue", ...Array.from({length: 99}, (_, k) => String(k + 1))];
  const id = [...set.map((ball) => ball.id), ...names].find((name) => !state.ball(name));
  const {corner: [x, y], width, length} = scene.table;
  const place = freePlace(scene, [x + width / 2, y + length / 2], radius);
  if (place) begin(state, withBall(scene.everything, id, place), {set});
  state.placed = id;
  state.tell("placed");
}

/** Removes a ball from the table. */
export function removeBall(state, id) {
  if (id === state.scene.cue?.ball) return state.say("The cue strikes this ball; remove another one.", true);
  begin(state, withoutBall(state.scene.everything, id), {set: state.set});
}

/** Why a ball may not be moved there, or null. */
export function refusal(state, id, x, y) {
  const {game, scene} = state;
  if (state.locked("ball")) return "The balls of this scene are fixed.";
  if (state.level) return "It is carom's turn.";
  if (!game) return null;
  const inHand = game.state.in_hand;
  if (inHand === "no" || id !== scene.cue?.ball)
    return "In a game, only a cue ball in hand may be moved.";
  if (game.judged)
    return game.judged.mayPlace(x, y, game.option) ? null : "The cue ball may not be placed there.";
  const line = scene.table.corner[1] + scene.table.length / 4;
  return inHand === "head string" && y >= line
    ? "For the break, place the cue ball behind the head string." : null;
}

/** Moves a ball, or shows why it cannot. @returns whether it was moved */
export function put(state, id, x, y, how) {
  const why = refusal(state, id, x, y);
  if (why === null) return change(state, {[`ball.${id}.position.x`]: x, [`ball.${id}.position.y`]: y}, how);
  state.say(why, true);
  return false;
}

/** A ball and its place in numbers. */
export function placeFields(state) {
  const unit = make("span", {}), length = () => UNITS[state.units].length;
  const which = select("Ball to place", [], "", (id) => { state.placed = id; show(); });
  const typed = () => {
    put(state, which.value, ...places.map((input) => Number(input.value) / length()[0]));
    show();
  };
  const places = ["x", "y"].map((name) =>
    make("input", {type: "number", step: "any", "aria-label": name, onchange: typed}));
  const show = () => {
    const [factor, name, digits] = length();
    which.value = state.placed;
    unit.textContent = `[${name}]`;
    const ball = state.ball(state.placed);
    if (!ball) return;
    places.forEach((input, k) => { input.value = (factor * [ball.x, ball.y][k]).toFixed(digits + 1); });
  };
  state.on("table", () => {
    const ids = state.scene.balls.map((ball) => ball.id);
    which.replaceChildren(...optionsOf(ids.map((id) => [id, id])));
    [state.placed] = ids;
    show();
  });
  for (const what of ["placed", "lists"]) state.on(what, show);
  const more = [button("Add a ball", () => addBall(state)),
    button("Remove it", () => removeBall(state, which.value))];
  state.on("table", () => more.forEach((one) => { one.disabled = state.fixed || state.game !== null; }));
  return make("fieldset", {}, make("legend", {}, "Place a ball ", unit), which, ...places, ...more);
}
