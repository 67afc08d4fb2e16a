// A table with balls in WebGL2, by the shaders of the rendered frames and translations of the painters of
// balls and cues. The table is drawn into two textures, colours with the share of cloth, and depths, whenever
// the camera moves; shadows, balls, cue and lines are painted over a copy of it.

import * as look from "../../../../render/include/carom/render/look.h";

const BATCH = 64, MOST_NEAR = 6, BALL = 4 * (4 + MOST_NEAR), MOST_HOLES = 128;
const CUSHION = 0.06;  // [m] from the frame to the nose
const ROOM = Math.sqrt(0.004), ATLAS = [192, 288];
/** In the order of the mesh's parts. */
const PARTS = ["CLOTH", "WOOD", "REST", "FLOOR", "WALL", "CLOTH HOLES", "WOOD HOLES", "CHALK", "SHADE",
  "SHADE HOLES"];
const WALL = PARTS.indexOf("WALL"), LAMP = 36;  // vertices: the last ones of the walls
/** Vertex shader, fragment shader and its choices. */
const PAINTERS = {shadow: ["shadow", "shadow"], beside: ["ball", "beside", "REACH 2.1"],
  ball: ["ball", "ball", "REACH 1.0"], cue: ["ribbon", "cue"], cueShadow: ["cue_shadow", "cue_shadow"],
  lines: ["ribbon", "line", "LINES"]};
export const PATTERNS = ["solid", "stripe", "dots", "halves"];
export const GHOST = 9;

const PREFIX = ["#version 300 es", "precision highp float;", "precision highp int;", "#define LOCATION(n)",
  `#define MAX_HOLES ${MOST_HOLES}`, `#define MAX_BALLS ${BATCH}`,
  ...PATTERNS.map((name, k) => `#define ${name.toUpperCase()} ${k}`)].join("\n");
/** The constants of look.h in GLSL. */
const LOOK = Object.entries(look).map(([name, value]) => Array.isArray(value)
  ? `const vec3 ${name} = vec3(${value});` : `const float ${name} = float(${value});`).join("\n");

export const add = (a, b, t = 1) => a.map((x, i) => x + t * b[i]);
export const dot = (a, b) => a.reduce((sum, x, i) => sum + x * b[i], 0);
export const cross = ([a, b, c], [x, y, z]) => [b * z - c * y, c * x - a * z, a * y - b * x];
export const unit = (a) => a.map((x) => x / Math.hypot(...a));

/** Forward, right and up of a camera {eye, target, up, fov [degrees]}. */
export function axesOf({eye, target, up}) {
  const forward = unit(add(target, eye, -1)), right = unit(cross(forward, up));
  return [forward, right, cross(right, forward)];
}

/** The uniform block View, as render/src/draw/view.cpp makes it. */
function viewOf(camera, {mesh: {origin}, shape}, width, height) {
  const {lamp, bounds, inner, wood_top: top, felt} = shape, shift = [...origin, 0];
  const eye = add(camera.eye, shift, -1), [forward, right, up] = axesOf(camera);
  const y = Math.tan(camera.fov * Math.PI / 360), x = y * width / height;
  const low = [...bounds.low, -0.3], high = [...bounds.high, top + 0.1];
  const inside = camera.eye.map((e, k) => e - Math.min(Math.max(e, low[k]), high[k]));
  const corner = camera.eye.map((e, k) => Math.max(Math.abs(e - low[k]), Math.abs(e - high[k])));
  const near = Math.max(0.02, 0.4 * Math.hypot(...inside));
  const far = Math.max(3 * Math.hypot(...corner) + 2, 2 * near);
  const a = (far + near) / (far - near), b = -2 * far * near / (far - near);
  const rows = [right.map((r) => r / x), up.map((u) => u / y), forward.map((f) => a * f), forward];
  const last = rows.map((row, k) => -dot(row, eye) + (k === 2 ? b : 0));
  return new Float32Array([...[0, 1, 2].flatMap((k) => rows.map((row) => row[k])), ...last,
    ...eye, Number(lamp.endless), ...forward, 0, ...right.map((r) => r * x), 0, ...up.map((u) => u * y), 0,
    ...add(lamp.center, shift, -1), 0, width, height, ...lamp.half, near, far, 0, 0,
    ...add(inner.low, origin, -1), ...add(inner.high, origin, -1), ...(felt ?? look.kCloth), 0]);
}

/** The nearest balls, which block light from this one: offsets and weights. */
function neighbours(balls, ball) {
  const near = balls.filter((other) => other !== ball)
    .map((other) => add(other.at, ball.at, -1)).map((to) => [Math.hypot(...to) / ball.R, to])
    .filter(([d]) => d < 2.5).sort(([a], [b]) => a - b).slice(0, MOST_NEAR);
  return near.flatMap(([d, to]) => [...to, Math.min(1, (2.5 - d) / 0.4)]);
}

