// The players of a match.

/** The name of a player for people. */
export function nameOf({match}, player) {
  const level = match?.players[player], one = match?.players.filter((x) => x).length === 1;
  if (!level) return one ? "You" : `Player ${player + 1}`;
  return `carom${one ? "" : ` ${player + 1}`}, ${level}`;
}

/** The rules' words with the names of the players. */
export const withNames = (state, text) => !state.match ? text
  : text.replace(/\b([Pp])layer ([12]) (\w+)/g, (_, first, player, does) => {
    const name = nameOf(state, player - 1);
    if (name !== "You") return `${name.replace(/,.*/, "")} ${does}`;
    return `${first === "P" ? "You" : "you"} ${does.replace(/s$/, "")}`;
  });

/** The end of a game, and of its match. */
export function endWords(state) {
  const {match, verdict: {options: [{state: {winner}}]}} = state;
  if (winner < 0) return "Nobody wins.";
  const name = match ? nameOf(state, winner).replace(/,.*/, "") : `Player ${winner + 1}`;
  const racks = match?.racks.map((n, k) => n + Number(k === winner)).join(" to ");
  const won = !match || match.race === 1 ? "" : state.inMatch ? ` the rack: ${racks}`
    : ` the match, ${racks}`;
  return `${name} ${name === "You" ? "win" : "wins"}${won}.`;
}
