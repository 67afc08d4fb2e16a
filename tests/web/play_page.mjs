// Shared by the tests of the page of `carom play`. CAROM_PLAY_PAGE names an existing page;
// CAROM_VIEW_PICTURES names a folder for screenshots.
import {execFileSync} from "node:child_process";
import {existsSync, mkdtempSync, rmSync} from "node:fs";
import {tmpdir} from "node:os";
import * as path from "node:path";
import {pathToFileURL} from "node:url";
import {Browser, TWO_FRAMES} from "../tools/view/chromium.mjs";
import {Firefox} from "../tools/view/firefox.mjs";
import {PROGRAM, native, withoutProgram} from "./support.mjs";

export const folder = mkdtempSync(path.join(tmpdir(), "carom-play-"));
const page = process.env.CAROM_PLAY_PAGE || path.join(folder, "play.html");
export const pageUrl = pathToFileURL(page).href;

/** Why tests with this browser are skipped, or false. */
export function missing(program) {
  try {
    execFileSync(program, ["--version"], {stdio: "ignore"});
  } catch {
    return `${program} is not installed`;
  }
  if (existsSync(page)) return false;
  if (withoutProgram) return withoutProgram;
  native(["play", "-o", page]);
  return existsSync(page) ? false : `${PROGRAM} was built without WebAssembly`;
}

const KINDS = {"chromium": Browser, "firefox-esr": Firefox};

/** A browser, with a person's actions on the page. */
export class Player {
  constructor(name) { Object.assign(this, {name, profile: path.join(folder, `${name}-${process.pid}`)}); }
  async start() {
    const {profile} = this;
    this.browser = new KINDS[this.name]({profile, pictures: process.env.CAROM_VIEW_PICTURES});
    await this.browser.open();
    await this.browser.size(1400, 900);
  }
  async end() {
    this.browser.process.kill();
    await new Promise((resolve) => this.browser.process.once("exit", resolve));
    rmSync(this.profile, {recursive: true, force: true, maxRetries: 5});
  }
  async open(url = pageUrl) {
    await this.browser.go(url);
    await this.browser.until(`document.body?.dataset.ready === "true"`);
    // A question would wait for a person.
    await this.value("void (window.asked = [], " +
      "window.confirm = (text) => window.asked.push(text) && !window.declines)");
  }
  value(expression) { return this.browser.value(expression); }
  settled() {
    return this.value(TWO_FRAMES);
  }
  /** The middle of the first element that matches a selector, or has this text. */
  placeOf(what) {
    const found = /^[.#[]/.test(what) ? `document.querySelector(${JSON.stringify(what)})`
      : `[...document.querySelectorAll("button")].find((b) => b.checkVisibility() && ` +
        `(b.textContent === ${JSON.stringify(what)} || b.ariaLabel === ${JSON.stringify(what)}))`;
    return this.value(`(() => { const b = ${found}.getBoundingClientRect();
      return [b.left + b.width / 2, b.top + b.height / 2]; })()`);
  }
  async press(what, type = "mouse") {
    await this.browser.drag([await this.placeOf(what)], type);
    await this.settled();
  }
  /** The screen place of a table place [m]. */
  onTable(x, y) {
    return this.value(`(() => { const {view} = caromPlay.state, b = view.over.getBoundingClientRect(),
      [px, py] = view.projection.at(${x}, ${y});
      return [b.left + px / view.dense, b.top + py / view.dense]; })()`);
  }
  async drag(places, type = "mouse") {
    const at = [];
    for (const [x, y] of places) at.push(await this.onTable(x, y));
    await this.browser.drag(at, type);
    await this.settled();
  }
  /** Starts in the middle of a game, with these balls, {id: [x, y]}. */
  async frame(game, balls, {players = ["", "machine"], more = {}, match: how = {}} = {}) {
    const toml = Object.entries(balls).map(([id, at]) => `[[ball]]\nid = "${id}"\nposition = [${at}]\n`);
    const text = JSON.stringify(`[table]\npreset = "nine_foot"\n[balls]\npreset = "pool"\n${toml.join("")}` +
      '[cue]\nball = "cue"\nspeed = 2\naim_deg = 90\n');
    const match = JSON.stringify({players, hints: true, rules: {}, errors: "", race: 1, racks: [0, 0],
      first: 0, ...how});
    await this.value(`(() => { const {state} = caromPlay;
      Object.assign(state, {mode: "play", match: ${match}});
      state.tell("mode");
      return caromPlay.begin(${text}, {game: {option: 0, state: {...state.carom.games.start("${game}"),
        opening: false, in_hand: "no", ...${JSON.stringify(more)}}}}); })()`);
  }
}