/** Whether a ball is in front of the cue. */
function isBefore(center, {tip, butt}, eye) {
  const along = add(butt, tip, -1), from = add(center, tip, -1);
  const share = Math.min(Math.max(dot(from, along) / dot(along, along), 0), 1);
  return dot(add(from, along, -share), add(center, eye, -1)) < 0;
}

export class TableGl {
  /** `gl`: a context of WebGL2 without alpha and depth. `sources`: the shaders by file name. */
  constructor(gl, sources) {
    Object.assign(this, {gl, sources, canvas: gl.canvas, drawn: "", size: ""});
    this.vertices = gl.createBuffer();
    this.solid = this.attributes(this.vertices, 40, [3, 3, 4], 0);
    this.lines = gl.createBuffer();
    this.strips = this.attributes(this.lines, 44, [3, 3, 1, 4], 1);
    this.nothing = gl.createVertexArray();
    this.blocks = [52, BALL * BATCH].map((floats, k) => {
      const made = gl.createBuffer();
      gl.bindBuffer(gl.UNIFORM_BUFFER, made);
      gl.bufferData(gl.UNIFORM_BUFFER, 4 * floats, gl.DYNAMIC_DRAW);
      gl.bindBufferBase(gl.UNIFORM_BUFFER, k, made);
      return made;
    });
    this.glyphs = gl.createTexture();
    this.frames = [gl.createFramebuffer(), gl.createFramebuffer()];
    this.compile();
  }
  /** Numbers of these sizes, one after the other in a buffer. */
  attributes(buffer, stride, sizes, divisor) {
    const {gl} = this, made = gl.createVertexArray();
    gl.bindVertexArray(made);
    gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
    sizes.reduce((offset, size, at) => {
      gl.enableVertexAttribArray(at);
      gl.vertexAttribPointer(at, size, gl.FLOAT, false, stride, offset);
      gl.vertexAttribDivisor(at, divisor);
      return offset + 4 * size;
    }, 0);
    return made;
  }

  /** Starts all programs before it asks for any result, so that the browser compiles in parallel. */
  compile() {
    const {gl} = this, kinds = ["", " LESS_DETAIL"].flatMap((less) => PARTS.map((part) => part + less));
    const all = [...kinds.map((kind) => [kind, ["table", "table", kind]]), ...Object.entries(PAINTERS)]
      .map(([name, parts]) => [name, this.link(...parts)]);
    this.programs = Object.fromEntries(all.map(([name, program]) => {
      if (!gl.getProgramParameter(program, gl.LINK_STATUS)) {
        const logs = gl.getAttachedShaders(program).map((shader) => gl.getShaderInfoLog(shader));
        throw new Error(`${name}: ${gl.getProgramInfoLog(program)} ${logs.join(" ")}`);
      }
      ["View", "Balls"].forEach((block, k) => {
        const index = gl.getUniformBlockIndex(program, block);
        if (index !== gl.INVALID_INDEX) gl.uniformBlockBinding(program, index, k);
      });
      gl.useProgram(program);
      ["u_glyphs", "u_table", "u_depths"].forEach((texture, k) =>
        gl.uniform1i(gl.getUniformLocation(program, texture), k));
      return [name, program];
    }));
  }
  link(vertex, fragment, choices = "") {
    const {gl, sources} = this, program = gl.createProgram(), words = choices.split(" ").filter(Boolean);
    const defines = choices.startsWith("REACH") ? `#define ${choices}\n`
      : words.map((word) => `#define ${word}\n`).join("");
    const balls = ["ball", "beside", "shadow"].includes(fragment) ? sources["balls.glsl"] : "";
    const picture = vertex === "table" ? "" : sources["picture.glsl"];
    for (const [stage, name] of [["VERTEX", `${vertex}.vert`], ["FRAGMENT", `${fragment}.frag`]]) {
      const shader = gl.createShader(gl[`${stage}_SHADER`]);
      gl.shaderSource(shader, [PREFIX, `#define ${stage}`, defines + LOOK, sources["common.glsl"], picture,
        balls,
        sources[name]].join("\n"));
      gl.compileShader(shader);
      gl.attachShader(program, shader);
    }
    gl.linkProgram(program);
    return program;
  }

