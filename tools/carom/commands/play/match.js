// A match that survives a reload: the table and the state of the rules, in the browser's storage.

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

/** Stores this page's match whenever it changes; a finished one is removed. */
export function keepMatch(state) {
  let own = false;
  const write = () => {
    const {game, match, set, mode, scene, fixed, verdict, clock} = state;
    if (fixed || !state.shot || clock.now > 0 && !verdict) return;
    const over = clock.now > 0 && verdict.options[0].state.over;
    if (match && !over) {
      own = true;
      store.set({toml: scene.toml, match, set, mode,
        game: {state: game.state, option: game.option, from: game.from}});
    } else if (own) {
      own = false;
      store.set(null);
    }
  };
  for (const what of ["lists", "ended"]) state.on(what, write);
}

/** Continues the stored match. The previous shot is played again, because the rules need it. @returns
 * whether there was one */
export function resumeMatch(state) {
  const kept = store.get(), {carom} = state;
  if (!kept || state.fixed) return false;
  try {
    const {state: now, option, from} = kept.game, game = {state: now, option, from};
    if (from) {
      game.shot = carom.simulate(carom.Scene.parse(from.toml), LIMITS);
      game.judged = carom.games.judge(from.state, game.shot, from.announced);
    }
    Object.assign(state, {match: kept.match, mode: kept.mode});
    return begin(state, kept.toml, {game, set: kept.set, remember: false});
  } catch {
    state.match = null;
    store.set(null);
    return false;
  }
}
