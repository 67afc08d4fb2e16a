// A match that survives a reload: the table, the state of the rules, and a shot from the moment it is struck,
// in the browser's storage.

import {LIMITS, begin} from "./shots.js";

const KEY = "carom.match";

const store = {
  get() {
    try {
      return JSON.parse(localStorage.getItem(KEY));
    } catch {
      return null;
    }
  },
  set(value) {
    try {
      if (value) localStorage.setItem(KEY, JSON.stringify(value));
      else localStorage.removeItem(KEY);
    } catch { /* A browser may refuse to store anything; then the match lasts as long as the page. */ }
  },
};

/** Stores this page's match whenever it changes, and a shot before it is drawn; a decided one is removed. */
export function keepMatch(state) {
  let own = false;
  const write = (struck) => () => {
    const {game, match, set, scene, fixed, announced} = state;
    if (fixed || state.replayed || !state.shot || !struck && !state.aiming) return;
    own ||= match !== null;
    if (match) store.set({toml: scene.toml, match, set, struck: struck && announced,
      game: {state: game.state, option: game.option, from: game.from}});
    else if (own) store.set(null);
    own = match !== null;
  };
  state.on("lists", write(false));
  state.on("struck", write(true));
  state.on("ended", () => { if (own && !state.inMatch && !state.replayed) store.set(null); });
}

/** Continues the stored match, with the shot that was struck. The previous shot is played again, because the
 * rules need it. @returns whether there was one */
export function resumeMatch(state) {
  const kept = store.get(), {carom} = state;
  if (!kept || state.fixed) return false;
  try {
    const {state: now, option, from} = kept.game, game = {state: now, option, from};
    if (from) {
      game.shot = carom.simulate(carom.Scene.parse(from.toml), LIMITS);
      game.judged = carom.games.judge(from.state, game.shot, from.announced);
    }
    // Version 0.4 stored no races and no hands.
    const match = {errors: "", race: 1, racks: [0, 0], first: 0, ...kept.match};
    Object.assign(state, {match, mode: "play", resumes: Boolean(kept.struck)});
    if (!begin(state, kept.toml, {game, set: kept.set, remember: false})) return false;
    if (!kept.struck) return true;
    state.announced = kept.struck;
    state.tell("announced");
    state.clock.run(true);
    return true;
  } catch {
    Object.assign(state, {match: null, resumes: false});
    store.set(null);
    return false;
  }
}
