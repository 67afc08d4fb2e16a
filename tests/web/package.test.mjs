// The npm package: its functions, its errors, the example of its README, its types.
import assert from "node:assert/strict";
import {readFileSync, writeFileSync, mkdtempSync, rmSync} from "node:fs";
import {execFileSync} from "node:child_process";
import {tmpdir} from "node:os";
import * as path from "node:path";
import {before, test} from "node:test";
import {PACKAGE, carom, sceneText} from "./support.mjs";

const {CaromError, STATES, Scene, games, simulate, simulateMany} = carom;

before(() => carom.init());

const draw = () => Scene.parse(sceneText("draw.toml"), "draw.toml");

test("a mistake in a scene has its place", () => {
  assert.throws(() => Scene.parse("[table]\npreset = \"nine_fot\"\n", "mine.toml"), (error) => {
    assert.ok(error instanceof CaromError);
    assert.equal(error.kind, "scene");
    assert.deepEqual([error.file, error.line], ["mine.toml", 2]);
    assert.match(error.message, /^mine\.toml:2:\d+: .*nine_fot/);
    return true;
  });
  assert.throws(() => Scene.parse("[table", "x"), CaromError);
});

test("any text is a scene or refused", () => {
  const text = sceneText("three_cushion.toml");
  let seed = 7;
  const random = (n) => { seed = (Math.imul(seed, 1103515245) + 12345) & 0x7fffffff; return seed % n; };
  for (let i = 0; i < 1000; ++i) {
    const at = random(text.length), cut = random(12);
    const put = String.fromCharCode(32 + random(200)).repeat(random(4));
    try {
      const scene = Scene.parse(text.slice(0, at) + put + text.slice(at + cut));
      simulate(scene, {seconds: 2}).free();
      scene.free();
    } catch (error) {
      assert.ok(error instanceof CaromError, error.stack);
    }
  }
});

test("with() makes another scene and keeps the first", () => {
  const scene = draw(), faster = scene.with({cue: {speed: 3.5, offset: [0.1, -0.2]}});
  assert.equal(faster.cue.speed, 3.5);
  assert.deepEqual([faster.cue.side, faster.cue.height], [0.1, -0.2]);
  assert.notEqual(scene.cue.speed, 3.5);
  assert.equal(Scene.parse(faster.toml).cue.speed, 3.5);
  assert.equal(scene.with({"balls.mu_s": 0.25}).toml.includes("0.25"), true);
  assert.throws(() => scene.with({"cue.sped": 3}), CaromError);
  assert.throws(() => scene.with({"cue.speed": "fast"}), CaromError);
  assert.throws(() => scene.with({"cue.speed": -1}), CaromError);
});

test("a record is checked against its scene", () => {
  const scene = Scene.parse(sceneText("eight_ball_break.toml")), shot = simulate(scene);
  assert.equal(scene.verify(shot.recordJson), null);
  // One ball rests 20 cm from where its motion ended.
  const record = JSON.parse(shot.recordJson);
  record.tracks[3].segments.at(-1).r[0] += 0.2;
  assert.match(scene.verify(JSON.stringify(record)), /\d m\b/);
  assert.throws(() => draw().verify(shot.recordJson), CaromError);
  const cluster = shot.events.find((event) => event.type === "ball_cluster");
  assert.ok(cluster.hits.length >= 15);
});

