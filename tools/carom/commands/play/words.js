// Numbers with units, and events in words.

export const UNITS = {
  metric: {speed: [1, "m/s", 2], length: [100, "cm", 1]},
  inch: {speed: [2.2369362921, "mph", 1], length: [39.37007874, "in", 1]},
};

/** A number of SI units for people. `kind`: speed or length. */
export function withUnit(units, kind, x) {
  const [factor, name, digits] = UNITS[units][kind];
  return `${(factor * x).toFixed(digits)} ${name}`;
}

/** What happened, for the list of events. */
export function eventWords(e, units) {
  const text = ballWords(e, units);
  return text.charAt(0).toUpperCase() + text.slice(1);
}
const named = (id) => (id === "cue" ? "the cue ball" : id);
function ballWords(e, units) {
  const ball = named(e.ball), other = named(e.other);
  const speed = (x) => (x === null ? "" : withUnit(units, "speed", x));
  const at = e.diamond === null ? "" : ` at diamond ${e.diamond.toFixed(1)}`;
  const rail = `the ${e.otherName}`;
  switch (e.type) {
    case "cue_strike": return `the cue strikes ${ball}: ${speed(e.speed)}`;
    case "ball_ball": {
      const cut = e.cut === null ? "" : `, cut ${(e.cut * 180 / Math.PI).toFixed(0)}°`;
      return `${ball} hits ${other} at ${speed(e.closing)}${cut}`;
    }
    case "ball_cluster": return `${e.balls.map(named).join(", ")} meet at once`;
    case "ball_cushion": return `${ball} bounces off ${rail}${at}: ${speed(e.speed)}`;
    case "ball_jaw": return `${ball} bounces off a jaw, ${e.otherName}: ${speed(e.speed)}`;
    case "ball_pocket": return `${ball} is in the ${e.otherName}`;
    case "ball_edge": return `${ball} crosses the edge of the ${e.otherName}`;
    case "ball_cloth": return `${ball} lands on the cloth`;
    case "ball_out": return `${ball} leaves the table`;
    case "slide_roll": return `${ball} begins to roll: ${speed(e.speed)}`;
    case "roll_stop": return `${ball} stops`;
    case "roll_spin": return `${ball} stops and spins on the spot`;
    case "spin_stop": return `${ball} stops spinning`;
    default: return `${ball}: ${e.type.replaceAll("_", " ")}${e.other ? ` ${e.other}` : ""}`;
  }
}

/** Events that a player wants to know, without changes of motion. */
export const isContact = (e) => ["cue_strike", "ball_ball", "ball_cluster", "ball_cushion", "ball_jaw",
  "ball_pocket", "ball_out"].includes(e.type);

/** The verdict on a shot in a sentence. */
export function verdictWords(verdict) {
  const fouls = verdict.fouls.map(({foul, rule}) => (rule ? `${foul} (${rule})` : foul));
  const points = verdict.points > 0 ? `, ${verdict.points} point${verdict.points === 1 ? "" : "s"}` : "";
  return fouls.length > 0 ? `Foul: ${fouls.join(", ")}.` : `Fair shot${points}.`;
}
