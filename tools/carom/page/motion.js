// The position of every ball of a record at any time. The formulas are those of
// docs/reference/record_format.md, with their terms in the engine's order, so that positions, velocities and
// spins have the same bits. Orientations do not: they need sin and cos, and a browser's differ from the
// engine's.

/** The index of the last item in `list` whose `start` (or other key) is at most t; 0 if there is none. */
export function lastBefore(list, t, key = "start") {
  let low = 0, high = list.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (t < list[middle][key]) high = middle;
    else low = middle + 1;
  }
  return low === 0 ? 0 : low - 1;
}

/** Whether a ball with this state is off the table. */
export const isGone = (state) => state === "pocketed" || state === "out";

export const flies = (track) => track.segments.some((s) => s.state === "airborne");
/** The length of a vector. */
export const size = (v) => Math.hypot(...v);

export const radiusOf = (record, ball) => record.tracks[ball].radius ?? record.balls.R;
const massOf = (record, ball) => record.tracks[ball].mass ?? record.balls.m;

function velocityAt(s, tau) {
  if (s.state === "rolling" && s.duration !== null && !s.held) {
    const left = Math.max(0, 1 - tau / s.duration);
    return [s.v[0] * left, s.v[1] * left, 0];
  }
  return [s.v[0] + tau * s.a[0], s.v[1] + tau * s.a[1], 0];
}

function spinAt(s, tau, R) {
  const left = Math.abs(s.w[2]) - s.spin_decay * tau;
  const wz = !(left > 0) ? 0 : s.w[2] < 0 ? -left : left;
  if (s.state === "rolling") {
    const v = velocityAt(s, tau);
    return [-v[1] / R, v[0] / R, wz];
  }
  return [s.w[0] + tau * s.dw[0], s.w[1] + tau * s.dw[1], wz];
}

// [m] As in the engine: distance of the floor below the cloth.
const FLOOR_DEPTH = 0.76;

/** Time until a ball that has left the table lies on the floor, as in the engine. */
function untilFloor(s, R, g) {
  if (s.state !== "out" || !(g > 0)) return Infinity;
  const v = s.v[2], height = Math.max(0, s.r[2] + (FLOOR_DEPTH - R));
  return (v + Math.sqrt(v * v + 2 * g * height)) / g;
}

/** The state of a ball: {state, r, v, w, pocket}, in SI units. */
export function stateAt(record, ball, t) {
  t = Math.min(Math.max(t, 0), record.duration);
  const track = record.tracks[ball], s = track.segments[lastBefore(track.segments, t)];
  const R = radiusOf(record, ball), floor = untilFloor(s, R, record.gravity);
  const tau = Math.min(t - s.start, s.duration === null ? Infinity : s.duration, floor);
  const along = (k) => s.r[k] + tau * (s.v[k] + 0.5 * tau * s.a[k]), r = [along(0), along(1), s.r[2]];
  const v = velocityAt(s, tau), g = record.gravity;
  if (s.state === "colliding") {
    r[2] += tau * s.v[2];
    v[2] = s.v[2];
  } else if (s.state === "airborne" || s.state === "out") {
    r[2] = s.r[2] + tau * (s.v[2] - 0.5 * g * tau);
    v[2] = s.v[2] - g * tau;
  } else if (s.state === "falling") {
    const falls = g * tau - s.v[2];
    r[2] -= falls * falls / (2 * g);
    v[2] = -falls;
  }
  if (tau === floor)
    return {state: s.state, r: [r[0], r[1], R - FLOOR_DEPTH], v: [0, 0, 0], w: [0, 0, 0], pocket: -1};
  return {state: s.state, r, v, w: spinAt(s, tau, R), pocket: s.state === "pocketed" ? track.pocket : -1};
}

/** The path of a ball on the table in the k-th segment of its track, up to a time: [start, middle, end] of a
 * quadratic curve, which is exactly the parabola of the segment; null if it does not move there. */
export function pathPiece(record, track, k, until) {
  const s = track.segments[k], next = track.segments[k + 1]?.start ?? record.duration;
  const tau = Math.min(Math.min(next, until) - s.start, s.duration ?? Infinity);
  const still = s.v[0] === 0 && s.v[1] === 0 && s.a[0] === 0 && s.a[1] === 0;
  if (!(tau > 0) || still || isGone(s.state) || s.state === "falling") return null;
  const point = (at) => [at(0), at(1)];
  return [point((j) => s.r[j]), point((j) => s.r[j] + 0.5 * tau * s.v[j]),
    point((j) => s.r[j] + tau * (s.v[j] + 0.5 * tau * s.a[j]))];
}

