// The table on the page, the drawings on it, and the controls below it.

import {ICONS, button, icon, make} from "../../page/dom.js";
import {orientations} from "../../page/motion.js";
import {PlaybackBar} from "../../page/playback.js";
import {TableView} from "../../page/stage.js";
import {drawContact, drawCue, drawHints, firstContact} from "./aids.js";
import {endReplay, nextShot, replay} from "./game.js";
import {hint, mayHint, stopThinking, takeTurn} from "./opponent.js";
import {followPointer, lookAtAll} from "./pointer.js";
import {strike, takeBack} from "./shots.js";
import {strokeParts} from "./stroke.js";

const USUAL = 5;    // [degrees] every cue is raised this much over a cushion

/** The balls at this time; while aiming, the part of the shot that the mode shows, and the cue. */
function draw(state) {
  const {view, shot, scene, paths, mode, sight, clock: {now}} = state, record = shot.motion;
  view.record = record;
  view.orientation = state.aiming ? () => [1, 0, 0, 0] : state.rotations ??= orientations(record);
  if (sight?.draw(now)) return;
  if (!state.aiming) {
    view.draw(now, {trails: mode === "play" ? "off" : "ball"});
    return;
  }
  const from = state.struck(), only = scene.cue ? shot.balls.indexOf(scene.cue.ball) : -1;
  if (mode === "play") {
    const contact = from && !state.level ? firstContact(shot, scene.cue.ball) : null;
    view.draw(0, {trails: contact ? "ball" : "off", until: contact?.time, only});
    if (contact) drawContact(view, contact, "rgba(255, 255, 255, 0.85)");
  } else {
    const ahead = paths !== "off";
    view.draw(0, {trails: ahead ? "ball" : "off", until: record.duration, only: paths === "cue" ? only : -1,
      ends: ahead});
  }
  if (from) drawCue(state, from);
  drawHints(state);
}

/** Why the shot that is aimed is doubtful: "" for a usual one. */
function warningOf({aiming, scene: {cue}, shot, level}) {
  if (!aiming || level) return "";
  const raise = cue?.in && (cue.clears_deg === null || cue.clears_deg > cue.elevation_deg + USUAL);
  const reaches = raise
    ? [`the cue reaches into the ${cue.in.replace(/ c\d+$/, "").replace(/^ball /, "")}; raise it`] : [];
  return [...reaches, ...shot.warnings].map((text) => `Warning: ${text}.`).join(" ");
}

/** The effect of a drag on the table now. */
function helpOf(state) {
  const {game, mode, scene, clock} = state;
  if (state.busy) return "";
  const coarse = matchMedia("(pointer: coarse)").matches;
  if (clock.playing && coarse) return "";
  if (clock.playing) return state.counts ? "Space stops the balls." : "Space stops the balls, Esc goes back.";
  if (!state.aiming) return mode === "play" ? "" : "← → one frame, ↑ ↓ one event, Esc back to aiming.";
  if (!scene.cue) return "Drag a ball to move it.";
  const placed = game ? game.state.in_hand !== "no" : true;
  const ball = mode === "practise" && !game ? "a ball: move it"
    : placed && !state.locked("ball") ? "the cue ball: move it" : "";
  const fine = coarse ? "a second finger" : "Shift";
  return [`Drag the cloth: aim (${fine}: finely)`, ball, "the cue: pull back and let go"]
    .filter((x) => x).join(" · ") + ".";
}

/** The controls during playback. */
function watchBar(state) {
  const {clock} = state, bar = new PlaybackBar(clock, 2, ["Previous event", "Next event"]);
  const back = button("Back to aiming", () => state.replayed ? endReplay(state) : clock.go(0)),
    next = button("Next shot", () => nextShot(state));
  bar.element.append(back, next, bar.speeds);
  const show = () => {
    bar.show();
    back.hidden = state.counts;
    next.hidden = state.replayed !== null || state.game !== null && state.mode === "play";
    bar.scrub.disabled = state.counts && clock.playing;
  };
  state.on("label", () => bar.label(clock.playing ? "Pause" : "Play"));
  state.on("time", show);
  state.on("mode", () => { if (state.shot) show(); });
  return make("div", {class: "watching"}, make("div", {class: "scrubbing"}, bar.scrub), bar.element);
}

