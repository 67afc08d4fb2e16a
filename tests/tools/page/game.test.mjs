// Games: states from shot to shot, with rules set by the test.
import assert from "node:assert/strict";
import {test} from "node:test";
import {judge, legal, newGame, nextShot} from "../../../tools/carom/commands/play/game.js";
import {refusal} from "../../../tools/carom/commands/play/place.js";
import {begin, takeBack} from "../../../tools/carom/commands/play/shots.js";
import {OPTIONS, START, carom, freshState} from "./fakes.mjs";

/** A page in a game whose first shot has been judged. */
function playing() {
  const made = freshState();
  begin(made.state, START, {game: {state: carom.games.start("nine_ball"), option: 0}});
  return made;
}

test("without a game the balls continue from where they rest, and nothing is judged", () => {
  const {state} = freshState();
  begin(state, START);
  judge(state);
  assert.equal(state.verdict, null);
  assert.deepEqual(legal(state), {text: "", callable: [], may_push_out: false});
  nextShot(state);
  assert.equal(state.ball("cue").x, 0.9);
  takeBack(state);
  assert.equal(state.ball("cue").x, 0.5);
});

test("a verdict leads to the next state, and undo to the one before", () => {
  const {state} = playing(), first = state.game, {shot} = state;
  Object.assign(state.announced, {ball: "1", pocket: "p1", safety: true});
  let told = 0;
  state.on("judged", () => ++told);
  nextShot(state);
  assert.equal(told, 1);
  assert.deepEqual(state.game.state, OPTIONS[0].state);
  assert.deepEqual(state.game.judged.announced.pocket, "p1");
  assert.deepEqual(state.announced, {ball: "1", pocket: "", safety: false, push_out: false});
  assert.equal(state.verdict, null);
  // The verdict still needs its shot.
  assert.equal(shot.freed, false);
  takeBack(state);
  assert.equal(state.game, first);
});

test("a game ends, or its balls are racked again", () => {
  const {state, said} = playing(), {game} = state;
  judge(state);
  state.verdict.options = [{text: "player 1 wins", state: {over: true}}];
  nextShot(state);
  assert.deepEqual([state.game, said.at(-1)], [game, "Player 1 wins."]);
  // The fake scenes are JSON, so a rack is refused after the rules have requested it.
  state.verdict.options = [{rerack: true, text: "", state: {game: "nine_ball"}}];
  assert.throws(() => nextShot(state), SyntaxError);
});

test("a failure to judge is reported, and the shot stays", (t) => {
  const {state, said} = playing();
  t.mock.method(carom.games, "judge", () => { throw new Error("no such pocket"); });
  nextShot(state);
  assert.equal(said.at(-1), "no such pocket");
  assert.equal(state.ball("cue").x, 0.5);
});

test("words state what a player may do", () => {
  const {state} = playing();
  assert.equal(legal(state).text, "Player 1 shoots. Hit first: 1.");
  Object.assign(state.game.state,
    {game: "eight_ball", turn: 1, group: ["solids", "stripes"], points: [2, 0]});
  assert.equal(legal(state).text, "Player 1 shoots, playing stripes. Hit first: 1. Points: 2 to 0.");
  assert.deepEqual(legal(state).callable, ["1", "2"]);
});

test("in a game only the cue ball is moved, in hand, where the rules allow it", () => {
  const {state} = playing();
  assert.match(refusal(state, "1", 0.5, 0.1), /only a cue ball in hand/);
  assert.equal(refusal(state, "cue", 0.5, 0.4), null);
  assert.match(refusal(state, "cue", 0.5, 0.6), /head string/);
  nextShot(state);
  state.game.state.in_hand = "anywhere";
  assert.equal(refusal(state, "cue", 0.4, 1.5), null);
  assert.match(refusal(state, "cue", 0.6, 1.5), /may not be placed there/);
  state.game.state.in_hand = "no";
  assert.match(refusal(state, "cue", 0.4, 1.5), /in hand may be moved/);
});

test("a game needs its table", (t) => {
  const {state} = freshState(), asked = [];
  state.page.games = [["eight_ball", "nine_foot"], ["three_cushion", "carom"], ["snooker", "snooker"]].map(
    ([name, table]) => ({name, table, start: "x = 0.5w", usual_target: 0}));
  begin(state, START);
  t.mock.method(carom.Scene, "parse", (toml) => {
    asked.push(/preset = "(\w+)"/.exec(toml)[1]);
    return {table: {width: 1, length: 2}, balls: [], with: null, free() {}, toml, cue: {speed: 11}};
  });
  for (const name of ["eight_ball", "three_cushion", "snooker"]) newGame(state, name);
  assert.deepEqual([...new Set(asked)], ["nine_foot", "carom", "snooker"]);
});
