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

export interface SceneCue {
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
  readonly cue: SceneCue | null;
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
  other_name: string;
  /** Centre of the ball [m]. */
  place: [number, number, number];
  /** Of the ball [m/s], just before and just after. */
  speed_before: number | null;
  speed: number | null;
  /** Approach speed of the two [m/s]. */
  closing: number | null;
  /** Cut angle [degrees]. */
  cut_deg: number | null;
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

// begin types
export type Game = "eight_ball" | "nine_ball" | "three_cushion" | "snooker" | "sum_to_three" | "ten_ball" |
  "straight_pool" | "free_pyramid" | "straight_rail" | "one_cushion" | "four_ball";

/** The memory of a game between two shots. Players are 0 and 1; a pair has a value for each. */
export interface State {
  /** The game. */
  game: Game;
  /** Whose shot it is. */
  turn: number;
  /** The break, or the first shot of a carom game. */
  opening: boolean;
  /** Of the cue ball: its area. */
  in_hand: "no" | "anywhere" | "head string" | "D";
  /** Below 0 in straight pool and four-ball. */
  points: [number, number];
  /** Points that win; 0: no end. */
  target: number;
  /** The game is over. */
  over: boolean;
  /** -1: none, or not yet. */
  winner: number;
  /** Eight-ball. */
  group: ["open" | "solids" | "stripes", "open" | "solids" | "stripes"];
  /** Nine-ball, ten-ball: the shot after the break. */
  may_push_out: boolean;
  /** In a row; snooker: misses with a clear path to a full ball. */
  fouls: [number, number];
  /** Snooker: the ball on; colour: any, after a red. */
  on: "colour" | "red" | "yellow" | "green" | "brown" | "blue" | "pink" | "black";
  /** Snooker: any ball may be nominated. */
  free_ball: boolean;
  /** Options that are not defaults, such as "call=eight". */
  rules: string[];
}

/** An announcement before a shot. */
export interface Call {
  /** Id of the called ball. Snooker: the nominated colour or free ball; if "", the ball that is hit first. */
  ball: string;
  /** Id of the called pocket: "p1", ... */
  pocket: string;
  /** Eight-ball, ten-ball, straight pool: the turn ends whatever falls. */
  safety: boolean;
  /** Nine-ball, ten-ball: a push out. */
  push_out: boolean;
}

/** The rules of the next shot. */
export interface Legal {
  /** That may be struck: one, in free pyramid any. */
  cue_balls: string[];
  /** That may be hit first. */
  first: string[];
  /** That may be called. */
  callable: string[];
  /** As in the state. */
  in_hand: "no" | "anywhere" | "head string" | "D";
  /** A push out may be called. */
  may_push_out: boolean;
}

/** A foul, and the rule that it breaks. */
export interface Foul {
  /** Its name. */
  foul: "cue ball pocketed" | "cue ball off the table" | "no ball hit" | "wrong ball first" |
    "no cushion after contact" | "too few balls to a cushion on the break" | "ball off the table" |
    "cue ball placed outside its area" | "ball behind the head string first" | "third foul in a row" |
    "wrong cue ball" | "opening shot not at the red" | "wrong ball pocketed" | "two balls hit at once" |
    "jump shot" | "snooker behind the free ball" | "miss" | "opponent's cue ball hit" |
    "touching ball played into";
  /** "WPA 6.1"; "" if the game has no such rule. */
  rule: string;
}

/** A ball that is respotted. */
export interface Respot {
  /** Its id. */
  ball: string;
  /** [m] */
  place: [number, number];
}

/** A possible continuation of the game. */
export interface Option {
  /** The next step. */
  decision: "play on" | "take in hand" | "pass back" | "rerack" | "rerack for other" | "spot the eight" |
    "spot touching balls" | "replace the balls" | "rack fourteen";
  /** Of the next shot. */
  state: State;
  /** Before it. */
  respots: Respot[];
  /** The balls are racked again. */
  rerack: boolean;
  /** The next shot in words. */
  text: string;
  /** Hash of the judged record; "": unknown. */
  record: string;
}

/** The outcome of a shot. */
export interface Verdict {
  /** Empty for a fair shot. */
  fouls: Foul[];
  /** Scored by the shot. */
  points: number;
  /** Snooker: points for the other player. */
  penalty: number;
  /** At least one; the first applies unless the chooser picks another. */
  options: Option[];
  /** A player; -1 with one option, or if lots decide. */
  chooser: number;
}

/** An option of a game's rules. */
export interface RuleOption {
  /** The game. */
  game: Game;
  /** Its name. */
  key: string;
  /** The first one is the default. */
  values: string[];
  /** Its meaning. */
  what: string;
}

/** A game. */
export interface GameInfo {
  /** In files. */
  name: string;
  /** For people. */
  title: string;
  /** Its published rules, with their edition. */
  book: string;
  /** Announcements before a shot. */
  calls: string;
  /** Players collect points. */
  is_scored: boolean;
  /** Each player has a group of balls. */
  has_groups: boolean;
  /** A safety may be called. */
  has_safety: boolean;
  /** A push out may be called. */
  has_push_out: boolean;
  /** Points that win, if none are given; 0: no end. */
  target: number;
  /** A target to offer; 0: none. */
  usual_target: number;
  /** Object balls of a full rack. */
  balls: number;
  /** A table for it: a preset. */
  table: string;
  /** Its first scene, without table and balls. Places are fractions of the width (w) and the length (l) of
   * the table; SEED is of the rack. */
  start: string;
  /** Of its rules. */
  options: RuleOption[];
}

/** A strike: [cue] of a scene file. */
export interface Cue {
  /** kind of cue: its `mass`, `end_mass` and `restitution` */
  preset: string;
  /** id of the ball that is struck */
  ball: string;
  /** of the cue [m/s] */
  speed: number;
  /** 0 is +x, 90 is +y [degrees] */
  aim_deg: number;
  /** of the butt; above 0 it lifts the ball; `"auto"`: the least that clears rails and balls [degrees] */
  elevation_deg: number;
  /** left and up positive, together at most 0.5: farther out the tip slips off [ball radii] */
  offset: [number, number];
  /** of the cue [kg] */
  mass: number;
  /** of its end, for squirt; 0 for none, at most `mass` [kg] */
  end_mass: number;
  /** of the tip; 1 loses nothing */
  restitution: number;
}

/** A share of shots, with an interval that contains the true one 95 times in 100. */
export interface Share {
  /** 0 to 1. */
  value: number;
  /** Of the interval. */
  low: number;
  /** Of the interval. */
  high: number;
}

/** A shot to play, and its success rate. */
export interface Advice {
  /** The shot: "7 into p5 (right side pocket), half ball to the left, stun, medium". */
  words: string;
  /** Its result: "pots 84 % (80 to 87), wins 61 %, fouls 2 %; ...". */
  result: string;
  /** Its kind. */
  kind: "pot" | "combination" | "bank" | "kick" | "safety" | "push out" | "break";
  /** The ball that it pots; "" for other kinds. */
  ball: string;
  /** The pocket of that ball. */
  pocket: string;
  /** Of a pot: how far the object ball turns to the left. */
  cut_deg: number;
  /** The strike. */
  cue: Cue;
  /** With random errors of the level. */
  strike: Cue;
  /** For the judge. */
  call: Call;
  /** Of the cue ball in hand [m]. */
  place: [number, number] | null;
  /** Of shots that the search has not used: it wins the turn or the game. */
  makes: Share;
  /** Of these shots: it is a foul. */
  fouls: Share;
  /** Mean chance to win the rack against a player of the same level, as estimated; in eight-ball only an
   * order. */
  worth: number;
  /** The balls that it most often leaves as the surest pot, at most 3. */
  leaves: string[];
}

/** Standard deviations of the independent normal errors of a strike. */
export interface Noise {
  /** [m/s] */
  speed: number;
  /** [degrees] */
  aim_deg: number;
  /** [degrees] */
  elevation_deg: number;
  /** Of the offset [ball radii]. */
  side: number;
  /** Of the offset [ball radii]. */
  height: number;
}

/** The straight paths of a ball into a pocket that touch neither cushion noses nor jaws. */
export interface PocketLine {
  /** Its id. */
  pocket: string;
  /** Unit vector in the middle of these paths. */
  towards: [number, number];
  /** Centre of the cue ball that sends the ball there, without throw [m]. */
  ghost: [number, number];
  /** Angle between the outermost paths; 0 if there is none. */
  width_deg: number;
  /** From the ball to the point where it begins to fall [m]. */
  distance: number;
  /** The nearest ball on the middle path, or "". */
  in_the_way: string;
  /** There is such a path, and no ball blocks the middle one. */
  open: boolean;
}

/** The result of a search for an aim. */
export interface Aim {
  /** Of a strike that was played and pots the ball; null: see `why`. */
  aim_deg: number | null;
  /** Of a pot: at the ghost ball, without throw, squirt and swerve. */
  geometric_deg: number;
  /** Of a pot: the cut angle of that aim. */
  cut_deg: number;
  /** Of a bank: the cushion that the ball hits. */
  cushion: string;
  /** Played in the search. */
  shots: number;
  /** Why there is no aim; "" if there is one. */
  why: string;
}

/** Standard deviations of a player's independent normal errors. */
export interface Hand {
  /** Of the aim [degrees]. */
  aim_deg: number;
  /** Of the cue's speed, as a fraction of it. */
  speed: number;
  /** Of the tip, sideways and up [ball radii]. */
  tip: number;
  /** Of the elevation [degrees]. */
  elevation_deg: number;
}

/** Standard deviations of a table's properties that a player does not know, drawn anew for every trial; all
 * 0 for exact tables. */
export interface Unknown {
  /** Of mu_s and of mu_r, as a fraction. */
  cloth: number;
  /** Of the restitution of the cushions, as a fraction. */
  rails: number;
  /** Of every ball along x and y, except racked ones [m]. */
  places: number;
  /** Between racked balls [m]. */
  gaps: number;
}

/** How often a ball falls into a pocket. */
export interface Fall {
  /** Its id. */
  ball: string;
  /** Its id. */
  pocket: string;
  /** Of the shots of the solution. */
  share: number;
}

/** The success if one input is off. */
export interface Cost {
  /** Its key, or aim. */
  input: string;
  /** The error. */
  by: number;
  /** Of the error. */
  unit: string;
  /** Share of successes; NaN if no scene is valid there. */
  less: number;
  /** The same in the other direction. */
  more: number;
  /** In each direction. */
  shots: number;
}

/** A fit, with the names of `scipy.optimize.least_squares` where it has them. */
export interface FitResult {
  /** The fitted values, in the order of `vary`. */
  x: number[];
  /** Covariance of `x` if the model is right. Infinite for values that the tracks do not determine, and for
   * all if the fit failed. Correlated errors of neighbours in time enlarge it. */
  cov: number[][];
  /** Of every point: simulated minus tracked [m]; 0 in a pocket. */
  fun: [number, number][];
  /** The fit converged, and its residuals are noise. */
  success: boolean;
  /** Why it failed, or "converged". */
  message: string;
  /** Typical residual of a coordinate, without outliers [m]. */
  noise: number;
  /** Coordinates farther off than three times the noise. */
  outliers: number;
  /** Shots compared with the tracks; derivatives need more. */
  nfev: number;
  /** On values that the tracks cannot separate, a sentence each. */
  warnings: string[];
  /** The scene with the fitted values. */
  scene: string;
  /** Standard deviations of `x`. */
  std: number[];
  /** The values in the given scene. */
  start: number[];
  /** Of all residuals [m]. */
  rms: number;
  /** Positions that count: none of a ball in a pocket. */
  points: number;
}
// end types

export type GameState = State;

export class Verdict {
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
  /** All games, with their rules and options. */
  list(): GameInfo[];
  /** The rules of the next shot. */
  legal(state: GameState, scene: Scene): Legal & {text: string};
  /** The best shots of different kind, ball or pocket, the best first; at least one. `skill`: "beginner",
   * "club", "league", "professional" or "machine"; `shots`: fresh shots for each, 0 for none. It takes some
   * tenths of a second: call it in a Worker. After 0.6 `seconds` it looks for pots alone. Eight-ball,
   * nine-ball and ten-ball. @throws CaromError */
  advise(state: GameState, scene: Scene,
    options?: {skill?: string; seed?: number; best?: number; shots?: number; seconds?: number}): Advice[];
  /** The strike of a player of this level who intends the scene's cue. @throws CaromError */
  strike(scene: Scene, options?: {skill?: string; seed?: number}): Cue;
  judge(state: GameState, shot: Shot, announced?: Partial<Call>): Verdict;
};
