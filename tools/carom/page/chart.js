// SVG charts of the program's plots (tools/carom/report/plot.h), with a cursor that follows the pointer or
// the arrow keys.

import {make, onWidth, shown} from "./dom.js";

const LEFT = 58, RIGHT = 12, TOP = 22, BOTTOM = 42;  // [px] room around the curves, for texts

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

/** The chart with every point as [x, y]: of a series that has the x of the first one, the page has y only. */
function withBoth(spec) {
  const first = spec.series[0]?.points;
  const both = (p, k) => Array.isArray(p) ? p : [first[k][0], p];
  return {...spec, series: spec.series.map((s) => ({...s, points: s.points.map(both)}))};
}

/** A chart in its own element. A click calls pick(x). */
export class Chart {
  constructor(given, pick = null) {
    const spec = withBoth(given);
    Object.assign(this, {spec, pick, width: 0, height: spec.height || 230, line: null, held: null});
    const notes = spec.notes || [];
    this.host = make("div", {class: "plot", tabindex: "0", role: "img",
      "aria-label": `${spec.title}. ${notes.join(". ")}`});
    this.readout = make("p", {class: "readout", "aria-live": "polite"});
    this.element = make("figure", {class: "card"}, make("figcaption", {}, make("h2", {}, spec.title),
      ...notes.map((note) => make("p", {}, note))), this.host, this.readout);
    this.points = spec.series.flatMap((s) => s.points);
    this.listen();
    this.say(null);
    onWidth(this.host, () => this.draw());
  }

  draw() {
    const {spec, host, height} = this, levels = (spec.levels || []).map((l) => l.y);
    const width = this.width = Math.max(host.clientWidth, 220);
    this.x = new Scale(spec.x, this.points.map((p) => p[0]), LEFT, width - RIGHT);
    this.y = new Scale(spec.y, this.points.map((p) => p[1]).concat(levels), height - BOTTOM, TOP);
    const series = spec.series.flatMap((s, i) => this.seriesParts(s, this.colour(s, i)));
    this.line = make("line", {class: "cursor", y1: TOP, y2: height - BOTTOM, x1: -9, x2: -9});
    const box = {width, height, viewBox: `0 0 ${width} ${height}`, "aria-hidden": "true"};
    host.replaceChildren(make("svg", box, ...this.axes(), ...series, ...this.markParts(), this.line));
    if (this.held !== null) this.cursor(this.held);
  }

  axes() {
    const {spec, x, y, width} = this, parts = [], foot = this.height - BOTTOM, end = width - RIGHT;
    for (const [value, words] of x.marks(spec.x, Math.max(2, Math.floor(width / 75)))) {
      const px = x.at(value);
      parts.push(make("line", {class: "grid", x1: px, x2: px, y1: TOP, y2: foot}),
        svgText(px, foot + 15, "middle", words));
    }
    for (const [value, words] of y.marks(spec.y, 5)) {
      const py = y.at(value);
      parts.push(make("line", {class: "grid", x1: LEFT, x2: end, y1: py, y2: py}),
        svgText(LEFT - 6, py + 4, "end", words));
    }
    parts.push(svgText((LEFT + end) / 2, this.height - 6, "middle", spec.x.title, "axis"),
      svgText(4, 12, "start", spec.y.title, "axis"));
    for (const ticks of spec.ticks || []) {
      const path = ticks.at.map((t) => `M${x.at(t).toFixed(1)} ${foot}v-6`).join("");
      parts.push(make("path", {d: path, class: "tick"}, make("title", {}, ticks.name)));
    }
    for (const level of spec.levels || []) {
      const py = y.at(level.y);
      parts.push(make("line", {class: "level", x1: LEFT, x2: end, y1: py, y2: py}),
        svgText(end - 4, py - 5, "end", level.name, "level"));
    }
    return parts;
  }

  markParts() {
    return (this.spec.marks || []).flatMap((mark) => {
      const px = this.x.at(mark.x), py = this.y.at(mark.y), end = px > this.width / 2;
      return [make("circle", {class: "mark", cx: px, cy: py, r: 6}),
        svgText(px + (end ? -10 : 10), py + 4, end ? "end" : "start", mark.name, "mark")];
    });
  }

