// The table, the balls and the units.

import {make, select} from "../../page/dom.js";
import {placeFields} from "./place.js";
import {begin, change, setOrDrop} from "./shots.js";
import {CLOTHS, gamesOf, infoOf, startOf, tableOf} from "./tables.js";

const MATERIAL = [["mu_s", "sliding friction", 0.01], ["mu_r", "rolling friction", 0.001],
  ["mu_b", "ball-ball friction", 0.01], ["e_b", "ball-ball restitution", 0.01],
  ["e_c", "cushion restitution", 0.01], ["f_c", "cushion friction", 0.01], ["mass", "mass [kg]", 0.001],
  ["radius", "radius [m]", 0.0001]];

const field = (label, input) => make("label", {class: "field"}, make("span", {}, label), input);

/** The numbers of all balls. */
function materialFields(state) {
  const disabled = state.locked("balls") ? "" : null;
  return MATERIAL.map(([key, label, step]) => {
    const input = make("input", {type: "number", min: 0, step, disabled,
      onchange: () => change(state, {[`balls.${key}`]: Number(input.value)})});
    state.on("stroke", () => {
      if (document.activeElement !== input) input.value = String(state.scene.describe().material[key]);
    });
    return field(label, input);
  });
}

export function setupCard(state) {
  const {page, carom} = state;
  const tables = page.tables.map((name) => [name, name.replaceAll("_", " ")]);
  const table = select("Table", tables, "nine_foot", (name) => begin(state, startOf(carom, {}, name)));
  const cloth = select("Cloth", CLOTHS, "", (name) => setOrDrop(state, "table.cloth", name));
  const rack = select("Rack", [["", "choose …"], ...gamesOf(state)], "", (name) => {
    rack.value = "";
    const info = infoOf(state, name);
    if (name) begin(state, startOf(carom, info, tableOf(info, state.scene.table.preset || "nine_foot")));
  });
  const models = page.keys.physics.cushion.enum.map((name) => [name, name]);
  const cushions = select("Cushion model", [["", "as the balls"], ...models], "",
    (name) => setOrDrop(state, "physics.cushion", name));
  const units = select("Units", [["metric", "metric"], ["inch", "inches, mph"]], state.units, (x) => {
    state.units = x;
    state.tell("stroke");
    state.tell("lists");
  });
  const paths = select("Predicted paths",
    [["all", "all paths"], ["cue", "cue ball's path"], ["off", "no paths"]], state.paths, (x) => {
      state.paths = x;
      state.clock.refresh();
      state.tell("lists");
    });
  const numbers = make("input", {type: "checkbox", onchange: () => {
    state.numbered = state.view.numbered = numbers.checked;
    state.clock.refresh();
  }});
  table.disabled = rack.disabled = state.fixed || state.locked("table");
  cloth.disabled = cushions.disabled = state.locked("table");
  state.on("table", () => {
    table.value = state.scene.table.preset;
    cloth.value = state.scene.table.cloth;
  });
  return make("details", {class: "card setup"}, make("summary", {}, "Table, balls, units"),
    field("Table", table), field("Rack", rack), field("Cloth", cloth), field("Cushions", cushions),
    field("Units", units), field("Predicted paths", paths),
    make("label", {}, numbers, " number the diamonds"), placeFields(state),
    make("fieldset", {class: "materials"}, make("legend", {}, "Balls"), ...materialFields(state)));
}
