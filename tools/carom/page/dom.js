// Small helpers for every page: elements, numbers, colours, and the frame of a page.

/** An element: make("button", {class: "x", onclick: f}, "text", child, ...). It never parses HTML. */
export function make(tag, attributes = {}, ...children) {
  const drawn = ["svg", "path", "line", "text", "g", "circle", "rect", "title"].includes(tag);
  const svg = drawn && attributes.svg !== false;
  const element =
    svg ? document.createElementNS("http://www.w3.org/2000/svg", tag) : document.createElement(tag);
  for (const [key, value] of Object.entries(attributes)) {
    if (value === null || value === undefined || key === "svg") continue;
    if (typeof value === "function") element[key] = value;
    else element.setAttribute(key, value);
  }
  element.append(...children.flat().filter((child) => child !== null && child !== undefined));
  return element;
}

/** The page's data with this id, or null. */
export function pageData(id) {
  const element = document.getElementById(id);
  return element === null ? null : JSON.parse(element.textContent);
}

/** A number with a few digits, in a readable form. */
export function shown(x, digits = 3) {
  if (x === null || x === undefined) return "\u2013";
  if (typeof x !== "number") return typeof x === "boolean" ? (x ? "yes" : "no") : String(x);
  if (x === 0) return "0";
  const size = Math.abs(x);
  if (size >= 1e9 || size < 1e-4) {
    const [digit, power] = x.toExponential(digits - 1).split("e");
    return `${Number(digit)}e${Number(power)}`;
  }
  return String(Number(x.toPrecision(size >= 1000 ? Math.max(digits, 4) : digits)));
}

/** A time in ns, in a suitable unit. */
export function duration(ns) {
  const [size, name] = ns < 1e3 ? [1, "ns"] : ns < 1e6 ? [1e3, "µs"] : ns < 1e9 ? [1e6, "ms"] : [1e9, "s"];
  return `${shown(ns / size)}\u2009${name}`;
}

/** The header, with the title and lead, and the footer, with the command, around the parts of a page. */
export function pageFrame(page, ...parts) {
  document.body.append(
    make("header", {}, make("h1", {}, page.title), make("p", {class: "lead"}, page.lead || "")),
    make("main", {}, ...parts),
    make("footer", {}, make("p", {}, "Made by ", make("code", {}, page.command)),
      make("p", {}, page.machine)));
}

export const prefers = (what) => matchMedia(`(prefers-${what})`).matches;

/** Calls draw() when the element gets a width or another width, but never during the browser's layout. */
export function onWidth(element, draw) {
  let width = 0;
  new ResizeObserver(() => {
    if (element.clientWidth === width) return;
    width = element.clientWidth;
    requestAnimationFrame(draw);
  }).observe(element);
}

/** A symbol of 16 x 16, because not all fonts have these. */
export const icon = (d) => make("svg", {viewBox: "0 0 16 16", width: 16, height: 16, "aria-hidden": "true"},
  make("path", {d, fill: "currentColor"}));
export const ICONS = {play: "M4 2v12l10-6z", pause: "M3 2h4v12H3zM9 2h4v12H9z",
  back: "M3 2h2v12H3zM14 2v12L6 8z", next: "M11 2h2v12h-2zM2 2v12l8-6z"};

export const button = (text, onclick, more = {}) => make("button", {type: "button", onclick, ...more}, text);
/** A button with a symbol, whose name is for screen readers and the pointer. */
export const iconButton = (d, name, onclick, more = {}) =>
  button(icon(d), onclick, {"aria-label": name, title: name, ...more});

/** The options of a list of [value, text]. */
export const optionsOf = (list) => list.map(([value, text]) => make("option", {value}, text));
/** A list of [value, text] to choose from. */
export function select(name, list, value, pick, more = {}) {
  const box = make("select", {"aria-label": name, title: name, onchange: () => pick(box.value), ...more},
    ...optionsOf(list));
  box.value = value;
  return box;
}

// A colour is a list of red, green and blue from 0 to 1.
export const cssColour = (color) => `rgb(${color.map((c) => Math.round(255 * c)).join()})`;
export const brightness = ([red, green, blue]) => 0.3 * red + 0.6 * green + 0.1 * blue;
