// The aids while aiming: the cue, the line to the first ball, and the shots of a hint.

import {radiusOf, stateAt} from "../../page/motion.js";

const MEETS = ["ball_ball", "ball_cluster", "ball_cushion", "ball_jaw", "ball_pocket", "ball_out"];
const SHORT = 0.22;  // [m] the line of a ball after the contact
const OBVIOUS = 0.1;  // [rad]
export const PULL = 0.3;  // [m] pull of the cue for the hardest stroke
export const HARDEST = 12;  // [m/s] a break
export const HINT_COLOURS = ["#ffd84d", "#7fd4ff", "#ffb0e0"];

/** The pull of the cue for a speed, and the speed for a pull: soft strokes have more room. */
export const pulledBack = (speed) => PULL * Math.sqrt(Math.min(speed / HARDEST, 1));
export const speedOf = (way) => HARDEST * Math.min(Math.max(way / PULL, 0), 1) ** 2;

/** The first contact of the struck ball: {ball, at, time, R, lines, met}: its position then, the short
 * lines of both balls, and {id, cut, left} of the ball that it meets, or null; `cut` in radians, and its
 * side. */
export function firstContact({motion: record, events}, id) {
  const indexOf = (name) => record.tracks.findIndex((track) => track.id === name), ball = indexOf(id);
  const hits = (e) => e.hits?.filter(({ball, other}) => ball === id || other === id);
  const has = (e) => e.hits ? hits(e).length > 0 : e.ball === id || e.other === id && e.type === "ball_ball";
  const e = events.find((event) => MEETS.includes(event.type) && has(event));
  if (!e) return null;
  const R = radiusOf(record, ball), {r: at, v} = stateAt(record, ball, e.time), lines = [];
  const found = {ball, at, time: e.time, R, lines, met: null};
  if (!e.type.startsWith("ball_ball") && e.type !== "ball_cluster") return found;
  const line = (from, way) => {
    const speed = Math.hypot(way[0], way[1]);
    if (speed > 1e-3) lines.push([from, [0, 1].map((k) => from[k] + SHORT * way[k] / speed)]);
  };
  const [hit] = hits(e) ?? [e], first = indexOf(hit.ball === id ? hit.other : hit.ball);
  if (first < 0) return found;
  const along = (other) => [0, 1].map((k) => stateAt(record, other, e.time).r[k] - at[k]);
  const came = stateAt(record, ball, Math.max(e.time - 1e-6, 0)).v;
  const ahead = (other) => along(other).reduce((sum, x, k) => sum + x * came[k], 0);
  const to = along(first);
  line(stateAt(record, first, e.time).r, stateAt(record, first, e.time).v);
  line(at, v);
  const cross = came[0] * to[1] - came[1] * to[0];
  found.met = {id: record.tracks[first].id, cut: Math.atan2(Math.abs(cross), ahead(first)), left: cross > 0};
  return found;
}

/** The ball and the pocket of an obvious shot, which need no call: the ball that is met, and the pocket it
 * runs towards; null if there is none. */
export function obviousCall(contact, pockets) {
  if (!contact?.met || contact.lines.length === 0) return null;
  const [from, to] = contact.lines[0], away = (a, b) => [0, 1].map((k) => b[k] - a[k]), way = away(from, to);
  const turn = ({center}) => {
    const [x, y] = away(from, center);
    return Math.abs(Math.atan2(way[0] * y - way[1] * x, way[0] * x + way[1] * y));
  };
  const [nearest] = [...pockets].sort((a, b) => turn(a) - turn(b));
  return nearest && turn(nearest) < OBVIOUS ? {ball: contact.met.id, pocket: nearest.id} : null;
}

