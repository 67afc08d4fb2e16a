// The page of `carom play`: a table to play on. Every change is a whole shot, simulated here; its paths are
// what the player sees while aiming. At time 0 the player aims; later the shot is being watched.

import * as carom from "../../../../web/npm/core.js";
import {make, pageData, prefers} from "../../page/dom.js";
import {eventsCard} from "./events_card.js";
import {judge, newGame} from "./game.js";
import {gameCard} from "./game_card.js";
import {followKeys} from "./pointer.js";
import {setupCard} from "./setup_card.js";
import {wasmOfPage} from "./share.js";
import {openAddress, share, shareCard} from "./share_card.js";
import {begin, change, keep} from "./shots.js";
import {State} from "./state.js";
import {strokeCard} from "./stroke.js";
import {tableCard} from "./table_card.js";
import {startOf} from "./tables.js";
import {verdictWords} from "./words.js";

const KEYS = "Drag a ball to move it, drag elsewhere to aim. " +
  "Keys on the table: ← → aim (shift: 1°, alt: 0.01°), ↑ ↓ speed, W A S D tip, space shoot, Esc back, " +
  "Ctrl+Z undo.";

/** Loads carom. @returns whether this browser can run it */
async function load() {
  const loading = make("p", {class: "loading", role: "status"}, "Loading carom …");
  document.body.append(loading);
  try {
    await carom.start(await wasmOfPage(pageData("wasm")));
  } catch (error) {
    loading.textContent = `This browser cannot run carom: ${error.message}`;
    return false;
  }
  loading.remove();
  return true;
}

/** Judges a shot that has ended, and says what happened. */
function conclude(state) {
  judge(state);
  const {shot, verdict} = state, fell = shot.outcome.balls.filter((b) => b.pocket);
  const ids = fell.sort((a, b) => a.fell - b.fell).map((b) => b.id);
  const gone = ids.length > 0 ? ` In pockets: ${ids.join(", ")}.` : "";
  state.say(
    `At rest after ${shot.duration.toFixed(2)} s.${gone}${verdict ? ` ${verdictWords(verdict)}` : ""}`);
}

/** Makes the parts of the page. @returns the input that shows its address */
function build(state) {
  const {page} = state, table = tableCard(state), stroke = strokeCard(state), shared = shareCard(state);
  document.body.prepend(
    make("header", {}, make("h1", {}, page.title), make("p", {class: "lead"}, page.lead)),
    make("main", {class: "play"}, table.card, make("div", {class: "side"}, stroke.card, gameCard(state),
      eventsCard(state), setupCard(state), shared.card, make("p", {class: "keys"}, KEYS))),
    make("footer", {},
      make("p", {}, "Made by ", make("code", {}, page.command), `, carom ${carom.version()}`)));
  followKeys(state, table.box, stroke.tip);
  state.on("starts", () => {
    if (state.clock.now > 0) return;
    keep(state);
    judge(state);
  });
  state.on("ended", () => conclude(state));
  return shared.address;
}

async function main() {
  if (!await load()) return;
  const state = new State(pageData("page"), carom, prefers("reduced-motion: reduce"));
  const address = build(state), {clock} = state;
  window.addEventListener("hashchange", async () => {
    const said = await openAddress(state);
    if (said) state.say(said);
  });
  const opened = await openAddress(state);
  if (!state.shot) begin(state, state.page.scene || startOf(carom, "", "nine_foot"), {remember: false});
  if (opened) state.say(opened);
  globalThis.caromPlay = {scene: () => state.scene, shot: () => state.shot, show: (t) => clock.show(t),
    run: (on) => clock.run(on), change: (changes, how) => change(state, changes, how),
    begin: (toml) => begin(state, toml), newGame: (name) => newGame(state, name),
    share: () => share(state, address)};
  document.body.dataset.ready = "true";
}

main();
