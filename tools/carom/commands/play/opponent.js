// carom as a player, and its hints: it thinks in a worker, announces its shot, and strikes with the errors of
// its level.

import {firstContact} from "./aids.js";
import {nextShot} from "./game.js";
import {withNames} from "./players.js";
import {LIMITS, change, changesOf, strike} from "./shots.js";
import {adviceWords} from "./words.js";

export const LEVELS = ["beginner", "club", "league", "professional", "machine"];
/** The games that carom plays itself. */
export const PLAYED = ["eight_ball", "nine_ball", "ten_ball"];
const SEEN = 1400;  // [ms] from the announcement of a shot to its strike, and from a verdict to the next
const seedOf = () => 1 + Math.floor(Math.random() * 1e9);

export const wait = (state, ms) => new Promise((done) => setTimeout(done, state.quick ? 0 : ms));

/** Thinks, and says so. @returns the advice, or null if it is stopped or fails, with a message */
async function think(state, busy, game, options) {
  state.busy = busy;
  state.say(busy.level ? `carom (${busy.level}) is thinking …` : "carom is looking for the best shots …");
  state.tell("busy");
  try {
    const advice = await state.thinker.advise(state.scene.toml, game, {seed: seedOf(), ...options});
    return state.busy === busy ? advice : null;
  } catch (error) {
    if (state.busy === busy) state.refuse(error);
    return null;
  }
}
function done(state, busy) {
  if (state.busy !== busy) return;
  state.busy = null;
  state.tell("busy");
}

/** The shot of carom, if it is its turn. */
export async function takeTurn(state) {
  const {level} = state, busy = {level};
  if (!level || !state.aiming || state.busy || state.resumes) return;
  const advice = await think(state, busy, state.game.state, {skill: level, best: 1, shots: 0});
  if (!advice || state.busy !== busy) return done(state, busy);
  const [{words, call, strike: hand, cue, place}] = advice;
  state.announced = {...call};
  const made = change(state, changesOf(state, hand, place), {remember: false}) ||
    change(state, changesOf(state, cue, place), {remember: false});
  state.say(`carom (${level}): ${adviceWords(words)}.`);
  if (made) await wait(state, SEEN);
  const goes = made && state.busy === busy && state.aiming;
  done(state, busy);
  if (goes) strike(state);
}

/** For another table: drops the search for the last one. */
export function newTable(state) {
  if (state.busy) done(state, state.busy);
  state.thinker.stop();
  state.yielded = false;
  takeTurn(state);
}

/** Stops thinking, or a shot that is announced. */
export function stopThinking(state) {
  const {busy} = state;
  if (!busy) return;
  done(state, busy);
  state.thinker.stop();
  if (!busy.level) return;
  state.yielded = true;
  state.say("Stopped. Shoot for carom, or let it shoot.");
  state.tell("busy");
}

/** After a shot: carom chooses, and a match continues by itself if there is no choice. */
export async function goOn(state) {
  const {verdict, shot} = state, {players} = state.match ?? {players: []};
  const level = players[verdict?.chooser];
  if (!verdict || state.mode !== "play" && !level) return;
  if (verdict.options[0].state.over || verdict.chooser >= 0 && !level) return;
  const option = level ? verdict.choose(level) : 0;
  if (level) state.say(`carom chooses: ${withNames(state, verdict.options[option].text)}.`);
  await wait(state, verdict.fouls.length > 0 ? 1.6 * SEEN : SEEN);
  if (state.shot === shot && state.verdict === verdict && !state.clock.playing && !state.aiming)
    nextShot(state, option);
}

/** A game state for advice in practice: the break of a rack, or the middle of a turn with an open table. */
function practice({carom, scene}) {
  const [, racked] = /^\[rack\]\s*\ngame = "(\w+)"/m.exec(scene.toml) ?? [];
  if (PLAYED.includes(racked)) return carom.games.start(racked);
  return {...carom.games.start("eight_ball"), opening: false, in_hand: "no"};
}

/** Whether hints are allowed. */
export const mayHint = ({fixed, game, match, mode, level}) => !fixed && !level &&
  (game === null || PLAYED.includes(game.state.game) && (mode === "practise" || Boolean(match?.hints)));

/** Shows the three best shots. */
export async function hint(state) {
  const {carom, scene, game, match} = state, busy = {hint: true}, skill = match?.errors || "professional";
  if (!state.aiming || state.busy) return;
  const advice = await think(state, busy, game?.state ?? practice(state),
    {skill, best: 3, shots: 100, seconds: 1.5});
  if (advice && state.scene === scene) state.hints = advice.map((one) => {
    const changed = scene.with(changesOf(state, one.cue, one.place)), shot = carom.simulate(changed, LIMITS);
    const {x, y} = changed.balls.find(({id}) => id === changed.cue.ball);
    const contact = firstContact(shot, changed.cue.ball);
    shot.free();
    changed.free();
    return {...one, contact, from: [x, y], words: adviceWords(one.words)};
  });
  if (advice) state.say(`The success rates are for a hand with the errors of the level ${skill}.`);
  done(state, busy);
  state.tell("hints");
  state.clock.refresh();
}

/** Aims as a hint says. */
export function take(state, {cue, place, call}) {
  const {hints} = state;
  if (!change(state, changesOf(state, cue, place))) return;
  state.announced = {...call};
  state.hints = hints;
  state.tell("hints");
  state.tell("announced");
  state.clock.refresh();
}
