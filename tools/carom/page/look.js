// The look of a table and its balls from above: the lamp, materials and patterns of the rendered frames
// (render/src/draw/shaders), computed pixel by pixel. The table is painted once per size, a ball whenever it
// moves or turns.

import * as look from "../../../render/include/carom/render/look.h";
import {brightness} from "./dom.js";

export const clamp = (x, low, high) => Math.min(Math.max(x, low), high);
const mix = (a, b, t) => a + (b - a) * t;
/** GLSL's smoothstep; a may be greater than b. */
const step = (a, b, x) => { const t = clamp((x - a) / (b - a), 0, 1); return t * t * (3 - 2 * t); };
/** Screen value (0..1) of a radiance, with the renderer's soft shoulder. */
const toScreen = (c) => {
  const over = 1 + Math.max(c - 0.5, 0);
  return Math.sqrt(clamp(c, 0, 0.5) + 0.5 - 0.5 / (over * over));
};
const fromScreen = (c) => c.map((x) => x * x);

const [CLOTH, WOOD_DARK, WOOD_LIGHT, TRIM, INLAY, IVORY, RED_DOT, PALE_DOT] =
  ["Cloth", "WoodDark", "WoodLight", "Trim", "Inlay", "Ivory", "RedDot", "PaleDot"]
    .map((name) => fromScreen(look[`k${name}`]));

function lattice(x, y) {
  let h = Math.imul(x, 0x9E3779B1) ^ Math.imul(y, 0x85EBCA77);
  h ^= h >>> 15; h = Math.imul(h, 0x2C1B3C6D); h ^= h >>> 12; h = Math.imul(h, 0x297A2D39); h ^= h >>> 15;
  return (h >>> 8) / 16777216;
}
function noise(x, y) {
  const i = Math.floor(x), j = Math.floor(y);
  let u = x - i, v = y - j;
  u = u * u * (3 - 2 * u); v = v * v * (3 - 2 * v);
  return mix(mix(lattice(i, j), lattice(i + 1, j), u), mix(lattice(i, j + 1), lattice(i + 1, j + 1), u), v);
}

/** Light of the lamp on a level surface at (x, y, z); 1 straight below it. */
function lampLight(lamp, x, y, z) {
  const h = lamp.center[2];
  if (lamp.endless) return 1;
  const ax = x - lamp.center[0], ay = y - lamp.center[1], rx = 0.6 * lamp.half[0], ry = 0.6 * lamp.half[1];
  const tx = clamp(ax, -rx, rx) - ax, ty = clamp(ay, -ry, ry) - ay, tz = h - z;
  const inverse = 1 / Math.sqrt(tx * tx + ty * ty + tz * tz);
  return Math.max(tz * inverse, 0) * h * h * inverse * inverse;
}

/** The position of the table [m] on a canvas [px]: lengthwise along the longer side, as in the camera
 * `top`. */
export class Projection {
  constructor(bounds, width, height, margin) {
    const [w, l] = [0, 1].map((k) => Math.max(bounds.high[k] - bounds.low[k], 1e-3));
    const W = Math.max(width - 2 * margin, 10), H = Math.max(height - 2 * margin, 10);
    const upright = Math.min(W / w, H / l), lying = Math.min(W / l, H / w);
    this.lying = lying > upright;
    this.scale = Math.max(upright, lying);
    const x = 0.5 * (bounds.low[0] + bounds.high[0]), y = 0.5 * (bounds.low[1] + bounds.high[1]);
    const s = this.scale;
    this.matrix = this.lying ? [0, s, s, 0, width / 2 - s * y, height / 2 - s * x]
      : [s, 0, 0, -s, width / 2 - s * x, height / 2 + s * y];
  }
  /** Enlarges it by `times`; the pixel `from` is then at `to`. */
  look(times, from, to) {
    const m = this.matrix;
    this.scale *= times;
    const moved = [0, 1].map((k) => to[k] + times * (m[4 + k] - from[k]));
    this.matrix = [...m.slice(0, 4).map((x) => times * x), ...moved];
  }
  at(x, y) {
    const m = this.matrix;
    return [m[0] * x + m[2] * y + m[4], m[1] * x + m[3] * y + m[5]];
  }
  table(px, py) {
    const m = this.matrix, dx = px - m[4], dy = py - m[5];
    return this.lying ? [dy / m[1], dx / m[2]] : [dx / m[0], dy / m[3]];
  }
}

export function pathOf(loops) {
  const path = new Path2D();
  for (const loop of loops) {
    for (let i = 0; i < loop.length; i += 2) path[i === 0 ? "moveTo" : "lineTo"](loop[i], loop[i + 1]);
    path.closePath();
  }
  return path;
}

