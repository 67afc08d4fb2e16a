// The list of balls beside a shot: state, speed and spin of each at an instant.

import {cssColour, make} from "./dom.js";
import {words} from "./event_words.js";
import {flies, isGone, radiusOf, size, stateAt} from "./motion.js";

export class BallList {
  /** `second`: the record of another shot, to which distances are shown, or null. `pick(ball)`: called by
   * a click on a ball. */
  constructor(record, second, styles, pick) {
    Object.assign(this, {record, second, high: record.tracks.some(flies)});
    const columns = ["ball", "state", "m/s", "turns/s", ...(this.high ? ["mm high"] : []),
      ...(second ? ["mm apart"] : [])];
    this.rows = record.tracks.map((track, i) => {
      const swatch = make("i", {class: styles[i].pattern});
      swatch.style.setProperty("--ball", cssColour(styles[i].color));
      const cells =
        columns.slice(1).map((name) => make("td", {class: name === "state" ? null : "number"}));
      const row = make("tr", {tabindex: "0", onclick: () => pick(i),
        onkeydown: (event) => { if (event.key === "Enter") pick(i); }},
      make("th", {scope: "row"}, swatch, track.id), ...cells);
      return {row, cells};
    });
    const heads = make("tr", {}, ...columns.map((name) => make("th", {scope: "col"}, name)));
    this.element = make("section", {class: "card"}, make("h2", {}, "Balls"), make("div", {class: "scroll"},
      make("table", {}, make("thead", {}, heads), make("tbody", {}, ...this.rows.map((r) => r.row)))));
  }

  /** `states`: of all balls at the instant t. */
  show(states, t, marked) {
    for (const s of states) {
      const {row, cells} = this.rows[s.i], texts = this.texts(s, t), gone = isGone(s.state);
      cells.forEach((cell, k) => { if (cell.textContent !== texts[k]) cell.textContent = texts[k]; });
      row.className = [gone ? "gone" : "", s.i === marked ? "marked" : ""].join(" ");
    }
  }

  texts(s, t) {
    const {record, second} = this, other = second && second.tracks.findIndex((track) => track.id === s.id);
    const place = s.pocket >= 0 ? `in ${record.table.pockets[s.pocket].id}` : words(s.state);
    const apart = () => 1000 * Math.hypot(...stateAt(second, other, t).r.map((x, k) => x - s.r[k]));
    const texts = [place, size(s.v).toFixed(2), (size(s.w) / (2 * Math.PI)).toFixed(1)];
    if (this.high) texts.push((1000 * Math.max(0, s.r[2] - radiusOf(record, s.i))).toFixed(0));
    if (second) texts.push(other < 0 ? "" : apart().toFixed(1));
    return isGone(s.state) ? texts.fill("", 1) : texts;
  }
}