  /** Another table: the result of Scene.mesh(), and the shape of Scene.look(). */
  furnish(mesh, shape) {
    const {gl} = this;
    Object.assign(this, {mesh, shape, drawn: ""});
    gl.bindBuffer(gl.ARRAY_BUFFER, this.vertices);
    gl.bufferData(gl.ARRAY_BUFFER, mesh.vertices, gl.STATIC_DRAW);
    gl.activeTexture(gl.TEXTURE0);
    gl.bindTexture(gl.TEXTURE_2D, this.glyphs);
    gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.R8, ...ATLAS, 0, gl.RED, gl.UNSIGNED_BYTE, mesh.atlas);
    for (const key of ["MIN_FILTER", "MAG_FILTER"])
      gl.texParameteri(gl.TEXTURE_2D, gl[`TEXTURE_${key}`], gl.LINEAR);
    const holes = shape.holes.slice(0, MOST_HOLES);
    const numbers = holes.flatMap(({center, radius}) => [...add(center, mesh.origin, -1), radius, 0]);
    for (const [name, program] of Object.entries(this.programs)) {
      if (!name.includes("HOLES")) continue;
      gl.useProgram(program);
      if (holes.length > 0) gl.uniform4fv(gl.getUniformLocation(program, "u_holes[0]"), numbers);
      gl.uniform1i(gl.getUniformLocation(program, "u_hole_count"), holes.length);
    }
  }

  /** The buffers of the table: with several samples, and their mean with the depths. */
  resize(width, height, samples) {
    const {gl, canvas} = this, size = [width, height, samples].join();
    if (this.size === size) return;
    Object.assign(canvas, {width, height});
    Object.assign(this, {size, drawn: ""});
    this.stores?.forEach((store) => gl.deleteRenderbuffer(store));
    this.textures?.forEach((texture) => gl.deleteTexture(texture));
    const kinds = [["RGBA8", "COLOR_ATTACHMENT0"], ["DEPTH_COMPONENT24", "DEPTH_ATTACHMENT"]];
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.frames[0]);
    this.stores = kinds.map(([format, place]) => {
      const store = gl.createRenderbuffer();
      gl.bindRenderbuffer(gl.RENDERBUFFER, store);
      gl.renderbufferStorageMultisample(gl.RENDERBUFFER, samples, gl[format], width, height);
      gl.framebufferRenderbuffer(gl.FRAMEBUFFER, gl[place], gl.RENDERBUFFER, store);
      return store;
    });
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.frames[1]);
    this.textures = kinds.map(([format, place], k) => {
      const texture = gl.createTexture();
      gl.activeTexture(gl.TEXTURE1 + k);
      gl.bindTexture(gl.TEXTURE_2D, texture);
      gl.texStorage2D(gl.TEXTURE_2D, 1, gl[format], width, height);
      for (const key of ["MIN_FILTER", "MAG_FILTER"])
        gl.texParameteri(gl.TEXTURE_2D, gl[`TEXTURE_${key}`], gl.NEAREST);
      gl.framebufferTexture2D(gl.FRAMEBUFFER, gl[place], gl.TEXTURE_2D, texture, 0);
      return texture;
    });
    gl.activeTexture(gl.TEXTURE0);
  }
  copy(from, to, mask) {
    const {gl, canvas: {width, height}} = this;
    gl.bindFramebuffer(gl.READ_FRAMEBUFFER, from);
    gl.bindFramebuffer(gl.DRAW_FRAMEBUFFER, to);
    gl.blitFramebuffer(0, 0, width, height, 0, 0, width, height, mask, gl.NEAREST);
  }

  /** `low`: whether the eye is below the lamp, which would hide the table from a higher one. `less`: without
   * the finest noise. */
  drawTable(low, less) {
    const {gl, mesh: {ends}} = this;
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.frames[0]);
    gl.clearColor(ROOM, ROOM, ROOM, 0);
    gl.depthMask(true);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.enable(gl.DEPTH_TEST);
    gl.depthFunc(gl.LEQUAL);
    gl.disable(gl.BLEND);
    // The shading keeps the share of cloth.
    gl.blendFuncSeparate(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA, gl.ZERO, gl.ONE);
    gl.bindVertexArray(this.solid);
    PARTS.forEach((part, k) => {
      if (part === "CHALK") gl.depthMask(false);
      if (part === "SHADE") gl.enable(gl.BLEND);
      (part === "FLOOR" || part === "WALL" ? gl.enable : gl.disable).call(gl, gl.CULL_FACE);
      gl.useProgram(this.programs[less ? `${part} LESS_DETAIL` : part]);
      const first = k > 0 ? ends[k - 1] : 0, count = ends[k] - first - (k === WALL && !low ? LAMP : 0);
      if (count > 0) gl.drawArrays(gl.TRIANGLES, first, count);
    });
    gl.disable(gl.CULL_FACE);
    gl.disable(gl.DEPTH_TEST);
    gl.enable(gl.BLEND);
  }

  use(name, uniforms = {}) {
    const {gl} = this, program = this.programs[name];
    gl.useProgram(program);
    for (const [key, value] of Object.entries(uniforms)) {
      const at = gl.getUniformLocation(program, key);
      if (typeof value === "number") gl.uniform1f(at, value);
      else gl.uniform3fv(at, value);
    }
  }
  strips4(count = 1) { this.gl.drawArraysInstanced(this.gl.TRIANGLE_STRIP, 0, 4, count); }

  /** Paints balls by these programs, in batches. `others`: the balls that darken them. */
  paint(balls, others, ...names) {
    const {gl, mesh: {origin}} = this;
    for (let first = 0; first < balls.length; first += BATCH) {
      const some = balls.slice(first, first + BATCH), data = new Float32Array(BALL * BATCH);
      some.forEach((ball, k) => data.set([...add(ball.at, [...origin, 0], -1), ball.R, ...ball.turn,
        ...ball.color.map((x) => x * x), ball.number, ball.pattern, Number(ball.sunk), 0, 0,
        ...neighbours(others, ball)], k * BALL));
      gl.bindBuffer(gl.UNIFORM_BUFFER, this.blocks[1]);
      gl.bufferSubData(gl.UNIFORM_BUFFER, 0, data);
      for (const name of names) {
        this.use(name, name === "shadow" ? {} : {u_first: 0});
        this.strips4(some.length);
      }
    }
  }

  besideCushion(at, reach) {
    const {low, high} = this.shape.inner;
    return [0, 1].some((k) => at[k] < low[k] + reach || at[k] > high[k] - reach);
  }

  /** Draws balls {at, R, turn, color, pattern, number, sunk}, ghosts of balls, a cue {tip, butt} and lines
   * {from, to, width [px], colour} in m. `quick`: coarsely, for a moving camera without a graphics card. */
  draw(camera, {balls, ghosts = [], cue = null, lines = []}, width, height, quick = false) {
    const {gl} = this, shift = [...(this.mesh.origin), 0];
    this.resize(...[width, height].map((x) => Math.ceil(quick ? x / 2 : x)), quick ? 0 : 4);
    gl.viewport(0, 0, this.canvas.width, this.canvas.height);
    gl.bindBuffer(gl.UNIFORM_BUFFER, this.blocks[0]);
    const view = viewOf(camera, this, this.canvas.width, this.canvas.height), key = view.join();
    gl.bufferSubData(gl.UNIFORM_BUFFER, 0, view);
    if (key !== this.drawn) {
      this.drawTable(camera.eye[2] < this.shape.lamp.center[2], quick);
      this.copy(this.frames[0], this.frames[1], gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
      this.drawn = key;
    }
    this.copy(this.frames[1], null, gl.COLOR_BUFFER_BIT);
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    gl.bindVertexArray(this.nothing);
    // The farthest first, so that their edges blend over the balls behind them.
    const away = (ball) => Math.hypot(...add(ball.at, camera.eye, -1));
    const sorted = [...balls].sort((a, b) => away(b) - away(a));
    const ends = cue && {u_from: add(cue.tip, shift, -1), u_to: add(cue.butt, shift, -1), u_opacity: 1};
    this.paint(sorted, [], "shadow");
    this.paint(sorted.filter(({at, R}) => this.besideCushion(at, 3 * R + CUSHION)), [], "beside");
    if (cue) {
      this.use("cueShadow", ends);
      this.strips4();
    }
    if (lines.length > 0) {
      gl.bindVertexArray(this.strips);
      gl.bindBuffer(gl.ARRAY_BUFFER, this.lines);
      gl.bufferData(gl.ARRAY_BUFFER, new Float32Array(lines.flatMap(({from, to, width: wide, colour}) =>
        [...add(from, shift, -1), ...add(to, shift, -1), wide / (quick ? 4 : 2), ...colour])),
          gl.STREAM_DRAW);
      this.use("lines");
      this.strips4(lines.length);
      gl.bindVertexArray(this.nothing);
    }
    // As in the frames, the cue lies between the balls behind it and those in front of it.
    const front = cue ? sorted.findIndex(({at}) => isBefore(at, cue, camera.eye)) : -1;
    const split = front < 0 ? sorted.length : front;
    this.paint(sorted.slice(0, split), sorted, "ball");
    if (cue) {
      this.use("cue", ends);
      this.strips4();
    }
    this.paint(sorted.slice(split), sorted, "ball");
    this.paint(ghosts, [], "ball");
  }
}
