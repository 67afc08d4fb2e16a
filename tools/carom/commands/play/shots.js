// The scene on the table and its shot. Every change is a whole shot, simulated at once, and can be undone.

import {without} from "./scene_text.js";

// Of one shot, so that no scene stops the page.
export const LIMITS = {seconds: 2, events: 20000};
const UNDO_LIMIT = 200;

/** Simulates a scene and shows it, or says why that cannot be. `fresh`: it has other balls or another table.
 * @returns whether it can */
function use(state, candidate, fresh) {
  let played;
  try {
    played = state.carom.simulate(candidate, LIMITS);
  } catch (error) {
    candidate.free();
    state.refuse(error);
    return false;
  }
  // A game still asks about the shot that it judged.
  if (state.shot && state.game?.shot !== state.shot) state.shot.free();
  Object.assign(state, {scene: candidate, shot: played, verdict: null, rotations: null});
  state.clock.now = 0;
  if (fresh) state.tell("table");
  state.clock.show(0);
  state.later();
  return true;
}

/** Remembers the scene for takeBack(). */
export function keep({scene, game, past}) {
  const {toml} = scene, last = past.at(-1);
  if (last && last.toml === toml && last.game === game) return;
  past.push({toml, game});
  if (past.length > UNDO_LIMIT) past.shift();
}

/** Puts other balls or another table onto the page, in a game or without one. @returns whether it can */
export function enter(state, candidate, {game = null, remember = true} = {}) {
  const before = state.game, kept = state.past.length;
  if (remember && state.scene) keep(state);
  state.game = game;
  state.clock.run(false);
  if (use(state, candidate, true)) return true;
  state.game = before;
  state.past.length = kept;
  return false;
}

/** Begins with a scene file. @throws CaromError if it is no scene */
export function begin(state, toml, how = {}) {
  const candidate = state.carom.Scene.parse(toml);
  state.say("");
  return enter(state, candidate, how);
}

/** Tries a change of the scene. @returns whether it was made */
export function change(state, changes, {remember = true} = {}) {
  const before = state.scene;
  let candidate;
  try {
    candidate = before.with(changes);
  } catch (error) {
    state.refuse(error);
    state.tell("stroke");
    return false;
  }
  state.clock.run(false);
  if (remember) keep(state);
  if (!use(state, candidate, Object.keys(changes).some((key) => /^(table|balls\.radius)/.test(key)))) {
    if (remember) state.past.pop();
    state.tell("stroke");
    return false;
  }
  before.free();
  state.say("");
  return true;
}

/** Sets a text, or removes its line from the file. */
export function setOrDrop(state, key, text) {
  if (text !== "") return change(state, {[key]: text});
  return begin(state, without(state.scene.toml, key), {game: state.game});
}

export function takeBack(state) {
  const before = state.past.pop();
  if (before === undefined) return state.say("There is nothing to undo.");
  begin(state, before.toml, {game: before.game, remember: false});
  state.say("Undone.");
}
