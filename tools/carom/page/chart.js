// SVG charts of the program's plots (tools/carom/report/plot.h), with a cursor that follows the pointer or
// the arrow keys.
"use strict";

/** About `count` round values from low to high on an axis. */
function roundValues(low, high, log, count) {
  if (log) {
    const first = Math.ceil(low - 1e-9), last = Math.floor(high + 1e-9), list = [];
    if (last - first < 2) {
      for (let p = first - 1; p <= last + 1; ++p) for (const part of [1, 2, 5]) list.push(part * 10 ** p);
      const inside = list.filter((x) => Math.log10(x) >= low && Math.log10(x) <= high);
      return inside.length > 1 ? inside : roundValues(10 ** low, 10 ** high, false, count);
    }
    const every = Math.ceil((last - first + 1) / count);
    for (let p = first; p <= last; p += every) list.push(10 ** p);
    return list;
  }
  const rough = (high - low) / count, power = 10 ** Math.floor(Math.log10(rough));
  const unit = power * ([1, 2, 5, 10].find((m) => m * power >= rough) || 10), list = [];
  for (let k = Math.ceil(low / unit - 1e-9); k * unit <= high + 1e-9 * unit; ++k) list.push(k * unit);
  return list;
}

/** One axis: turns values into pixels. */
class Scale {
  constructor(axis, values, from, to) {
    this.log = Boolean(axis.log);
    const place = (x) => this.log ? Math.log10(x) : x;
    const usable = values.filter((x) => this.shows(x)).map(place);
    let low = axis.low ?? Math.min(...usable), high = axis.high ?? Math.max(...usable);
    if (axis.low !== undefined) low = place(axis.low);
    if (axis.high !== undefined) high = place(axis.high);
    if (!(low <= high)) low = high = 0;
    if (low === high) { low -= 0.5; high += 0.5; }
    const room = 0.04 * (high - low);
    this.low = axis.low === undefined ? low - room : low;
    this.high = axis.high === undefined ? high + room : high;
    Object.assign(this, {from, to});
  }
  shows(x) { return Number.isFinite(x) && (!this.log || x > 0); }
  at(x) {
    const place = this.log ? Math.log10(x) : x;
    return this.from + (this.to - this.from) * (place - this.low) / (this.high - this.low);
  }
  value(pixel) {
    const x = this.low + (this.high - this.low) * (pixel - this.from) / (this.to - this.from);
    return this.log ? 10 ** x : x;
  }
  marks(axis, count) {
    if (axis.marks) return axis.marks;
    return roundValues(this.low, this.high, this.log, count).map((x) => [x, shown(x, 6)]);
  }
}