/** Fills a path with the radiance that colour(x, y, out) writes to `out` for every place of the table. */
function paint(scratch, projection, path, colour) {
  const {canvas} = scratch, out = [0, 0, 0];
  scratch.setTransform(1, 0, 0, 1, 0, 0);
  scratch.clearRect(0, 0, canvas.width, canvas.height);
  scratch.setTransform(...projection.matrix);
  scratch.fill(path);
  const image = scratch.getImageData(0, 0, canvas.width, canvas.height), data = image.data;
  for (let py = 0, at = 0; py < canvas.height; ++py) {
    for (let px = 0; px < canvas.width; ++px, at += 4) {
      if (data[at + 3] === 0) continue;
      const [x, y] = projection.table(px + 0.5, py + 0.5);
      colour(x, y, out);
      for (let k = 0; k < 3; ++k) data[at + k] = 255 * toScreen(out[k]);
    }
  }
  scratch.putImageData(image, 0, 0);
  return canvas;
}

/** Paints the table without balls. `shape`: as tools/carom/page/table_shape.h describes. */
export function paintTable(canvas, projection, shape) {
  const context = canvas.getContext("2d");
  const scratch = document.createElement("canvas").getContext("2d", {willReadFrequently: true});
  scratch.canvas.width = canvas.width;
  scratch.canvas.height = canvas.height;
  const lamp = shape.lamp, top = shape.wood_top, plain = () => context.setTransform(1, 0, 0, 1, 0, 0);
  const lit = (out, albedo, gain, x, y, z) => {
    const light = gain * (1.05 * lampLight(lamp, x, y, z) + 0.16);
    for (let k = 0; k < 3; ++k) out[k] = albedo[k] * light;
  };
  const layer = (loops, colour) => {
    if (loops.length === 0) return;
    const painted = paint(scratch, projection, pathOf(loops), colour);
    plain();
    context.drawImage(painted, 0, 0);
  };
  const nap = (x, y) => 1 + (noise(14 * x, 9 * y) - 0.5) * 0.035;
  const line = (loops, width, style) => {
    context.setTransform(...projection.matrix);
    context.lineWidth = Math.max(width, 0.7 / projection.scale);
    context.strokeStyle = style;
    context.stroke(pathOf(loops));
  };
  plain();
  context.fillStyle = "#100f0e";
  context.fillRect(0, 0, canvas.width, canvas.height);
  for (const board of shape.wood) {
    const [ux, uy, u0, vx, vy, v0] = board.grain;
    layer(board.loops, (x, y, out) => {
      const u = ux * x + uy * y + u0, v = vx * x + vy * y + v0;
      const rings = noise(2.2 * u, 38 * v) * 0.65 + noise(9 * u, 160 * v) * 0.35, t = step(0.15, 0.85, rings);
      lit(out, [0, 1, 2].map((k) => mix(WOOD_DARK[k], WOOD_LIGHT[k], t)), 1, x, y, top);
    });
    line(board.loops, 0.003, "rgba(0,0,0,0.28)");
  }
  const felt = fromScreen(shape.felt ?? look.kCloth);
  layer(shape.cloth, (x, y, out) => lit(out, felt, nap(x, y), x, y, 0));
  shade(context, projection, shape);
  layer(shape.chalk, (x, y, out) => lit(out, [look.kChalk, look.kChalk, look.kChalk], 0.42, x, y, 0));
  plain();
  for (const hole of shape.holes) paintHole(context, projection, hole);
  layer(shape.trim, (x, y, out) => lit(out, TRIM, 1, x, y, top));
  layer(shape.cushion, (x, y, out) => lit(out, felt, look.kCushionGain * nap(x, y), x, y, 0.04));
  line(shape.cushion, 0.0025, "rgba(0,20,10,0.35)");
  layer(shape.inlay, (x, y, out) => lit(out, INLAY, 1, x, y, top));
  plain();
}

/** The darkness of the cloth along the cushions: the renderer's profile, as overlapping strokes. */
function shade(context, projection, shape) {
  context.save();
  context.setTransform(...projection.matrix);
  context.clip(pathOf(shape.cloth));
  context.lineCap = "round";
  const path = new Path2D(), pieces = 14, wide = 0.045;
  for (const loops of [shape.cushion, ...shape.wood.map((board) => board.loops)]) path.addPath(pathOf(loops));
  const dark = (d) => d > 0.018 ? 0.1 * (wide - d) / 0.027 : mix(0.42, 0.1, d / 0.018);
  let left = 1;  // share of the light outside the strokes so far
  for (let i = 1; i <= pieces; ++i) {
    const d = wide * (1 - i / pieces), target = 1 - dark(d + 0.5 * wide / pieces);
    context.strokeStyle = `rgba(0,0,0,${Math.max(0, 1 - target / left)})`;
    context.lineWidth = 2 * (d + wide / pieces);
    context.stroke(path);
    left = Math.min(left, target);
  }
  context.restore();
}

