// A table with the balls of a record, on two canvases: the lower one with the table, painted once per size,
// the upper one with everything that moves.

import {cssColour, make} from "./dom.js";
import {BallPicture, Projection, clamp, paintTable, pathOf, shadowPicture} from "./look.js";
import {isGone, orientations, pathPiece, product, radiusOf, stateAt} from "./motion.js";

const TRAIL_COLOURS = {sliding: "#ff9e2e", rolling: "#f0f0e6", airborne: "#ff6bd0"};
const SINK_TIME = 0.15;  // [s] duration for which a pocketed ball sinks, as in rendered frames
const QUARTER = [Math.SQRT1_2, 0, 0, -Math.SQRT1_2];
const MOST_ZOOM = 6, SETTLED = 120;  // [ms] after a change, until the table is painted anew
const CONTACT_SHADOW = 0.55, LAMP_SHADOW = 0.55;

export class TableView {
  /** `shape` and `styles`: the table's outlines, and {color, pattern, number} for each ball. */
  constructor(record, shape, styles, label) {
    Object.assign(this, {record, shape, styles, width: 0, numbered: false});
    this.under = make("canvas", {"aria-hidden": "true"});
    this.over = make("canvas", {role: "img", "aria-label": label});
    this.element = make("div", {class: "table"}, this.under, this.over);
    this.pictures = styles.map((style) => new BallPicture(style));
    this.orientation = orientations(record);
    const cube = (x) => x * x * x;
    this.contact = shadowPicture(2.5, (d) => CONTACT_SHADOW * cube(Math.max(0, 1 - d * d / 6.25)));
    this.lamp = shadowPicture(1.85, (d) => LAMP_SHADOW * Math.max(0, 1 - d * d / 3.4) ** 2);
    this.cushions = pathOf(shape.cushion);
    const box = shape.bounds, sides = [box.high[0] - box.low[0], box.high[1] - box.low[1]];
    this.eye = 0.6 * Math.max(...sides);  // [m] height of the viewer: a ball in the air is drawn larger
    this.ratio = clamp(Math.min(...sides) / Math.max(...sides), 0.4, 1);
  }

  /** Fits into a width and a height [CSS px]; the table is upright on narrow screens, lying on wide ones.
   * @returns whether that changes anything */
  fit(width, height) {
    const lying = Math.min(width, height / this.ratio) >= Math.min(height, width / this.ratio);
    const w = Math.floor(lying ? Math.min(width, height / this.ratio) : Math.min(width, height * this.ratio));
    const h = Math.floor(lying ? w * this.ratio : w / this.ratio);
    const dense = Math.min(window.devicePixelRatio || 1, 2);
    if (w === this.width && h === this.height && dense === this.dense) return false;
    Object.assign(this, {width: w, height: h, dense});
    for (const canvas of [this.under, this.over]) {
      canvas.width = Math.round(w * dense);
      canvas.height = Math.round(h * dense);
      canvas.style.width = `${w}px`;
      canvas.style.height = `${h}px`;
    }
    this.element.style.width = `${w}px`;
    this.element.style.height = `${h}px`;
    this.look(0);
    return true;
  }

  /** Shows the table enlarged by `times`, the pixel `from` at `to`, but never less than all of it; 0: all
   * of it. While this changes, the painted table is stretched. */
  look(times, from, to) {
    const {under, shape} = this, {width, height} = under;
    const paint = () => paintTable(under, this.projection, shape);
    const whole = new Projection(shape.bounds, width, height, 0);
    clearTimeout(this.painting);
    this.zoomed = times !== 0 && this.projection.scale * times > whole.scale;
    if (!this.zoomed) {
      this.projection = whole;
      return paint();
    }
    times = Math.min(times, MOST_ZOOM * whole.scale / this.projection.scale);
    const {projection} = this, corner = (x, y) => projection.at(...whole.table(x, y)), before = corner(0, 0);
    projection.look(times, from, to);
    // No empty room beside the table.
    const low = corner(0, 0), high = corner(width, height);
    const shift = [width, height].map((size, k) => Math.max(0, size - high[k]) - Math.max(0, low[k]));
    projection.look(1, [0, 0], shift);
    const after = corner(0, 0), context = under.getContext("2d");
    const copy = make("canvas", {width, height});
    copy.getContext("2d").drawImage(under, 0, 0);
    context.setTransform(times, 0, 0, times, after[0] - times * before[0], after[1] - times * before[1]);
    context.drawImage(copy, 0, 0);
    context.setTransform(1, 0, 0, 1, 0, 0);
    this.painting = setTimeout(paint, SETTLED);
  }

