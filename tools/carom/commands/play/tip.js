// The cue ball from the player's view: the place of the tip, set by pointer or keys.

import {make} from "../../page/dom.js";
import {tipWords} from "./words.js";

const MOST_OFFSET = 0.5;  // [ball radii] farther out the tip slips off

/** The offsets nearest to these at which the tip does not slip off, to a thousandth of the radius. */
export function reachable(side, height) {
  const size = Math.hypot(side, height), most = MOST_OFFSET - 1e-6, shrink = size > most ? most / size : 1;
  return [side, height].map((x) => Math.trunc(x * shrink * 1000) / 1000 + 0);
}

export class TipPicture {
  /** `onchange(side, height)`: offsets in ball radii, left and up positive. */
  constructor(onchange) {
    Object.assign(this, {onchange, side: 0, height: 0});
    this.mark = make("circle", {r: "0.12", class: "tip-mark"});
    this.element = make("svg", {viewBox: "-1.08 -1.08 2.16 2.16", class: "tip-ball", tabindex: "0",
      role: "slider", "aria-label": "Where the tip strikes the cue ball", "aria-valuemin": "-50",
      "aria-valuemax": "50"},
    make("circle", {r: "1", class: "tip-face"}), make("circle", {r: "0.5", class: "tip-limit"}),
    make("path", {d: "M-1 0H1M0-1V1", class: "tip-cross"}), this.mark);
    const place = (event) => {
      const box = this.element.getBoundingClientRect(), unit = 2.16 / box.width;
      const x = (event.clientX - box.left) * unit - 1.08, y = (event.clientY - box.top) * unit - 1.08;
      this.change(-x, -y);
    };
    this.element.addEventListener("pointerdown", (event) => {
      this.element.setPointerCapture(event.pointerId);
      place(event);
    });
    this.element.addEventListener("pointermove", (event) => { if (event.buttons !== 0) place(event); });
    this.element.addEventListener("dblclick", () => this.change(0, 0));
    this.element.addEventListener("keydown", (event) => {
      const step = event.shiftKey ? 0.1 : 0.02;
      const way = {ArrowLeft: [step, 0], ArrowRight: [-step, 0], ArrowUp: [0, step], ArrowDown: [0, -step]};
      if (event.key === "Home") this.change(0, 0);
      else if (way[event.key]) this.step(...way[event.key]);
      else return;
      event.preventDefault();
      event.stopPropagation();
    });
  }
  change(side, height) { this.onchange(...reachable(side, height)); }
  step(side, height) { this.change(this.side + side, this.height + height); }
  show(side, height) {
    Object.assign(this, {side, height});
    this.mark.setAttribute("cx", -side);
    this.mark.setAttribute("cy", -height);
    this.words = tipWords(side, height);
    this.element.setAttribute("aria-valuenow", Math.round(100 * side));
    this.element.setAttribute("aria-valuetext", this.words);
  }
}
