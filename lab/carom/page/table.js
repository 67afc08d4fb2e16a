// Sortable tables: {title, columns: [{title}], rows: [[value, ...], ...]}; extra values are notes.

import {make, shown} from "../../../tools/carom/page/dom.js";

export function sortedTable(spec) {
  const body = make("tbody", {svg: false}), heads = [];
  let by = -1, down = false;
  const cell = (value, i) => make("td", {class: typeof value === "number" ? "number" : null},
    i < spec.columns.length ? shown(value, 4) : String(value));
  function fill() {
    const rows = spec.rows.slice();
    if (by >= 0) rows.sort((a, b) => compared(a[by], b[by]) * (down ? -1 : 1));
    body.replaceChildren(...rows.map((row) => make("tr", {}, ...row.map(cell))));
    const sorted = down ? "descending" : "ascending";
    heads.forEach((head, i) => head.setAttribute("aria-sort", i === by ? sorted : "none"));
  }
  function compared(a, b) {
    const lacks = (x) => x === null || x === undefined;
    if (lacks(a) || lacks(b)) return Number(lacks(a)) - Number(lacks(b));
    if (typeof a === "number" && typeof b === "number") return a - b;
    return String(a).localeCompare(String(b), "en", {numeric: true});
  }
  const isNumber = (i) => spec.rows.some((row) => typeof row[i] === "number");
  spec.columns.forEach((column, i) => {
    const onclick = () => {
      down = by === i && !down;
      by = i;
      fill();
    };
    heads.push(make("th", {scope: "col", class: isNumber(i) ? "number" : null},
      make("button", {type: "button", onclick}, column.title)));
  });
  fill();
  return make("section", {class: "card"}, make("h2", {}, spec.title), make("div", {class: "scroll"},
    make("table", {}, make("thead", {}, make("tr", {}, ...heads)), body)));
}
