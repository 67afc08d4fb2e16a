// The page of `carom play`: an interactive table. Every change is a whole shot, simulated here; the mode
// decides which part of it the player sees while aiming. At time 0 the player aims; later the shot is played
// back.

import * as carom from "../../../../web/npm/core.js";
import {button, make, pageData, prefers} from "../../page/dom.js";
import {eventsCard} from "./events_card.js";
import {openScene} from "./extras.js";
import {endReplay, judge, newGame} from "./game.js";
import {gameCard, gameDialog} from "./game_card.js";
import {keepMatch, resumeMatch} from "./match.js";
import {goOn, hint, newTable} from "./opponent.js";
import {followKeys} from "./pointer.js";
import {scoreBar} from "./score.js";
import {setupCard} from "./setup_card.js";
import {wasmOfPage} from "./share.js";
import {openAddress, share, shareCard} from "./share_card.js";
import {begin, change, keep} from "./shots.js";
import {sightButton} from "./sight.js";
import {followSounds} from "./sound.js";
import {State} from "./state.js";
import {strokeCard} from "./stroke.js";
import {tableCard} from "./table_card.js";
import {infoOf, startOf} from "./tables.js";
import {Thinker} from "./thinker.js";
import {named, verdictWords} from "./words.js";

const KEYS = "Keys: ← → aim (Shift: 1°, Alt: 0.01°), ↑ ↓ power, W A S D tip, Space shoot, Esc back, " +
  "Ctrl+Z undo, 0 the whole table, V behind the cue ball. The wheel or two fingers " +
  "zoom; Shift and the wheel aim finely.";
/** The original page, to send it with another scene. */
const WHOLE = location.protocol === "file:" ? document.documentElement.outerHTML : "";

/** Loads carom. @returns the bytes of carom.wasm, or null if this browser cannot run it */
async function load() {
  const loading = make("p", {class: "loading", role: "status"}, "Loading carom …");
  document.body.append(loading);
  try {
    const wasm = await wasmOfPage(pageData("wasm"));
    await carom.start(wasm);
    loading.remove();
    return wasm;
  } catch (error) {
    loading.textContent = `This browser cannot run carom: ${error.message}`;
    return null;
  }
}

/** Judges a shot that has ended, and reports it. */
function conclude(state) {
  judge(state);
  const {shot, verdict} = state, fell = shot.outcome.balls.filter((b) => b.fell >= 0);
  const ids = fell.sort((a, b) => a.fell - b.fell).map((b) => named(b.id, state.scene.table.preset));
  const gone = ids.length > 0 ? ` In pockets: ${ids.join(", ")}.` : "";
  if (state.game && !verdict) return;
  const judged = verdict ? ` ${verdictWords(verdict, infoOf(state, state.game.state.game))}` : "";
  const warned = shot.warnings.map((text) => ` Warning: ${text}.`).join("");
  state.say(`At rest after ${shot.duration.toFixed(2)} s.${gone}${judged}${warned}`);
}

/** A button that is on or off. */
function toggle(text, name, change) {
  const box = button(text, () => {
    const on = box.getAttribute("aria-pressed") !== "true";
    box.setAttribute("aria-pressed", String(on));
    change(on);
  }, {"aria-pressed": "false", "aria-label": name, title: name});
  return box;
}

/** The two modes of the page. */
function modes(state) {
  const names = [["practise", "Practise"], ["play", "Play"]];
  const boxes = names.map(([mode, text]) => button(text, () => {
    state.mode = mode;
    state.tell("mode");
    state.clock.refresh();
  }));
  // In a match, every shot counts, and no path is shown before.
  const show = () => boxes.forEach((box, k) => {
    box.setAttribute("aria-pressed", String(names[k][0] === state.mode));
    box.disabled = state.fixed || state.inMatch;
  });
  for (const event of ["mode", "table", "ended"]) state.on(event, show);
  show();
  return make("div", {class: "modes", role: "group", "aria-label": "Mode"}, ...boxes);
}

function topBar(state, sound, opens) {
  const {page} = state, full = () => document.fullscreenElement ? document.exitFullscreen()
    : document.documentElement.requestFullscreen?.();
  const word = (text) => make("span", {class: "word"}, text);
  const held = state.fixed || state.locked("table") ? "" : null;
  const more = toggle("☰", "More", (on) => document.body.classList.toggle("more", on));
  more.classList.add("more-button", "kept");
  return make("header", {class: "top"}, make("h1", {}, page.title), make("p", {class: "lead"}, page.lead),
    make("span", {class: "room"}), modes(state),
    button(["New", word(" game …")], opens, {disabled: held, "aria-label": "New game"}),
    toggle(["♪", word(" Sound")], "Sound", (on) => sound.turn(on)),
    button("Full screen", full, {class: "full"}), sightButton(state), more);
}

/** Makes the parts of the page. @returns objects for its tests */
function build(state) {
  const opens = gameDialog(state), sound = followSounds(state), table = tableCard(state),
    shared = shareCard(state, WHOLE);
  const made = ["Made by ", make("code", {}, state.page.command), `, carom ${carom.version()}`];
  const side = make("div", {class: "side"}, strokeCard(state), eventsCard(state), setupCard(state),
    shared.card, make("p", {class: "keys"}, KEYS), make("footer", {}, ...made));
  document.body.prepend(make("main", {class: "play"}, topBar(state, sound, opens), scoreBar(state),
    ...table.parts,
    make("div", {class: "right"}, gameCard(state, opens), side)));
  followKeys(state, table.tip);
  state.on("table", () => newTable(state));
  state.on("starts", () => {
    if (state.clock.now > 0 || state.replayed || state.fired && state.counts) return;
    keep(state);
    judge(state);
    Object.assign(state, {fired: true, resumes: false});
    state.tell("struck");
  });
  state.on("ended", () => {
    if (state.replayed) return endReplay(state);
    conclude(state);
    goOn(state);
  });
  keepMatch(state);
  return {sound, shared};
}

/** Begins with the scene of the address, of the page or of the stored match. */
async function open(state) {
  const said = await openAddress(state);
  if (state.shot) return said;
  const resumed = !said && state.page.scene === "" && resumeMatch(state);
  if (!state.shot) openScene(state, state.page.scene || startOf(carom, {}, "nine_foot"), {remember: false});
  state.tell("mode");
  return said ?? (resumed ? "The match continues." : null);
}

async function main() {
  const wasm = await load();
  if (wasm === null) return;
  const state = new State(pageData("page"), carom, prefers("reduced-motion: reduce")), {clock} = state;
  state.thinker = new Thinker(wasm);
  const {sound, shared} = build(state);
  window.addEventListener("hashchange", async () => {
    const said = await openAddress(state);
    if (said) state.say(said);
  });
  const said = await open(state);
  if (said) state.say(said);
  globalThis.caromPlay = {state, sound, scene: () => state.scene, shot: () => state.shot,
    show: (t) => clock.show(t), run: (on) => clock.run(on),
    change: (changes, how) => change(state, changes, how),
    begin: (toml, how) => begin(state, toml, how), newGame: (name, match) => newGame(state, name, {}, match),
    hint: () => hint(state), share: () => share(state, shared.address), download: shared.download};
  performance.mark("usable");
  document.body.dataset.ready = "true";
}

main();