/** A chart in its own element. A click calls pick(x). Returns {element, cursor(x)}. */
function chart(spec, pick = null) {
  const label = `${spec.title}. ${(spec.notes || []).join(". ")}`;
  const host = make("div", {class: "plot", tabindex: "0", role: "img", "aria-label": label});
  const readout = make("p", {class: "readout", "aria-live": "polite"});
  const figure = make("figure", {class: "card"}, make("figcaption", {}, make("h2", {}, spec.title),
    ...(spec.notes || []).map((note) => make("p", {}, note))), host, readout);
  const all = spec.series.flatMap((s) => s.points);
  const colour = (s, i) => s.stroke || `var(--c${(s.colour >= 0 ? s.colour : i) % 8})`;
  const height = spec.height || 230, left = 58, right = 12, top = 22, bottom = 42;
  let x, y, width = 0, line = null, held = null;

  function draw() {
    width = Math.max(host.clientWidth, 220);
    x = new Scale(spec.x, all.map((p) => p[0]), left, width - right);
    const levels = (spec.levels || []).map((l) => l.y);
    y = new Scale(spec.y, all.map((p) => p[1]).concat(levels), height - bottom, top);
    const parts = [], text = (px, py, anchor, words, name = "") =>
      make("text", {x: px, y: py, "text-anchor": anchor, class: name}, words);
    for (const [value, words] of x.marks(spec.x, Math.max(2, Math.floor(width / 75)))) {
      const px = x.at(value);
      parts.push(make("line", {class: "grid", x1: px, x2: px, y1: top, y2: height - bottom}),
        text(px, height - bottom + 15, "middle", words));
    }
    for (const [value, words] of y.marks(spec.y, 5)) {
      const py = y.at(value);
      parts.push(make("line", {class: "grid", x1: left, x2: width - right, y1: py, y2: py}),
        text(left - 6, py + 4, "end", words));
    }
    parts.push(text((left + width - right) / 2, height - 6, "middle", spec.x.title, "axis"));
    parts.push(text(4, 12, "start", spec.y.title, "axis"));
    for (const ticks of spec.ticks || []) {
      const path = ticks.at.map((t) => `M${x.at(t).toFixed(1)} ${height - bottom}v-6`).join("");
      parts.push(make("path", {d: path, class: "tick"}, make("title", {}, ticks.name)));
    }
    for (const level of spec.levels || []) {
      const py = y.at(level.y);
      parts.push(make("line", {class: "level", x1: left, x2: width - right, y1: py, y2: py}),
        text(width - right - 4, py - 5, "end", level.name, "level"));
    }
    spec.series.forEach((s, i) => parts.push(...seriesParts(s, colour(s, i))));
    for (const mark of spec.marks || []) {
      const px = x.at(mark.x), py = y.at(mark.y), end = px > width / 2;
      parts.push(make("circle", {class: "mark", cx: px, cy: py, r: 6}),
        text(px + (end ? -10 : 10), py + 4, end ? "end" : "start", mark.name, "mark"));
    }
    line = make("line", {class: "cursor", y1: top, y2: height - bottom, x1: -9, x2: -9});
    const box = {width, height, viewBox: `0 0 ${width} ${height}`, "aria-hidden": "true"};
    host.replaceChildren(make("svg", box, ...parts, line));
    if (held !== null) cursor(held);
  }

  function seriesParts(s, stroke) {
    const parts = [], usable = s.points.filter((p) => x.shows(p[0]) && y.shows(p[1]));
    const points = usable.map((p) => [x.at(p[0]).toFixed(1), y.at(p[1]).toFixed(1)]);
    if (points.length === 0) return parts;
    const style = {fill: "none", "stroke-width": s.width || 1.6, "stroke-dasharray": s.dashed ? "4 3" : null};
    const coloured = (element, property) => { element.style[property] = stroke; return element; };
    const curve = {...style, d: "M" + points.map((p) => p.join(" ")).join("L")};
    const dots = {fill: "none", "stroke-width": 5, "stroke-linecap": "round",
      d: points.map((p) => `M${p.join(" ")}h0`).join("")};
    if (s.line) parts.push(coloured(make("path", curve), "stroke"));
    if (s.dots) parts.push(coloured(make("path", dots), "stroke"));
    return parts;
  }

  /** The point of a series nearest to x. */
  function valueAt(s, at) {
    let best = null;
    for (const p of s.points)
      if (best === null || Math.abs(p[0] - at) < Math.abs(best[0] - at)) best = p;
    return best;
  }

  const key = (s, i, words) => {
    const swatch = make("i", {});
    swatch.style.background = colour(s, i);
    return make("span", {class: "key"}, swatch, words);
  };

  function say(at, point = null) {
    const named = spec.series.map((s, i) => [s, i]).filter(([s]) => s.name);
    if (point !== null) {
      const [s, i] = point.of, [px, py] = point.p.map((value) => shown(value));
      readout.replaceChildren(key(s, i, `${s.name}: ${spec.x.title} ${px}; ${spec.y.title} ${py}`));
      return;
    }
    const keys = (words) => named.map(([s, i]) => key(s, i, words(s)));
    if (at === null || spec.byPoint) readout.replaceChildren(...keys((s) => s.name));
    else readout.replaceChildren(make("b", {}, `${shown(at, 4)} ${spec.x.unit || ""}`),
      ...keys((s) => `${s.name} ${shown(valueAt(s, at)?.[1])}`));
  }

  function cursor(at) {
    held = at;
    if (line === null) return;
    line.setAttribute("x1", x.at(at));
    line.setAttribute("x2", x.at(at));
  }

  function nearest(px, py) {
    let best = null;
    spec.series.forEach((s, i) => {
      for (const p of s.points) {
        if (!s.name || !x.shows(p[0]) || !y.shows(p[1])) continue;
        const away = Math.hypot(x.at(p[0]) - px, y.at(p[1]) - py);
        if (best === null || away < best.away) best = {away, p, of: [s, i]};
      }
    });
    return best;
  }

  const place = (event) => {
    const box = host.getBoundingClientRect();
    return [event.clientX - box.left, event.clientY - box.top];
  };
  host.onpointermove = (event) => {
    const [px, py] = place(event);
    if (spec.byPoint) say(null, nearest(px, py));
    else if (px >= left && px <= width - right) { say(x.value(px)); if (pick === null) cursor(x.value(px)); }
  };
  host.onpointerleave = () => say(null);
  if (pick !== null)
    host.onclick = (event) => pick(x.value(Math.min(Math.max(place(event)[0], left), width - right)));
  host.onkeydown = (event) => {
    const turn = {ArrowLeft: -1, ArrowRight: 1}[event.key];
    if (turn === undefined || pick !== null) return;
    const order = all.slice().sort((a, b) => a[0] - b[0]);
    const now = held === null ? 0 : order.findIndex((p) => p[0] >= held);
    let next = now;
    while (order[next] && held !== null && order[next][0] === held && order[next + turn]) next += turn;
    event.preventDefault();
    cursor(order[next][0]);
    if (spec.byPoint) say(null, nearest(x.at(order[next][0]), y.at(order[next][1])));
    else say(order[next][0]);
  };
  say(null);
  onWidth(host, draw);
  return {element: figure, cursor};
}