/** The controls while aiming: tip, power, and buttons. @returns {element, tip} */
function aimBar(state) {
  const {tip, parts} = strokeParts(state);
  const shoot = button([icon(ICONS.play), "Shoot"], () => strike(state),
    {class: "shoot", title: "Shoot (space)"});
  const stop = button("Stop", () => stopThinking(state), {class: "shoot"});
  const lets = button("Let carom shoot", () => {
    state.yielded = false;
    takeTurn(state);
  });
  const again = button("Replay", () => replay(state), {title: "Show the last shot again"});
  const asks = button("Hint", () => hint(state)), undo = button("Undo", () => takeBack(state));
  const show = () => {
    shoot.hidden = state.busy !== null;
    shoot.disabled = !state.free || !state.scene?.cue;
    stop.hidden = state.busy === null;
    lets.hidden = !state.yielded;
    again.hidden = !state.game?.from || state.busy !== null;
    asks.hidden = !mayHint(state);
    asks.disabled = state.busy !== null;
    undo.hidden = state.counts;
    undo.disabled = state.past.length === 0;
  };
  for (const what of ["stroke", "mode", "busy", "label"]) state.on(what, show);
  const element = make("div", {class: "hands"}, ...parts, make("div", {class: "tools"}, lets, asks, again,
    undo),
    make("div", {class: "doing"}, shoot, stop));
  return {element, tip};
}

export function tableCard(state) {
  const box = make("div", {class: "tables", tabindex: "0", role: "application", "aria-label":
    "Table. Left and right: aim. Up and down: power. W A S D: tip. Space: shoot. Escape: back."});
  const says = make("p", {class: "says", role: "status", "aria-live": "polite"});
  const help = make("p", {class: "help"});
  const aims = aimBar(state), watch = watchBar(state);
  state.on("says", (text, bad) => {
    says.textContent = text;
    says.classList.toggle("error", bad);
  });
  const whole = button("Whole table", () => lookAtAll(state), {class: "whole", title: "Whole table (0)",
    hidden: ""});
  const lay = () => {
    if (!state.view) return;
    const room = [Math.max(box.clientWidth, 200), Math.max(box.clientHeight, 120)];
    if (state.view.fit(...room)) state.clock.refresh();
  };
  for (const change of ["table", "view"]) state.on(change, () => {
    const {shape, styles} = state.scene.look(), {bounds: {low, high}} = shape;
    // The frame outside the diamonds would only make a phone's balls smaller.
    const rim = shape.wood.length === 0 ? [0, 0] : shape.inlay.length > 0 ? [0.025, 0.025] : [0.05, 0.115];
    rim.forEach((cut, k) => { low[k] += cut; high[k] -= cut; });
    state.view = new TableView(state.shot.motion, shape, styles, "The table from above");
    state.view.numbered = state.numbered;
    followPointer(state);
    box.replaceChildren(state.view.element, whole);
    lay();
  });
  const helps = () => {
    const warning = state.shot ? warningOf(state) : "";
    help.textContent = warning || (state.shot ? helpOf(state) : "");
    help.classList.toggle("warn", warning !== "");
  };
  const now = () => {
    document.body.classList.toggle("aiming", state.aiming);
    document.body.classList.toggle("thinking", state.busy !== null);
    document.body.classList.toggle("in-game", state.game !== null);
    helps();
  };
  for (const what of ["label", "mode", "busy", "stroke"]) state.on(what, now);
  state.on("time", () => {
    draw(state);
    whole.hidden = !state.view.zoomed;
    if (state.aiming) state.tell("stroke");
    else if (document.body.classList.contains("aiming")) now();
  });
  new ResizeObserver(() => requestAnimationFrame(lay)).observe(box);
  // The lists may take room from the table, and return it before the browser paints.
  state.on("lists", lay);
  const strip = make("section", {class: "strip card", "aria-label": "Stroke"}, aims.element, watch);
  return {parts: [box, make("div", {class: "telling"}, says, help), strip], tip: aims.tip};
}
