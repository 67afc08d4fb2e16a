// Lines of a scene file.

/** The lines as {line, section, key, value}; key and value are undefined except in "key = value". */
function linesOf(toml) {
  let section = "";
  return toml.split("\n").map((line) => {
    if (line.startsWith("[")) section = line.trim().replace(/^\[|\]$/g, "");
    const [, key, value] = /^([\w.]+)\s*=\s*(.*)$/.exec(line) || [];
    return {line, section, key, value};
  });
}

/** The values in one section of a scene file that carom wrote: {key: text}. */
export function sectionOf(toml, section) {
  const own = linesOf(toml).filter((line) => line.section === section && line.key !== undefined);
  return Object.fromEntries(own.map(({key, value}) => [key, value]));
}

/** The file without the line of "section.key". */
export function without(toml, name) {
  const [section, key] = name.split(".");
  return linesOf(toml).filter((line) => !(line.section === section && line.key === key))
    .map(({line}) => line).join("\n");
}

/** Where the n-th line begins and ends in a text, from 1. */
export function rangeOf(text, n) {
  const lines = text.split("\n");
  const start = lines.slice(0, n - 1).reduce((sum, line) => sum + line.length + 1, 0);
  return [start, start + lines[n - 1].length];
}
