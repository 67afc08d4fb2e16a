// Lines of a scene file.

/** The lines as {line, name, value}; in "key = value", name is the section and the key. */
function linesOf(toml) {
  let section = "";
  return toml.split("\n").map((line) => {
    const [, head] = /^\s*\[+([A-Za-z_][\w.]*)\]/.exec(line) || [];
    if (head) section = `${head}.`;
    const [, key, value] = /^\s*([\w.]+)\s*=\s*(.*)$/.exec(line) || [];
    return {line, name: key && section + key, value};
  });
}

/** The values in one section of a scene file that carom wrote: {key: text}. */
export function sectionOf(toml, section) {
  const own = linesOf(toml).filter(({name}) => name?.startsWith(`${section}.`));
  return Object.fromEntries(own.map(({name, value}) => [name.slice(section.length + 1), value]));
}

/** The file without the line of "section.key". */
export const without = (toml, key) =>
  linesOf(toml).filter(({name}) => name !== key).map(({line}) => line).join("\n");

/** Start and end of the n-th line in a text, from 1. */
export function rangeOf(text, n) {
  const lines = text.split("\n");
  const start = lines.slice(0, n - 1).reduce((sum, line) => sum + line.length + 1, 0);
  return [start, start + lines[n - 1].length];
}

/** The file with another ball; in a file by carom, every ball has its own entry. */
export const withBall = (toml, id, [x, y]) =>
  `${toml.replace(/\n*$/, "\n")}[[ball]]\nid = ${JSON.stringify(id)}\nposition = [${x}, ${y}]\n`;

/** The file without a ball. */
export const withoutBall = (toml, id) => toml.split(/^(?=\[)/m)
  .filter((part) => !part.startsWith("[[ball]]") || !part.includes(`id = ${JSON.stringify(id)}`)).join("");

/** The title of a scene file: its first comment, up to its first sentence's end or a colon. */
export const titleOf = (toml) => /^#\s*(.*?)(?:[.:](?=\s)|[.:]?$)/m.exec(toml)?.[1] ?? "";

/** The "Look for" of a scene file, in one line; "" if it has none. */
export const lookFor = (toml) =>
  (/^#.*Look for: ((?:.*\n#)*.*)/m.exec(toml)?.[1] ?? "").replace(/\s*\n#\s*/g, " ").trim();
