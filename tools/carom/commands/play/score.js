// Whose turn it is, the score, the groups, and the balls that are off the table.

import {brightness, button, cssColour, make} from "../../page/dom.js";
import {newGame} from "./game.js";
import {nameOf} from "./players.js";
import {infoOf} from "./tables.js";

const LEAVES = ["ball_pocket", "ball_out"];

/** A ball as a small picture. */
function chip({id, style: {color, pattern, number}}) {
  const ball = make("i", {class: `chip ${pattern}`, title: id}, number > 0 ? String(number) : "");
  ball.style.setProperty("--ball", cssColour(color));
  if (pattern === "solid" && brightness(color) < 0.6) ball.classList.add("dark");
  return ball;
}

const groupOf = (id) => (Number(id) < 8 ? "solids" : Number(id) > 8 ? "stripes" : "");

/** The text beside a player's name. */
function standing(state, player) {
  const {game: {state: now}, match} = state;
  const hand = match && !match.players[player] ? [`${match.errors || "exact"} hand`] : [];
  const racks = match?.race > 1 ? [`${match.racks[player]} of ${match.race}`] : [];
  return [...racks, points(now, player, infoOf(state, now.game)), ...hand].filter((x) => x).join(" · ");
}
function points(now, player, {is_scored: scored}) {
  if (now.game === "eight_ball") return now.group[player] === "open" ? "" : now.group[player];
  return scored ? `${now.points[player]}${now.target ? ` of ${now.target}` : ""}` : "";
}

export function scoreBar(state) {
  const element = make("section", {class: "score", "aria-label": "Score"});
  const again = button(["↺", make("span", {class: "word"}, " Start again")], () => {
    const {game: {state: now}, match} = state;
    newGame(state, now.game, match?.rules ?? {}, match && {...match, racks: [0, 0]}, match?.first);
  }, {"aria-label": "Start again", title: "Start again"});
  const show = () => {
    if (!state.shot) return;
    const {game, set, scene, clock, shot} = state, now = game?.state, time = clock.now > 0 ? clock.now : -1;
    // A ball that falls in this shot moves to the tray after it has fallen.
    const fell = new Map(shot.events.filter(({type}) => LEAVES.includes(type)).map((e) => [e.ball, e.time]));
    const lies = (id) => scene.balls.some((b) => b.id === id) && !(time >= (fell.get(id) ?? Infinity));
    const off = set.filter(({id, style}) => style && !lies(id) && !["cue", scene.cue?.ball].includes(id));
    const tray = (balls) => make("span", {class: "tray"}, ...balls.map(chip));
    const grouped = now?.game === "eight_ball" && now.group[0] !== "open";
    const key = JSON.stringify([now, off.map(({id}) => id), state.match, state.busy]);
    if (key === element.dataset.key) return;
    element.dataset.key = key;
    const players = !now ? [] : [0, 1].map((player) => {
      const own = grouped ? tray(off.filter(({id}) => groupOf(id) === now.group[player])) : null;
      return make("span", {class: "player", "aria-current": now.turn === player && !now.over ? "true" : null},
        make("b", {}, nameOf(state, player)), " ", make("small", {}, standing(state, player)), own);
    });
    const others = off.filter(({id}) => !grouped || groupOf(id) === "");
    const rest = others.length > 0 ? [tray(others)] : [];
    element.replaceChildren(...players, ...rest, make("span", {class: "room"}), ...(now ? [again] : []));
    element.hidden = !now && off.length === 0;
  };
  for (const what of ["time", "busy", "judged"]) state.on(what, show);
  return element;
}
