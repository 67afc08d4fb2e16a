// The page of a shot: time, keys, the list of events, the balls, and charts.
"use strict";

{
  const page = pageData("page"), record = pageData("shot"), second = pageData("second");
  const FRAME = 1 / 60, SPEEDS = [0.05, 0.1, 0.25, 0.5, 1, 2, 4];  // [s] and times real time
  const STILL = 900;  // [ms] how long each still is shown
  const end = record.duration, calm = prefers("reduced-motion: reduce");
  const ids = record.tracks.map((track) => track.id);
  const view = new TableView(record, page.shape, page.styles, "The table from above");
  const beside =
    second && new TableView(second, page.second.shape, page.second.styles, "The table of the second shot");
  const words = (type) => type.replaceAll("_", " ");
  const partner = (record, e) => {
    const {jaws, pockets, cushions} = record.table;
    const lists = {ball_jaw: jaws, ball_edge: pockets, ball_pocket: pockets, ball_cushion: cushions};
    if (e.b < 0) return "";
    const kind = Object.keys(lists).find((name) => e.type.startsWith(name));
    return (kind ? lists[kind] : record.tracks)[e.b].id;
  };
  let now = 0, playing = false, speed = 1, trails = "state", mode = second ? "over" : "off";
  let marked = -1, hovered = -1, chosen = -1, last = 0;

  // ---- The parts of the page.
  const button = (label, name, onclick) =>
    make("button", {type: "button", "aria-label": name, title: name, onclick}, label);
  const play = button(icon(ICONS.play), "Play (space)", () => run(!playing));
  const clock = make("output", {class: "clock"});
  const scrub = make("input", {type: "range", min: "0", max: String(end), step: "any",
    "aria-label": "Time in seconds", class: "scrub",
    oninput: () => { run(false); show(Number(scrub.value)); }});
  const ticks = make("div", {class: "ticks", "aria-hidden": "true"});
  const select = (name, list, value, pick) => {
    const onchange = () => { pick(box.value); box.blur(); };
    const box = make("select", {"aria-label": name, title: name, onchange},
      ...list.map(([key, text]) => make("option", {value: key}, text)));
    box.value = value;
    return box;
  };
  const factors = SPEEDS.map((x) => [String(x), `${x} ×`]);
  const speeds = select("Speed", factors, "1", (x) => { speed = Number(x); });
  const trailKinds = [["state", "trails: state"], ["ball", "trails: ball"], ["off", "no trails"]];
  const trailBox = select("Trails", trailKinds, trails, (x) => { trails = x; show(now); });
  const kinds = [["over", "second over"], ["beside", "second beside"], ["off", "second off"]];
  const modes = second && select("Second shot", kinds, mode, (x) => { mode = x; lay(); });
  const tip = make("div", {class: "tip", hidden: ""});
  const tables = make("div", {class: "tables"}, view.element, beside && beside.element, tip);
  const spoken = make("p", {class: "spoken", role: "status", "aria-live": "polite"});
  const bar = make("div", {class: "bar", role: "group", "aria-label": "Playback"},
    button(icon(ICONS.back), "Previous event (arrow up)", () => jump(-1)), play,
    button(icon(ICONS.next), "Next event (arrow down)", () => jump(1)),
    clock, make("span", {class: "room"}), speeds, trailBox, modes);
  const keys = "Space: play or pause. ← →: one frame. ↑ ↓: one event. Home, End. + −: speed. T: trails. " +
    "D: numbers of the diamonds.";
  const stage = make("section", {class: "stage card", "aria-label": "The shot"}, tables,
    make("div", {class: "scrubbing"}, scrub, ticks), bar, make("p", {class: "keys"}, keys), spoken);

  // ---- Balls.
  const flies = record.tracks.some((track) => track.segments.some((s) => s.state === "airborne"));
  const columns = ["ball", "state", "m/s", "turns/s", ...(flies ? ["mm high"] : []),
    ...(second ? ["mm apart"] : [])];
  const rows = record.tracks.map((track, i) => {
    const swatch = make("i", {class: page.styles[i].pattern});
    swatch.style.setProperty("--ball", cssColour(page.styles[i].color));
    const cells = columns.slice(1).map((name) => make("td", {class: name === "state" ? null : "number"}));
    const toggle = () => mark(marked === i ? -1 : i);
    const onkeydown = (event) => { if (event.key === "Enter") toggle(); };
    const row = make("tr", {tabindex: "0", onclick: toggle, onkeydown},
      make("th", {scope: "row"}, swatch, track.id), ...cells);
    return {row, cells};
  });
  const heads = make("tr", {}, ...columns.map((name) => make("th", {scope: "col"}, name)));
  const balls = make("section", {class: "card"}, make("h2", {}, "Balls"), make("div", {class: "scroll"},
    make("table", {}, make("thead", {}, heads), make("tbody", {}, ...rows.map((r) => r.row)))));

  // ---- Events.
  const items = record.events.map((e, i) => {
    const pair = () => [ids[e.a], partner(record, e)].filter((x) => x).join(" – ");
    const who = e.balls ? e.balls.map((b) => ids[b]).join(", ") : pair();
    const detail = () => [words(e.method), e.steps > 0 ? `${e.steps} steps` : "",
      e.kernel_ns > 0 ? duration(e.kernel_ns) : ""].filter((x) => x).join(", ");
    const cost = !record.profiled || !e.method ? null : make("small", {}, detail());
    const title = !record.profiled ? null : `detection ${duration(e.detect_ns)}, ` +
      `resolution ${duration(e.resolve_ns)} including kernel ${duration(e.kernel_ns)}`;
    return make("li", {},
      make("button", {type: "button", onclick: () => { run(false); show(e.time, i); }, title},
        make("time", {}, e.time.toFixed(4)),
        make("span", {}, make("b", {}, words(e.type)), ` ${who}`, cost)));
  });
  const list = make("ol", {class: "events"}, ...items);
  const events = make("section", {class: "card"}, make("h2", {}, `Events (${items.length})`), list);
  for (const e of record.events) {
    const stroke = make("i", {class: e.type.startsWith("ball_") ? "hit" : null});
    stroke.style.left = `${end > 0 ? 100 * e.time / end : 0}%`;
    ticks.append(stroke);
  }

  // ---- Charts.
  const grid = [...Array(241).keys()].map((k) => end * k / 240);
  const edges = record.events.flatMap((e) => [Math.max(0, e.time - 1e-9), e.time]);
  const times = [...new Set(grid.concat(edges))].sort((a, b) => a - b);
  const seconds = {title: "s", low: 0, high: Math.max(end, 1e-3), unit: "s"};
  const dark = prefers("color-scheme: dark"), sum = times.map((t) => energiesAt(record, t));
  const hits = record.events.filter((e) => e.type.startsWith("ball_")).map((e) => e.time);
  const pick = (t) => { run(false); show(t); }, size = (v) => Math.hypot(v[0], v[1], v[2]);
  const inkOf = (color) => {
    const bright = 0.3 * color[0] + 0.6 * color[1] + 0.1 * color[2];
    return !dark && bright > 0.8 ? "#a89f8a" : dark && bright < 0.2 ? "#8d8d96" : cssColour(color);
  };
  const some = (i, has) => record.tracks[i].segments.some(has);
  const moving = ids.map((id, i) => i).filter((i) => some(i, (s) => size(s.v) > 0));
  const flying = moving.filter((i) => some(i, (s) => s.state === "airborne"));
  const energy = (name, key) => ({name, line: true, points: times.map((t, k) => [t, sum[k][key]])});
  const ofBall = (i, value) => ({name: ids[i], stroke: inkOf(page.styles[i].color), line: true,
    points: times.map((t) => [t, stateAt(record, i, t)]).filter(([, s]) => !isGone(s.state))
      .map(([t, s]) => [t, value(s)])});
  const contacts = [{name: "contacts", at: hits}];
  const energies = [energy("motion", "moving"), energy("rotation", "turning"),
    ...(flies ? [energy("height", "raised")] : [])];
  const charts = [
    chart({title: "Speed of every ball", height: 190, x: seconds, y: {title: "m/s", low: 0}, ticks: contacts,
      series: moving.map((i) => ofBall(i, (s) => size(s.v)))}, pick),
    chart({title: "Energy", height: 190, x: seconds, y: {title: "J", low: 0}, ticks: contacts,
      series: energies}, pick),
    flies && chart({title: "Height above the cloth", height: 150, x: seconds, y: {title: "mm", low: 0},
      series: flying.map((i) => ofBall(i, (s) => 1000 * Math.max(0, s.r[2] - radiusOf(record, i))))}, pick),
    page.margin && chart({...page.margin, x: {...page.margin.x, ...seconds, title: page.margin.x.title},
      height: 230}, pick),
  ].filter((x) => x);

  pageFrame(page, make("div", {class: "shot"}, stage, make("div", {class: "side"}, balls, events)),
    make("div", {class: "charts"}, ...charts.map((c) => c.element)));

  // ---- Time.
  function eventBefore(t) {
    return record.events.length > 0 && record.events[0].time <= t ? lastBefore(record.events, t, "time") : -1;
  }

  /** Shows an instant; `event`: which event to mark, if several have this time. */
  function show(t, event = -1) {
    now = Math.min(Math.max(t, 0), end);
    const options = {trails, marked: hovered >= 0 ? hovered : marked, ghost: mode === "over" ? second : null};
    view.draw(now, options);
    if (mode === "beside") beside.draw(now, {trails, marked});
    clock.textContent = `${now.toFixed(3)} s of ${end.toFixed(3)}`;
    scrub.value = String(now);
    scrub.style.setProperty("--done", `${end > 0 ? 100 * now / end : 0}%`);
    for (const c of charts) c.cursor(now);
    const states = record.tracks.map((track, i) => ({i, id: track.id, ...stateAt(record, i, now)}));
    const told = states.map(({id, r, state}) => ({id, x: r[0], y: r[1], z: r[2], state}));
    document.body.dataset.state = JSON.stringify(told);
    if (!playing || performance.now() - last > 100) tell(states, event);
  }

  /** Updates what need not change in every frame: lists, numbers, the address. */
  function tell(states, event) {
    last = performance.now();
    for (const s of states) {
      const {row, cells} = rows[s.i], gone = isGone(s.state), R = radiusOf(record, s.i);
      const other = second && second.tracks.findIndex((track) => track.id === s.id);
      const place = s.pocket >= 0 ? `in ${record.table.pockets[s.pocket].id}` : words(s.state);
      const apart = () =>
        1000 * Math.hypot(...stateAt(second, other, now).r.map((x, k) => x - s.r[k]));
      const turns = size(s.w) / (2 * Math.PI), values = [place, size(s.v).toFixed(2), turns.toFixed(1)];
      if (flies) values.push((1000 * Math.max(0, s.r[2] - R)).toFixed(0));
      if (second) values.push(other < 0 ? "" : apart().toFixed(1));
      if (gone) values.fill("", 1);
      cells.forEach((cell, k) => { if (cell.textContent !== values[k]) cell.textContent = values[k]; });
      row.className = [gone ? "gone" : "", s.i === marked ? "marked" : ""].join(" ");
    }
    const at = event >= 0 ? event : eventBefore(now);
    if (at !== chosen) {
      if (chosen >= 0) items[chosen].firstChild.removeAttribute("aria-current");
      chosen = at;
      if (at >= 0) {
        items[at].firstChild.setAttribute("aria-current", "true");
        list.scrollTop = items[at].offsetTop - list.clientHeight / 2;
      }
    }
    showTip(states);
    if (playing) return;
    const busy = states.filter((s) => size(s.v) > 0).length;
    const latest = at >= 0 ? ` Last event: ${words(record.events[at].type)}.` : "";
    const sentence = `${now.toFixed(3)} seconds. ${busy} of ${states.length} balls move.${latest}`;
    spoken.textContent = sentence;
    scrub.setAttribute("aria-valuetext", sentence);
    // A page inside another one has no address of its own.
    try { history.replaceState(null, "", `#t=${Number(now.toFixed(9))}`); } catch { /* see above */ }
  }

  function showTip(states) {
    const i = hovered >= 0 ? hovered : marked, ball = i < 0 ? undefined : view.seen.find((b) => b.i === i);
    tip.hidden = ball === undefined;
    if (tip.hidden) return;
    const s = states[i], mm = (x) => (1000 * x).toFixed(1);
    tip.replaceChildren(make("b", {}, s.id), ` ${words(s.state)}`, make("br"),
      `x ${mm(s.r[0])}, y ${mm(s.r[1])}, z ${mm(s.r[2])} mm`, make("br"),
      `v ${s.v.map((x) => x.toFixed(3)).join(", ")} m/s`, make("br"),
      `w ${s.w.map((x) => x.toFixed(1)).join(", ")} rad/s`);
    const x = view.element.offsetLeft + ball.x / view.dense, y = view.element.offsetTop + ball.y / view.dense;
    const r = ball.r / view.dense + 8, below = y + r + tip.offsetHeight < tables.clientHeight;
    tip.style.left = `${Math.min(Math.max(x + r, 4), tables.clientWidth - tip.offsetWidth - 4)}px`;
    tip.style.top = `${below ? y + r : Math.max(4, y - r - tip.offsetHeight)}px`;
  }

  function mark(i) {
    marked = i;
    show(now);
  }

  function jump(direction) {
    run(false);
    show(eventTime(direction));
  }
  function eventTime(direction) {
    const list = record.events, at = eventBefore(now);
    if (direction > 0) return list[at + 1] ? list[at + 1].time : end;
    let i = at;
    while (i >= 0 && list[i].time >= now) --i;
    return i >= 0 ? list[i].time : 0;
  }

  let started = 0;
  function run(on) {
    if (on === playing) return;
    playing = on;
    play.replaceChildren(icon(on ? ICONS.pause : ICONS.play));
    play.setAttribute("aria-label", on ? "Pause (space)" : "Play (space)");
    if (!on) { show(now); return; }
    if (now >= end) now = 0;
    started = performance.now();
    requestAnimationFrame(tick);
  }
  function tick(time) {
    if (!playing) return;
    if (calm) {  // Users who prefer less motion get stills, one event after the other.
      if (time - started >= STILL) { started = time; show(eventTime(1)); }
    } else {
      const passed = Math.min(Math.max(time - started, 0), 100) / 1000;
      started = time;
      show(now + speed * passed);
    }
    if (now >= end) run(false);
    else requestAnimationFrame(tick);
  }

  // ---- Keys, pointer, size, address.
  function setSpeed(turn) {
    speed = SPEEDS[Math.min(Math.max(SPEEDS.indexOf(speed) + turn, 0), SPEEDS.length - 1)];
    speeds.value = String(speed);
  }
  const actions = {" ": () => run(!playing), ArrowLeft: () => pick(now - FRAME),
    ArrowRight: () => pick(now + FRAME), ArrowUp: () => jump(-1), ArrowDown: () => jump(1),
    Home: () => pick(0), End: () => pick(end), "+": () => setSpeed(1), "-": () => setSpeed(-1),
    Escape: () => mark(-1),
    d: () => { view.numbered = !view.numbered; show(now); },
    t: () => { trailBox.selectedIndex = (trailBox.selectedIndex + 1) % 3; trailBox.onchange(); }};
  document.addEventListener("keydown", (event) => {
    const on = event.target, action = actions[event.key] || actions[event.key.toLowerCase()];
    const pressed = event.ctrlKey || event.metaKey || event.altKey;
    const taken = on.tagName === "SELECT" || (event.key === " " && on.tagName === "BUTTON");
    if (!action || pressed || taken) return;
    event.preventDefault();
    action();
  });
  view.over.onpointermove = (event) => {
    const i = view.ballAt(event);
    if (i === hovered) return;
    hovered = i;
    if (!playing) show(now);
  };
  view.over.onpointerleave = () => { hovered = -1; if (!playing) show(now); };
  view.over.onclick = (event) => { const i = view.ballAt(event); mark(i === marked ? -1 : i); };

  function lay() {
    const both = mode === "beside", wide = tables.clientWidth;
    const room = Math.max(0.62 * window.innerHeight, 260);
    if (beside) beside.element.hidden = !both;
    view.fit(both && wide > 700 ? wide / 2 - 5 : wide, room);
    if (both) beside.fit(wide > 700 ? wide / 2 - 5 : wide, room);
    show(now);
  }
  function address() {
    const t = Number(new URLSearchParams(location.hash.slice(1)).get("t"));
    return Number.isFinite(t) ? t : 0;
  }
  window.addEventListener("hashchange", () => {
    if (Math.abs(address() - now) > 1e-9) pick(address());
  });
  onWidth(tables, lay);
  now = Math.min(Math.max(address(), 0), end);
  lay();
  globalThis.carom = {record, show, now: () => now};
  document.body.dataset.ready = "true";
}
