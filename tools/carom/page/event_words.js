// Events and states of a record in words.

import {duration, make} from "./dom.js";

export const words = (type) => type.replaceAll("_", " ");

/** A sentence of the engine's for people: "Cue meets 1, cut 31°". */
export const sentence = (text) =>
  text.charAt(0).toUpperCase() + text.slice(1).replace(/ deg\b/, "°");

/** An event in the list, with its cost if the record is profiled. `story`: its sentence. */
export function described(record, e, story) {
  const detail = () => [words(e.method), e.steps > 0 ? `${e.steps} steps` : "",
    e.kernel_ns > 0 ? duration(e.kernel_ns) : ""].filter((x) => x).join(", ");
  return {words: [sentence(story), record.profiled && e.method ? make("small", {}, detail()) : null],
    title: !record.profiled ? null : `detection ${duration(e.detect_ns)}, ` +
      `resolution ${duration(e.resolve_ns)} including kernel ${duration(e.kernel_ns)}`};
}
