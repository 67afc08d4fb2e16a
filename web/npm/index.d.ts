// Types of carom for JavaScript. Units are SI: m, m/s, rad/s, s. Keys of scenes are those of scene files
// (docs/reference/scene_format.md); angles there are degrees, and their names end in _deg.

/** Loads carom.wasm, once. Without `source`, from the file beside the package. Needs WebAssembly with
 * SIMD. */
export function init(source?: string | URL | Response | ArrayBuffer | ArrayBufferView | WebAssembly.Module
  | Promise<Response>): Promise<void>;

/** The version of carom: three numbers with dots. */
export function version(): string;

export class CaromError extends Error {
  /** "scene": a mistake in a scene. "simulation": the shot cannot continue. "limit": it took too long. */
  readonly kind: "scene" | "simulation" | "argument" | "limit" | "memory";
  /** The place in the scene; line 0 means the whole scene. The message begins with file:line:column. */
  readonly file: string;
  readonly line: number;
  readonly column: number;
  /** The message without the place. */
  readonly reason: string;
}

export type BallState =
  "stationary" | "spinning" | "sliding" | "rolling" | "pocketed" | "falling" | "airborne" | "out" |
  "colliding";
export const STATES: readonly BallState[];
export const STATUSES: readonly ("at_rest" | "time" | "events" | "endless" | "invalid" | "failed")[];

/** A value of a scene file. */
export type Value = number | boolean | string | Value[];
/** Keys of a scene file, nested or with dots: {cue: {speed: 4}}, {"ball.red.position.x": 0.7}. */
export interface Changes { [key: string]: Value | Changes }

export interface BallPlace {
  id: string;
  /** Centre [m]. */
  x: number;
  y: number;
  /** [m] */
  radius: number;
  /** [kg] */
  mass: number;
}

export interface Cue {
  /** Id of the ball that it strikes. */
  ball: string;
  /** Of the cue [m/s]. */
  speed: number;
  /** [degrees] 0 is +x, 90 is +y. */
  aim_deg: number;
  /** Of the butt [degrees]. */
  elevation_deg: number;
  /** Offset of the tip [ball radii]: left and up positive. */
  side: number;
  height: number;
  /** The obstacle that the cue would reach into: "cushion c3", "ball 7"; "" if it is free. */
  in: string;
  /** The least elevation that clears it; null if none does. */
  clears_deg: number | null;
}

export interface TableInfo {
  /** "nine_foot", ..., or "" for an outline of its own. */
  preset: string;
  cloth: string;
  /** Between the noses [m]: along x and along y. */
  width: number;
  length: number;
  /** Its corner of smallest x and y [m]. */
  corner: [number, number];
  pockets: {id: string; name: string; center: [number, number]}[];
}

/** A scene: table, balls and cue. It never changes. */
export class Scene {
  /** Reads a scene file. @throws CaromError with file:line:column */
  static parse(toml: string, name?: string): Scene;
  /** Another scene with these values. @throws CaromError */
  with(changes: Changes): Scene;
  /** The scene file. */
  readonly toml: string;
  /** The scene file with every value written out and every ball placed on its own. */
  readonly everything: string;
  readonly balls: BallPlace[];
  /** null if no ball is struck. */
  readonly cue: Cue | null;
  readonly table: TableInfo;
  /** The table's outlines [m] and how the balls look, for drawing. */
  look(): {shape: object; styles: {color: [number, number, number]; pattern: string; number: number}[]};
  /** Checks a record of this scene, perhaps another program's: null, or the first law of mechanics that it
   * breaks, with the event and a residual. @throws CaromError if it is of another scene */
  verify(recordJson: string): string | null;
  /** The table's triangles for WebGL: ten parts, one after the other, whose last vertices are in `ends`; ten
   * numbers for each vertex, relative to `origin` [m]; and an atlas of digits, a byte per pixel. */
  mesh(): {origin: [number, number]; ends: number[]; vertices: Float32Array; atlas: Uint8Array};
  /** Frees its memory now; otherwise the garbage collector does. */
  free(): void;
}