test("a wrong type is a TypeError that names the argument", () => {
  const scene = draw(), shot = simulate(scene), state = games.start("nine_ball");
  const carambole = Scene.parse(sceneText("nine_ball_break.toml"));
  const verdict = games.judge(state, simulate(carambole));
  const wrong = {
    toml: [() => Scene.parse(-1), () => Scene.parse(undefined), () => Scene.parse(new Uint8Array(3))],
    name: [() => Scene.parse("", 7), () => Scene.parse("", null)],
    changes: [() => scene.with(null), () => scene.with("cue.speed"), () => scene.with([1])],
    "cue.speed": [() => scene.with({"cue.speed": null}), () => scene.with({cue: {speed: undefined}}),
      () => simulateMany(scene, {"cue.speed": "123"}), () => simulateMany(scene, {"cue.speed": 3})],
    "cue.speed\\[1\\]": [() => simulateMany(scene, {"cue.speed": [1, "2"]}),
      () => simulateMany(scene, {"cue.speed": [1, null]})],
    scene: [() => simulate(5), () => simulate({handle: 64}), () => simulate(shot),
      () => simulateMany(null, {}), () => games.legal(state, shot)],
    until: [() => simulate(scene, {until: "1"}), () => simulate(scene, {until: NaN})],
    events: [() => simulate(scene, {events: null})],
    hash: [() => simulateMany(scene, {}, {hash: 1})],
    ball: [() => shot.stateAt(0.5, 0), () => shot.stateAt(null, 0), () => shot.stateAt([0], 0)],
    time: [() => shot.stateAt(0, "0"), () => shot.stateAt(0)],
    times: [() => shot.states("0"), () => shot.states(null)],
    "times\\[1\\]": [() => shot.states([0, NaN]), () => shot.states([0, "1"])],
    game: [() => games.start(3), () => games.start()],
    first: [() => games.start("nine_ball", {first: 0.5})],
    state: [() => games.legal(undefined, scene), () => games.judge("nine_ball", shot)],
    shot: [() => games.judge(state, scene)],
    option: [() => verdict.next({option: -1}), () => verdict.mayPlace(0, 0, 0.5)],
    x: [() => verdict.mayPlace("0", 0)],
    place: [() => verdict.next({place: 3}), () => verdict.next({place: [1]})],
  };
  for (const [name, calls] of Object.entries(wrong))
    for (const call of calls)
      assert.throws(call, {name: "TypeError", message: new RegExp(`^${name} is `)}, call.toString());
  assert.throws(() => new Scene(), TypeError);
  assert.throws(() => games.judge(state, shot, {safety: "no"}),
    {kind: "argument", message: "call.safety: expected true or false"});
});

test("a value that is not a number is reported by its key", () => {
  const scene = draw();
  for (const value of [NaN, Infinity, -Infinity]) {
    const message = new RegExp(`^cue.speed is ${value}; expected a finite number$`);
    assert.throws(() => scene.with({cue: {speed: value}}), {name: "CaromError", kind: "argument", message});
    assert.throws(() => scene.with({"cue.speed": value}), {message});
  }
  assert.throws(() => scene.with({cue: {offset: [0, NaN]}}), {message: /^cue.offset\[1\] is NaN/});
});

test("many keys at once equal one by one", () => {
  const keys = ["cue.speed", "cue.aim_deg", "balls.mu_s", "balls.e_b", "ball.cue.position.x"], changes = {};
  let one = draw();
  for (let k = 0; k < 500; ++k) {
    const key = keys[k % keys.length], value = 0.5 + 1e-4 * k;
    one = one.with({[key]: value});
    changes[key] = value;
  }
  assert.equal(draw().with(changes).everything, one.everything);
  assert.equal(Scene.parse(one.toml).everything, one.everything);
});

test("the quick path and the file give the same bits", () => {
  const scene = Scene.parse(sceneText("eight_ball_break.toml"));
  const quick = scene.with({"cue.speed": 6.1, "cue.offset.side": 0.05, "ball.cue.position.x": 0.5});
  const read = Scene.parse(quick.toml), written = Scene.parse(quick.everything);
  const hash = simulate(quick).hash;
  assert.equal(simulate(read).hash, hash);
  assert.equal(simulate(written).hash, hash);
  // A racked ball can be moved; from then on the balls are placed one by one.
  const moved = scene.with({"ball.3.position.x": 0.2, "ball.3.position.y": 0.3});
  assert.equal(simulate(Scene.parse(moved.toml)).hash, simulate(moved).hash);
});

test("a shot has events, states, an outcome and a record", () => {
  const shot = simulate(draw());
  assert.match(shot.hash, /^[0-9a-f]{16}$/);
  assert.equal(shot.events.length, shot.eventCount);
  assert.equal(shot.events[0].type, "cue_strike");
  assert.ok(shot.events.every((e, i) => i === 0 || e.time >= shot.events[i - 1].time));
  assert.equal(shot.record.tracks.length, shot.balls.length);
  const times = [0, 0.3, shot.duration], all = shot.states(times);
  assert.equal(all.numbers.length, 9 * times.length * shot.balls.length);
  assert.equal(all.states.length, times.length * shot.balls.length);
  const one = shot.stateAt(shot.balls[0], 0.3);
  assert.deepEqual(one.position, [...all.numbers.subarray(9 * shot.balls.length, 9 * shot.balls.length + 3)]);
  assert.ok(STATES.includes(one.state));
  assert.equal(shot.outcome.status, "at_rest");
  assert.equal(shot.outcome.balls.length, shot.balls.length);
  assert.throws(() => shot.stateAt("nobody", 0), RangeError);
  assert.ok(shot.after().balls.length <= shot.balls.length);
  shot.free();
  assert.throws(() => shot.states(0), /freed/);
});

test("a look has outlines and diamond numbers", () => {
  const {shape} = draw().look();
  assert.ok(shape.cloth.length > 0);
  assert.deepEqual(shape.numbers.map(({number}) => number).sort(),
    [1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3, 5, 5, 6, 6, 7, 7]);
});