/** Lines in canvas pixels. */
function strokes(view) {
  const context = view.over.getContext("2d"), {dense, projection} = view;
  return {context, line(a, b, colour, thick = 1.5 * dense, dash = []) {
    context.beginPath();
    context.moveTo(...a);
    context.lineTo(...b);
    context.setLineDash(dash);
    context.lineWidth = thick;
    context.strokeStyle = colour;
    context.stroke();
  }, ring([x, y], R, colour) {
    context.beginPath();
    context.arc(...projection.at(x, y), R * projection.scale, 0, 7);
    context.setLineDash([]);
    context.lineWidth = 1.5 * dense;
    context.strokeStyle = colour;
    context.stroke();
  }};
}

/** The ghost ball at the first contact, and the short lines behind it. */
export function drawContact(view, contact, colour, word = "") {
  const {context, line, ring} = strokes(view), {at, R, lines} = contact, {projection, dense} = view;
  context.save();
  ring(at, R, colour);
  for (const [from, to] of lines) line(projection.at(...from), projection.at(...to), colour);
  if (word) {
    const [x, y] = projection.at(...at);
    Object.assign(context, {font: `600 ${13 * dense}px system-ui, sans-serif`, fillStyle: colour,
      textAlign: "center", textBaseline: "middle", strokeStyle: "rgba(0, 0, 0, 0.75)", lineWidth: 3 * dense});
    context.strokeText(word, x, y);
    context.fillText(word, x, y);
  }
  context.restore();
}

/** The straight paths of a hint. */
export function drawHints(state) {
  const {view, hints} = state, {line} = strokes(view);
  [...hints].reverse().forEach((hint) => {
    const k = hints.indexOf(hint), {contact, from} = hint;
    if (!contact) return;
    line(view.projection.at(...from), view.projection.at(...contact.at), HINT_COLOURS[k], 1.2 * view.dense,
      [6 * view.dense, 4 * view.dense]);
    drawContact(view, contact, HINT_COLOURS[k], String(k + 1));
  });
}

/** The ends of the cue along its line, from the ball backwards [m]; a raised one looks shorter. */
export const cueSpan = ({speed, elevation_deg: raised}, R) => {
  const gap = 1.25 * R + pulledBack(speed), shrink = Math.cos(raised * Math.PI / 180);
  return [gap * shrink, (gap + 1.1) * shrink];
};

/** The cue behind its ball, and its shadow if it is raised. */
export function drawCue({scene: {cue}, view}, from) {
  const angle = cue.aim_deg * Math.PI / 180, along = [Math.cos(angle), Math.sin(angle)];
  const {projection, dense} = view, R = from.radius, {context, line} = strokes(view);
  const at = (d, side = 0) => projection.at(from.x + d * along[0] - side * along[1],
    from.y + d * along[1] + side * along[0]);
  const side = cue.side * R, [gap, end] = cueSpan(cue, R), {scale} = projection;
  context.save();
  context.lineCap = "round";
  const lift = Math.tan(Math.min(cue.elevation_deg, 60) * Math.PI / 180);
  // The lamp is above, so a shadow lies a little beside.
  const aside = side - 0.012 - 0.12 * lift * (end - gap);
  line(at(-gap - 0.012, side - 0.012), at(-end, aside), "rgba(0, 0, 0, 0.3)", 0.02 * scale);
  line(at(-gap - 0.012, side), at(-end, side), "#3a2414", 0.024 * scale);
  line(at(-gap - 0.012, side), at(-gap - 0.68 * (end - gap), side), "#d9b06c", 0.014 * scale);
  line(at(-gap, side), at(-gap - 0.014, side), "#3f7fbf", Math.max(0.013 * scale, 2 * dense));
  context.restore();
}

/** Whether a place [m] is on the cue, or within `slop` [m] of it. */
export function onCue(cue, ball, [x, y], slop) {
  const angle = cue.aim_deg * Math.PI / 180, dx = ball.x - x, dy = ball.y - y;
  const back = dx * Math.cos(angle) + dy * Math.sin(angle);
  const beside = Math.abs(dx * Math.sin(angle) - dy * Math.cos(angle));
  const [gap, end] = cueSpan(cue, ball.radius);
  return beside < slop && back > gap - 0.5 * slop && back < end;
}
