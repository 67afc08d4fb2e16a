// Scenes to begin with: the tables, the balls on them, and the games that can be played.
"use strict";

const TABLES = [["nine_foot", "nine-foot"], ["eight_foot", "eight-foot"], ["seven_foot", "seven-foot"],
  ["seven_foot_bar", "seven-foot bar"], ["snooker", "snooker"], ["english_pool", "English pool"],
  ["carom", "carom"]];
const CLOTHS = [["", "as the balls"], ["club", "club"], ["tournament", "tournament"],
  ["match_heated", "heated, match"]];
const CUSHIONS = [["", "as the balls"], ["han_2005", "han_2005"], ["mathavan_2010", "mathavan_2010"],
  ["stronge", "stronge"], ["impulse", "impulse"], ["smooth", "smooth"]];
const GAMES = [["", "no rules"], ["eight_ball", "eight-ball"], ["nine_ball", "nine-ball"],
  ["three_cushion", "three-cushion"]];

const ball = (id, x, y) => `[[ball]]\nid = "${id}"\nposition = [${x}, ${y}]\n`;
const cue = (id, speed, aim) => `[cue]\nball = "${id}"\nspeed = ${speed}\naim_deg = ${aim}\n`;

/** A scene file for a table: a few balls to practise with, or the start of a game. */
function startOf(game, table, seed = 1) {
  const french = table === "carom", own = french || ["snooker", "english_pool"].includes(table);
  const head = `[table]\npreset = "${table}"\n`;
  const balls = `[balls]\npreset = "${own ? table : "pool"}"\n`;
  const rack = (name, more = "") => `[rack]\ngame = "${name}"\ngap = 1e-4\nseed = ${seed}\n${more}`;
  if (game === "three_cushion" || (french && game === ""))
    return head + balls + ball("white", 0.893, 0.71) + ball("yellow", 0.71, 0.71) + ball("red", 0.71, 2.13) +
      cue("white", 4, 98.5);
  const {width: w, length: l} = carom.Scene.parse(head + balls + ball("cue", 0.3, 0.3)).table;
  const at = (x, y) => [(x * w).toFixed(4), (y * l).toFixed(4)];
  if (game === "eight_ball")
    return head + balls + rack("eight_ball") + ball("cue", ...at(0.45, 0.22)) + cue("cue", 8, 90);
  if (game === "nine_ball")
    return head + balls + rack("nine_ball", "spot_ball = 9\n") + ball("cue", ...at(0.4, 0.22)) +
      cue("cue", 8, 84);
  const ids = table === "snooker" ? ["red1", "black", "blue"] : ["1", "8", "9"];
  return head + balls + ball("cue", ...at(0.42, 0.25)) + ball(ids[0], ...at(0.6, 0.6)) +
    ball(ids[1], ...at(0.25, 0.8)) + ball(ids[2], ...at(0.75, 0.35)) + cue("cue", 3, 78);
}
