// The view behind the cue ball: a canvas of WebGL2 in place of the table from above, made when it is wanted
// first. Without WebGL2 there is no button.

import {button, make} from "../../page/dom.js";
import {isGone, pathPiece, stateAt} from "../../page/motion.js";
import {HINT_COLOURS, firstContact, pulledBack} from "./aids.js";
import {between, cueCamera, pixelOf, topCamera} from "./cameras.js";
import {GHOST, PATTERNS, TableGl, add} from "./table_gl.js";

const FLIGHT = 700;   // [ms] of the camera
const SETTLED = 120;  // [ms] after its last move, until the picture is drawn finely
const CLOTH = 0.002, CUE = 1.47;    // [m] height of lines; length
const CURVED = 8;                   // straight pieces of a curved path
const PREFERENCES = {alpha: false, antialias: false, depth: false, powerPreference: "high-performance"};

/** A canvas and its context, or null. */
function context() {
  const canvas = make("canvas", {"aria-hidden": "true", class: "sight", hidden: ""});
  return canvas.getContext("webgl2", PREFERENCES);
}
/** Whether the browser computes the pictures without a graphics card. */
function isSoftware(gl) {
  const about = gl.getExtension("WEBGL_debug_renderer_info");
  const name = gl.getParameter(about ? about.UNMASKED_RENDERER_WEBGL : gl.RENDERER);
  return /swiftshader|llvmpipe|softpipe|software|basic render/i.test(name);
}

/** The paths of a record up to a time as straight lines. `only`: one ball, or -1. */
function pathsOf(record, until, only, line) {
  return record.tracks.flatMap((track, ball) => only >= 0 && ball !== only ? []
    : track.segments.flatMap((s, k) => {
      const piece = pathPiece(record, track, k, until);
      if (piece === null) return [];
      const count = s.a[0] * s.v[1] === s.a[1] * s.v[0] ? 1 : CURVED;
      const at = (t) => [0, 1].map((j) => (1 - t) ** 2 * piece[0][j] + 2 * t * (1 - t) * piece[1][j] +
        t * t * piece[2][j]);
      return Array.from({length: count}, (_, i) => line(at(i / count), at((i + 1) / count), ball));
    }));
}

/** A CSS colour of six digits as [red, green, blue], 0..1. */
const colourOf = (text) => [1, 3, 5].map((k) => parseInt(text.slice(k, k + 2), 16) / 255);

/** The aids while aiming: {cue, lines, ghosts}. */
function aidsOf(state, styleOf) {
  const {shot, scene: {cue}, hints, paths, mode, view: {dense}} = state, from = state.struck();
  const record = shot.motion, struck = shot.balls.indexOf(cue.ball), ghosts = [];
  const line = (a, b, colour, alpha = 0.85) => ({from: [a[0], a[1], CLOTH], to: [b[0], b[1], CLOTH],
    width: 1.6 * dense, colour: [...colour, alpha]});
  const ghost = (at, R, color) => ghosts.push({at: [...at.slice(0, 2), R], R, turn: [0, 0, 0, 1], color,
    pattern: GHOST, number: 0, sunk: true});
  const contact = state.level ? null : firstContact(shot, cue.ball), own = (a, b, i) => line(a, b,
    styleOf(i).color);
  let lines = [];
  if (mode === "play" && contact) {
    lines = pathsOf(record, contact.time, struck, own);
    lines.push(...contact.lines.map(([a, b]) => line(a, b, [1, 1, 1])));
    ghost(contact.at, contact.R, [1, 1, 1]);
  } else if (mode === "practise" && paths !== "off") {
    const only = paths === "cue" ? struck : -1;
    lines = pathsOf(record, record.duration, only, own);
    record.tracks.forEach((track, i) => {
      const end = stateAt(record, i, record.duration);
      if (track.segments.length > 1 && (only < 0 || i === only) && !isGone(end.state))
        ghost(end.r, end.r[2], styleOf(i).color);
    });
  }
  hints.forEach(({contact: met, from: [x, y]}, k) => {
    if (!met) return;
    const colour = colourOf(HINT_COLOURS[k]);
    lines.push(line([x, y], met.at, colour), ...met.lines.map(([a, b]) => line(a, b, colour)));
    ghost(met.at, met.R, colour);
  });
  const aim = cue.aim_deg * Math.PI / 180, raised = cue.elevation_deg * Math.PI / 180, R = from.radius;
  const back = [-Math.cos(aim) * Math.cos(raised), -Math.sin(aim) * Math.cos(raised), Math.sin(raised)];
  const aside = [-Math.sin(aim) * cue.side * R, Math.cos(aim) * cue.side * R, cue.height * R];
  const tip = add(add([from.x, from.y, R], aside), back, R + 0.02 + pulledBack(cue.speed));
  return {cue: {tip, butt: add(tip, back, CUE)}, lines, ghosts};
}

