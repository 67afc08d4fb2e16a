// Initial scenes: the tables, the balls on them, and the available games.

export const CLOTHS = [["", "as the balls"], ["club", "club"], ["tournament", "tournament"],
  ["match_heated", "heated, match"]];
export const GAMES = [["", "no rules"], ["eight_ball", "eight-ball"], ["nine_ball", "nine-ball"],
  ["ten_ball", "ten-ball"], ["straight_pool", "straight pool"], ["snooker", "snooker"],
  ["free_pyramid", "free pyramid"], ["three_cushion", "three-cushion"], ["one_cushion", "one-cushion"],
  ["straight_rail", "straight rail"], ["four_ball", "four-ball"], ["sum_to_three", "sum to three"]];
export const CAROM = ["three_cushion", "one_cushion", "straight_rail", "four_ball", "sum_to_three"];
/** The table that a game needs; the present one if it is suitable. */
export function tableOf(game, preset) {
  const kind = CAROM.includes(game) ? "carom" : game === "free_pyramid" ? "pyramid"
    : game === "snooker" ? "snooker" : "pool";
  const fits = ballsOf(preset) === kind || (kind === "pool" && ballsOf(preset) === "english_pool");
  return game === "" || fits ? preset : kind === "pool" ? "nine_foot" : kind;
}

const ball = (id, x, y) => `[[ball]]\nid = "${id}"\nposition = [${x}, ${y}]\n`;
const cue = (id, speed, aim) => `[cue]\nball = "${id}"\nspeed = ${speed}\naim_deg = ${aim}\n`;

/** The preset of the balls for a table. */
function ballsOf(table) {
  const kind = ["carom", "snooker", "english_pool", "pyramid"].find((name) => table.startsWith(name));
  return kind || "pool";
}

/** A scene file for a table: a few balls to practise with, or the start of a game. `carom`: core.js. */
export function startOf(carom, game, table, seed = 1) {
  const kind = ballsOf(table), head = `[table]\npreset = "${table}"\n[balls]\npreset = "${kind}"\n`;
  const rack = (name, more = "") => `[rack]\ngame = "${name}"\ngap = 1e-4\nseed = ${seed}\n${more}`;
  const {width: w, length: l} = carom.Scene.parse(head + ball("cue", 0.3, 0.3)).table;
  const at = (x, y) => [(x * w).toFixed(4), (y * l).toFixed(4)];
  if (game === "four_ball") return head + rack("four_ball") + cue("white", 3, 85);
  if (game === "sum_to_three")
    return head + ball("cue", ...at(0.6, 0.25)) + ball("red", ...at(0.5, 0.7)) + cue("cue", 3, 98);
  if (CAROM.includes(game) || (kind === "carom" && game === ""))
    return head + ball("white", ...at(0.6289, 0.25)) + ball("yellow", ...at(0.5, 0.25)) +
      ball("red", ...at(0.5, 0.75)) + cue("white", 4, 98.5);
  if (game === "eight_ball")
    return head + rack("eight_ball") + ball("cue", ...at(0.45, 0.22)) + cue("cue", 8, 90);
  if (game === "nine_ball")
    return head + rack("nine_ball", "spot_ball = 9\n") + ball("cue", ...at(0.4, 0.22)) +
      cue("cue", 8, 84);
  if (game === "ten_ball")
    return head + rack("ten_ball") + ball("cue", ...at(0.4, 0.22)) + cue("cue", 8, 84);
  if (game === "straight_pool")
    return head + rack("triangle") + ball("cue", ...at(0.65, 0.22)) + cue("cue", 4, 98);
  if (game === "snooker") return head + rack("snooker") + ball("cue", ...at(0.58, 0.2)) + cue("cue", 3.2, 90);
  if (game === "free_pyramid")
    return head + rack("pyramid") + ball("cue", ...at(0.45, 0.22)) + cue("cue", 8, 90);
  const ids = kind === "snooker" ? ["red1", "black", "blue"] : ["1", "8", "9"];
  return head + ball("cue", ...at(0.42, 0.25)) + ball(ids[0], ...at(0.6, 0.6)) +
    ball(ids[1], ...at(0.25, 0.8)) + ball(ids[2], ...at(0.75, 0.35)) + cue("cue", 3, 78);
}
