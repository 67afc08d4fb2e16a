// The page of a shot: the table at any instant, keys and pointer, the lists of balls and events, and charts.

import {BallList} from "./ball_list.js";
import {make, pageData, pageFrame, onWidth, prefers, select} from "./dom.js";
import {described, words} from "./event_words.js";
import {size, stateAt} from "./motion.js";
import {EventList, Playback, PlaybackBar, SPEEDS, eventBefore} from "./playback.js";
import {shotCharts} from "./shot_charts.js";
import {TableView} from "./stage.js";

const FRAME = 1 / 60;  // [s]
const STILL = 900;  // [ms] how long each still is shown, for users who prefer less motion
const KEYS = "Space: play or pause. ← →: one frame. ↑ ↓: one event. Home, End. + −: speed. T: trails. " +
  "D: numbers of the diamonds.";

/** The page and its state. */
class ShotPage {
  constructor(page, record, second) {
    Object.assign(this, {page, record, second, trails: "state", mode: second ? "over" : "off",
      marked: -1, hovered: -1, told: 0});
    this.view = new TableView(record, page.shape, page.styles, "The table from above");
    this.beside = second &&
      new TableView(second, page.second.shape, page.second.styles, "The table of the second shot");
    const still = (ms) => ms < STILL ? null : this.clock.eventTime(1);
    this.clock = new Playback({end: () => record.duration, events: () => record.events,
      show: (event) => this.draw(event), label: () => this.bar.label(this.clock.playing ? "Pause" : "Play"),
      still: prefers("reduced-motion: reduce") ? still : null});
    this.balls = new BallList(record, second, page.styles, (i) => this.mark(i === this.marked ? -1 : i));
    this.events = new EventList(this.clock, 4);
    this.events.fill(record.events, (e, i) => described(record, e, page.story[i]));
    this.charts = shotCharts(record, page.styles, page.margin, (t) => this.clock.go(t));
    pageFrame(page, make("div", {class: "shot"}, this.stage(), make("div", {class: "side"},
      this.balls.element, make("section", {class: "card"},
        make("h2", {}, `Events (${record.events.length})`), this.events.element))),
    make("div", {class: "charts"}, ...this.charts.map((c) => c.element)));
    this.listen();
  }

  /** The table with the controls below it. */
  stage() {
    const {record, view, clock} = this, end = record.duration;
    this.bar = new PlaybackBar(clock, 3, ["Previous event (arrow up)", "Next event (arrow down)"]);
    this.trailBox = select("Trails",
      [["state", "trails: state"], ["ball", "trails: ball"], ["off", "no trails"]], this.trails,
      (x) => { this.trails = x; this.clock.refresh(); });
    const modes = this.second && select("Second shot",
      [["over", "second over"], ["beside", "second beside"], ["off", "second off"]], this.mode,
      (x) => { this.mode = x; this.lay(); });
    this.bar.element.append(this.bar.speeds, this.trailBox, modes || "");
    const ticks = record.events.map((e) => {
      const tick = make("i", {class: e.type.startsWith("ball_") ? "hit" : null});
      tick.style.left = `${end > 0 ? 100 * e.time / end : 0}%`;
      return tick;
    });
    this.tip = make("div", {class: "tip", hidden: ""});
    this.tables =
      make("div", {class: "tables"}, view.element, this.beside && this.beside.element, this.tip);
    this.spoken = make("p", {class: "spoken", role: "status", "aria-live": "polite"});
    return make("section", {class: "stage card", "aria-label": "The shot"}, this.tables,
      make("div", {class: "scrubbing"}, this.bar.scrub,
        make("div", {class: "ticks", "aria-hidden": "true"}, ...ticks)), this.bar.element,
      make("p", {class: "keys"}, KEYS), this.spoken);
  }

  /** Draws the instant; `event`: the event to mark, if several have this time. */
  draw(event = eventBefore(this.record.events, this.clock.now)) {
    const {record, trails, clock: {now, playing}} = this;
    this.view.draw(now, {trails, marked: this.hovered >= 0 ? this.hovered : this.marked,
      ghost: this.mode === "over" ? this.second : null});
    if (this.mode === "beside") this.beside.draw(now, {trails, marked: this.marked});
    this.bar.show();
    for (const c of this.charts) c.cursor(now);
    const states = record.tracks.map((track, i) => ({i, id: track.id, ...stateAt(record, i, now)}));
    document.body.dataset.state =
      JSON.stringify(states.map(({id, r, state}) => ({id, x: r[0], y: r[1], z: r[2], state})));
    if (!playing || performance.now() - this.told > 100) this.tell(states, event);
  }

