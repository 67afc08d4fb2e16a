// Initial scenes: the tables, the balls on them, and the available games.

export const CLOTHS = [["", "as the balls"], ["club", "club"], ["tournament", "tournament"],
  ["match_heated", "heated, match"]];
/** The row of a game (docs/reference/types.md), or {}. */
export const infoOf = ({page}, name) => page.games?.find((game) => game.name === name) ?? {};
/** The games for a list, pool first. */
export const gamesOf = ({page}) => [...page.games]
  .sort((a, b) => (a.table !== "nine_foot") - (b.table !== "nine_foot"))
  .map(({name, title}) => [name, title]);
/** The table that a game needs; the present one if it is suitable. */
export function tableOf({table = ""}, preset) {
  const kind = ballsOf(table), present = ballsOf(preset);
  return table === "" || present === kind || (kind === "pool" && present === "english_pool") ? preset : table;
}

const ball = (id, x, y) => `[[ball]]\nid = "${id}"\nposition = [${x}, ${y}]\n`;
const cue = (id, speed, aim) => `[cue]\nball = "${id}"\nspeed = ${speed}\naim_deg = ${aim}\n`;

/** The preset of the balls for a table. */
function ballsOf(table) {
  const kind = ["carom", "snooker", "english_pool", "pyramid"].find((name) => table.startsWith(name));
  return kind || "pool";
}

/** A scene file for a table: a few balls to practise with, or the start of a game, given its row.
 * `carom`: core.js. */
export function startOf(carom, {start = ""}, table, seed = 1) {
  const kind = ballsOf(table), head = `[table]\npreset = "${table}"\n[balls]\npreset = "${kind}"\n`;
  const {width: w, length: l} = carom.Scene.parse(head + ball("cue", 0.3, 0.3)).table;
  if (start)
    return head + start.replace("SEED", seed).replace(/([\d.]+)([wl])\b/g,
      (_, part, side) => (part * (side === "w" ? w : l)).toFixed(4));
  const at = (x, y) => [(x * w).toFixed(4), (y * l).toFixed(4)];
  if (kind === "carom")
    return head + ball("white", ...at(0.6289, 0.25)) + ball("yellow", ...at(0.5, 0.25)) +
      ball("red", ...at(0.5, 0.75)) + cue("white", 4, 98.5);
  const ids = kind === "snooker" ? ["red1", "black", "blue"] : ["1", "8", "9"];
  return head + ball("cue", ...at(0.42, 0.25)) + ball(ids[0], ...at(0.6, 0.6)) +
    ball(ids[1], ...at(0.25, 0.8)) + ball(ids[2], ...at(0.75, 0.35)) + cue("cue", 3, 78);
}
