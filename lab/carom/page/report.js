// A report: sentences, charts and tables.
"use strict";

{
  const page = pageData("page");
  pageFrame(page,
    page.notes.length ? make("section", {class: "card"}, ...page.notes.map((note) => make("p", {}, note))) : null,
    ...page.charts.map((spec) => chart({...spec, height: 360}).element), ...page.tables.map(sortedTable));
  document.body.dataset.ready = "true";
}
