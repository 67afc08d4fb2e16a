// The charts of a shot: speeds, energies, heights, and the cost of each frame.

import {Chart} from "./chart.js";
import {brightness, cssColour, prefers} from "./dom.js";
import {energiesAt, flies, isGone, radiusOf, size, stateAt} from "./motion.js";

/** The times of a record's curves: even ones, and both sides of every event. */
function timesOf(record) {
  const grid = [...Array(241).keys()].map((k) => record.duration * k / 240);
  const edges = record.events.flatMap((e) => [Math.max(0, e.time - 1e-9), e.time]);
  return [...new Set(grid.concat(edges))].sort((a, b) => a - b);
}

/** A colour that shows on the page's background. */
function inkOf(color) {
  const bright = brightness(color), dark = prefers("color-scheme: dark");
  return !dark && bright > 0.8 ? "#a89f8a" : dark && bright < 0.2 ? "#8d8d96" : cssColour(color);
}

/** `margin`: a plot of the program or null. `pick(t)`: called by a click. */
export function shotCharts(record, styles, margin, pick) {
  const times = timesOf(record), sums = times.map((t) => energiesAt(record, t));
  const seconds = {title: "s", low: 0, high: Math.max(record.duration, 1e-3), unit: "s"};
  const hits = record.events.filter((e) => e.type.startsWith("ball_")).map((e) => e.time);
  const ticks = [{name: "contacts", at: hits}];
  const energy = (name, key) => ({name, line: true, points: times.map((t, k) => [t, sums[k][key]])});
  const ofBall = (i, value) => ({name: record.tracks[i].id, stroke: inkOf(styles[i].color), line: true,
    points: times.map((t) => [t, stateAt(record, i, t)]).filter(([, s]) => !isGone(s.state))
      .map(([t, s]) => [t, value(s)])});
  const moving = [...record.tracks.keys()]
    .filter((i) => record.tracks[i].segments.some((s) => size(s.v) > 0));
  const high = moving.filter((i) => flies(record.tracks[i]));
  const ofTime = (title, height, unit, series, more = {}) =>
    new Chart({title, height, x: seconds, y: {title: unit, low: 0}, series, ...more}, pick);
  return [
    ofTime("Speed of every ball", 190, "m/s", moving.map((i) => ofBall(i, (s) => size(s.v))), {ticks}),
    ofTime("Energy", 190, "J", [energy("motion", "moving"), energy("rotation", "turning"),
      ...(high.length > 0 ? [energy("height", "raised")] : [])], {ticks}),
    high.length > 0 && ofTime("Height above the cloth", 150, "mm",
      high.map((i) => ofBall(i, (s) => 1000 * Math.max(0, s.r[2] - radiusOf(record, i))))),
    margin && new Chart({...margin, x: {...margin.x, ...seconds, title: margin.x.title}, height: 230}, pick),
  ].filter((x) => x);
}