export interface ShotEvent {
  /** Since the start of the shot [s]. */
  time: number;
  /** "ball_ball", "ball_cushion", "slide_roll", ... (docs/reference/record_format.md) */
  type: string;
  /** Id of the ball. */
  ball: string;
  /** Id of the other ball, cushion, jaw or pocket; "" if there is none. */
  other: string;
  /** Its name for people: "left rail, head half". */
  otherName: string;
  /** Centre of the ball [m]. */
  place: [number, number, number];
  /** Of the ball [m/s], just before and just after. */
  speedBefore: number | null;
  speed: number | null;
  /** Approach speed of the two [m/s]. */
  closing: number | null;
  /** Cut angle [rad]. */
  cut: number | null;
  /** Place along the rail in diamonds: 0 to 4 on short rails, 0 to 8 on long ones. */
  diamond: number | null;
  /** Ids of all balls of a cluster. */
  balls?: string[];
}

/** The outcomes of one shot (see Batch): a ball or a pocket is its id, "" for none; "out": off the table. */
export interface Outcome {
  // begin outcome
  status: string;
  duration: number;
  events: number;
  first_hit: string;
  contacts: number;
  approach_cushions: number;
  // end outcome
  balls: {
    id: string;
    /** At the end: [m], [m/s], [rad/s]. */
    state: BallState;
    position: [number, number, number];
    velocity: [number, number, number];
    spin: [number, number, number];
    // begin ball_outcome
    pocket: string;
    fell: number;
    cushions: number;
    // end ball_outcome
  }[];
}

export class Shot {
  readonly scene: Scene;
  /** 16 hexadecimal digits, equal to those of `carom simulate --hash`. */
  readonly hash: string;
  /** [s] */
  readonly duration: number;
  readonly eventCount: number;
  /** Warnings about the shot, a sentence each. */
  readonly warnings: string[];
  /** Ids. */
  readonly balls: string[];
  readonly outcome: Outcome;
  readonly events: ShotEvent[];
  /** The record file (docs/reference/record_format.md), as text and parsed. */
  readonly recordJson: string;
  readonly record: object;
  /** A sentence for each event: "cue meets 1, cut 31 deg, 2.1 m/s". `inches`: speeds in mph. */
  story(options?: {inches?: boolean}): string[];
  /** Its duration, gravity and tracks alone, in the form of the record: much faster. */
  readonly motion: {duration: number; gravity: number; tracks: object[]};
  /** States of all balls at these times [s]. `numbers` contains nine for each time and ball, ball after ball:
   * centre [m], velocity [m/s], angular velocity [rad/s]. `states` contains an index into STATES for each. */
  states(times: number | ArrayLike<number>): {balls: number; numbers: Float64Array; states: Uint8Array};
  /** The state of one ball. */
  stateAt(ball: string | number, time: number): {
    state: BallState;
    position: [number, number, number];
    velocity: [number, number, number];
    spin: [number, number, number];
  };
  /** The scene at rest, without pocketed balls and with the same cue. */
  after(): Scene;
  /** A measure or expression (see `carom describe measures`): shot.measure("route"). `game`: the rules for
   * "point" and others. @throws CaromError */
  measure(expression: string, options?: {game?: Game}): number | boolean | null | string[];
  free(): void;
}

/** Simulates a shot. `until`: stop there [s]. It throws after `seconds` of computing (60), or after more than
 * `events` events (1e6).
 * @throws CaromError */
export function simulate(scene: Scene, options?: {until?: number; seconds?: number; events?: number}): Shot;

export interface Batch {
  shots: number;
  balls: number;
  ids: string[];
  /** Why a shot has no result. */
  messages: {shot: number; message: string}[];
  // begin outcomes
  /** (n) index of the status at the end */
  status: Uint8Array;
  /** (n) [s] until its end */
  duration: Float64Array;
  /** (n) in its record */
  events: BigInt64Array;
  /** (n) index of the ball that the struck ball hits first, or -1 */
  first_hit: Int32Array;
  /** (n) balls that it hits */
  contacts: Int32Array;
  /** (n) cushions that it hits before its second ball, or in all; one that it touches at the start counts
   * after it has left it */
  approach_cushions: Int32Array;
  /** (n, b, 2) [m] at the end; of a pocketed ball, its pocket; NaN if it was left out */
  xy: Float64Array;
  /** (n, b) index of the pocket that holds it; -1: none; -2: it has left the table */
  pocket: Int32Array;
  /** (n, b) 0 for the first ball that falls, 1 for the next, ..., or -1 */
  fell: Int32Array;
  /** (n, b) how often it hits a cushion or a jaw */
  cushions: Int32Array;
  /** (n) of the record, on request */
  hash?: BigUint64Array;
  // end outcomes
}

/** Simulates many shots of one scene, in which these numbers differ: {"cue.speed": [1, 2, 3]}. */
export function simulateMany(scene: Scene, columns: {[key: string]: ArrayLike<number>},
  options?: {hash?: boolean}): Batch;