function paintHole(context, projection, hole) {
  const [x, y] = projection.at(hole.center[0], hole.center[1]), r = hole.radius * projection.scale;
  const edge = context.createRadialGradient(x, y, 0.9 * r, x, y, 1.12 * r);
  edge.addColorStop(0, "rgba(0,0,0,0.55)");
  edge.addColorStop(1, "rgba(0,0,0,0)");
  const inside = context.createRadialGradient(x, y, 0.55 * r, x, y, r);
  inside.addColorStop(0, "#090807");
  inside.addColorStop(1, "#211b18");
  for (const [style, reach] of [[edge, 1.12], [inside, 1]]) {
    context.fillStyle = style;
    context.beginPath();
    context.arc(x, y, reach * r, 0, 7);
    context.fill();
  }
}

const GLYPH = 96;  // [px] size of the square that a number is drawn into
const glyphs = new Map();
/** The share of the ivory disc's square that the digits cover, as bytes. */
function glyphOf(number) {
  if (!glyphs.has(number)) {
    const context = document.createElement("canvas").getContext("2d", {willReadFrequently: true});
    context.canvas.width = context.canvas.height = GLYPH;
    context.font = `600 ${number > 9 ? 62 : 74}px system-ui, sans-serif`;
    context.textAlign = "center";
    context.textBaseline = "middle";
    context.fillText(String(number), GLYPH / 2, GLYPH / 2 + 3, GLYPH * 0.8);
    if (number === 6 || number === 9)
      context.fillRect(GLYPH * 0.34, GLYPH * 0.85, GLYPH * 0.32, GLYPH * 0.06);
    glyphs.set(number, context.getImageData(0, 0, GLYPH, GLYPH).data.filter((_, i) => i % 4 === 3));
  }
  return glyphs.get(number);
}

/** Share of white light that a ball reflects at b, in the ball's frame. w: the size of a pixel [radii]. */
function albedo(style, b, w, out) {
  const inside = (x) => clamp(0.5 - x / w, 0, 1);
  const blend = (colour, t) => { for (let k = 0; k < 3; ++k) out[k] = mix(out[k], colour[k], t); };
  for (let k = 0; k < 3; ++k) out[k] = style.base[k];
  if (style.pattern === "stripe") {
    const band = inside(Math.abs(b[0]) - look.kStripe);
    for (let k = 0; k < 3; ++k) out[k] = mix(IVORY[k], style.base[k], band);
  } else if (style.pattern === "dots") {
    const [x, y, z] = b.map(Math.abs), upper = z >= x && z >= y;
    const away = upper ? Math.hypot(x, y) : x > y ? Math.hypot(y, z) : Math.hypot(x, z);
    blend(style.bright ? RED_DOT : PALE_DOT, inside(away - (upper && b[2] > 0 ? look.kLargeDot : look.kDot)));
  } else if (style.pattern === "halves") {
    blend(style.base.map((c) => mix(c, 1, look.kPaleHalf)), inside(b[0]));
  }
  if (style.number === 0) return 1;
  const spot = inside(Math.hypot(b[0], b[1]) - look.kSpot);
  if (spot === 0) return 1;
  blend(IVORY, spot);
  const across = b[1] / (2 * look.kSpot) + 0.5, down = (b[2] > 0 ? b[0] : -b[0]) / (2 * look.kSpot) + 0.5;
  const i = Math.floor(clamp(across, 0, 0.999) * GLYPH), j = Math.floor(clamp(down, 0, 0.999) * GLYPH);
  const ink = spot * glyphOf(style.number)[j * GLYPH + i] / 255;
  blend([look.kInk, look.kInk, look.kInk], ink);
  return 1 - 0.85 * ink;
}

/** A ball as a small picture, which is drawn again when the ball moves or turns. */
export class BallPicture {
  constructor(style) {
    this.style = {...style, base: fromScreen(style.color), bright: false};
    this.style.bright = brightness(this.style.base) > look.kBright;
    this.context = document.createElement("canvas").getContext("2d", {willReadFrequently: true});
    this.key = "";
  }