  seriesParts(s, stroke) {
    const {x, y} = this, parts = [], usable = s.points.filter((p) => x.shows(p[0]) && y.shows(p[1]));
    const points = usable.map((p) => [x.at(p[0]).toFixed(1), y.at(p[1]).toFixed(1)]);
    if (points.length === 0) return parts;
    const style = {fill: "none", "stroke-width": s.width || 1.6, "stroke-dasharray": s.dashed ? "4 3" : null};
    const curve = {...style, d: "M" + points.map((p) => p.join(" ")).join("L")};
    const dots = {fill: "none", "stroke-width": 5, "stroke-linecap": "round",
      d: points.map((p) => `M${p.join(" ")}h0`).join("")};
    if (s.line) parts.push(make("path", curve));
    if (s.dots) parts.push(make("path", dots));
    for (const part of parts) part.style.stroke = stroke;
    return parts;
  }

  colour(s, i) { return s.stroke || `var(--c${(s.colour >= 0 ? s.colour : i) % 8})`; }

  key(s, i, words) {
    const swatch = make("i", {});
    swatch.style.background = this.colour(s, i);
    return make("span", {class: "key"}, swatch, words);
  }

  /** Writes the values at an instant below the chart, or those of one point. */
  say(at, point = null) {
    const {spec, readout} = this, named = spec.series.map((s, i) => [s, i]).filter(([s]) => s.name);
    if (point !== null) {
      const [s, i] = point.of, [px, py] = point.p.map((value) => shown(value));
      readout.replaceChildren(this.key(s, i, `${s.name}: ${spec.x.title} ${px}; ${spec.y.title} ${py}`));
      return;
    }
    const keys = (words) => named.map(([s, i]) => this.key(s, i, words(s)));
    if (at === null || spec.byPoint) readout.replaceChildren(...keys((s) => s.name));
    else readout.replaceChildren(make("b", {}, `${shown(at, 4)} ${spec.x.unit || ""}`),
      ...keys((s) => `${s.name} ${shown(nearestTo(s, at)?.[1])}`));
  }

  cursor(at) {
    this.held = at;
    this.line?.setAttribute("x1", this.x.at(at));
    this.line?.setAttribute("x2", this.x.at(at));
  }

  /** The point nearest to a place [px], with its series, or null. */
  nearest(px, py) {
    const {x, y} = this;
    let best = null;
    this.spec.series.forEach((s, i) => {
      for (const p of s.points) {
        if (!s.name || !x.shows(p[0]) || !y.shows(p[1])) continue;
        const away = Math.hypot(x.at(p[0]) - px, y.at(p[1]) - py);
        if (best === null || away < best.away) best = {away, p, of: [s, i]};
      }
    });
    return best;
  }

  listen() {
    const {spec, host, pick} = this;
    const place = (event) => {
      const box = host.getBoundingClientRect();
      return [event.clientX - box.left, event.clientY - box.top];
    };
    host.onpointermove = (event) => {
      const [px, py] = place(event);
      if (spec.byPoint) this.say(null, this.nearest(px, py));
      else if (px >= LEFT && px <= this.width - RIGHT) {
        this.say(this.x.value(px));
        if (pick === null) this.cursor(this.x.value(px));
      }
    };
    host.onpointerleave = () => this.say(null);
    if (pick === null) host.onkeydown = (event) => this.step(event);
    else host.onclick = (event) =>
      pick(this.x.value(Math.min(Math.max(place(event)[0], LEFT), this.width - RIGHT)));
  }

  /** Goes to the next point by the arrow keys. */
  step(event) {
    const turn = {ArrowLeft: -1, ArrowRight: 1}[event.key], {held} = this;
    if (turn === undefined) return;
    const order = this.points.slice().sort((a, b) => a[0] - b[0]);
    let next = held === null ? 0 : order.findIndex((p) => p[0] >= held);
    while (order[next] && held !== null && order[next][0] === held && order[next + turn]) next += turn;
    event.preventDefault();
    const [x, y] = order[next];
    this.cursor(x);
    if (this.spec.byPoint) this.say(null, this.nearest(this.x.at(x), this.y.at(y)));
    else this.say(x);
  }
}

const svgText = (x, y, anchor, words, name = "") =>
  make("text", {x, y, "text-anchor": anchor, class: name}, words);

/** The point of a series nearest to x. */
function nearestTo(s, x) {
  let best = null;
  for (const p of s.points) if (best === null || Math.abs(p[0] - x) < Math.abs(best[0] - x)) best = p;
  return best;
}