// Quaternions are [w, x, y, z].
export function product(p, q) {
  return [p[0] * q[0] - p[1] * q[1] - p[2] * q[2] - p[3] * q[3],
    p[0] * q[1] + p[1] * q[0] + p[2] * q[3] - p[3] * q[2],
    p[0] * q[2] + p[2] * q[0] + p[3] * q[1] - p[1] * q[3],
    p[0] * q[3] + p[3] * q[0] + p[1] * q[2] - p[2] * q[1]];
}

function rotation(x, y, z) {
  const angle = Math.sqrt(x * x + y * y + z * z);
  if (angle === 0) return [1, 0, 0, 0];
  const half = 0.5 * (angle % (4 * Math.PI)), k = Math.sin(half) / angle;
  return [Math.cos(half), k * x, k * y, k * z];
}

function unit(q) {
  const n = Math.hypot(...q);
  return n > 0 ? q.map((x) => x / n) : [1, 0, 0, 0];
}

// As in the engine: the largest angle of a step [rad], and the most steps of one call.
const LARGEST_STEP = 0.2, MOST_STEPS = 1e5;

/** The rotation over `time` for the angular velocity w with the rate dw: fourth-order Magnus steps. */
function turned(w, dw, time) {
  const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
  const then = w.map((x, k) => x + time * dw[k]);
  if (cross(w, dw).every((x) => x === 0)) {
    const h = 0.5 * time * time;
    return rotation(w[0] * time + h * dw[0], w[1] * time + h * dw[1], w[2] * time + h * dw[2]);
  }
  const wanted = Math.max(Math.hypot(...w), Math.hypot(...then)) * time / LARGEST_STEP;
  const steps = 1 + Math.floor(Math.min(wanted, MOST_STEPS)), h = time / steps, c = h * h * h / 12;
  let q = [1, 0, 0, 0];
  for (let i = 0; i < steps; ++i) {
    const middle = w.map((x, k) => x + (i + 0.5) * h * dw[k]), swerve = cross(middle, dw);
    q = product(rotation(...[0, 1, 2].map((k) => h * middle[k] - c * swerve[k])), q);
  }
  return unit(q);
}

function segmentTurn(s, tau) {
  if (!(tau > 0)) return [1, 0, 0, 0];
  const sign = Math.sign(s.w[2]), level = [s.dw[0], s.dw[1], 0];
  const dw = [s.dw[0], s.dw[1], sign === 0 ? 0 : -sign * s.spin_decay];
  const end = sign !== 0 && s.spin_decay > 0 ? Math.abs(s.w[2]) / s.spin_decay : Infinity;
  if (tau <= end) return turned(s.w, dw, tau);
  const then = [s.w[0] + end * s.dw[0], s.w[1] + end * s.dw[1], 0];
  return product(turned(then, level, tau - end), turned(s.w, dw, end));
}

/** A function (ball, t) that returns the rotation since the start, from the ball's frame to the table's. */
export function orientations(record) {
  const starts = record.tracks.map((track) => {
    let q = [1, 0, 0, 0];
    return track.segments.map((s, i) => {
      const start = q, next = track.segments[i + 1];
      if (next) q = unit(product(segmentTurn(s, next.start - s.start), q));
      return start;
    });
  });
  return (ball, t) => {
    t = Math.min(Math.max(t, 0), record.duration);
    const segments = record.tracks[ball].segments, i = lastBefore(segments, t), s = segments[i];
    const floor = untilFloor(s, radiusOf(record, ball), record.gravity);
    const tau = Math.min(t - s.start, s.duration === null ? Infinity : s.duration, floor);
    return product(segmentTurn(s, tau), starts[ball][i]);
  };
}

/** The energy [J] of all balls in play together: {moving, turning, raised}. */
export function energiesAt(record, t) {
  const sum = {moving: 0, turning: 0, raised: 0};
  const square = (x) => x[0] * x[0] + x[1] * x[1] + x[2] * x[2];
  for (let ball = 0; ball < record.tracks.length; ++ball) {
    const s = stateAt(record, ball, t), R = radiusOf(record, ball), m = massOf(record, ball);
    if (isGone(s.state)) continue;
    sum.moving += 0.5 * m * square(s.v);
    sum.turning += 0.2 * m * R * R * square(s.w);
    if (s.state === "airborne") sum.raised += m * record.gravity * Math.max(0, s.r[2] - R);
  }
  return sum;
}