  /** Draws the ball at the pixel (x, y) with the radius r [px]; p: its centre [m], R: its radius [m]. */
  draw(context, projection, lamp, x, y, r, p, R, q) {
    const size = 2 * Math.ceil(r + 1) + 1;
    const left = Math.floor(x) - (size >> 1), upper = Math.floor(y) - (size >> 1);
    const key = [x, y, r, p[2], ...q].join();
    if (key !== this.key) {
      this.key = key;
      if (this.context.canvas.width !== size) {
        this.context.canvas.width = this.context.canvas.height = size;
        this.image = this.context.createImageData(size, size);
      }
      this.shade(projection, lamp, x - left, y - upper, r, p, R, q);
      this.context.putImageData(this.image, 0, 0);
    }
    context.drawImage(this.context.canvas, left, upper);
  }

  shade(projection, lamp, cx, cy, r, p, R, q) {
    const data = this.image.data, size = this.image.width, b = [0, 0, 0], base = [0, 0, 0];
    const fade = mix(0.06, 1, Math.exp(Math.min(p[2] / 0.035, 0)));
    const endless = lamp.endless, h = lamp.center[2];
    const half = endless ? [0.22 * h, 0.5 * h] : lamp.half, blur = 0.1 * h;
    for (let py = 0, at = 0; py < size; ++py) {
      for (let px = 0; px < size; ++px, at += 4) {
        const sx = (px + 0.5 - cx) / r, sy = (py + 0.5 - cy) / r, d = Math.hypot(sx, sy);
        const cover = clamp(0.5 + (1 - d) * r, 0, 1);
        data[at + 3] = 255 * cover;
        if (cover === 0) continue;
        const shrink = d > 1 ? 1 / d : 1;
        const nx = (projection.lying ? sy : sx) * shrink, ny = (projection.lying ? sx : -sy) * shrink;
        const nz = Math.sqrt(Math.max(0, 1 - nx * nx - ny * ny));
        // Into the ball's frame: the conjugate of q turns n.
        const tx = 2 * (q[3] * ny - q[2] * nz), ty = 2 * (q[1] * nz - q[3] * nx);
        const tz = 2 * (q[2] * nx - q[1] * ny);
        b[0] = nx + q[0] * tx + (q[3] * ty - q[2] * tz);
        b[1] = ny + q[0] * ty + (q[1] * tz - q[3] * tx);
        b[2] = nz + q[0] * tz + (q[2] * tx - q[1] * ty);
        const shine = albedo(this.style, b, 1 / (r * mix(1, Math.max(nz, 0.08), 0.6)), base);
        const x = p[0] + nx * R, y = p[1] + ny * R, z = p[2] + nz * R;
        const lx = endless ? 0 : lamp.center[0] - x, ly = endless ? 0 : lamp.center[1] - y;
        const lz = endless ? h : h - z;
        const inverse = 1 / Math.sqrt(lx * lx + ly * ly + lz * lz);
        const facing = Math.max(((nx * lx + ny * ly + nz * lz) * inverse + 0.6) / 1.6, 0);
        const under = 0.5 - 0.5 * nz, light = facing * facing * h * h * inverse * inverse + 0.2 * (1 - under);
        const mx = 2 * nz * nx, my = 2 * nz * ny, mz = 2 * nz * nz - 1, grazing = (1 - nz) * (1 - nz);
        const fresnel = 0.045 + 0.955 * grazing * grazing, sky = step(-0.25, 0.25, mz);
        let mirror = 0;
        if (mz > 0.02) {
          const ex = Math.abs(x + mx * (h - z) / mz - (endless ? x : lamp.center[0])) - half[0];
          const ey = Math.abs(y + my * (h - z) / mz - (endless ? y : lamp.center[1])) - half[1];
          mirror = 11 * shine * step(blur, -blur, ex) * step(blur, -blur, ey);
        }
        for (let k = 0; k < 3; ++k) {
          const body = base[k] * (light + CLOTH[k] * 0.75 * under * under);
          data[at + k] = 255 * toScreen(fade * (body + fresnel * (mirror + mix(CLOTH[k] * 0.35, 0.1, sky))));
        }
      }
    }
  }
}

/** A round shadow, whose darkness at d radii is profile(d), up to `reach` radii. */
export function shadowPicture(reach, profile) {
  const canvas = document.createElement("canvas"), size = canvas.width = canvas.height = 64;
  const context = canvas.getContext("2d");
  const image = context.createImageData(size, size);
  for (let i = 0; i < size * size; ++i) {
    const x = (i % size + 0.5) * 2 / size - 1, y = (Math.floor(i / size) + 0.5) * 2 / size - 1;
    image.data[4 * i + 3] = 255 * profile(reach * Math.hypot(x, y));
  }
  context.putImageData(image, 0, 0);
  return {canvas, reach};
}
