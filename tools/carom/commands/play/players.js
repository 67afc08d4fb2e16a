// The players of a match.

/** The name of a player for people. */
export function nameOf({match}, player) {
  const level = match?.players[player], one = match?.players.filter((x) => x).length === 1;
  if (!level) return one ? "You" : `Player ${player + 1}`;
  return `carom${one ? "" : ` ${player + 1}`}, ${level}`;
}

/** The rules' words with the names of the players. */
export const withNames = (state, text) => !state.match ? text
  : text.replace(/\b[Pp]layer ([12]) (\w+)/g, (_, player, does) => {
    const name = nameOf(state, player - 1);
    return name === "You" ? `${name} ${does.replace(/s$/, "")}` : `${name.replace(/,.*/, "")} ${does}`;
  });
