// The scene as a file and as an address, the hash of the shot, and other tools of the page.

import {button, make} from "../../page/dom.js";
import {dialog, extras} from "./extras.js";
import {rangeOf} from "./scene_text.js";
import {LONGEST_FRAGMENT, fragmentOf, sceneInFragment} from "./share.js";
import {LIMITS, begin} from "./shots.js";

async function copy(state, text) {
  try {
    await navigator.clipboard.writeText(text);
    state.say("Copied.");
  } catch {
    state.say("This browser does not allow copying; select the text and copy it.");
  }
}

/** Puts the scene into the page's address, and shows that in the input `address`. */
export async function share(state, address) {
  const fragment = await fragmentOf(state.scene.toml, state.shot.hash);
  if (fragment.length > LONGEST_FRAGMENT)
    return state.say("This scene is too long for an address; copy its file.", true);
  history.replaceState(null, "", fragment);
  address.value = location.href;
  address.hidden = false;
  address.select();
  await copy(state, location.href);
  document.body.dataset.shared = fragment;
}

/** Shows the scene in the page's address, if there is one. @returns a message about it, or null */
export async function openAddress(state) {
  let found = null;
  try {
    found = await sceneInFragment(location.hash);
  } catch (error) {
    return error.message;
  }
  if (found === null) return null;
  if (state.fixed) return "This page shows only its own scene, not the one in the address.";
  try {
    if (!begin(state, found.toml, {remember: false}) && state.shot)
      return "The scene in the address was not opened.";
  } catch (error) {
    return `The scene in the address is not valid: ${error.message}`;
  }
  if (!state.shot) return "The scene in the address cannot be played.";
  const {hash} = state.shot;
  return hash === found.hash ? `The same bits as when this address was made: ${hash}.`
    : `Other bits than when this address was made (${found.hash}): another version of carom made it.`;
}

/** A copy of the page that begins with this shot, to send to somebody. `whole`: the page before its script
 * ran. */
function download(state, whole) {
  const page = {...state.page, scene: state.scene.toml, lead: "a shot to watch"};
  const json = JSON.stringify(page).replaceAll("<", "\\u003c");
  const html = whole.replace(/(<script [^>]*id="page">)[^<]*/, (_, head) => head + json);
  const url = URL.createObjectURL(new Blob(["<!doctype html>\n", html], {type: "text/html"}));
  make("a", {href: url, download: "shot.html"}).click();
  setTimeout(() => URL.revokeObjectURL(url), 1000);
  state.say("Saved shot.html, this page with this shot; send it to somebody.");
  return html;
}

/** Selects the line with a mistake. */
function showLine(area, line) {
  area.focus();
  area.setSelectionRange(...rangeOf(area.value, line));
  area.scrollTop = Math.max(0, (line - 4) * area.scrollHeight / area.value.split("\n").length);
}

/** A dialog with the scene's file. @returns a function that opens it */
function fileDialog(state) {
  const {carom} = state, wrong = make("p", {class: "error", role: "alert"});
  const area = make("textarea", {spellcheck: "false", "aria-label": "Scene file", rows: "18"});
  const use = () => {
    wrong.textContent = "";
    try {
      const candidate = carom.Scene.parse(area.value, "scene");
      carom.simulate(candidate, LIMITS).free();
      candidate.free();
    } catch (error) {
      const {line} = error, reason = error.reason || error.message;
      wrong.textContent = line > 0 ? `Line ${line}: ${reason}` : reason;
      if (line > 0) showLine(area, line);
      return;
    }
    element.close();
    begin(state, area.value);
  };
  const file = make("input", {type: "file", accept: ".toml,text/plain",
    onchange: async () => { area.value = await file.files[0].text(); }});
  const element = dialog("Scene file", [area, wrong],
    button("Use this scene", use, {disabled: state.fixed ? "" : null}),
    button("Copy", () => copy(state, area.value)),
    button("Every value", () => { area.value = state.scene.everything; }),
    make("label", {class: "file"}, "Open … ", file));
  return () => {
    area.value = state.scene.toml;
    wrong.textContent = "";
    element.showModal();
  };
}

/** `whole`: the text of the page if it was opened from a file, which has no address to share; else "". */
export function shareCard(state, whole) {
  const address =
    make("input", {readonly: "", "aria-label": "Address of this shot", class: "address", hidden: ""});
  const hash = make("code", {title: "Hash of all bits of this shot"});
  state.on("stroke", () => { document.body.dataset.hash = hash.textContent = state.shot.hash; });
  const card = make("section", {class: "card"}, make("div", {class: "bar"},
    whole ? button("Download this shot", () => download(state, whole))
      : button("Share by address", () => share(state, address)),
    button("Scene file …", fileDialog(state)), ...extras(state)), address,
  make("p", {class: "hash"}, "Hash ", hash));
  return {card, address, download: () => download(state, whole)};
}
