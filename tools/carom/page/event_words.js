// Events and states of a record in the words of its file.

import {duration, make} from "./dom.js";

export const words = (type) => type.replaceAll("_", " ");

/** The partner of ball a in an event: another ball or a part of the table. */
export function partner(record, e) {
  const {jaws, pockets, cushions} = record.table;
  const lists = {ball_jaw: jaws, ball_edge: pockets, ball_pocket: pockets, ball_cushion: cushions};
  if (e.b < 0) return "";
  const kind = Object.keys(lists).find((name) => e.type.startsWith(name));
  return (kind ? lists[kind] : record.tracks)[e.b].id;
}

/** An event in the list, with its cost if the record is profiled. */
export function described(record, e) {
  const ids = record.tracks.map((track) => track.id);
  const who = e.balls ? e.balls.map((b) => ids[b]).join(", ")
    : [ids[e.a], partner(record, e)].filter((x) => x).join(" – ");
  const detail = () => [words(e.method), e.steps > 0 ? `${e.steps} steps` : "",
    e.kernel_ns > 0 ? duration(e.kernel_ns) : ""].filter((x) => x).join(", ");
  return {words: [make("b", {}, words(e.type)), ` ${who}`,
    record.profiled && e.method ? make("small", {}, detail()) : null],
  title: !record.profiled ? null : `detection ${duration(e.detect_ns)}, ` +
      `resolution ${duration(e.resolve_ns)} including kernel ${duration(e.kernel_ns)}`};
}