export type Game = "eight_ball" | "nine_ball" | "three_cushion" | "snooker" | "sum_to_three"
  | "ten_ball" | "straight_pool" | "free_pyramid" | "straight_rail" | "one_cushion" | "four_ball";

/** An option of a game's rules; the first value is the default. */
export interface RuleOption {
  game: Game;
  key: string;
  values: string[];
  what: string;
}

/** The state of a game between two shots, as in `carom judge --state-out`. Players are 0 and 1. */
export interface GameState {
  game: Game;
  turn: number;
  opening: boolean;
  in_hand: "no" | "anywhere" | "head string" | "D";
  points: [number, number];
  target: number;
  over: boolean;
  winner: number;
  group: [string, string];
  may_push_out: boolean;
  fouls: [number, number];
  on: string;
  free_ball: boolean;
  /** Options of the rules that are not defaults: "call=eight". */
  rules?: string[];
}

export interface Strike {
  speed: number;
  aim_deg: number;
  elevation_deg: number;
  /** Side and height [ball radii]. */
  offset: [number, number];
}

/** A shot to play, and its success rate. Shares have intervals of 95 %: [share, low, high]. */
export interface Advice {
  words: string;
  /** Its success rate, the chance to win, fouls and the position that it leaves, in words. */
  result: string;
  kind: "pot" | "combination" | "bank" | "kick" | "safety" | "push out" | "break";
  /** The ball to pot, and the pocket; "" for other kinds. */
  ball: string;
  pocket: string;
  cut_deg: number;
  cue: Strike;
  /** The cue with random errors of the level. */
  strike: Strike;
  /** The argument `announced` of judge(). */
  call: {ball: string; pocket: string; safety: boolean; pushOut: boolean};
  /** Of the cue ball in hand [m]. */
  place: [number, number] | null;
  /** Shares of shots that the search has not used: wins of the turn or the game, and fouls. */
  makes: [number, number, number];
  fouls: [number, number, number];
  /** Mean chance to win against a player of the same level, as estimated; for eight-ball only an order. */
  worth: number;
  leaves: string[];
}

export class Verdict {
  /** Empty for a fair shot. */
  readonly fouls: {foul: string; rule: string}[];
  readonly points: number;
  readonly penalty: number;
  /** The player who chooses among the options, or -1. */
  readonly chooser: number;
  readonly options: {
    decision: string;
    /** "player 2 shoots, cue ball in hand anywhere" */
    text: string;
    rerack: boolean;
    state: GameState;
    respots: {ball: string; place: [number, number]}[];
  }[];
  /** Whether the cue ball may be placed there [m]. */
  mayPlace(x: number, y: number, option?: number): boolean;
  /** The best option for the player who chooses: eight-ball, nine-ball and ten-ball. */
  choose(skill?: string): number;
  /** The next scene. `place`: of the cue ball in hand [m]; without it, near the head spot.
   * @throws CaromError */
  next(choice?: {option?: number; place?: [number, number] | null}): Scene;
  free(): void;
}

export const games: {
  /** The state before the first shot. `target`: points that win, 0 for no end (free pyramid: 8). `rules`:
   * options that are not defaults, {call: "eight"}. */
  start(game: Game,
    options?: {first?: 0 | 1; target?: number; rules?: {[key: string]: string | boolean}}): GameState;
  /** The options of a game. */
  options(game: Game): RuleOption[];
  /** The rules of the next shot. */
  legal(state: GameState, scene: Scene): {
    cueBalls: string[];
    first: string[];
    callable: string[];
    inHand: GameState["in_hand"];
    mayPushOut: boolean;
    text: string;
  };
  /** The best shots of different kind, ball or pocket, the best first; at least one. `skill`: "beginner",
   * "club", "league", "professional" or "machine"; `shots`: fresh shots for each, 0 for none. It takes some
   * tenths of a second: call it in a Worker. After 0.6 `seconds` it looks for pots alone. Eight-ball,
   * nine-ball and ten-ball. @throws CaromError */
  advise(state: GameState, scene: Scene,
    options?: {skill?: string; seed?: number; best?: number; shots?: number; seconds?: number}): Advice[];
  /** The strike of a player of this level who intends the scene's cue. @throws CaromError */
  strike(scene: Scene, options?: {skill?: string; seed?: number}): Strike;
  judge(state: GameState, shot: Shot,
    announced?: {ball?: string; pocket?: string; safety?: boolean; pushOut?: boolean}): Verdict;
};