  /** The place of a state in the drawing: {x, y, r} in canvas pixels, and in m; null if it is not visible. */
  placed(ball, s, t) {
    if (s.state === "out" && s.r[2] < 0) return null;
    const R = radiusOf(this.record, ball);
    let p = s.r;
    if (s.state === "pocketed") {
      const since = this.record.tracks[ball].segments.at(-1).start, age = t - since;
      if (since > 0 && age < SINK_TIME) {
        const before = stateAt(this.record, ball, since - 1e-9).r, left = (1 - age / SINK_TIME) ** 2;
        p = s.r.map((x, k) => x + left * (before[k] - x));
      }
    }
    const [x, y] = this.projection.at(p[0], p[1]);
    const nearer = this.eye / Math.max(this.eye - Math.max(p[2] - R, 0), 0.3 * this.eye);
    return {x, y, r: Math.max(R * this.projection.scale * nearer, 2), p, R};
  }

  /** All visible balls at t, the lowest first. */
  balls(record, t) {
    const list = [];
    for (let i = 0; i < record.tracks.length; ++i) {
      const state = stateAt(record, i, t), place = this.placed(i, state, t);
      if (place === null) continue;
      const since = state.state === "pocketed" ? record.tracks[i].segments.at(-1).start : 0;
      list.push({i, state, ...place, since});
    }
    return list.sort((a, b) => a.p[2] - b.p[2] || a.since - b.since);
  }

  /** Draws the balls at t. `until`: the end of their drawn paths. `only`: the ball whose path is drawn, or
   * -1 for all. `ends`: whether to outline the final positions. */
  draw(t, {trails = "off", ghost = null, marked = -1, until = t, only = -1, ends = false} = {}) {
    const context = this.over.getContext("2d");
    context.setTransform(1, 0, 0, 1, 0, 0);
    context.clearRect(0, 0, this.over.width, this.over.height);
    if (this.numbered) this.numbers(context);
    if (ghost !== null && trails !== "off") this.trails(context, ghost, t, trails, true);
    if (trails !== "off") this.trails(context, this.record, until, trails, false, only);
    this.seen = this.balls(this.record, t);
    this.shadows(context);
    const {projection, shape: {lamp}} = this;
    // Balls begin with their numbers upright on a lying table.
    const turned = (q) => projection.lying ? q : product(q, QUARTER);
    for (const {i, x, y, r, p, R} of this.seen)
      this.pictures[i].draw(context, projection, lamp, x, y, r, p, R, turned(this.orientation(i, t)));
    if (ghost !== null) this.ghosts(context, ghost, t);
    if (ends) {
      const moves = (i) => this.record.tracks[i].segments.length > 1 && (only < 0 || i === only);
      this.ghosts(context, this.record, this.record.duration, moves);
    }
    for (const ball of this.seen) {
      if (ball.i !== marked) continue;
      context.lineWidth = 2 * this.dense;
      context.strokeStyle = "#fff";
      context.beginPath();
      context.arc(ball.x, ball.y, ball.r + 4 * this.dense, 0, 7);
      context.stroke();
    }
  }

  /** The diamonds' numbers, upright on the cushions. */
  numbers(context) {
    context.save();
    context.font = `${Math.max(10 * this.dense, 0.03 * this.projection.scale)}px sans-serif`;
    Object.assign(context, {fillStyle: "#f5f2e8", textAlign: "center", textBaseline: "middle"});
    for (const {at, number} of this.shape.numbers) context.fillText(number, ...this.projection.at(...at));
    context.restore();
  }

