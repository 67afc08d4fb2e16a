// The game on the page: the player's rights and calls, the verdict, and its options.

import {button, make, optionsOf, select} from "../../page/dom.js";
import {sentence} from "../../page/event_words.js";
import {HINT_COLOURS, firstContact, obviousCall} from "./aids.js";
import {dialog} from "./extras.js";
import {judge, legal, newGame, nextRack, nextShot} from "./game.js";
import {LEVELS, PLAYED, take} from "./opponent.js";
import {endWords, withNames} from "./players.js";
import {gamesOf, infoOf} from "./tables.js";
import {named, verdictWords} from "./words.js";

/** The calls before the shot. */
function announcements(state) {
  let chosen = false;
  const announce = (what) => (value) => {
    state.announced[what] = value;
    chosen = true;
    judge(state);
  };
  const box = (what) => make("input", {type: "checkbox", onchange: (e) => announce(what)(e.target.checked)});
  const ball = select("Called ball", [], "", announce("ball"));
  const pocket = select("Called pocket", [], "", announce("pocket"));
  const safety = box("safety"), pushOut = box("push_out");
  const callRow = make("div", {class: "bar"}, ball, pocket, make("label", {}, safety, " safety"));
  const pushRow = make("div", {class: "bar"}, make("label", {}, pushOut, " push out"));
  const tell = () => {
    pocket.value = state.announced.pocket;
    safety.checked = state.announced.safety;
    pushOut.checked = state.announced.push_out;
  };
  state.on("table", () => {
    const pockets = state.scene.table.pockets.map(({id, name}) => [id, name || id]);
    pocket.replaceChildren(...optionsOf([["", "pocket …"], ...pockets]));
    state.announced.pocket = "";
    chosen = false;
    tell();
  });
  let callable = [], nominates = false;
  // An obvious call is automatic until the player makes a call.
  const obvious = () => {
    const {announced, scene, shot, clock} = state;
    if (chosen || callable.length === 0 || state.level || !scene.cue || clock.now > 0) return;
    const contact = firstContact(shot, scene.cue.ball), call = !nominates
      ? obviousCall(contact, scene.table.pockets) : contact?.met ? {ball: contact.met.id, pocket: ""} : null;
    const right = call && callable.includes(call.ball) ? call : {ball: "", pocket: ""};
    Object.assign(announced, right);
    ball.value = right.ball;
    tell();
  };
  state.on("starts", obvious);
  state.on("announced", () => { chosen = true; });
  const show = ({callable: now, may_push_out: mayPushOut, nominates: colour}) => {
    const {announced} = state, person = !state.level && state.aiming, {preset} = state.scene.table;
    callable = now;
    nominates = Boolean(colour);
    pocket.hidden = safety.parentNode.hidden = nominates;
    callRow.hidden = callable.length === 0 || !person;
    pushRow.hidden = !mayPushOut || !person;
    ball.replaceChildren(...optionsOf([["", "ball …"], ...callable.map((id) => [id, nominates ? named(id,
      preset) : id])]));
    if (!callable.includes(announced.ball)) announced.ball = "";
    ball.value = announced.ball;
    tell();
    obvious();
  };
  return {rows: [callRow, pushRow], show};
}

/** The verdict, and a button for each option of a person. */
function verdictParts(state, opens) {
  const {verdict, clock, match, mode} = state;
  if (verdict === null || clock.now === 0) return [];
  const {chooser, options} = verdict, several = options.length > 1;
  const info = infoOf(state, state.game.state.game);
  const who = chooser >= 0 ? withNames(state, `Player ${chooser + 1} chooses:`) : "";
  if (state.over) {
    const next = !match ? [] : [button(state.inMatch ? "Next rack" : "Rematch", () => nextRack(state),
      {class: "shoot"}),
      button("New game …", opens)];
    return [make("p", {class: "over"}, endWords(state)), make("p", {}, verdictWords(verdict, info)),
      make("div", {class: "bar"}, ...next)];
  }
  const mine = (mode === "practise" || several) && !match?.players[chooser];
  return [make("p", {}, verdictWords(verdict, info), " ", who), ...options.map((option,
    i) => {
    const then = withNames(state, sentence(option.text));
    const label = several ? `${sentence(option.decision)}: ${then}` : then;
    if (!mine) return make("p", {class: "over"}, `${label}.`);
    return button(label, () => nextShot(state, i));
  })];
}

