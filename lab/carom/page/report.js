// A report: sentences, charts and tables.

import {Chart} from "../../../tools/carom/page/chart.js";
import {make, pageData, pageFrame} from "../../../tools/carom/page/dom.js";
import {sortedTable} from "./table.js";

const page = pageData("page");
const notes = page.notes.map((note) => make("p", {}, note));
pageFrame(page, notes.length ? make("section", {class: "card"}, ...notes) : null,
  ...page.charts.map((spec) => new Chart({...spec, height: 360}).element), ...page.tables.map(sortedTable));
document.body.dataset.ready = "true";
