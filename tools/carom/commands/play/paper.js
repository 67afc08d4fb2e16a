// The shot on white paper, for printing.

import {brightness, cssColour, make} from "../../page/dom.js";
import {isGone, pathPiece, radiusOf, stateAt} from "../../page/motion.js";
import {withUnit} from "./words.js";

/** An SVG of the table, the balls at the start, their paths and final positions. The table lies: its y
 * points to the right, its x down. */
function drawnOnPaper(record, shape, styles, cue) {
  const {low, high} = shape.bounds, at = (x, y) => [y - low[1], x - low[0]];
  const text = (x, y) => at(x, y).map((v) => v.toFixed(4)).join(" ");
  const outline = (loop) => {
    const corners = [];
    for (let i = 0; i < loop.length; i += 2) corners.push(text(loop[i], loop[i + 1]));
    return `M${corners.join("L")}Z`;
  };
  const filled = (loops, fill) =>
    make("path", {d: loops.map(outline).join(""), fill, stroke: "#000", "stroke-width": 0.003});
  const circle = (x, y, r, attributes) => {
    const [cx, cy] = at(x, y);
    return make("circle", {cx, cy, r, stroke: "#000", "stroke-width": 0.002, ...attributes});
  };
  const ink = (i) => brightness(styles[i].color) > 0.75 ? "#555" : cssColour(styles[i].color);
  const parts = [filled(shape.wood.flatMap((board) => board.loops), "#f4f2ee"),
    filled(shape.cushion, "#dcd8cf"), filled(shape.inlay, "#000"),
    ...shape.holes.map(({center, radius}) => circle(center[0], center[1], radius, {fill: "#666"}))];
  record.tracks.forEach((track, i) => {
    const pieces = track.segments.map((_, k) => {
      const piece = pathPiece(record, track, k, Infinity)?.map((place) => text(...place));
      return piece ? `M${piece[0]}Q${piece[1]} ${piece[2]}` : "";
    });
    parts.push(make("path", {d: pieces.join(""), fill: "none", stroke: ink(i), "stroke-width": 0.006}));
    const end = stateAt(record, i, record.duration), R = radiusOf(record, i);
    if (!isGone(end.state) && track.segments.length > 1)
      parts.push(circle(end.r[0], end.r[1], R,
        {fill: "none", stroke: ink(i), "stroke-width": 0.004, "stroke-dasharray": "0.012 0.008"}));
  });
  record.tracks.forEach((track, i) => {
    const [x, y] = stateAt(record, i, 0).r, R = radiusOf(record, i), {color, pattern, number} = styles[i];
    const [cx, cy] = at(x, y), striped = pattern === "stripe", ring = 0.3 * R;
    parts.push(striped
      ? circle(x, y, R - ring / 2, {fill: "#fff", stroke: cssColour(color), "stroke-width": ring})
      : circle(x, y, R, {fill: cssColour(color)}));
    if (number > 0)
      parts.push(make("text", {x: cx, y: cy + 0.36 * R, "text-anchor": "middle",
        class: striped || brightness(color) > 0.6 ? "on-paper" : "on-paper on-dark"}, track.id));
  });
  const struck = cue === null ? -1 : record.tracks.findIndex((track) => track.id === cue.ball);
  if (struck >= 0) {
    const [x, y] = stateAt(record, struck, 0).r, R = radiusOf(record, struck);
    const angle = cue.aim_deg * Math.PI / 180;
    const back = (s) => text(x - s * Math.cos(angle), y - s * Math.sin(angle));
    parts.push(make("path", {d: `M${back(1.5 * R)}L${back(0.6)}`, stroke: "#000", "stroke-width": 0.009}));
  }
  const [wide, tall] = [high[1] - low[1], high[0] - low[0]];
  return make("svg", {viewBox: `0 0 ${wide.toFixed(4)} ${tall.toFixed(4)}`}, ...parts);
}

/** Draws the shot on paper when the page is printed. */
export function printShots(state) {
  const paper = make("section", {class: "paper", "aria-hidden": "true"});
  document.body.append(paper);
  window.addEventListener("beforeprint", () => {
    const {scene, shot} = state, {cue} = scene, {shape, styles} = scene.look();
    const offset = (x, one, other) => `${Math.abs(x).toFixed(2)} R ${x < 0 ? other : one}`;
    const speed = cue && withUnit("metric", "speed", cue.speed);
    const stroke = cue === null ? [] : [`Ball ${cue.ball} is struck at ${speed}`,
      `aim ${cue.aim_deg.toFixed(2)}°`, `tip ${offset(cue.side, "left", "right")} and ` +
      `${offset(cue.height, "above", "below")} the centre`, `cue raised by ${cue.elevation_deg.toFixed(1)}°`];
    const fell = shot.outcome.balls.filter(({fell}) => fell >= 0).map(({id, pocket}) => `${id} in ${pocket}`);
    paper.replaceChildren(drawnOnPaper(shot.motion, shape, styles, cue),
      make("p", {}, `${stroke.concat(fell).join(", ")}. ${shot.duration.toFixed(2)} s, hash ${shot.hash}.`));
  });
}
