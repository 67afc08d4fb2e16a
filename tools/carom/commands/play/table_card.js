// The table on the page, its controls, and the cue.

import {button, make, onWidth, select} from "../../page/dom.js";
import {orientations} from "../../page/motion.js";
import {PlaybackBar} from "../../page/playback.js";
import {TableView} from "../../page/stage.js";
import {nextShot} from "./game.js";
import {followPointer} from "./pointer.js";
import {takeBack} from "./shots.js";

/** The cue behind its ball, and the line of aim. */
function drawCue({scene: {cue}, view}, from) {
  const angle = cue.aim_deg * Math.PI / 180, along = [Math.cos(angle), Math.sin(angle)];
  const at = (d, side = 0) => view.projection.at(from.x + d * along[0] - side * along[1],
    from.y + d * along[1] + side * along[0]);
  const context = view.over.getContext("2d"), R = from.radius, width = view.dense;
  context.save();
  const line = (a, b, colour, thick, dash = []) => {
    context.beginPath();
    context.moveTo(...a);
    context.lineTo(...b);
    context.setLineDash(dash);
    context.lineWidth = thick;
    context.strokeStyle = colour;
    context.stroke();
  };
  line(at(R), at(12 * R), "rgba(255, 255, 255, 0.75)", 1.2 * width, [5 * width, 4 * width]);
  const side = cue.side * R, gap = 1.25 * R + 0.02 * cue.speed, {scale} = view.projection;
  context.lineCap = "round";
  line(at(-gap - 0.012, side), at(-gap - 1.1, side), "#3a2414", 0.024 * scale);
  line(at(-gap - 0.012, side), at(-gap - 0.75, side), "#d9b06c", 0.014 * scale);
  line(at(-gap, side), at(-gap - 0.014, side), "#3f7fbf", 0.013 * scale);
  context.restore();
}

/** The balls at this time; while aiming, the paths of the whole shot and the cue, too. */
function draw(state) {
  const {view, shot, scene, paths, clock: {now}} = state, {record} = shot;
  view.record = record;
  if (!state.aiming) {
    view.orientation = state.rotations ??= orientations(record);
    view.draw(now, {trails: "ball"});
    return;
  }
  view.orientation = () => [1, 0, 0, 0];
  const only = paths === "cue" && scene.cue ? shot.balls.indexOf(scene.cue.ball) : -1;
  const ahead = paths !== "off", from = state.struck();
  view.draw(0, {trails: ahead ? "ball" : "off", until: record.duration, only, ends: ahead});
  if (from) drawCue(state, from);
}

/** Fits the table into the window. */
function lay(state, box) {
  if (!state.view) return;
  const beside = matchMedia("(max-height: 520px) and (orientation: landscape)").matches;
  const rest = beside ? 92 : window.innerWidth > 900 ? 240 : 200;
  state.view.fit(Math.max(box.clientWidth, 200), Math.max(window.innerHeight - rest, beside ? 180 : 260));
  state.clock.refresh();
}

/** The bar below the table. */
function playbackBar(state) {
  const {clock} = state;
  const bar = new PlaybackBar(clock, 2, ["Previous event", "Next event"]);
  bar.play.className = "shoot";
  const back = button("Back to aiming", () => clock.go(0)), next = button("Next shot", () => nextShot(state));
  const undo = button("Undo", () => takeBack(state));
  bar.element.append(back, next, undo, bar.speeds, select("Predicted paths",
    [["all", "all paths"], ["cue", "cue ball's path"], ["off", "no paths"]], state.paths,
    (x) => { state.paths = x; clock.refresh(); }));
  const label = () => {
    const name = clock.playing ? "Pause" : clock.now === 0 ? "Shoot" : "Play";
    bar.label(name, name === "Shoot" ? name : "");
  };
  state.on("label", label);
  state.on("time", () => {
    if (state.aiming !== document.body.classList.contains("aiming")) {
      document.body.classList.toggle("aiming", state.aiming);
      label();
    }
    bar.show();
    back.hidden = next.hidden = clock.now === 0;
  });
  state.on("stroke", () => { undo.disabled = state.past.length === 0; });
  return bar;
}

export function tableCard(state) {
  const box = make("div", {class: "tables", tabindex: "0", role: "application",
    "aria-label":
      "Table. Left and right: aim. Up and down: speed. W A S D: tip. Space: shoot. Escape: back."});
  const bar = playbackBar(state), says = make("p", {class: "says", role: "status", "aria-live": "polite"});
  state.on("says", (text, bad) => {
    says.textContent = text;
    says.classList.toggle("error", bad);
  });
  state.on("table", () => {
    const {shape, styles} = state.scene.look();
    state.view = new TableView(state.shot.record, shape, styles, "The table from above");
    state.view.numbered = state.numbered;
    followPointer(state);
    box.replaceChildren(state.view.element);
    lay(state, box);
  });
  state.on("time", () => {
    draw(state);
    if (state.aiming) state.tell("stroke");
  });
  window.addEventListener("resize", () => requestAnimationFrame(() => lay(state, box)));
  onWidth(box, () => lay(state, box));
  const card = make("section", {class: "stage card", "aria-label": "The table"}, box,
    make("div", {class: "scrubbing"}, bar.scrub), bar.element, says);
  return {card, box, says};
}