const YES_NO = {true: "yes", false: "no"};
/** A choice for each option of a game's rules, kept in `rules`. */
function ruleChoices(state, game, rules) {
  return infoOf(state, game).options.map(({key, values, what}) => {
    const title = key.replaceAll("_", " ");
    const named = values.map((value) => [value, `${title}: ${YES_NO[value] ?? value.replaceAll("_", " ")}`]);
    const box = select(title, named, values[0], (value) => { rules[key] = value; });
    box.title = what;
    return box;
  });
}

/** The dialog that begins a game. @returns a function that opens it */
export function gameDialog(state) {
  let rules = {};
  const row = make("div", {class: "bar"}), note = make("p", {class: "note"});
  const levels = [["", "a person"], ...LEVELS.map((level) => [level, `carom: ${level}`])];
  const players = [["First player", ""], ["Second player", "club"]].map(([name, level]) =>
    select(name, levels, level, () => follow()));
  const hints = make("input", {type: "checkbox", checked: ""});
  const hand = select("Your hand", [["", "exact"], ...LEVELS.map((level) => [level, `errs: ${level}`])],
    "club",
    () => {});
  const race = select("Race to", [1, 2, 3, 5, 7, 9].map((n) => [String(n),
    n === 1 ? "1 rack" : `${n} racks`]),
    "1", () => {});
  // A person's hand errs as much as carom's.
  const follow = () => { hand.value = players.map(({value}) => value).find((level) => level) ?? ""; };
  const choose = (name) => {
    rules = {};
    row.replaceChildren(...(name === "" ? [] : ruleChoices(state, name, rules)));
    const plays = PLAYED.includes(name);
    players.forEach((box) => {
      box.disabled = !plays;
      if (!plays) box.value = "";
    });
    if (plays && players.every(({value}) => value === "")) players[1].value = "club";
    follow();
    note.textContent = plays || name === "" ? ""
      : "carom judges this game but does not play it: two people play it on this page.";
  };
  const game = select("Game", [["", "no rules"], ...gamesOf(state)], "eight_ball", choose);
  const start = () => {
    const name = game.value, levelsOf = players.map(({value}) => value);
    element.close();
    newGame(state, name, rules, name === "" ? null : {players: levelsOf, hints: hints.checked, rules,
      errors: hand.value, race: Number(race.value), racks: [0, 0], first: 0});
  };
  const labelled = (text, input) => make("label", {class: "field"}, make("span", {}, text), input);
  const element = dialog("New game", [labelled("Game", game), row, note, labelled("First", players[0]),
    labelled("Second", players[1]), labelled("Your hand", hand), labelled("Race to", race), make("label",
      {}, hints, " allow hints")],
  button("Start", start, {class: "shoot"}));
  return () => {
    choose(game.value);
    element.showModal();
  };
}

/** The shots of a hint, the best first. */
function hintList(state) {
  const list = make("ol", {class: "hint-list"});
  state.on("hints", () => list.replaceChildren(...state.hints.map((hint, i) => {
    // A safety does not aim to win the turn, only to be fair.
    const scores = hint.kind !== "safety" && hint.kind !== "push out",
      {value: share} = scores ? hint.makes : hint.fouls;
    const rate = `${(100 * (scores ? share : 1 - share)).toFixed(0)} %${scores ? "" : " fair"}`,
      mark = make("b", {}, String(i + 1));
    mark.style.setProperty("--hint", HINT_COLOURS[i]);
    return make("li", {}, button([mark, ` ${hint.words}: ${rate}`], () => take(state, hint)));
  })));
  state.on("table", () => list.replaceChildren());
  state.on("starts", () => list.replaceChildren());
  return list;
}

/** `opens`: opens the dialog for a new game. */
export function gameCard(state, opens) {
  const text = make("p", {class: "game-text", role: "status", "aria-live": "polite"});
  const {rows, show} = announcements(state), options = make("div", {class: "bar verdict"});
  const card = make("section", {class: "card game", "aria-label": "Game"}, text,
    make("div", {class: "choices"}, ...rows, options, hintList(state)));
  const hide = () => {
    const told = text.textContent || options.hasChildNodes() || state.hints.length > 0;
    card.hidden = !told || Boolean(state.level) && state.aiming;
  };
  const tell = () => {
    if (!state.shot) return;
    const may = legal(state);
    text.textContent = state.aiming ? withNames(state, may.text) : "";
    show(may);
    hide();
  };
  state.on("table", () => {
    options.replaceChildren();
    card.classList.remove("end");
    tell();
  });
  for (const what of ["lists", "busy", "mode", "label", "hints", "announced"]) state.on(what, tell);
  state.on("judged", () => {
    options.replaceChildren(...verdictParts(state, opens));
    card.classList.toggle("end", options.querySelector(".over") !== null);
    hide();
  });
  return card;
}
