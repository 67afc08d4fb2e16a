// What happened in the shot, event by event.

import {make} from "../../page/dom.js";
import {EventList, eventBefore} from "../../page/playback.js";
import {eventWords} from "./words.js";

const BUSY = 50;  // [ms] If a picture takes longer, the list waits until the shot stops.

export function eventsCard(state) {
  const {clock} = state, list = new EventList(clock, 3), head = make("h2", {});
  let shown = [];
  const mark = () => {
    const busy = clock.playing && performance.now() - clock.drawn > BUSY;
    if (!busy && state.shot === list.shot) list.mark(clock.now > 0 ? eventBefore(shown, clock.now) : -1);
  };
  const fill = () => {
    shown = state.events();
    list.shot = state.shot;
    head.textContent = `Events (${shown.length})`;
    list.fill(shown, (e) => ({words: [eventWords(e, state.units)]}));
    mark();
  };
  const all = make("input", {type: "checkbox", onchange: () => {
    state.contactsOnly = !all.checked;
    fill();
  }});
  state.on("lists", fill);
  state.on("time", mark);
  return make("section", {class: "card event-card"}, make("div", {class: "bar"}, head,
    make("span", {class: "room"}), make("label", {}, all, " all")), list.element);
}
