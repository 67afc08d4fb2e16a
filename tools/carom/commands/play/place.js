// Where balls may be put.

import {make, optionsOf, select} from "../../page/dom.js";
import {change} from "./shots.js";
import {UNITS} from "./words.js";

/** Why a ball may not be moved there, or null. */
export function refusal(state, id, x, y) {
  const {game, scene} = state;
  if (state.locked("ball")) return "The balls of this scene are fixed.";
  if (!game) return null;
  const inHand = game.state.in_hand;
  if (inHand === "no" || id !== scene.cue?.ball)
    return "In a game only the cue ball may be moved, and only in hand.";
  if (game.judged) return game.judged.mayPlace(x, y, game.option) ? null : "The cue ball may not lie there.";
  const line = scene.table.corner[1] + scene.table.length / 4;
  return inHand === "head string" && y >= line
    ? "For the break the cue ball is behind the head string." : null;
}

/** Moves a ball, or says why it cannot be. @returns whether it was moved */
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
  return make("fieldset", {}, make("legend", {}, "Place a ball ", unit), which, ...places);
}
