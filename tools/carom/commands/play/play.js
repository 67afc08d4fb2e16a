// The page of `carom play`: a table to play on. Every change is a whole shot, simulated here; its paths are
// what the player sees while aiming. At time 0 the player aims; later the shot is being watched.
"use strict";

(async () => {
  const page = pageData("page"), {Scene, simulate, games} = carom;
  const loading = make("p", {class: "loading", role: "status"}, "Loading carom …");
  document.body.append(loading);
  try {
    await carom.start(await wasmOfPage(pageData("wasm")));
  } catch (error) {
    loading.textContent = `This browser cannot run carom: ${error.message}`;
    return;
  }
  loading.remove();

  const SPEEDS = [0.05, 0.1, 0.25, 0.5, 1, 2, 4];  // [times real time]
  const LIMITS = {seconds: 2, events: 20000};  // of one shot, so that no scene stops the page
  const UNDO_LIMIT = 200;
  const locked = (key) => page.lock.some((name) => key === name || key.startsWith(`${name}.`));
  // A page that holds something fast shows its own scene only.
  const fixed = page.lock.length > 0;
  const calm = prefers("reduced-motion: reduce");
  let scene, shot, view, look, units = "metric", paths = "all", speed = 1;
  let now = 0, playing = false, started = 0, contactsOnly = true, rotations = null;
  let game = null;  // {state, verdict, option}: the state before this shot, and what gave it
  let verdict = null, choice = 0;  // on this shot
  const past = [];

  // ---- The parts of the page.
  const button = (label, name, onclick, more = {}) =>
    make("button", {type: "button", "aria-label": name, title: name, onclick, ...more}, label);
  const textButton = (label, onclick, more = {}) => make("button", {type: "button", onclick, ...more}, label);
  const select = (name, list, value, pick, more = {}) => {
    const box = make("select", {"aria-label": name, title: name, onchange: () => pick(box.value), ...more},
      ...list.map(([key, text]) => make("option", {value: key}, text)));
    box.value = value;
    return box;
  };
  const field = (label, ...inputs) => make("label", {class: "field"}, make("span", {}, label), ...inputs);
  const says = make("p", {class: "says", role: "status", "aria-live": "polite"});
  const stageBox = make("div", {class: "tables", tabindex: "0", role: "application",
    "aria-label":
      "Table. Left and right: aim. Up and down: speed. W A S D: tip. Space: shoot. Escape: back."});
  const clock = make("output", {class: "clock"});
  const scrub = make("input", {type: "range", min: "0", max: "1", step: "any", class: "scrub",
    "aria-label": "Time in seconds", oninput: () => { run(false); show(Number(scrub.value)); }});
  const playButton = button(icon(ICONS.play), "Shoot (space)", () => run(!playing), {class: "shoot"});
  const back = textButton("Back to aiming", () => { run(false); show(0); });
  const next = textButton("Next shot", () => nextShot());
  const undo = textButton("Undo", () => takeBack());
  const bar = make("div", {class: "bar", role: "group", "aria-label": "Playback"},
    button(icon(ICONS.back), "Previous event", () => jump(-1)), playButton,
    button(icon(ICONS.next), "Next event", () => jump(1)), clock, make("span", {class: "room"}),
    back, next, undo,
    select("Speed of playback", SPEEDS.map((x) => [String(x), `${x} ×`]), "1",
      (x) => { speed = Number(x); }),
    select("Predicted paths", [["all", "all paths"], ["cue", "cue ball's path"], ["off", "no paths"]], paths,
      (x) => { paths = x; show(now); }));
  const stage = make("section", {class: "stage card", "aria-label": "The table"}, stageBox,
    make("div", {class: "scrubbing"}, scrub), bar, says);

  // ---- The stroke.
  const number = (label, key, {min, max, step, digits, unit}, read, write) => {
    const attributes = {min, max, step, disabled: locked(key) ? "" : null};
    const slide = make("input", {type: "range", ...attributes, "aria-label": `${label}, ${unit()}`,
      oninput: () => change(write(Number(slide.value)))});
    const type = make("input", {type: "number", ...attributes, "aria-label": label,
      onchange: () => change(write(Number(type.value)))});
    const named = make("span", {});
    const element = make("label", {class: "field"}, named, type, slide);
    return {element, show: () => {
      const value = read();
      named.textContent = `${label} [${unit()}]`;
      slide.value = String(value);
      if (document.activeElement !== type) type.value = value.toFixed(digits);
    }};
  };
  const factor = () => UNITS[units].speed[0];
  const strokes = [
    number("Speed", "cue.speed", {min: 0, max: 30, step: 0.01, digits: 2, unit: () => UNITS[units].speed[1]},
      () => scene.cue.speed * factor(), (x) => ({"cue.speed": x / factor()})),
    number("Aim", "cue.aim_deg", {min: -180, max: 180, step: 0.01, digits: 2, unit: () => "°"},
      () => wrapped(scene.cue.aim_deg), (x) => ({"cue.aim_deg": x})),
    number("Cue raised", "cue.elevation_deg", {min: 0, max: 85, step: 0.5, digits: 1, unit: () => "°"},
      () => scene.cue.elevation_deg, (x) => ({"cue.elevation_deg": x})),
  ];
  const wrapped = (angle) => angle - 360 * Math.round(angle / 360);
  const tip = new TipPicture((side, height) => {
    if (!locked("cue.offset")) change({"cue.offset.side": side, "cue.offset.height": height});
  });
  const tipWords = make("span", {class: "tip-words"});
  const stroke = make("section", {class: "card stroke"}, make("h2", {}, "Stroke"),
    make("div", {class: "stroke-parts"}, make("div", {class: "tip-side"}, tip.element, tipWords),
      make("div", {}, ...strokes.map((s) => s.element))));

  // ---- The game.
  const gameBox = select("Game", GAMES, "", (name) => newGame(name));
  const gameText = make("p", {class: "game-text", role: "status", "aria-live": "polite"});
  const options = make("div", {class: "bar"});
  const callBall = select("Called ball", [["", "call a ball"]], "", () => judge());
  const callPocket = select("Called pocket", [["", "and a pocket"]], "", () => judge());
  const safety = make("input", {type: "checkbox", onchange: () => judge()});
  const pushOut = make("input", {type: "checkbox", onchange: () => judge()});
  const callRow = make("div", {class: "bar"}, callBall, callPocket, make("label", {}, safety, " safety"));
  const pushRow = make("div", {class: "bar"}, make("label", {}, pushOut, " push out"));
  const gameCard = make("section", {class: "card"},
    make("h2", {}, "Game"), make("div", {class: "bar"}, gameBox,
      textButton("Start again",
      () => newGame(gameBox.value), {disabled: fixed ? "" : null})), gameText, callRow, pushRow, options);

  // ---- Events.
  const list = make("ol", {class: "events"});
  const eventHead = make("h2", {});
  const events = make("section", {class: "card event-card"}, make("div", {class: "bar"}, eventHead,
    make("span", {class: "room"}), make("label", {}, make("input", {type: "checkbox",
      onchange: (e) => { contactsOnly = !e.target.checked; listEvents(); }}), " all")), list);

  // ---- Table, balls, scene.
  const tables = page.tables.map((name) => [name, name.replaceAll("_", " ")]);
  const tableBox = select("Table", tables, "nine_foot", (name) => begin(startOf("", name)));
  const clothBox = select("Cloth", CLOTHS, "", (name) => setOrDrop("table.cloth", name));
  const cushionBox = select("Cushion model", CUSHIONS, "", (name) => setOrDrop("physics.cushion", name));
  const MATERIAL = [["mu_s", "sliding friction", 0.01], ["mu_r", "rolling friction", 0.001],
    ["mu_b", "ball-ball friction", 0.01], ["e_b", "ball-ball restitution", 0.01],
    ["e_c", "cushion restitution", 0.01], ["f_c", "cushion friction", 0.01], ["mass", "mass [kg]", 0.001],
    ["radius", "radius [m]", 0.0001]];
  const materials = MATERIAL.map(([key, label, step]) => {
    const input = make("input", {type: "number", min: 0, step, disabled: locked("balls") ? "" : null,
      onchange: () => change({[`balls.${key}`]: Number(input.value)})});
    return {key, input, element: field(label, input)};
  });
  const whichBall = select("Ball to place", [], "", () => showPlace());
  const [placeX, placeY] = ["x", "y"].map((name) => make("input",
    {type: "number", step: "any", "aria-label": name, onchange: () => typedPlace()}));
  const placeUnit = make("span", {});
  const unitBox = select("Units", [["metric", "metric"], ["inch", "inches, mph"]], units,
    (x) => { units = x; tell(); listEvents(); showPlace(); });
  const numbers = make("input", {type: "checkbox", onchange: () => {
    view.numbered = numbers.checked;
    show(now);
  }});
  const setup = make("details", {class: "card setup"}, make("summary", {}, "Table, balls, units"),
    field("Table", tableBox), field("Cloth", clothBox), field("Cushions", cushionBox),
    field("Units", unitBox), make("label", {}, numbers, " number the diamonds"),
    make("fieldset", {}, make("legend", {}, "Place a ball ", placeUnit), whichBall, placeX, placeY),
    make("fieldset", {class: "materials"}, make("legend", {}, "Balls"), ...materials.map((m) => m.element)));
  for (const box of [tableBox, gameBox]) box.disabled = fixed || locked("table");
  for (const box of [clothBox, cushionBox]) box.disabled = locked("table");

  const sceneText = make("textarea", {spellcheck: "false", "aria-label": "Scene file", rows: "18"});
  const sceneError = make("p", {class: "error", role: "alert"});
  const dialog = make("dialog", {"aria-label": "Scene file"}, make("h2", {}, "Scene file"), sceneText,
    sceneError, make("div", {class: "bar"}, textButton("Use this scene", () => useText(),
      {disabled: fixed ? "" : null}),
      textButton("Copy", () => copy(sceneText.value)), textButton("Every value", () => {
        sceneText.value = scene.everything;
      }), make("label", {class: "file"}, "Open … ", make("input", {type: "file", accept: ".toml,text/plain",
        onchange: async (e) => { sceneText.value = await e.target.files[0].text(); }})),
      make("span", {class: "room"}), textButton("Close", () => dialog.close())));
  const address = make("input",
    {readonly: "", "aria-label": "Address of this shot", class: "address", hidden: ""});
  const hashText = make("code", {title: "Hash of all bits of this shot"});
  const shareCard = make("section", {class: "card"}, make("div", {class: "bar"},
    textButton("Share by address", () => share()),
    textButton("Scene file …", () => {
      sceneText.value = scene.toml;
      sceneError.textContent = "";
      dialog.showModal();
    }), ...playExtras(page, {scene: () => scene, shot: () => shot, change, locked,
      begin: (toml) => begin(toml)})), address, make("p", {class: "hash"}, "Hash ", hashText));
  const keys = make("p", {class: "keys"}, "Drag a ball to move it, drag elsewhere to aim. " +
    "Keys on the table: ← → aim (shift: 1°, alt: 0.01°), ↑ ↓ speed, W A S D tip, space shoot, Esc back, " +
    "Ctrl+Z undo.");
  document.body.append(
    make("header", {}, make("h1", {}, page.title), make("p", {class: "lead"}, page.lead)),
    make("main", {class: "play"}, stage,
      make("div", {class: "side"}, stroke, gameCard, events, setup, shareCard, keys)),
    make("footer", {},
      make("p", {}, "Made by ", make("code", {}, page.command), `, carom ${carom.version()}`)), dialog);

  // ---- Scenes and shots.
  function say(text, bad = false) {
    says.textContent = text;
    says.classList.toggle("error", bad);
  }

  /** Simulates a scene and shows it, or says why that cannot be. `fresh`: it has other balls or
   * another table. @returns whether it can */
  function use(candidate, fresh = false) {
    let played;
    try {
      played = simulate(candidate, LIMITS);
    } catch (error) {
      candidate.free();
      say(error.reason || error.message, true);
      return false;
    }
    if (shot && (!verdictHolds() || game?.shot !== shot)) shot.free();
    scene = candidate;
    shot = played;
    verdict = null;
    rotations = null;
    if (fresh) view = null;
    show(0);
    later();
    return true;
  }
  const verdictHolds = () => game !== null && game.shot !== undefined;

  /** A new table: looks and outlines are made again. */
  function begin(toml, remember = true, before = null) {
    const candidate = Scene.parse(toml), gameBefore = game, kept = past.length;
    say("");
    if (remember && scene) keep();
    game = before;
    run(false);
    if (use(candidate, true)) return redraw();
    game = gameBefore;
    past.length = kept;
  }
  function redraw() {
    look = scene.look();
    view = new TableView(shot.record, look.shape, look.styles, "The table from above");
    view.numbered = numbers.checked;
    view.over.onpointerdown = press;
    view.over.onpointermove = move;
    view.over.onpointerup = view.over.onpointercancel = release;
    view.over.addEventListener("wheel", turn, {passive: false});
    stageBox.replaceChildren(view.element);
    lay();
    fillLists();
    show(0);
    later();
  }
  function fillLists() {
    const option = (id) => make("option", {value: id}, id);
    whichBall.replaceChildren(...scene.balls.map((ball) => option(ball.id)));
    const pockets = scene.table.pockets.map(({id, name}) => make("option", {value: id}, name || id));
    callPocket.replaceChildren(make("option", {value: ""}, "and a pocket"), ...pockets);
    tableBox.value = scene.table.preset;
    clothBox.value = scene.table.cloth;
    gameBox.value = game ? game.state.game : "";
    showPlace();
    legal();
  }

  /** Tries a change of the scene. `quiet`: while a pointer moves. @returns whether it was made */
  function change(changes, {remember = true} = {}) {
    let candidate;
    try {
      candidate = scene.with(changes);
    } catch (error) {
      say(error.reason || error.message, true);
      tell();
      return false;
    }
    run(false);
    const before = scene;
    if (remember) keep();
    const shape = Object.keys(changes).some((key) => /^(table|balls\.radius)/.test(key));
    if (!use(candidate, shape)) {
      if (remember) past.pop();
      tell();
      return false;
    }
    if (before !== scene) before.free();
    say("");
    if (shape) redraw();
    return true;
  }
  /** Sets a text, or removes its line from the file. */
  function setOrDrop(key, name) {
    if (name !== "") return change({[key]: name});
    const [table, last] = key.split("."), lines = scene.toml.split("\n");
    const at = lines.findIndex((line) => line.trim().startsWith(`${last} =`) && table !== "");
    if (at >= 0) lines.splice(at, 1);
    begin(lines.join("\n"), true, game);
  }
  function keep() {
    const toml = scene.toml;
    if (past.length > 0 && past.at(-1).toml === toml && past.at(-1).game === game) return;
    past.push({toml, game});
    if (past.length > UNDO_LIMIT) past.shift();
  }
  function takeBack() {
    const before = past.pop();
    if (before === undefined) return say("There is nothing to undo.");
    begin(before.toml, false, before.game);
    say("Undone.");
  }

  // ---- Time.
  function show(t) {
    now = Math.min(Math.max(t, 0), shot.duration);
    const aiming = now === 0 && !playing, record = shot.record;
    if (view) {
      view.record = record;
      if (aiming) {
        view.orientation = () => [1, 0, 0, 0];
        const only = paths === "cue" && scene.cue ? shot.balls.indexOf(scene.cue.ball) : -1;
        const ahead = paths !== "off";
        view.draw(0, {trails: ahead ? "ball" : "off", until: record.duration, only, ends: ahead});
        if (scene.cue) drawCue();
      } else {
        view.orientation = rotations ??= orientations(record);
        view.draw(now, {trails: "ball"});
      }
    }
    if (aiming !== document.body.classList.contains("aiming")) {
      document.body.classList.toggle("aiming", aiming);
      label();
    }
    clock.textContent = `${now.toFixed(2)} s of ${shot.duration.toFixed(2)}`;
    scrub.max = String(shot.duration);
    scrub.value = String(now);
    scrub.style.setProperty("--done", `${shot.duration > 0 ? 100 * now / shot.duration : 0}%`);
    back.hidden = now === 0;
    next.hidden = now === 0;
    if (aiming) tell();
    markEvent();
  }

  /** The cue behind its ball, and the line of aim. */
  function drawCue() {
    const {cue} = scene, from = scene.balls.find((ball) => ball.id === cue.ball);
    if (!from) return;
    const angle = cue.aim_deg * Math.PI / 180, along = [Math.cos(angle), Math.sin(angle)];
    const at = (d, side = 0) => view.projection.at(from.x + d * along[0] - side * along[1],
      from.y + d * along[1] + side * along[0]);
    const context = view.over.getContext("2d"), R = from.radius, width = view.dense;
    context.save();
    const line = (a, b, colour, thick, dash = []) => {
      context.beginPath();
      context.moveTo(...a);
      context.lineTo(...b);
      context.setLineDash(dash);
      context.lineWidth = thick;
      context.strokeStyle = colour;
      context.stroke();
    };
    line(at(R), at(12 * R), "rgba(255, 255, 255, 0.75)", 1.2 * width, [5 * width, 4 * width]);
    const side = cue.side * R, gap = 1.25 * R + 0.02 * cue.speed;
    context.lineCap = "round";
    line(at(-gap - 0.012, side), at(-gap - 1.1, side), "#3a2414", 0.024 * view.projection.scale);
    line(at(-gap - 0.012, side), at(-gap - 0.75, side), "#d9b06c", 0.014 * view.projection.scale);
    line(at(-gap, side), at(-gap - 0.014, side), "#3f7fbf", 0.013 * view.projection.scale);
    context.restore();
  }

  function label() {
    const name = playing ? "Pause" : now === 0 ? "Shoot" : "Play";
    playButton.replaceChildren(icon(playing ? ICONS.pause : ICONS.play), name === "Shoot" ? "Shoot" : "");
    playButton.setAttribute("aria-label", `${name} (space)`);
    playButton.title = `${name} (space)`;
  }
  function run(on) {
    if (on === playing) return;
    playing = on;
    label();
    if (!on) { show(now); return; }
    if (now >= shot.duration) now = 0;
    if (now === 0) { keep(); judge(); }
    started = performance.now();
    requestAnimationFrame(tick);
  }
  function tick(time) {
    if (!playing) return;
    const passed = Math.min(Math.max(time - started, 0), 100) / 1000;
    started = time;
    const t = calm ? shot.duration : now + speed * passed;
    show(t);
    if (now < shot.duration) { requestAnimationFrame(tick); return; }
    run(false);
    ended();
  }
  function ended() {
    judge();
    const fell = shot.outcome.balls.filter((b) => b.pocket).sort((a, b) => a.fell - b.fell).map((b) => b.id);
    const gone = fell.length > 0 ? ` In pockets: ${fell.join(", ")}.` : "";
    say(`At rest after ${shot.duration.toFixed(2)} s.${gone}${verdict ? ` ${verdictWords(verdict)}` : ""}`);
  }
  const shownEvents = () => shot.events.filter((e) => !contactsOnly || isContact(e));
  function jump(direction) {
    run(false);
    const times = [...new Set(shownEvents().map((e) => e.time))];
    if (direction > 0) show(times.find((t) => t > now) ?? shot.duration);
    else show(times.filter((t) => t < now).at(-1) ?? 0);
  }

  // ---- Words.
  let waiting = 0;
  /** What need not follow a pointer at once: lists, the address. */
  function later() {
    clearTimeout(waiting);
    waiting = setTimeout(() => { listEvents(); legal(); showPlace(); }, 120);
  }
  function tell() {
    stroke.hidden = scene.cue === null;
    if (scene.cue) {
      for (const s of strokes) s.show();
      tip.show(scene.cue.side, scene.cue.height);
      tipWords.textContent = `Tip: ${tip.words}`;
    }
    const {material} = scene.describe();
    for (const {key, input} of materials)
      if (document.activeElement !== input) input.value = String(material[key]);
    hashText.textContent = shot.hash;
    undo.disabled = past.length === 0;
    document.body.dataset.hash = shot.hash;
  }
  let marked = null;
  function listEvents() {
    const all = shownEvents();
    marked = null;
    list.scrollTop = 0;
    eventHead.textContent = `Events (${all.length})`;
    list.replaceChildren(...all.map((e) => make("li", {}, make("button", {type: "button",
      onclick: () => { run(false); show(e.time); }}, make("time", {}, e.time.toFixed(3)),
    make("span", {}, eventWords(e, units))))));
    markEvent();
  }
  function markEvent() {
    if (!list.firstChild || playing && performance.now() - started > 50) return;
    const all = shownEvents();
    if (all.length !== list.children.length) return;
    let at = -1;
    if (now > 0) for (let i = 0; i < all.length && all[i].time <= now; ++i) at = i;
    const item = at >= 0 ? list.children[at].firstChild : null;
    if (item === marked) return;
    marked?.removeAttribute("aria-current");
    item?.setAttribute("aria-current", "true");
    marked = item;
    if (item) list.scrollTop = item.offsetTop - list.clientHeight / 2;
  }

  // ---- Placing balls.
  function showPlace() {
    const [k, name, digits] = UNITS[units].length, one = scene.balls.find((b) => b.id === whichBall.value);
    placeUnit.textContent = `[${name}]`;
    if (!one) return;
    placeX.value = (k * one.x).toFixed(digits + 1);
    placeY.value = (k * one.y).toFixed(digits + 1);
  }
  function typedPlace() {
    const [k] = UNITS[units].length;
    put(whichBall.value, Number(placeX.value) / k, Number(placeY.value) / k);
    showPlace();
  }
  /** Why a ball may not be moved there, or null. */
  function refusal(id, x, y) {
    if (locked("ball")) return "The balls of this scene are fixed.";
    if (!game) return null;
    const {state} = game;
    if (state.in_hand === "no" || id !== scene.cue?.ball)
      return "In a game only the cue ball may be moved, and only in hand.";
    if (game.judged)
      return game.judged.mayPlace(x, y, game.option) ? null : "The cue ball may not lie there.";
    const line = scene.table.corner[1] + scene.table.length / 4;
    return state.in_hand === "head string" && y >= line
      ? "For the break the cue ball is behind the head string." : null;
  }
  function put(id, x, y, settings) {
    const why = refusal(id, x, y);
    if (why !== null) { say(why, true); return false; }
    return change({[`ball.${id}.position.x`]: x, [`ball.${id}.position.y`]: y}, settings);
  }

  // ---- The pointer on the table.
  let held = null, pointed = null, asked = false;
  const placeOf = (event) => {
    const box = view.over.getBoundingClientRect();
    return view.projection.table((event.clientX - box.left) * view.dense,
      (event.clientY - box.top) * view.dense);
  };
  function press(event) {
    if (now > 0 || playing || event.button !== 0) return;
    view.over.setPointerCapture(event.pointerId);
    const ball = view.ballAt(event), [x, y] = placeOf(event);
    const id = ball >= 0 ? shot.balls[ball] : null, at = id && scene.balls.find((b) => b.id === id);
    held = at ? {id, dx: at.x - x, dy: at.y - y} : {id: null};
    held.kept = false;
    if (at) { whichBall.value = id; showPlace(); } else { pointed = [x, y]; follow(); }
  }
  function move(event) {
    if (held === null) {
      view.over.style.cursor = now > 0 ? "default" : view.ballAt(event) >= 0 ? "grab" : "crosshair";
      return;
    }
    pointed = placeOf(event);
    if (asked) return;
    asked = true;
    requestAnimationFrame(follow);
  }
  function follow() {
    asked = false;
    if (held === null || pointed === null) return;
    const remember = !held.kept;
    const [x, y] = pointed;
    if (held.id !== null) {
      if (put(held.id, x + held.dx, y + held.dy, {remember})) held.kept = true;
    } else if (scene.cue && !locked("cue.aim_deg")) {
      const from = scene.balls.find((b) => b.id === scene.cue.ball);
      const aim = Math.atan2(y - from.y, x - from.x) * 180 / Math.PI;
      if (change({"cue.aim_deg": Math.round(aim * 1000) / 1000}, {remember})) held.kept = true;
    }
  }
  function release() {
    held = pointed = null;
    later();
  }
  function turn(event) {
    if (now > 0 || !scene.cue || locked("cue.aim_deg")) return;
    event.preventDefault();
    nudge("aim_deg", Math.sign(event.deltaY) * (event.shiftKey ? 0.01 : 0.1));
  }

  // ---- Keys.
  function nudge(key, by) {
    if (now > 0 || !scene.cue || locked(`cue.${key}`)) return;
    const value = Math.round(1000 * (scene.cue[key] + by)) / 1000;
    change({[`cue.${key}`]: key === "speed" ? Math.max(0, value) : wrapped(value)});
  }
  const moveTip = (side, height) => tip.change(tip.side + side, tip.height + height);
  stageBox.addEventListener("keydown", (event) => {
    const step = event.altKey ? 0.01 : event.shiftKey ? 1 : 0.1, key = event.key.toLowerCase();
    if (event.ctrlKey || event.metaKey) return;
    const aiming = {arrowleft: () => nudge("aim_deg", step), arrowright: () => nudge("aim_deg", -step),
      arrowup: () => nudge("speed", step), arrowdown: () => nudge("speed", -step),
      a: () => moveTip(0.02, 0), d: () => moveTip(-0.02, 0),
      w: () => moveTip(0, 0.02), s: () => moveTip(0, -0.02)};
    const watching = {arrowleft: () => show(now - 1 / 60), arrowright: () => show(now + 1 / 60),
      arrowup: () => jump(-1), arrowdown: () => jump(1)};
    const action = (now > 0 ? watching : aiming)[key];
    if (!action) return;
    event.preventDefault();
    action();
  });
  document.addEventListener("keydown", (event) => {
    const typing = ["INPUT", "TEXTAREA", "SELECT"].includes(event.target.tagName) || dialog.open;
    if (event.key === " " && !typing && event.target.tagName !== "BUTTON") {
      event.preventDefault();
      run(!playing);
    } else if (event.key === "Escape" && !dialog.open) {
      run(false);
      show(0);
    } else if (event.key.toLowerCase() === "z" && (event.ctrlKey || event.metaKey) && !typing) {
      event.preventDefault();
      takeBack();
    }
  });

  // ---- Games.
  function newGame(name) {
    const wanted = {eight_ball: "nine_foot", nine_ball: "nine_foot", three_cushion: "carom"}[name];
    const table = scene.table.preset === "carom" || name === "three_cushion" ? wanted : scene.table.preset;
    const seed = 1 + Math.floor(Math.random() * 1e6);
    const state = name === "" ? null : games.start(name, {target: name === "three_cushion" ? 15 : 0});
    begin(startOf(name, table || scene.table.preset || "nine_foot", seed), true, state && {state, option: 0});
  }
  /** What the player may do, in words and lists. */
  function legal() {
    callRow.hidden = pushRow.hidden = true;
    if (!game) { gameText.textContent = ""; return; }
    const {state} = game;
    try {
      const may = games.legal(state, scene);
      const score = state.points.some((x) => x > 0) ? ` Points: ${state.points.join(" to ")}.` : "";
      const groups = state.game === "eight_ball" && state.group[state.turn] !== "open"
        ? ` Plays ${state.group[state.turn]}.` : "";
      const few = may.first.length > 0 && may.first.length < 8;
      const first = few ? ` Hit first: ${may.first.join(", ")}.` : "";
      gameText.textContent = `${sentence(may.text)}.${groups}${first}${score}`;
      callRow.hidden = may.callable.length === 0;
      pushRow.hidden = !may.mayPushOut;
      const chosen = callBall.value;
      callBall.replaceChildren(make("option", {value: ""}, "call a ball"),
        ...may.callable.map((id) => make("option", {value: id}, id)));
      callBall.value = may.callable.includes(chosen) ? chosen : "";
    } catch (error) {
      gameText.textContent = error.reason || error.message;
    }
  }
  const sentence = (text) => text.charAt(0).toUpperCase() + text.slice(1);
  function judge() {
    options.replaceChildren();
    verdict = null;
    choice = 0;
    if (!game) return;
    try {
      verdict = games.judge(game.state, shot, {ball: callBall.value, pocket: callPocket.value,
        safety: safety.checked, pushOut: pushOut.checked});
    } catch (error) {
      say(error.reason || error.message, true);
      return;
    }
    if (now === 0) return;
    const chooser = verdict.chooser >= 0 ? `Player ${verdict.chooser + 1} chooses:` : "";
    options.append(make("p", {}, verdictWords(verdict), " ", chooser));
    verdict.options.forEach((option, i) => {
      const several = verdict.options.length > 1;
      const label = sentence(several ? `${option.decision}: ${option.text}` : option.text);
      options.append(option.state.over ? make("p", {}, `${label}.`) : textButton(label, () => nextShot(i)));
    });
  }
  function nextShot(option = 0) {
    if (!game) return advance(shot.after(), null);
    if (verdict === null) judge();
    if (verdict === null) return;
    const {state, rerack} = verdict.options[option];
    if (state.over) return say(`${sentence(verdict.options[option].text)}.`);
    if (rerack)
      return begin(startOf(state.game, scene.table.preset, 1 + Math.floor(Math.random() * 1e6)), true,
        {state, option: 0});
    try {
      advance(verdict.next({option}), {state, judged: verdict, option, shot});
    } catch (error) {
      say(error.reason || error.message, true);
    }
  }
  function advance(after, then) {
    if (after.cue === null) {
      const [first] = after.balls;
      if (!first) return say("No ball is left on the table.");
      after = after.with({"cue.ball": first.id});
    }
    keep();
    game = then;
    options.replaceChildren();
    callPocket.value = "";
    safety.checked = pushOut.checked = false;
    run(false);
    if (use(after, true)) redraw();
  }

  // ---- Files and addresses.
  async function copy(text) {
    try {
      await navigator.clipboard.writeText(text);
      say("Copied.");
    } catch {
      say("This browser does not allow copying; select the text and copy it.");
    }
  }
  async function share() {
    const fragment = await fragmentOf(scene.toml, shot.hash);
    if (fragment.length > LONGEST_FRAGMENT)
      return say("This scene is too long for an address; copy its file.", true);
    history.replaceState(null, "", fragment);
    address.value = location.href;
    address.hidden = false;
    address.select();
    await copy(location.href);
    document.body.dataset.shared = fragment;
  }
  function useText() {
    sceneError.textContent = "";
    let candidate;
    try {
      candidate = Scene.parse(sceneText.value, "scene");
      simulate(candidate, LIMITS).free();
    } catch (error) {
      const {line} = error, reason = error.reason || error.message;
      sceneError.textContent = line > 0 ? `Line ${line}: ${reason}` : reason;
      if (line > 0) {
        const lines = sceneText.value.split("\n");
        const start = lines.slice(0, line - 1).reduce((sum, text) => sum + text.length + 1, 0);
        sceneText.focus();
        sceneText.setSelectionRange(start, start + lines[line - 1].length);
        sceneText.scrollTop = Math.max(0, (line - 4) * sceneText.scrollHeight / lines.length);
      }
      return;
    }
    candidate.free();
    dialog.close();
    begin(sceneText.value);
  }
  async function openAddress() {
    let found = null;
    try {
      found = await sceneInFragment(location.hash);
    } catch (error) {
      return error.message;
    }
    if (found === null) return null;
    if (fixed) return "This page shows its own scene only, not that of the address.";
    try {
      begin(found.toml, false);
    } catch (error) {
      return `The scene in the address is not valid: ${error.message}`;
    }
    if (!shot) return "The scene in the address cannot be played.";
    return shot.hash === found.hash ? `The same bits as where this address was made: ${shot.hash}.`
      : `Other bits than where this address was made (${found.hash}): another version of carom made it.`;
  }

  // ---- Size and start.
  function lay() {
    if (!view) return;
    const beside = matchMedia("(max-height: 520px) and (orientation: landscape)").matches;
    const rest = beside ? 92 : window.innerWidth > 900 ? 240 : 200;
    view.fit(Math.max(stageBox.clientWidth, 200), Math.max(window.innerHeight - rest, beside ? 180 : 260));
    show(now);
  }
  window.addEventListener("resize", () => requestAnimationFrame(lay));
  window.addEventListener("hashchange", async () => {
    const said = await openAddress();
    if (said) say(said);
  });
  const opened = await openAddress();
  if (!shot) begin(page.scene || startOf("", "nine_foot"), false);
  if (opened) say(opened);
  onWidth(stageBox, lay);
  globalThis.caromPlay = {scene: () => scene, shot: () => shot, change, show, run, begin, newGame, share};
  document.body.dataset.ready = "true";
})();