  shadows(context) {
    context.save();
    context.setTransform(...this.projection.matrix);
    // Draw only on the cloth: the even-odd rule cuts out the cushions.
    const cloth = new Path2D();
    cloth.rect(-1e4, -1e4, 2e4, 2e4);
    cloth.addPath(this.cushions);
    context.clip(cloth, "evenodd");
    context.setTransform(1, 0, 0, 1, 0, 0);
    const {lamp} = this.shape, down = this.projection.lying ? [0, 1, 1, 0] : [1, 0, 0, -1];
    const aside = (p, k) => lamp.endless ? 0 : (p[k] - lamp.center[k]) / (lamp.center[2] - p[2]);
    for (const {state, x, y, p, R} of this.seen) {
      const lift = Math.max(p[2] / R, 1), faint = clamp(p[2] / R, 0, 1);
      const scale = R * this.projection.scale * lift;
      if (isGone(state.state) || faint === 0) continue;
      let dx = aside(p, 0), dy = aside(p, 1);
      const far = Math.max(1, Math.hypot(dx, dy) / 0.65);
      [dx, dy] = [(down[0] * dx + down[1] * dy) / far, (down[2] * dx + down[3] * dy) / far];
      const put = (picture, ox, oy, alpha) => {
        const reach = picture.reach * scale, size = 2 * reach;
        context.globalAlpha = alpha;
        context.drawImage(picture.canvas, x + ox * scale - reach, y + oy * scale - reach, size, size);
      };
      put(this.contact, 0, 0, faint / (lift * lift));
      put(this.lamp, dx, dy, faint / lift);
    }
    context.restore();
  }

  /** Outlines of the requested balls of a record at t. */
  ghosts(context, record, t, wanted = () => true) {
    for (const {i, state, x, y, r} of this.balls(record, t)) {
      if (isGone(state.state) || !wanted(i)) continue;
      context.beginPath();
      context.arc(x, y, r, 0, 7);
      context.globalAlpha = 0.45;
      context.fillStyle = cssColour(this.styles[i % this.styles.length].color);
      context.fill();
      context.globalAlpha = 0.95;
      context.lineWidth = 1.5 * this.dense;
      context.strokeStyle = "#fff";
      context.setLineDash([3 * this.dense, 2 * this.dense]);
      context.stroke();
      context.setLineDash([]);
      context.globalAlpha = 1;
    }
  }

  /** The balls' paths up to t. A segment is a parabola, which a canvas draws exactly as a quadratic curve. */
  trails(context, record, t, kind, dashed, only = -1) {
    context.save();
    context.setTransform(...this.projection.matrix);
    context.lineWidth = 1.6 * this.dense / this.projection.scale;
    context.lineCap = dashed ? "butt" : "round";
    context.globalAlpha = dashed ? 0.55 : 0.85;
    if (dashed) context.setLineDash([5, 4].map((x) => x * this.dense / this.projection.scale));
    record.tracks.forEach((track, ball) => {
      if (only >= 0 && ball !== only) return;
      const own = cssColour(this.styles[ball % this.styles.length].color), paths = new Map();
      track.segments.forEach((s, k) => {
        const piece = pathPiece(record, track, k, t);
        if (piece === null) return;
        const colour = kind === "ball" ? own : TRAIL_COLOURS[s.state] || "#8cbfff";
        if (!paths.has(colour)) paths.set(colour, new Path2D());
        paths.get(colour).moveTo(...piece[0]);
        paths.get(colour).quadraticCurveTo(...piece[1], ...piece[2]);
      });
      // One stroke for each colour: many short ones are slower.
      for (const [colour, path] of paths) {
        context.strokeStyle = colour;
        context.stroke(path);
      }
    });
    context.restore();
  }

  /** The canvas pixel under the pointer. */
  pixelAt(event) {
    const box = this.over.getBoundingClientRect();
    return [(event.clientX - box.left) * this.dense, (event.clientY - box.top) * this.dense];
  }
  /** The place of the table under the pointer [m]. */
  placeAt(event) { return this.projection.table(...this.pixelAt(event)); }
  /** The ball under the pointer, or -1. */
  ballAt(event) {
    const [x, y] = this.pixelAt(event);
    let best = -1, nearest = 12 * this.dense;
    for (const ball of this.seen || []) {
      const away = Math.hypot(ball.x - x, ball.y - y) - ball.r;
      if (away < nearest && !isGone(ball.state.state)) [best, nearest] = [ball.i, away];
    }
    return best;
  }
}
