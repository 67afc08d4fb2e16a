// The game on the page: what the player may do and announces, the verdict, and the options after it.

import {button, make, optionsOf, select} from "../../page/dom.js";
import {judge, legal, newGame, nextShot, sentence} from "./game.js";
import {GAMES} from "./tables.js";
import {verdictWords} from "./words.js";

/** What the player calls before the shot. */
function announcements(state) {
  const announce = (what) => (value) => {
    state.announced[what] = value;
    judge(state);
  };
  const box = (what) => make("input", {type: "checkbox", onchange: (e) => announce(what)(e.target.checked)});
  const ball = select("Called ball", [], "", announce("ball"));
  const pocket = select("Called pocket", [], "", announce("pocket"));
  const safety = box("safety"), pushOut = box("pushOut");
  const callRow = make("div", {class: "bar"}, ball, pocket, make("label", {}, safety, " safety"));
  const pushRow = make("div", {class: "bar"}, make("label", {}, pushOut, " push out"));
  state.on("table", () => {
    const pockets = state.scene.table.pockets.map(({id, name}) => [id, name || id]);
    pocket.replaceChildren(...optionsOf([["", "and a pocket"], ...pockets]));
    pocket.value = state.announced.pocket = "";
    safety.checked = state.announced.safety;
    pushOut.checked = state.announced.pushOut;
  });
  const show = ({callable, mayPushOut}) => {
    const {announced} = state;
    callRow.hidden = callable.length === 0;
    pushRow.hidden = !mayPushOut;
    ball.replaceChildren(...optionsOf([["", "call a ball"], ...callable.map((id) => [id, id])]));
    if (!callable.includes(announced.ball)) announced.ball = "";
    ball.value = announced.ball;
  };
  return {rows: [callRow, pushRow], show};
}

/** The verdict, and a button for each option. */
function verdictParts(state) {
  const {verdict, clock} = state;
  if (verdict === null || clock.now === 0) return [];
  const chooser = verdict.chooser >= 0 ? `Player ${verdict.chooser + 1} chooses:` : "";
  const several = verdict.options.length > 1;
  return [make("p", {}, verdictWords(verdict), " ", chooser), ...verdict.options.map((option, i) => {
    const label = sentence(several ? `${option.decision}: ${option.text}` : option.text);
    return option.state.over ? make("p", {}, `${label}.`) : button(label, () => nextShot(state, i));
  })];
}

/** A choice for each option of the game's rules; another choice begins anew. */
function ruleChoices(state) {
  const row = make("div", {class: "bar"});
  let game = "", rules = {};
  const start = (name) => newGame(state, name, name === game ? rules : {});
  const show = (name) => {
    if (name === game) return;
    [game, rules] = [name, {}];
    row.replaceChildren(...(name === "" ? [] : state.carom.games.options(name)).map(({key, values, what}) => {
      const title = key.replaceAll("_", " ");
      const box = select(title, values.map((value) => [value, `${title}: ${value.replaceAll("_", " ")}`]), "",
        (value) => {
          rules[key] = value;
          start(game);
        });
      box.title = what;
      box.disabled = state.fixed || state.locked("table");
      return box;
    }));
  };
  return {row, show, start};
}

export function gameCard(state) {
  const rules = ruleChoices(state);
  const box = select("Game", GAMES, "", rules.start);
  box.disabled = state.fixed || state.locked("table");
  const text = make("p", {class: "game-text", role: "status", "aria-live": "polite"});
  const {rows, show} = announcements(state), options = make("div", {class: "bar"});
  const tell = () => {
    const may = legal(state);
    text.textContent = may.text;
    show(may);
  };
  state.on("table", () => {
    box.value = state.game ? state.game.state.game : "";
    rules.show(box.value);
    options.replaceChildren();
    tell();
  });
  state.on("lists", tell);
  state.on("judged", () => options.replaceChildren(...verdictParts(state)));
  return make("section", {class: "card"}, make("h2", {}, "Game"), make("div", {class: "bar"}, box,
    button("Start again", () => rules.start(box.value), {disabled: state.fixed ? "" : null})),
  rules.row, text, ...rows, options);
}
