// Cameras of the page, {eye, target, up, fov [degrees]}, and the flight between two.

import {add, axesOf, cross, dot, unit} from "./table_gl.js";

const BEHIND = 0.85, HEIGHT = 0.48, DOWN = 23 * Math.PI / 180;  // [m], [m], [rad]

/** From above, as the camera `top` of the frames. */
export function topCamera({bounds: {low, high}, wood_top: top}, width, height) {
  const fov = 16, size = [0, 1].map((k) => high[k] - low[k]), middle = low.map((x, k) => x + size[k] / 2);
  const upright = Math.min(width / size[0], height / size[1]);
  const lying = Math.min(width / size[1], height / size[0]);
  const away = 0.5 * height / (Math.max(upright, lying) * Math.tan(fov * Math.PI / 360));
  return {eye: [...middle, top + away], target: [...middle, 0], fov,
    up: lying > upright ? [-1, 0, 0] : [0, 1, 0]};
}

/** Behind a ball along the aim [rad]: as the camera `player` of the frames, but on the line of aim, and
 * independent of the shot. */
export function cueCamera({x, y}, aim, wide) {
  const level = [Math.cos(aim), Math.sin(aim)];
  const eye = [x - BEHIND * level[0], y - BEHIND * level[1], HEIGHT];
  const forward = [...level.map((c) => Math.cos(DOWN) * c), -Math.sin(DOWN)];
  return {eye, target: add(eye, forward, HEIGHT / Math.sin(DOWN)), up: [0, 0, 1], fov: wide ? 40 : 62};
}

/** The rotation of the columns right, up and backwards. */
function quaternion([forward, r, u]) {
  const m = [r, u, forward.map((x) => -x)], trace = m[0][0] + m[1][1] + m[2][2];
  if (trace > 0) {
    const s = 2 * Math.sqrt(trace + 1);
    return [s / 4, (m[1][2] - m[2][1]) / s, (m[2][0] - m[0][2]) / s, (m[0][1] - m[1][0]) / s];
  }
  const i = [0, 1, 2].reduce((a, b) => m[b][b] > m[a][a] ? b : a), j = (i + 1) % 3, k = (i + 2) % 3;
  const s = 2 * Math.sqrt(1 + m[i][i] - m[j][j] - m[k][k]), q = [(m[j][k] - m[k][j]) / s, 0, 0, 0];
  q[1 + i] = s / 4;
  q[1 + j] = (m[i][j] + m[j][i]) / s;
  q[1 + k] = (m[i][k] + m[k][i]) / s;
  return q;
}
const turned = ([w, ...a], v) => add(v, cross(a, add(cross(a, v), v, w)), 2);

/** Between two cameras, t = 0..1: the middle of the picture, its size and the direction change evenly. */
export function between(a, b, t) {
  const s = t * t * (3 - 2 * t), tan = (c) => Math.tan(c.fov * Math.PI / 360);
  const mix = (x, y) => x + s * (y - x), away = (c) => Math.hypot(...add(c.target, c.eye, -1));
  const p = quaternion(axesOf(a)), q = quaternion(axesOf(b)), same = dot(p, q) < 0 ? -1 : 1;
  const half = Math.acos(Math.min(1, same * dot(p, q))), sine = Math.sin(half);
  const w = sine < 1e-6 ? [1 - s, s] : [Math.sin((1 - s) * half) / sine, Math.sin(s * half) / sine];
  const turn = unit(p.map((x, k) => w[0] * x + same * w[1] * q[k]));
  const size = Math.exp(mix(Math.log(away(a) * tan(a)), Math.log(away(b) * tan(b))));
  const view = mix(tan(a), tan(b)), target = a.target.map((x, k) => mix(x, b.target[k]));
  return {target, eye: add(target, turned(turn, [0, 0, 1]), size / view), up: turned(turn, [0, 1, 0]),
    fov: Math.atan(view) * 360 / Math.PI};
}

/** The canvas pixel of a place [m]. */
export function pixelOf(camera, place, width, height) {
  const [forward, right, up] = axesOf(camera), from = add(place, camera.eye, -1);
  const scale = 0.5 * height / (Math.tan(camera.fov * Math.PI / 360) * dot(from, forward));
  return [width / 2 + scale * dot(from, right), height / 2 - scale * dot(from, up)];
}
