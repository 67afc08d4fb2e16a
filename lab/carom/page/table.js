// Tables that sort: {title, columns: [{title}], rows: [[value, ...], ...]}; what a row has beyond its columns is a note.
"use strict";

function sortedTable(spec) {
  const body = make("tbody", {svg: false}), heads = [];
  let by = -1, down = false;
  const cell = (value, i) => make("td", {class: typeof value === "number" ? "number" : null}, i < spec.columns.length ? shown(value, 4) : String(value));
  function fill() {
    const rows = spec.rows.slice();
    if (by >= 0) rows.sort((a, b) => compared(a[by], b[by]) * (down ? -1 : 1));
    body.replaceChildren(...rows.map((row) => make("tr", {}, ...row.map(cell))));
    heads.forEach((head, i) => head.setAttribute("aria-sort", i !== by ? "none" : down ? "descending" : "ascending"));
  }
  function compared(a, b) {
    const lacks = (x) => x === null || x === undefined;
    if (lacks(a) || lacks(b)) return Number(lacks(a)) - Number(lacks(b));
    return typeof a === "number" && typeof b === "number" ? a - b : String(a).localeCompare(String(b), "en", {numeric: true});
  }
  const isNumber = (i) => spec.rows.some((row) => typeof row[i] === "number");
  spec.columns.forEach((column, i) => heads.push(make("th", {scope: "col", class: isNumber(i) ? "number" : null}, make("button", {type: "button", onclick: () => {
    down = by === i && !down;
    by = i;
    fill();
  }}, column.title))));
  fill();
  return make("section", {class: "card"}, make("h2", {}, spec.title), make("div", {class: "scroll"},
    make("table", {}, make("thead", {}, make("tr", {}, ...heads)), body)));
}
