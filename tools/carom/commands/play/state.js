// What the page to play on remembers, in one object, and which parts of the page follow it.

import {Playback} from "../../page/playback.js";
import {isContact} from "./words.js";

export class State {
  /** `page`: what play.cpp wrote. `carom`: the module core.js. `calm`: the user prefers less motion. */
  constructor(page, carom, calm = false) {
    Object.assign(this, {page, carom, followers: {}, waiting: 0,
      // The table: a scene, its shot, how it is drawn; earlier ones as {toml, game}.
      scene: null, shot: null, view: null, rotations: null, past: [],
      // What the player chose.
      units: "metric", paths: "all", numbered: false, contactsOnly: true, placed: "", said: "",
      // A game is {state, option, judged, shot}: the state before this shot, and what led to it.
      game: null, verdict: null, announced: {ball: "", pocket: "", safety: false, pushOut: false},
      // The pointer on the table: what it holds, where it points, and whether a picture has been asked for.
      held: null, pointed: null, asked: false});
    // A page that holds something fast shows its own scene only.
    this.fixed = page.lock.length > 0;
    this.clock = new Playback({end: () => this.shot.duration, events: () => this.events(),
      show: () => this.tell("time"), label: () => this.tell("label"), starts: () => this.tell("starts"),
      ended: () => this.tell("ended"), still: calm ? () => this.shot.duration : null});
  }

  /** Follows what happens: "table" (another one, or other balls), "time", "label" (of the button to play),
   * "starts", "ended", "stroke" (any value that is shown while aiming), "lists" (which need not follow a
   * pointer at once), "placed" (another ball is to be placed), "judged", "says". */
  on(what, follow) { (this.followers[what] ||= []).push(follow); }
  tell(what, ...about) { for (const follow of this.followers[what] || []) follow(...about); }

  say(text, bad = false) {
    this.said = text;
    this.tell("says", text, bad);
  }
  /** Says why something cannot be done. */
  refuse(error) { this.say(error.reason || error.message, true); }
  /** Lets the lists follow soon. */
  later() {
    clearTimeout(this.waiting);
    this.waiting = setTimeout(() => this.tell("lists"), 120);
  }

  /** Whether nothing has moved yet. */
  get aiming() { return this.clock.now === 0 && !this.clock.playing; }
  locked(key) { return this.page.lock.some((name) => key === name || key.startsWith(`${name}.`)); }
  /** The events in the list. */
  events() { return this.shot.events.filter((e) => !this.contactsOnly || isContact(e)); }
  ball(id) { return this.scene.balls.find((ball) => ball.id === id); }
  /** The ball that the cue strikes. */
  struck() { return this.scene.cue ? this.ball(this.scene.cue.ball) : undefined; }
}
