// Games: the player's rights, the verdict on a shot, and its consequences.

import {sentence} from "../../page/event_words.js";
import {inHand} from "./place.js";
import {begin, change, enter, mayLeave} from "./shots.js";
import {infoOf, startOf, tableOf} from "./tables.js";
import {named} from "./words.js";

const NOTHING = {ball: "", pocket: "", safety: false, push_out: false};
const randomSeed = () => 1 + Math.floor(Math.random() * 1e6);

/** Begins a game with these options of its rules, or continues without one if the name is "". `match`: as
 * in the state; `first`: the player who begins. */
export function newGame(state, name, rules = {}, match = null, first = 0) {
  if (mayLeave(state)) rackUp(state, name, rules, match, first);
}

function rackUp(state, name, rules, match, first) {
  const {carom} = state, info = infoOf(state, name);
  const table = tableOf(info, state.scene.table.preset || "nine_foot"), {usual_target: target} = info;
  const game = name === "" ? null : {state: carom.games.start(name, {first, target, rules}), option: 0};
  Object.assign(state, {match, mode: match ? "play" : state.mode});
  state.tell("mode");
  begin(state, startOf(carom, info, table, randomSeed()), {game});
}

/** The player's rights: {callable, may_push_out}, and all of them in words. */
export function legal({carom, game, scene}) {
  if (!game) return {text: "", callable: [], may_push_out: false};
  const now = game.state;
  let may;
  try {
    may = carom.games.legal(now, scene);
  } catch (error) {
    return {text: error.reason || error.message, callable: [], may_push_out: false};
  }
  const score = now.points.some((x) => x !== 0) ? ` Points: ${now.points.join(" to ")}.` : "";
  const group = now.game === "eight_ball" && now.group[now.turn] !== "open"
    ? `, playing ${now.group[now.turn]}` : "";
  const few = may.first.length > 0 && may.first.length < 8;
  const first = now.game === "snooker" ? ` ${ballOn(now)}` : few ? ` Hit first: ${may.first.join(", ")}.`
    : "";
  const nominates = now.game === "snooker" && (now.free_ball || now.on === "colour");
  return {...may, nominates, callable: nominates ? may.first : may.callable,
    text: `${sentence(may.text)}${group}.${first}${score}`};
}

const VALUES = {red: 1, yellow: 2, green: 3, brown: 4, blue: 5, pink: 6, black: 7};
/** Snooker: the ball on, and its value. */
function ballOn({on, free_ball: free}) {
  if (on === "colour") return "On: any colour; nominate it.";
  const due = `${on === "red" ? "a red" : `the ${on}`} (${VALUES[on]})`;
  return free ? `On: ${due}, or any ball as a free ball; nominate it.` : `On: ${due}.`;
}

/** Straight pool: where the balls go after the fourteenth. */
function rackWords({decision, respots}, {outcome}, {corner, length}) {
  if (decision !== "rack fourteen") return "";
  const where = ({place: [, y]}) => ["head", "centre", "foot"].find((_, k) =>
    Math.abs(y - corner[1] - (k + 1) * length / 4) < 0.01);
  const left = outcome.balls.filter(({id, pocket}) => id !== "cue" && !pocket);
  const told = [...left.map(({id}) => id), "cue"].map((id) => {
    const back = respots.find(({ball}) => ball === id), spot = back && where(back);
    if (!back) return id === "cue" ? "" : ` ${sentence(named(id))} stays where it is.`;
    return ` ${sentence(named(id))} goes to ${spot ? `the ${spot} spot` : "its place in the rack"}.`;
  });
  return `${left.length === 0 ? "All fifteen" : "The fourteen"} balls are racked.${told.join("")}`;
}

/** Judges the shot with the player's calls. */
export function judge(state) {
  const {carom, game, shot, announced} = state;
  state.verdict = null;
  try {
    if (game) state.verdict = carom.games.judge(game.state, shot, announced);
  } catch (error) {
    state.refuse(error);
  }
  state.tell("judged");
}

/** Continues from the balls at rest; in a game, by one of the verdict's options. */
export function nextShot(state, option = 0) {
  const {carom, game, shot, scene, announced} = state;
  if (!game) return advance(state, shot.after(), null);
  if (state.verdict === null) judge(state);
  const {verdict} = state;
  if (verdict === null) return;
  const {state: then, rerack, text} = verdict.options[option];
  if (then.over) return state.say(`${sentence(text)}.`);
  if (rerack)
    return begin(state, startOf(carom, infoOf(state, then.game), scene.table.preset, randomSeed()),
      {game: {state: then, option: 0}});
  const from = {toml: scene.toml, state: game.state, announced: {...announced}, option};
  try {
    advance(state, verdict.next({option}), {state: then, judged: verdict, option, shot, from});
    const racked = rackWords(verdict.options[option], shot, scene.table);
    if (racked) state.say(racked);
  } catch (error) {
    state.refuse(error);
  }
}

function advance(state, after, game) {
  const {scene, set, raised} = state;
  let said = "";
  if (after.cue === null) {
    const {ball} = scene.cue ?? {}, placed = ball && inHand(state.carom, after, scene, ball);
    const [first] = after.balls;
    if (!placed && !first) return state.say("No ball is left on the table.");
    if (placed) said = "Cue ball in hand: drag it where you want it.";
    after = placed || after.with({"cue.ball": first.id});
  }
  state.announced = {...NOTHING, ball: state.announced.ball};
  // A raised cue was for one shot of a game.
  if (enter(state, after, {game, set}) && !state.level && (game || state.raised !== raised))
    change(state, {"cue.elevation_deg": game ? 0 : raised}, {remember: false});
  if (said) state.say(said);
}

/** Another rack of the match, or after its last one another match; the other player breaks. */
export function nextRack(state) {
  const {match, game, verdict, inMatch} = state, {winner} = verdict.options[0].state;
  const racks = match.racks.map((won, k) => inMatch ? won + Number(k === winner) : 0),
    first = 1 - match.first;
  rackUp(state, game.state.game, match.rules, {...match, racks, first}, first);
}

/** Shows the last shot of the game again. */
export function replay(state) {
  const {carom, game, scene, shot} = state;
  if (!game?.from || !state.free) return;
  Object.assign(state, {replayed: {scene, shot}, scene: carom.Scene.parse(game.from.toml), shot: game.shot,
    rotations: null, hints: []});
  state.tell("view");
  state.clock.run(true);
}
export function endReplay(state) {
  state.scene.free();
  Object.assign(state, {...state.replayed, replayed: null, rotations: null});
  state.tell("view");
  state.clock.go(0);
}
