// What the page offers beside the table: scenes to open, every value of table, balls and physics, printing.
"use strict";

/** The values in one section of a scene file that carom wrote: {key: text}. */
function sectionOf(toml, section) {
  const values = {};
  let inside = false;
  for (const line of toml.split("\n")) {
    if (line.startsWith("[")) inside = line.trim() === `[${section}]`;
    const [, key, value] = (inside && /^([\w.]+)\s*=\s*(.*)$/.exec(line)) || [];
    if (key !== undefined) values[key] = value;
  }
  return values;
}

/** A dialog with every key of some sections. `keys`: {section: {key: {type, enum, description}}}. `play`: as
 * for playExtras. @returns a function that opens it */
function settingsDialog(keys, play) {
  const wrong = make("p", {class: "error", role: "alert"}), form = make("div", {class: "settings"});
  /** What an input says, or a sentence why it says nothing. */
  const read = (key, {type, enum: names}, text) => {
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
  };
  const row = (section, key, about, value = "") => {
    const id = `key-${section}-${key}`, before = value.replace(/^"(.*)"$/, "$1");
    const input = about.enum
      ? make("select", {id}, ...["", ...about.enum].map((x) => make("option", {value: x}, x || "default")))
      : make("input", {id, placeholder: "default", autocomplete: "off",
        inputmode: about.type === "array" ? "text" : "decimal"});
    input.value = before;
    input.disabled = play.locked(section);
    input.onchange = () => {
      wrong.textContent = "";
      try {
        const changes = {[`${section}.${key}`]: read(key, about, input.value)};
        play.scene().with(changes).free();
        if (!play.change(changes)) throw new Error(document.querySelector(".says").textContent);
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
    const toml = play.scene().everything, focused = document.activeElement?.id;
    form.replaceChildren(...Object.entries(keys).map(([section, list]) => {
      const values = sectionOf(toml, section);
      return make("fieldset", {class: "section"}, make("legend", {}, section),
        ...Object.entries(list).map(([key, about]) => row(section, key, about, values[key])));
    }));
    if (focused) document.getElementById(focused)?.focus();
  };
  const title = "Table, balls and physics";
  const dialog = make("dialog", {"aria-label": title}, make("h2", {}, title), wrong, form,
    make("div", {class: "bar"}, make("span", {class: "room"}),
      make("button", {type: "button", onclick: () => dialog.close()}, "Close")));
  document.body.append(dialog);
  return () => {
    wrong.textContent = "";
    fill();
    dialog.showModal();
  };
}

/** The controls. `play`: {scene(), shot(), change(changes), begin(toml), locked(key)} */
function playExtras(page, play) {
  const open = make("select", {class: "open", "aria-label": "Open a scene", onchange: () => {
    const chosen = page.scenes.find(({name}) => name === open.value);
    open.value = "";
    if (chosen) play.begin(chosen.text);
  }}, make("option", {value: ""}, "Open …"),
  ...page.scenes.map(({name, title}) => make("option", {value: name}, title)));
  const settings = settingsDialog(page.keys, play);
  printsShots(play);
  const button = (text, onclick) => make("button", {type: "button", onclick}, text);
  return [page.lock.length > 0 ? null : open, button("All values …", settings),
    button("Print", () => print())];
}
