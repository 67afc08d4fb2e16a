// The events of the shot. In the mode "play", the list fills while the balls move.

import {make} from "../../page/dom.js";
import {sentence} from "../../page/event_words.js";
import {EventList, eventBefore} from "../../page/playback.js";

const BUSY = 50;  // [ms] If a picture takes longer, the list waits until the shot stops.

export function eventsCard(state) {
  const {clock} = state, list = new EventList(clock, 3), head = make("h2", {}, "Events");
  let shown = [];
  const mark = () => {
    const busy = clock.playing && performance.now() - clock.drawn > BUSY;
    if (busy || state.shot !== list.shot) return;
    const at = clock.now > 0 ? eventBefore(shown, clock.now) : -1,
      all = state.mode === "practise" && state.paths !== "off";
    if (at === list.marked && list.all === all && !list.fresh) return;
    const open = all ? shown.length : at + 1;
    head.textContent = `Events${open > 0 ? ` (${open})` : ""}`;
    [...list.element.children].forEach((item, i) => { item.hidden = i >= open; });
    Object.assign(list, {all, fresh: false});
    list.mark(at);
  };
  const fill = () => {
    shown = state.events();
    Object.assign(list, {shot: state.shot, fresh: true});
    const {shot} = state, story = shot.story({inches: state.units === "inch"});
    list.fill(shown, (e) => ({words: [sentence(story[shot.events.indexOf(e)])]}));
    mark();
  };
  const all = make("input", {type: "checkbox", onchange: () => {
    state.contactsOnly = !all.checked;
    fill();
  }});
  state.on("lists", fill);
  state.on("table", () => {
    list.element.replaceChildren();
    list.marked = -1;
    head.textContent = "Events";
  });
  state.on("time", mark);
  state.on("mode", () => { if (state.shot) mark(); });
  return make("section", {class: "card event-card"}, make("div", {class: "bar"}, head,
    make("span", {class: "room"}), make("label", {}, all, " all")), list.element);
}
