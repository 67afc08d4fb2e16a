// Uses every part of the package's types. types.test.mjs compiles it; what must be refused is marked so.
import {CaromError, Scene, Shot, games, init, simulate, simulateMany} from "carom";
import type {BallState} from "carom";

export async function tour(): Promise<number> {
  await init();
  const scene: Scene = Scene.parse("", "a.toml").with({cue: {speed: 4}, "cue.aim_deg": 90});
  const shot: Shot = simulate(scene, {until: 1, events: 1000});
  const state: BallState = shot.stateAt("cue", 0.5).state;
  const numbers: Float64Array = shot.states([0, 1]).numbers;
  const met: string[] = shot.events.map((event) => event.type);
  const many = simulateMany(scene, {"cue.speed": [1, 2]}, {hash: true});
  const verdict = games.judge(games.start("nine_ball"), shot);
  const next: Scene = verdict.next({place: [0.6, 0.5]});
  try {
    next.free();
  } catch (error) {
    if (error instanceof CaromError) return error.line;
  }
  // @ts-expect-error: a speed is a number
  const wrong: string = shot.duration;
  // @ts-expect-error: there is no such game
  games.start("chess");
  // @ts-expect-error: shots never change
  shot.hash = "";
  // @ts-expect-error: no such limit
  simulate(scene, {minutes: 3});
  return state.length + numbers.length + met.length + many.xy.length + wrong.length;
}