test("a rail of a table without pockets is one board", () => {
  for (const preset of ["carom", "carom_small"]) {
    const ball = '[[ball]]\nid = "white"\nposition = [0.5, 0.5]\n';
    const scene = Scene.parse(`[table]\npreset = "${preset}"\n${ball}`);
    const corners = scene.look().shape.wood.map(({loops}) => loops.map((loop) => loop.length / 2));
    assert.deepEqual(corners, [[4], [4], [4], [4]], preset);
  }
});

test("until and seconds end a shot", () => {
  const scene = Scene.parse(sceneText("snooker_break.toml"));
  assert.equal(simulate(scene, {until: 0.5}).duration, 0.5);
  assert.throws(() => simulate(scene, {seconds: 0}), (error) => error.kind === "limit");
  const broken = Scene.parse(sceneText("eight_ball_break.toml"));
  assert.throws(() => simulate(broken, {events: 60}), (error) => error.kind === "limit");
});

test("many shots equal the single shots", () => {
  const scene = draw(), speeds = [1, 1.5, 2.25, -1], aims = [90, 90.5, 89, 90];
  const batch = simulateMany(scene, {"cue.speed": speeds, "cue.aim_deg": aims}, {hash: true});
  assert.deepEqual([batch.shots, batch.balls], [4, scene.balls.length]);
  for (let i = 0; i < 3; ++i) {
    const shot = simulate(scene.with({"cue.speed": speeds[i], "cue.aim_deg": aims[i]}));
    assert.equal(batch.hash[i].toString(16).padStart(16, "0"), shot.hash);
    assert.equal(batch.xy[2 * i * batch.balls], shot.outcome.balls[0].position[0]);
  }
  assert.equal(carom.STATUSES[batch.status[3]], "invalid");
  assert.equal(batch.messages[0].shot, 3);
  assert.throws(() => simulateMany(scene, {"cue.speed": [1], "cue.aim_deg": [1, 2]}), RangeError);
  assert.throws(() => simulateMany(scene, {"cue.sped": [1]}), CaromError);
});

test("games judge shots and return the next scene", () => {
  const scene = Scene.parse(sceneText("nine_ball_break.toml")), start = games.start("nine_ball");
  assert.deepEqual(games.legal(start, scene).first, ["1"]);
  const shot = simulate(scene), verdict = games.judge(start, shot);
  assert.ok(verdict.options.length >= 1);
  assert.match(verdict.options[0].text, /player [12] shoots|over/);
  const next = verdict.next(), state = verdict.options[0].state;
  assert.equal(next.cue.ball, "cue");
  assert.equal(games.judge(state, simulate(next)).options.length > 0, true);
  assert.throws(() => games.start("chess"), CaromError);
  assert.throws(() => games.judge({game: "nine_ball", turn: 7}, shot), CaromError);
  const carambole = Scene.parse(sceneText("three_cushion.toml"));
  const middle = {...games.start("three_cushion", {target: 30}), opening: false};
  const other = games.judge(middle, simulate(carambole));
  assert.deepEqual([other.fouls, other.points], [[], 1]);
});

test("a game has options, and a shot a route", () => {
  const state = games.start("eight_ball", {rules: {call: "none", in_hand: "behind_line"}});
  assert.deepEqual(state.rules, ["call=none", "in_hand=behind_line"]);
  assert.deepEqual(games.start("nine_ball", {rules: {push_out: false}}).rules, ["push_out=false"]);
  const [miss] = games.list().find(({name}) => name === "snooker").options;
  assert.deepEqual([miss.key, miss.values], ["miss", ["false", "true"]]);
  assert.throws(() => games.start("eight_ball", {rules: {cal: "all"}}), /it has call, eight_on_break/);
  const shot = simulate(Scene.parse(sceneText("three_cushion.toml")));
  assert.deepEqual(shot.measure("route"), ["head", "right", "left", "foot"]);
  assert.equal(shot.measure("cushions_before(red)"), 4);
  assert.equal(shot.measure("point", {game: "three_cushion"}), true);
  assert.equal(shot.measure("points(one_cushion)"), 1);
  assert.throws(() => shot.measure("rout"), CaromError);
  assert.throws(() => shot.measure("point"), CaromError);
});

test("a thousand shots do not fill the memory", () => {
  const scene = draw();
  for (let i = 0; i < 1000; ++i) {
    const changed = scene.with({"cue.aim_deg": 80 + i / 50}), shot = simulate(changed);
    shot.free();
    changed.free();
  }
});

