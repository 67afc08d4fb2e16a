// Numbers with units, and events in words.

export const UNITS = {
  metric: {speed: [1, "m/s", 2], length: [100, "cm", 1]},
  inch: {speed: [2.2369362921, "mph", 1], length: [39.37007874, "in", 1]},
};

const COLOURS = /^(white|yellow|red|green|brown|blue|pink|black)$/;
/** A ball for people. `preset`: of the table; on one for snooker, numbers are reds. */
export const named = (id, preset = "") => id === "cue" ? "the cue ball"
  : /^\d+$/.test(id) ? (preset.startsWith("snooker") ? "a red" : `the ${id}`) : COLOURS.test(id)
    ? `the ${id}` : id;

/** A number of SI units for people. `kind`: speed or length. */
export function withUnit(units, kind, x) {
  const [factor, name, digits] = UNITS[units][kind];
  return `${(factor * x).toFixed(digits)} ${name}`;
}

const SPEEDS = [[1, "soft"], [1.6, "slow"], [2.4, "medium"], [3.6, "hard"], [7, "very hard"]];
/** A speed in players' words, as in the engine's advice. */
export const speedWord = (speed) => SPEEDS.find(([most]) => speed < most)?.[1] ?? "break";

const SPINS = [[0.05, ""], [0.15, "a little "], [0.35, "half "], [1, "full "]];
/** The place of the tip in players' words: "half draw, a little left English". */
export function tipWords(side, height) {
  const part = (x, more, less) => {
    const share = SPINS.find(([most]) => Math.abs(x) < most)[1];
    return share && `${share}${x > 0 ? more : less}`;
  };
  const parts = [part(height, "follow", "draw"), part(side, "left English", "right English")];
  return parts.filter((x) => x).join(", ") || "centre";
}

/** The hit on the object ball: its fullness and the cut. */
export function aimWords(met, preset) {
  if (!met) return "no ball";
  const quarters = Math.round(4 * (1 - Math.sin(Math.min(met.cut, Math.PI / 2))));
  const part = ["thin", "quarter ball", "half ball", "three-quarter ball", "full"][quarters];
  const cut = (met.cut * 180 / Math.PI).toFixed(0);
  const side = cut === "0" ? "" : `, cut ${cut}° ${met.left ? "left" : "right"}`;
  return `${named(met.id, preset)} ${part}${side}`;
}

/** The engine's words for a shot, with the names of pockets only. */
export const adviceWords = (words) =>
  words.replace(/(\w+) into \w+ \(([^)]+)\)/, (_, ball, pocket) => `${named(ball)} into the ${pocket}`)
    .replace(/(\d) degrees/, "$1°");

/** Events of interest to a player, without changes of motion. */
export const isContact = (e) => ["cue_strike", "ball_ball", "ball_cluster", "ball_cushion", "ball_jaw",
  "ball_pocket", "ball_out"].includes(e.type);

const counted = (n) => `${n} point${n === 1 ? "" : "s"}`;
/** The verdict on a shot in a sentence. `is_scored`: whether the game counts points. */
export function verdictWords({fouls, points, penalty}, {is_scored: scored}) {
  const broken = fouls.map(({foul, rule}) => (rule ? `${foul} (${rule})` : foul)).join(", ");
  const other = penalty > 0 ? `; ${counted(penalty)} to the other player` : "";
  return broken ? `Foul: ${broken}${other}.`
    : `Fair shot${scored && points > 0 ? `, ${counted(points)}` : ""}.`;
}