  /** Updates parts that need not change in every frame: lists, numbers, the address. */
  tell(states, event) {
    const {now, playing} = this.clock;
    this.told = performance.now();
    this.balls.show(states, now, this.marked);
    this.events.mark(event);
    this.showTip(states);
    if (playing) return;
    const busy = states.filter((s) => size(s.v) > 0).length;
    const latest = event >= 0 ? ` Last event: ${this.page.story[event]}.` : "";
    const sentence = `${now.toFixed(3)} seconds. ${busy} of ${states.length} balls move.${latest}`;
    this.spoken.textContent = sentence;
    this.bar.scrub.setAttribute("aria-valuetext", sentence);
    // A page inside another one has no address of its own.
    try { history.replaceState(null, "", `#t=${Number(now.toFixed(9))}`); } catch { /* see above */ }
  }

  showTip(states) {
    const {tip, tables, view} = this, i = this.hovered >= 0 ? this.hovered : this.marked;
    const ball = i < 0 ? undefined : view.seen.find((b) => b.i === i);
    tip.hidden = ball === undefined;
    if (tip.hidden) return;
    const s = states[i], mm = (x) => (1000 * x).toFixed(1);
    tip.replaceChildren(make("b", {}, s.id), ` ${words(s.state)}`, make("br"),
      `x ${mm(s.r[0])}, y ${mm(s.r[1])}, z ${mm(s.r[2])} mm`, make("br"),
      `v ${s.v.map((x) => x.toFixed(3)).join(", ")} m/s`, make("br"),
      `w ${s.w.map((x) => x.toFixed(1)).join(", ")} rad/s`);
    const x = view.element.offsetLeft + ball.x / view.dense, y = view.element.offsetTop + ball.y / view.dense;
    const r = ball.r / view.dense + 8, below = y + r + tip.offsetHeight < tables.clientHeight;
    tip.style.left = `${Math.min(Math.max(x + r, 4), tables.clientWidth - tip.offsetWidth - 4)}px`;
    tip.style.top = `${below ? y + r : Math.max(4, y - r - tip.offsetHeight)}px`;
  }

  mark(i) {
    this.marked = i;
    this.clock.refresh();
  }
  hover(i) {
    if (i === this.hovered) return;
    this.hovered = i;
    if (!this.clock.playing) this.clock.refresh();
  }

  setSpeed(turn) {
    const {clock} = this, at = SPEEDS.indexOf(clock.speed) + turn;
    clock.speed = SPEEDS[Math.min(Math.max(at, 0), SPEEDS.length - 1)];
    this.bar.speeds.value = String(clock.speed);
  }

  listen() {
    const {view, clock, trailBox} = this;
    const actions = {" ": () => clock.run(!clock.playing), ArrowLeft: () => clock.go(clock.now - FRAME),
      ArrowRight: () => clock.go(clock.now + FRAME), ArrowUp: () => clock.jump(-1),
      ArrowDown: () => clock.jump(1), Home: () => clock.go(0), End: () => clock.go(this.record.duration),
      "+": () => this.setSpeed(1), "-": () => this.setSpeed(-1), Escape: () => this.mark(-1),
      d: () => { view.numbered = !view.numbered; this.clock.refresh(); },
      t: () => { trailBox.selectedIndex = (trailBox.selectedIndex + 1) % 3; trailBox.onchange(); }};
    document.addEventListener("keydown", (event) => {
      const on = event.target, action = actions[event.key] || actions[event.key.toLowerCase()];
      const pressed = event.ctrlKey || event.metaKey || event.altKey;
      const taken = on.tagName === "SELECT" || (event.key === " " && on.tagName === "BUTTON");
      if (!action || pressed || taken) return;
      event.preventDefault();
      action();
    });
    // After its use, a list returns the keys to the page.
    document.addEventListener("change", (event) => {
      if (event.target.tagName === "SELECT") event.target.blur();
    });
    view.over.onpointermove = (event) => this.hover(view.ballAt(event));
    view.over.onpointerleave = () => this.hover(-1);
    view.over.onclick = (event) => {
      const i = view.ballAt(event);
      this.mark(i === this.marked ? -1 : i);
    };
    window.addEventListener("hashchange", () => {
      if (Math.abs(address() - clock.now) > 1e-9) clock.go(address());
    });
    onWidth(this.tables, () => this.lay());
  }

  lay() {
    const {view, beside} = this, both = this.mode === "beside", wide = this.tables.clientWidth;
    const room = Math.max(0.62 * window.innerHeight, 260), width = both && wide > 700 ? wide / 2 - 5 : wide;
    if (beside) beside.element.hidden = !both;
    view.fit(width, room);
    if (both) beside.fit(width, room);
    this.clock.refresh();
  }
}

/** The time in the page's address. */
function address() {
  const t = Number(new URLSearchParams(location.hash.slice(1)).get("t"));
  return Number.isFinite(t) ? t : 0;
}

const shot = new ShotPage(pageData("page"), pageData("shot"), pageData("second"));
shot.clock.now = address();
shot.lay();
globalThis.carom = {record: shot.record, show: (t) => shot.clock.show(t), now: () => shot.clock.now};
document.body.dataset.ready = "true";