export class Sight {
  constructor(state) { Object.assign(this, {state, gl: null, table: null, share: 0, wanted: 0, last: ""}); }
  get on() { return this.share > 0; }

  /** @returns whether the browser has WebGL2; keeps the context, because making one is slow */
  possible() {
    this.gl ??= context();
    return this.gl !== null;
  }
  /** Flies to the other view. @throws Error of the browser's compiler */
  turn() {
    const {state} = this, from = this.share;
    if (!this.table) this.make();
    this.wanted = this.wanted > 0 || !state.scene.cue ? 0 : 1;
    this.furnish();
    const to = this.wanted, begin = performance.now();
    const step = () => {
      if (this.wanted !== to) return;
      const done = state.calm ? 1 : Math.min((performance.now() - begin) / FLIGHT, 1);
      this.share = from + done * (to - from);
      state.clock.refresh();
      if (done < 1) requestAnimationFrame(step);
      else state.tell("sight");
    };
    step();
  }
  make() {
    if (!this.possible()) throw new Error("this browser has no WebGL2");
    this.software = isSoftware(this.gl);
    this.table = new TableGl(this.gl, this.state.page.shaders);
    this.gl.canvas.addEventListener("webglcontextlost", () => {
      this.gl.canvas.remove();
      Object.assign(this, {gl: null, table: null, key: "", share: 0, wanted: 0});
      this.state.say("The browser lost the view behind the cue ball; press its button again.", true);
      this.state.clock.refresh();
      this.state.tell("sight");
    });
  }
  /** Fits to the scene's table; this canvas lies between the two of the view from above. */
  furnish() {
    const {state: {view, scene}, table} = this, {shape} = view, key = JSON.stringify([shape.cushion,
      shape.felt]);
    if (!table) return;
    if (view.over.previousSibling !== this.gl.canvas) view.over.before(this.gl.canvas);
    if (this.key !== key) table.furnish(scene.mesh(), shape);
    this.key = key;
  }

  camera() {
    const {state: {scene, view: {over: {width, height}, shape}}} = this,
      aim = scene.cue.aim_deg * Math.PI / 180;
    const above = topCamera(shape, width, height), behind = cueCamera(this.state.struck(), aim,
      width > height);
    return this.share < 1 ? between(above, behind, this.share) : behind;
  }
  /** Draws the table at time t; with a camera, size and coarseness of a test. @returns whether this view is
   * on */
  draw(t, camera = null, size = null, coarse = false) {
    const {state, table} = this, {view, shot, scene} = state, {under, over} = view, canvas = this.gl?.canvas;
    const on = camera !== null || this.on && scene.cue !== null;
    if (canvas) canvas.hidden = !on;
    // The upper canvas still receives the pointer.
    under.style.opacity = over.style.opacity = on ? "0" : "";
    if (!on) return false;
    this.furnish();
    const styleOf = (i) => view.styles[i % view.styles.length], [width, height] = size ?? [over.width,
      over.height];
    const balls = view.balls(shot.motion, t).map(({i, state: {state: how}, p, R}) => {
      const [w, ...turn] = view.orientation(i, t), {color, pattern, number} = styleOf(i);
      return {at: p, R, turn: [...turn, w], color, pattern: PATTERNS.indexOf(pattern), number,
        sunk: isGone(how)};
    });
    const aids = state.aiming && camera === null ? aidsOf(state, styleOf) : {};
    const from = camera ?? this.camera(), key = JSON.stringify([from, width, height]);
    const moves = camera === null && this.software && key !== this.last;
    this.last = key;
    table.draw(from, {balls, ...aids}, width, height, camera === null ? moves || this.coarse : coarse);
    if (moves) {
      this.coarse = true;
      clearTimeout(this.waits);
      this.waits = setTimeout(() => {
        this.coarse = false;
        state.clock.refresh();
      }, SETTLED);
    }
    return true;
  }
  /** The height of the struck ball in the picture, and of its lower edge [canvas px]. */
  ballAt() {
    const {state: {view: {over: {width, height}}}} = this, {x, y, radius} = this.state.struck();
    return pixelOf(this.camera(), [x, y, 0], width, height).concat(radius);
  }
}

/** The button of this view, if the browser has WebGL2. */
export function sightButton(state) {
  const sight = state.sight = new Sight(state), press = () => {
    try {
      sight.turn();
    } catch (error) {
      state.say(`The view behind the cue ball cannot be drawn: ${error.message}`, true);
    }
    show();
  };
  const element = button("View", press, {class: "kept", hidden: "", "aria-pressed": "false",
    "aria-label": "View behind the cue ball", title: "View behind the cue ball (V)"});
  const show = () => element.setAttribute("aria-pressed", String(sight.wanted > 0));
  state.on("sight", show);
  for (const change of ["table", "view"]) state.on(change, () => { if (sight.on) sight.furnish(); });
  setTimeout(() => { element.hidden = !sight.possible(); }, 300);
  state.switchSight = () => { if (!element.hidden) press(); };
  return element;
}
