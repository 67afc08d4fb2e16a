// The cards beside the table: scenes to open, every value of table, balls and physics, printing.

import {button, make, optionsOf, select} from "../../page/dom.js";
import {printShots} from "./paper.js";
import {lookFor, sectionOf, titleOf} from "./scene_text.js";
import {begin, change} from "./shots.js";

/** A dialog with a title, and a bar of buttons at its end that closes it. */
export function dialog(title, parts, ...buttons) {
  const element = make("dialog", {"aria-label": title}, make("h2", {}, title), ...parts, make("div",
    {class: "bar"}, ...buttons, make("span", {class: "room"}), button("Close", () => element.close())));
  document.body.append(element);
  return element;
}

/** The value of an input's text. @throws Error with a sentence */
export function valueOf(key, {type, enum: names}, text) {
  if (names) return text;
  if (type === "array") {
    try {
      return JSON.parse(text);
    } catch {
      throw new Error(`${key}: expected a list of numbers, such as [0.01, 0.1, 1.1]`);
    }
  }
  const x = Number(text.replace(",", "."));
  if (text.trim() === "" || Number.isNaN(x)) throw new Error(`${key}: expected a number`);
  return x;
}

/** A dialog with every key of some sections: {section: {key: {type, enum, description}}}.
 * @returns a function that opens it */
function settingsDialog(state, keys) {
  const wrong = make("p", {class: "error", role: "alert"}), form = make("div", {class: "settings"});
  const row = (section, key, about, value = "") => {
    const id = `key-${section}-${key}`, before = value.replace(/^"(.*)"$/, "$1");
    const input = about.enum
      ? make("select", {id}, ...optionsOf(["", ...about.enum].map((x) => [x, x || "default"])))
      : make("input", {id, placeholder: "default", autocomplete: "off",
        inputmode: about.type === "array" ? "text" : "decimal"});
    input.value = before;
    input.disabled = state.locked(section);
    input.onchange = () => {
      wrong.textContent = "";
      try {
        const changes = {[`${section}.${key}`]: valueOf(key, about, input.value)};
        state.scene.with(changes).free();
        if (!change(state, changes)) throw new Error(state.said);
        fill();
      } catch (error) {
        wrong.textContent = error.reason || error.message;
        input.value = before;
      }
    };
    return make("div", {class: "key"}, make("label", {for: id}, key), input,
      make("small", {}, about.description.replace(/; default: .*$/, "")));
  };
  const fill = () => {
    const toml = state.scene.everything, focused = document.activeElement?.id;
    form.replaceChildren(...Object.entries(keys).map(([section, list]) => {
      const values = sectionOf(toml, section);
      return make("fieldset", {class: "section"}, make("legend", {}, section),
        ...Object.entries(list).map(([key, about]) => row(section, key, about, values[key])));
    }));
    if (focused) document.getElementById(focused)?.focus();
  };
  const element = dialog("Table, balls and physics", [wrong, form]);
  return () => {
    wrong.textContent = "";
    fill();
    element.showModal();
  };
}

/** Begins with a scene, and shows its "Look for". */
export function openScene(state, toml, how) {
  begin(state, toml, how);
  const look = lookFor(toml);
  if (look && !state.fixed) state.say(`Look for: ${look}`);
}

/** The controls of the card. */
export function extras(state) {
  const {page} = state;
  const scenes = page.scenes.map(({name, text}) => [name, titleOf(text)]);
  scenes.sort((a, b) => a[1] < b[1] ? -1 : 1);
  const open = select("Open a scene", [["", "Open …"], ...scenes], "", (name) => {
    open.value = "";
    const chosen = page.scenes.find((scene) => scene.name === name);
    if (chosen) openScene(state, chosen.text);
  }, {class: "open"});
  printShots(state);
  return [state.fixed ? null : open, button("All values …", settingsDialog(state, page.keys)),
    button("Print", () => print())];
}
