// The scene on the table and its shot. Every change is a whole shot, simulated at once, and can be undone.

import {without} from "./scene_text.js";

// Limits of one shot, so that no scene blocks the page.
export const LIMITS = {seconds: 2, events: 20000};
const UNDO_LIMIT = 200;

/** Asks before a match ends without a winner. @returns whether it may end */
export const mayLeave = (state) => !state.inMatch || state.fixed || confirm("This ends the match. End it?");

/** The keys of a scene file for a strike, and the place of the ball in hand. */
export function changesOf(state, strike, place) {
  const {speed, aim_deg, elevation_deg, offset: [side, height]} = strike, {ball} = state.scene.cue;
  const put = place ? {[`ball.${ball}.position.x`]: place[0], [`ball.${ball}.position.y`]: place[1]} : {};
  return {...put, "cue.speed": speed, "cue.aim_deg": aim_deg, "cue.elevation_deg": elevation_deg,
    "cue.offset.side": side, "cue.offset.height": height};
}

/** Strikes, in a match with the errors of the person's hand. From then on the shot counts. */
export function strike(state) {
  const {carom, scene, match, level, counts} = state, skill = level ? "" : match?.errors;
  if (!state.aiming || !scene.cue) return;
  if (counts && skill) {
    const seed = 1 + Math.floor(Math.random() * 1e9), hand = carom.games.strike(scene, {skill, seed});
    change(state, changesOf(state, hand, null), {remember: false});
  }
  state.clock.run(true);
}

/** Simulates a scene and shows it, or shows why it cannot. `fresh`: it has other balls or another table.
 * @returns whether it succeeded */
function use(state, candidate, fresh) {
  let played;
  try {
    played = state.carom.simulate(candidate, LIMITS);
  } catch (error) {
    candidate.free();
    state.refuse(error);
    return false;
  }
  // A game still needs the shot that it judged.
  if (state.shot && state.game?.shot !== state.shot) state.shot.free();
  Object.assign(state, {scene: candidate, shot: played, verdict: null, rotations: null, hints: [],
    fired: false});
  state.clock.now = 0;
  if (fresh) state.tell("table");
  state.clock.show(0);
  state.later();
  return true;
}

/** Remembers the scene for takeBack(). */
export function keep({scene, game, set, past}) {
  const {toml} = scene, last = past.at(-1);
  if (last && last.toml === toml && last.game === game) return;
  past.push({toml, game, set});
  if (past.length > UNDO_LIMIT) past.shift();
}

/** The balls of a set and those of a scene that are not in it. */
function joined(set, scene) {
  const styles = scene.look?.().styles ?? [], known = new Set(set.map(({id}) => id));
  const more = scene.balls.map(({id}, i) => ({id, style: styles[i]})).filter(({id}) => !known.has(id));
  return [...set, ...more];
}

/** Puts other balls or another table on the page, in a game or without one. `set`: further balls that
 * belong to it. @returns whether it succeeded */
export function enter(state, candidate, {game = null, remember = true, set = []} = {}) {
  if (game === null && !mayLeave(state)) {
    candidate.free();
    return false;
  }
  if (game === null) state.match = null;
  const before = {game: state.game, set: state.set, raised: state.raised}, kept = state.past.length;
  if (remember && state.scene) keep(state);
  Object.assign(state, {game, set: joined(set, candidate), raised: candidate.cue?.elevation_deg ?? 0});
  state.clock.run(false);
  state.say("");
  if (use(state, candidate, true)) return true;
  Object.assign(state, before);
  state.past.length = kept;
  return false;
}

/** Begins with a scene file. @throws CaromError for an invalid scene */
export function begin(state, toml, how = {}) {
  return enter(state, state.carom.Scene.parse(toml), how);
}

/** The scene with its changes. The cue is raised over a ball that it would reach into and, if the shot
 * counts, over the cushions. */
function changed(state, changes) {
  const wanted = changes["cue.elevation_deg"] ?? state.raised, {cue} = state.scene;
  const other = cue && cue.elevation_deg !== wanted ? {"cue.elevation_deg": wanted} : {};
  const level = state.scene.with({...other, ...changes}), stroke = level.cue;
  const met = stroke?.in && (state.counts || stroke.in.startsWith("ball"));
  if (!met || stroke.clears_deg === null || state.locked("cue.elevation_deg"))
    return level;
  const raised = level.with({"cue.elevation_deg": stroke.clears_deg});
  level.free();
  return raised;
}

/** Tries a change of the scene. @returns whether it was made */
export function change(state, changes, {remember = true} = {}) {
  const before = state.scene;
  let candidate;
  try {
    candidate = changed(state, changes);
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
  state.raised = changes["cue.elevation_deg"] ?? state.raised;
  before.free();
  state.say("");
  return true;
}

/** Sets a text, or removes its line from the file. */
export function setOrDrop(state, key, text) {
  if (text !== "") return change(state, {[key]: text});
  return begin(state, without(state.scene.toml, key), {game: state.game, set: state.set});
}

export function takeBack(state) {
  const before = state.past.pop();
  if (before === undefined) return state.say("There is nothing to undo.");
  begin(state, before.toml, {game: before.game, set: before.set, remember: false});
  state.say("Undone.");
}
