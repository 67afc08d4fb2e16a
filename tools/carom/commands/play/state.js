// The state of the interactive page, in one object, and the parts of the page that follow it.

import {Playback} from "../../page/playback.js";
import {isContact} from "./words.js";

export class State {
  /** `page`: the data from play.cpp. `carom`: the module core.js. `calm`: the user prefers less motion. */
  constructor(page, carom, calm = false) {
    // A page with locked keys shows only its own scene, and does not predict the shot.
    const fixed = page.lock.length > 0;
    Object.assign(this, {page, carom, calm, fixed, followers: {}, waiting: 0,
      // The table: a scene, its shot, how it is drawn; earlier ones as {toml, game, set}. `set`: all balls
      // that have been on it, as {id, style}. `raised`: the elevation that the player wants [degrees].
      scene: null, shot: null, view: null, rotations: null, past: [], set: [], raised: 0,
      // The player's choices. In the mode "play" a shot counts; in "practise" all its paths are shown before.
      mode: fixed ? "play" : "practise",
      units: "metric", paths: "all", numbered: false, contactsOnly: true, placed: "", said: "",
      // A game is {state, option, judged, shot, from}: the state before this shot, and its origin. A match is
      // {players, hints, rules, errors, race, racks}: a level for each player, "" for a person; whether hints
      // are allowed; the level whose errors a person's hand has, "" for none; the racks that win, and those
      // that each player has won. `fired`: whether this shot was struck. `resumes`: a stored one will be.
      game: null, match: null, verdict: null, fired: false, resumes: false,
      // While the last shot of a game is shown again: the scene and the shot to return to.
      replayed: null,
      announced: {ball: "", pocket: "", safety: false, push_out: false},
      // The thinking player: {level, hint}, or null; whether a person shoots for carom. Advice on the table.
      busy: null, yielded: false, hints: [],
      // The pointer on the table: its target, its position, and whether a picture is requested.
      held: null, pointed: null, asked: false});
    this.clock = new Playback({end: () => this.shot.duration, events: () => this.events(),
      show: () => this.tell("time"), label: () => this.tell("label"), starts: () => this.tell("starts"),
      ended: () => this.tell("ended"), still: calm ? () => this.shot.duration : null});
  }

  /** Adds a listener for "table" (another one, or other balls), "time", "label" (of the button to play),
   * "starts", "ended", "stroke" (any value that is shown while aiming), "lists" (which need not follow a
   * pointer at once), "placed" (another ball is to be placed), "judged", "says", "mode", "busy", "hints". */
  on(what, follow) { (this.followers[what] ||= []).push(follow); }
  tell(what, ...about) { for (const follow of this.followers[what] || []) follow(...about); }

  say(text, bad = false) {
    this.said = text;
    this.tell("says", text, bad);
  }
  /** Shows why something cannot be done. */
  refuse(error) { this.say(error.reason || error.message, true); }
  /** Lets the lists follow soon. */
  later() {
    clearTimeout(this.waiting);
    this.waiting = setTimeout(() => this.tell("lists"), 120);
  }

  /** Whether nothing has moved yet; a shot that counts has none of that once it is struck. */
  get aiming() { return this.clock.now === 0 && !this.clock.playing && !(this.fired && this.counts); }
  /** Whether a person may aim now. */
  get free() { return this.aiming && (this.busy === null || this.busy.hint) && !this.level; }
  /** Whether strokes count: in a played game, nothing can be undone. */
  get counts() { return !this.replayed && this.game !== null && (this.mode === "play"
    || this.match !== null); }
  /** Whether this shot has ended the game. */
  get over() { return !this.aiming && Boolean(this.verdict?.options[0].state.over); }
  /** Whether a match is not decided yet. */
  get inMatch() {
    const {match, game, verdict} = this, winner = this.over ? verdict.options[0].state.winner : -1;
    return match !== null && game !== null && !(this.over && (match.racks?.[winner] ?? 0) +
      1 >= (match.race ?? 1));
  }
  /** The level of the player whose turn it is, or "" for a person. */
  get level() {
    const now = this.game?.state;
    return now && !now.over && !this.yielded ? this.match?.players[now.turn] ?? "" : "";
  }
  locked(key) { return this.page.lock.some((name) => key === name || key.startsWith(`${name}.`)); }
  /** The events in the list. */
  events() { return this.shot.events.filter((e) => !this.contactsOnly || isContact(e)); }
  ball(id) { return this.scene.balls.find((ball) => ball.id === id); }
  /** The ball that the cue strikes. */
  struck() { return this.scene.cue ? this.ball(this.scene.cue.ball) : undefined; }
}
