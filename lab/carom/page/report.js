// A report: sentences, charts and tables.
"use strict";

{
  const page = pageData("page");
  const notes = page.notes.map((note) => make("p", {}, note));
  pageFrame(page, notes.length ? make("section", {class: "card"}, ...notes) : null,
    ...page.charts.map((spec) => chart({...spec, height: 360}).element), ...page.tables.map(sortedTable));
  document.body.dataset.ready = "true";
}
