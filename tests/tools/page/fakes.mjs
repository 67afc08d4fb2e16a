// A fake carom for the interactive page's state: each shot lasts as many seconds as its speed.
import {State} from "../../../tools/carom/commands/play/state.js";

/** The scene that a JSON text describes: its cue, and balls by name. */
class FakeScene {
  constructor(told) {
    Object.assign(this, told, {told, freed: false});
    this.balls = Object.entries(told.balls).map(([id, [x, y]]) => ({id, x, y, radius: 0.03}));
    this.table = {preset: "nine_foot", cloth: "", corner: [0, 0], length: 2, width: 1, pockets: []};
  }
  static parse(toml) { return new FakeScene(JSON.parse(toml)); }
  get toml() { return JSON.stringify(this.told); }
  with(changes) {
    const told = JSON.parse(this.toml);
    for (const [key, value] of Object.entries(changes)) {
      const [what, name, , axis] = key.split(".");
      if (what === "ball") told.balls[name][axis === "x" ? 0 : 1] = value;
      else if (what in told) told[what][name] = value;
      else throw new Error(`no key is called ${key}`);
    }
    return new FakeScene(told);
  }
  free() { this.freed = true; }
}

class FakeShot {
  constructor(scene) {
    Object.assign(this, {scene, duration: scene.cue.speed, hash: scene.toml, freed: false,
      events: [0, 1, 2].map((time) => ({time, type: time === 1 ? "slide_roll" : "ball_ball"}))});
  }
  after() { return this.scene.with({"ball.cue.position.x": 0.9}); }
  free() { this.freed = true; }
}

/** The options of a verdict, as judge() returns them. */
export const OPTIONS = [{decision: "play", text: "player 2 plays", state: {game: "nine_ball", turn: 1}}];

export const carom = {
  Scene: FakeScene,
  simulate(scene) {
    if (scene.cue.speed > 10) throw new Error("the shot is too hard");
    return new FakeShot(scene);
  },
  games: {
    start: (game) => ({game, in_hand: "head string", points: [0, 0]}),
    legal: () => ({first: ["1"], callable: ["1", "2"], may_push_out: true, text: "player 1 shoots"}),
    judge: (state, shot, announced) => ({shot, announced, options: OPTIONS, chooser: -1,
      mayPlace: (x) => x < 0.5, next: () => shot.after()}),
  },
};

export const START = JSON.stringify({cue: {ball: "cue", speed: 3, aim_deg: 90, side: 0, height: 0},
  balls: {cue: [0.5, 0.25], 1: [0.5, 1.5]}});

/** A state without a page, and the list of its messages. */
export function freshState(lock = []) {
  const state = new State({lock}, carom), said = [];
  state.on("says", (text) => said.push(text));
  return {state, said};
}
