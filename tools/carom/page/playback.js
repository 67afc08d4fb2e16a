// Time on a page with a shot: a clock that runs, its controls, and the list of events.

import {ICONS, button, icon, iconButton, make, select} from "./dom.js";

export const SPEEDS = [0.05, 0.1, 0.25, 0.5, 1, 2, 4];  // [times real time]
const LONGEST_FRAME = 100;  // [ms] A page that was hidden continues where it was.

/** The index of the last event at or before t; -1 if there is none. */
export const eventBefore = (events, t) => events.findLastIndex((e) => e.time <= t);

/** The time that a page shows. `host`: {end(), events(), show(...), label()}, and perhaps starts(), ended(),
 * and still(ms) for users who prefer less motion: the time to show ms after the last picture, or null. */
export class Playback {
  constructor(host) { Object.assign(this, {host, now: 0, playing: false, speed: 1, drawn: 0}); }

  /** Shows an instant; `about` is for host.show(). */
  show(t, ...about) {
    this.now = Math.min(Math.max(t, 0), this.host.end());
    this.host.show(...about);
  }
  refresh() { this.show(this.now); }
  /** Stops at an instant. */
  go(t, ...about) {
    this.run(false);
    this.show(t, ...about);
  }
  run(on) {
    if (on === this.playing) return;
    this.playing = on;
    this.host.label();
    if (!on) return this.refresh();
    if (this.now >= this.host.end()) this.now = 0;
    this.host.starts?.();
    this.drawn = performance.now();
    this.wait();
  }
  wait() { requestAnimationFrame((time) => this.tick(time)); }
  tick(time) {
    if (!this.playing) return;
    const ms = time - this.drawn;
    const t = this.host.still ? this.host.still(ms)
      : this.now + this.speed * Math.min(Math.max(ms, 0), LONGEST_FRAME) / 1000;
    if (t !== null) {
      this.drawn = time;
      this.show(t);
    }
    if (this.now < this.host.end()) return this.wait();
    this.run(false);
    this.host.ended?.();
  }
  /** The time of the next event, or of the one before if direction is -1. */
  eventTime(direction) {
    const times = this.host.events().map((e) => e.time);
    return direction > 0 ? times.find((t) => t > this.now) ?? this.host.end()
      : times.findLast((t) => t < this.now) ?? 0;
  }
  jump(direction) { this.go(this.eventTime(direction)); }
}

/** The buttons and the slider of a clock. `digits`: of times in s. `names`: of the buttons to the previous
 * and the next event. */
export class PlaybackBar {
  constructor(clock, digits, names) {
    Object.assign(this, {clock, digits});
    this.time = make("output", {class: "clock"});
    this.scrub = make("input", {type: "range", min: "0", step: "any", class: "scrub",
      "aria-label": "Time in seconds", oninput: () => clock.go(Number(this.scrub.value))});
    this.play = iconButton(ICONS.play, "Play (space)", () => clock.run(!clock.playing));
    this.speeds = select("Speed of playback", SPEEDS.map((x) => [String(x), `${x} ×`]), "1",
      (x) => { clock.speed = Number(x); });
    this.element = make("div", {class: "bar", role: "group", "aria-label": "Playback"},
      iconButton(ICONS.back, names[0], () => clock.jump(-1)), this.play,
      iconButton(ICONS.next, names[1], () => clock.jump(1)), this.time, make("span", {class: "room"}));
  }
  show() {
    const {clock: {now, host}, digits} = this, end = host.end();
    this.time.textContent = `${now.toFixed(digits)} s of ${end.toFixed(digits)}`;
    this.scrub.max = String(end);
    this.scrub.value = String(now);
    this.scrub.style.setProperty("--done", `${end > 0 ? 100 * now / end : 0}%`);
  }
  /** Describes the action of the play button; `text` is its label. */
  label(name, text = "") {
    this.play.replaceChildren(icon(this.clock.playing ? ICONS.pause : ICONS.play), text);
    this.play.setAttribute("aria-label", `${name} (space)`);
    this.play.title = `${name} (space)`;
  }
}

/** Events that a click goes to. */
export class EventList {
  constructor(clock, digits) {
    Object.assign(this, {clock, digits, marked: -1, element: make("ol", {class: "events"})});
  }
  /** `describe(event, index)`: {words, title}: the parts of its text, and its tooltip. */
  fill(events, describe) {
    this.marked = -1;
    this.element.scrollTop = 0;
    this.element.replaceChildren(...events.map((e, i) => {
      const {words, title} = describe(e, i);
      const text = [make("time", {}, e.time.toFixed(this.digits)), make("span", {}, ...words)];
      return make("li", {}, button(text, () => this.clock.go(e.time, i), {title}));
    }));
  }
  /** Marks an event and scrolls to it; -1: none. */
  mark(at) {
    if (at === this.marked) return;
    const item = (i) => this.element.children[i];
    if (this.marked >= 0) item(this.marked).firstChild.removeAttribute("aria-current");
    this.marked = at;
    if (at < 0) return;
    item(at).firstChild.setAttribute("aria-current", "true");
    this.element.scrollTop = item(at).offsetTop - this.element.clientHeight / 2;
  }
}