test("the example of the README runs", () => {
  const readme = readFileSync(path.join(PACKAGE, "README.md"), "utf8");
  const code = /```js\n([^]*?)```/.exec(readme)[1];
  const folder = mkdtempSync(path.join(tmpdir(), "carom-readme-"));
  try {
    writeFileSync(path.join(folder, "example.mjs"),
      code.replace('"carom"', JSON.stringify(path.join(PACKAGE, "index.js"))));
    const said = execFileSync(process.execPath, [path.join(folder, "example.mjs")], {encoding: "utf8"});
    assert.match(said, /cue_strike cue/);
    assert.match(said, /ball_ball/);
  } finally {
    rmSync(folder, {recursive: true});
  }
});

test("every exported name has a type", () => {
  const types = readFileSync(path.join(PACKAGE, "index.d.ts"), "utf8");
  for (const name of Object.keys(carom))
    assert.match(types, new RegExp(`export (function|class|const) ${name}\\b`), name);
});

test("motion has the tracks of the record, bit for bit", () => {
  for (const name of ["eight_ball_break.toml", "jump_pot.toml", "bar_break.toml"]) {
    const {motion, record} = simulate(Scene.parse(sceneText(name)));
    assert.deepEqual([motion.duration, motion.gravity], [record.duration, record.gravity]);
    assert.equal(motion.tracks.length, record.tracks.length);
    motion.tracks.forEach((track, i) => {
      const {id, pocket, segments, radius = record.balls.R, mass = record.balls.m} = record.tracks[i];
      assert.deepEqual([track.id, track.pocket, track.radius, track.mass], [id, pocket, radius, mass]);
      segments.forEach((segment) => { delete segment.ends; });
      assert.deepEqual(track.segments, segments, `${name}, ${id}`);
    });
  }
});

test("a scene names obstacles of its cue, and a shot has warnings", () => {
  const ball = (id, y) => `[[ball]]\nid = "${id}"\nposition = [0.6, ${y}]\n`;
  const cue = '[cue]\nball = "cue"\nspeed = 2\naim_deg = 90\n';
  const behind = Scene.parse(ball("cue", 1.2) + ball("1", 1) + cue);
  assert.equal(behind.cue.in, "ball 1");
  const raised = behind.with({"cue.elevation_deg": behind.cue.clears_deg});
  assert.equal(raised.cue.in, "");
  assert.deepEqual(simulate(draw()).warnings, []);
  assert.match(simulate(Scene.parse(sceneText("masse.toml"))).warnings.join(), /elevat/);
});

test("an advised strike has the errors of its level, and the player entitled to choose chooses", () => {
  const scene = Scene.parse(sceneText("nine_ball_break.toml")), state = games.start("nine_ball");
  const strikes = [1, 2].map((seed) =>
    games.advise(state, scene, {skill: "beginner", seed, best: 1, shots: 0})[0]);
  for (const {cue, strike} of strikes) assert.notEqual(strike.aim_deg, cue.aim_deg);
  assert.notEqual(strikes[0].strike.aim_deg - strikes[0].cue.aim_deg,
    strikes[1].strike.aim_deg - strikes[1].cue.aim_deg);
  const soft = simulate(Scene.parse(sceneText("eight_ball_break.toml")).with({"cue.speed": 1}));
  const foul = games.judge(games.start("eight_ball"), soft);
  assert.ok(foul.options.length > 1);
  const choice = foul.choose("club");
  assert.ok(choice >= 0 && choice < foul.options.length);
  assert.throws(() => foul.choose("wizard"), /beginner, club/);
});

test("advice is a shot that can be played and judged", () => {
  const ball = (id, x, y) => `[[ball]]\nid = "${id}"\nposition = [${x}, ${y}]\n`;
  const scene = Scene.parse(ball("cue", 0.6, 0.6) + ball("3", 0.3, 0.3) + ball("8", 1.0, 2.3) + "[cue]\n");
  const state = {...games.start("eight_ball"), opening: false, in_hand: "no", group: ["solids", "stripes"]};
  const [best] = games.advise(state, scene, {skill: "club", best: 1});
  assert.deepEqual([best.kind, best.ball, best.call.pocket], ["pot", "3", best.pocket]);
  const {speed, aim_deg, elevation_deg, offset: [side, height]} = best.cue;
  const shot = simulate(scene.with({
    "cue.speed": speed, "cue.aim_deg": aim_deg, "cue.elevation_deg": elevation_deg,
    "cue.offset.side": side, "cue.offset.height": height}));
  assert.equal(games.judge(state, shot, best.call).points, 1);
  assert.throws(() => games.advise(state, scene, {skill: "wizard"}), /beginner, club/);
  assert.throws(() => games.advise(state, scene, {seed: 0.5}), TypeError);
});
