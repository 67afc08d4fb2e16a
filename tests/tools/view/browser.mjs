// node browser.mjs MANIFEST.json [PICTURES]: opens pages in headless Chromium, drives them by its DevTools protocol, and prints a line for
// everything that is not as the manifest says; exit status 1 then. The manifest: {chromium, profile, pages: [{name, file, bounds, times,
// states, second: {time, apart} where there is a second shot}], reports: [{name, file, column, command}]}, where states[k] is the list of {id, x, y, z, state, radius} at times[k]. With PICTURES, screenshots go to that folder.
import {spawn} from "node:child_process";
import {readFileSync, writeFileSync} from "node:fs";
import {pathToFileURL} from "node:url";

const manifest = JSON.parse(readFileSync(process.argv[2], "utf8")), pictures = process.argv[3];
let faults = 0;
const fault = (page, text) => { ++faults; console.log(`${page}: ${text}`); };

/** A browser behind two pipes, file descriptors 3 and 4: messages are JSON, each with a 0 behind it. */
class Browser {
  constructor() {
    this.process = spawn(manifest.chromium, ["--headless=new", "--no-sandbox", "--disable-gpu", "--hide-scrollbars", "--remote-debugging-pipe",
      "--host-resolver-rules=MAP * ~NOTFOUND", "--no-first-run", "--disable-background-networking", `--user-data-dir=${manifest.profile}`, "about:blank"],
    {stdio: ["ignore", "ignore", "ignore", "pipe", "pipe"]});
    this.waiting = new Map();
    this.listeners = [];
    this.next = 0;
    let text = "";
    this.process.stdio[4].setEncoding("utf8").on("data", (data) => {
      text += data;
      for (let end; (end = text.indexOf("\0")) >= 0; text = text.slice(end + 1)) this.receive(JSON.parse(text.slice(0, end)));
    });
    this.process.on("exit", () => { for (const {reject} of this.waiting.values()) reject(new Error("the browser ended")); });
  }
  receive(message) {
    const call = this.waiting.get(message.id);
    if (!call) { this.listeners.forEach((listen) => listen(message)); return; }
    this.waiting.delete(message.id);
    if (message.error) call.reject(new Error(message.error.message));
    else call.resolve(message.result);
  }
  send(method, params = {}, sessionId = this.session) {
    const id = ++this.next;
    this.process.stdio[3].write(JSON.stringify({id, method, params, sessionId}) + "\0");
    return new Promise((resolve, reject) => this.waiting.set(id, {resolve, reject}));
  }
  async open() {
    const {targetId} = await this.send("Target.createTarget", {url: "about:blank"}, undefined);
    this.session = (await this.send("Target.attachToTarget", {targetId, flatten: true}, undefined)).sessionId;
    for (const domain of ["Page", "Runtime", "Log", "Network"]) await this.send(`${domain}.enable`);
  }
  async value(expression) {
    const {result, exceptionDetails} = await this.send("Runtime.evaluate", {expression, returnByValue: true, awaitPromise: true});
    if (exceptionDetails) throw new Error(exceptionDetails.exception?.description || exceptionDetails.text);
    return result.value;
  }
  async until(expression) {
    for (let i = 0; i < 400; ++i) {
      if (await this.value(expression)) return;
      await new Promise((resolve) => setTimeout(resolve, 25));
    }
    throw new Error(`never true: ${expression}`);
  }
  async size(width, height, mobile = false) {
    await this.send("Emulation.setDeviceMetricsOverride", {width, height, deviceScaleFactor: mobile ? 2 : 1, mobile});
  }
  async media(scheme, motion = "no-preference") {
    await this.send("Emulation.setEmulatedMedia", {features: [{name: "prefers-color-scheme", value: scheme}, {name: "prefers-reduced-motion", value: motion}]});
  }
  async key(key, code = key) {
    for (const type of ["keyDown", "keyUp"]) await this.send("Input.dispatchKeyEvent", {type, key, code, text: type === "keyDown" && key.length === 1 ? key : undefined});
  }
  async mouse(type, x, y) {
    await this.send("Input.dispatchMouseEvent", {type, x, y, button: "left", buttons: type === "mouseReleased" ? 0 : 1, clickCount: 1});
  }
  async picture(name) {
    if (!pictures) return;
    const {data} = await this.send("Page.captureScreenshot", {format: "png"});
    writeFileSync(`${pictures}/${name}.png`, Buffer.from(data, "base64"));
  }
}

const near = (a, b, by = 1e-9) => Math.abs(a - b) <= by;
const settled = "new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() => done(true))))";

/** What stands on the upper canvas at the balls: cover of the disc, its mean colour, and cover well outside. */
function pixels(places) {
  return `(() => { const canvas = document.querySelectorAll(".table canvas")[1], copy = new OffscreenCanvas(canvas.width, canvas.height).getContext("2d", {willReadFrequently: true});
    copy.drawImage(canvas, 0, 0);
    const data = copy.getImageData(0, 0, canvas.width, canvas.height).data;
    return ${JSON.stringify(places)}.map(([x, y, r]) => { x *= canvas.width; y *= canvas.height; r *= Math.hypot(canvas.width, canvas.height); let n = 0, opaque = 0, sum = [0, 0, 0];
      for (let j = -r; j <= r; ++j) for (let i = -r; i <= r; ++i) { if (Math.hypot(i, j) > 0.8 * r) continue; const at = 4 * (Math.floor(y + j) * canvas.width + Math.floor(x + i));
        ++n; opaque += data[at + 3] === 255; for (let k = 0; k < 3; ++k) sum[k] += data[at + k]; }
      return {n, opaque, mean: sum.map((s) => s / n / 255)}; }); })()`;
}

/** Where a place of the table is on the canvas, as shares of its width and height: lengthwise along the longer side. */
function share(bounds, lying, x, y) {
  const [u, v] = [(x - bounds.low[0]) / (bounds.high[0] - bounds.low[0]), (y - bounds.low[1]) / (bounds.high[1] - bounds.low[1])];
  return lying ? [v, u] : [u, 1 - v];
}

async function checkInstants(browser, page) {
  const [width, height] = await browser.value(`(() => { const c = document.querySelector(".table canvas"); return [c.width, c.height]; })()`);
  const {bounds} = page, sides = [bounds.high[0] - bounds.low[0], bounds.high[1] - bounds.low[1]];
  const aspect = Math.max(...sides) / Math.min(...sides), exact = near(Math.max(width, height) / Math.min(width, height), aspect, 0.02);
  for (const [k, t] of page.times.entries()) {
    await browser.value(`location.hash = "#t=${t}"`);
    await browser.until(`carom.now() === ${t}`);
    await browser.value(settled);
    const here = JSON.parse(await browser.value("document.body.dataset.state")), expected = page.states[k];
    for (const [i, ball] of expected.entries())
      for (const key of ["id", "state", "x", "y", "z"])
        if (here[i][key] !== ball[key]) fault(page.name, `at ${t} s ${ball.id} has ${key} ${here[i][key]} instead of ${ball[key]}`);
    if (!exact) continue;  // an outline that is nearly a line is not drawn to the edges of the canvas
    const lying = width > height, inPlay = expected.map((ball, i) => ({...ball, i})).filter((ball) => !["pocketed", "out", "falling", "airborne"].includes(ball.state));
    const diagonal = Math.hypot(...sides), found = await browser.value(pixels(inPlay.map((ball) => [...share(bounds, lying, ball.x, ball.y), ball.radius / diagonal])));
    for (const [j, {n, opaque, mean}] of found.entries()) {
      const ball = inPlay[j];
      if (n === 0 || opaque < n) fault(page.name, `at ${t} s ${ball.id} covers ${opaque} of ${n} pixels of its place`);
      if (Math.max(...mean) < 0.02) fault(page.name, `at ${t} s ${ball.id} is black`);
    }
    const away = await browser.value(pixels([[0.5, 0.004, 0.001]]));
    if (away[0].opaque > 0) fault(page.name, `at ${t} s something is drawn on the rail`);
  }
}

async function checkKeys(browser, page, events, end) {
  const now = () => browser.value("carom.now()");
  await browser.key("Home");
  if (await now() !== 0) fault(page.name, "Home does not go to the start");
  await browser.key("ArrowDown");
  const first = events.find((t) => t > 0) ?? end;
  if (await now() !== first) fault(page.name, `arrow down goes to ${await now()} and not to the event at ${first}`);
  await browser.key("ArrowUp");
  if (await now() !== 0) fault(page.name, `arrow up goes to ${await now()}`);
  await browser.key("ArrowRight");
  if (!near(await now(), Math.min(1 / 60, end))) fault(page.name, `arrow right goes to ${await now()}`);
  await browser.key("ArrowLeft");
  await browser.key("End");
  if (await now() !== end) fault(page.name, "End does not go to the end");
  await browser.key("Home");
  await browser.key(" ", "Space");
  await browser.until(`carom.now() > ${0.05 * end}`);
  await browser.key(" ", "Space");
  const stopped = await now();
  await browser.value(settled);
  if (await now() !== stopped || stopped > end) fault(page.name, "space does not stop");
}

async function checkScrubbing(browser, page, end) {
  await browser.value(`document.querySelector(".scrub").scrollIntoView({block: "center"})`);
  const box = await browser.value(`(() => { const b = document.querySelector(".scrub").getBoundingClientRect(); return [b.left, b.top, b.width, b.height]; })()`);
  await browser.mouse("mousePressed", box[0] + 0.25 * box[2], box[1] + box[3] / 2);
  await browser.mouse("mouseMoved", box[0] + 0.5 * box[2], box[1] + box[3] / 2);
  await browser.mouse("mouseReleased", box[0] + 0.5 * box[2], box[1] + box[3] / 2);
  const t = await browser.value("carom.now()");
  if (!near(t, 0.5 * end, 0.01 * end)) fault(page.name, `scrubbing to the middle goes to ${t} of ${end}`);
}

async function checkLists(browser, page, events) {
  const last = events.length - 1;
  await browser.value(`document.querySelectorAll(".events button")[${last}].click()`);
  if (await browser.value("carom.now()") !== events[last]) fault(page.name, "a click on an event does not go there");
  const marked = await browser.value(`[...document.querySelectorAll(".events button")].findIndex((b) => b.getAttribute("aria-current"))`);
  if (marked !== last) fault(page.name, `event ${marked} is marked instead of ${last}`);
  const unnamed = await browser.value(`[...document.querySelectorAll("button, input, select, canvas[role], .plot")].filter((e) => !(e.getAttribute("aria-label") || e.textContent.trim())).length`);
  if (unnamed > 0) fault(page.name, `${unnamed} controls have no name for a screen reader`);
  const wide = await browser.value("document.documentElement.scrollWidth - document.documentElement.clientWidth");
  if (wide > 0) fault(page.name, `the page is ${wide} pixels too wide`);
}

/** The page of a hostile file shows its texts as texts. */
async function checkTexts(browser, page) {
  const shown = await browser.value(`[...document.querySelectorAll("tbody th")].map((th) => th.textContent)`);
  const ids = page.states[0].map((ball) => ball.id);
  if (JSON.stringify(shown) !== JSON.stringify(ids)) fault(page.name, `shows the balls ${JSON.stringify(shown)} instead of ${JSON.stringify(ids)}`);
  if (await browser.value(`document.querySelectorAll("body > script:not([type])").length`) !== 6) fault(page.name, "has scripts that it should not have");
}

/** Two shots: over, beside and off; and what the list says about how far apart balls are. */
async function checkSecond(browser, page) {
  const drawn = () => browser.value(`(() => { const canvas = document.querySelectorAll(".table canvas")[1], copy = new OffscreenCanvas(canvas.width, canvas.height).getContext("2d", {willReadFrequently: true});
    copy.drawImage(canvas, 0, 0); let sum = 0; for (const x of copy.getImageData(0, 0, canvas.width, canvas.height).data) sum = (31 * sum + x) % 1000000007; return sum; })()`);
  const choose = async (mode) => {
    await browser.value(`(() => { const s = document.querySelector("select[aria-label='Second shot']"); s.value = "${mode}"; s.onchange(); })()`);
    await browser.value(settled);
  };
  await browser.size(1400, 1000);
  await browser.value(settled);
  await browser.value(`carom.show(${page.second.time})`);
  await choose("over");
  const over = await drawn();
  const apart = await browser.value(`Number(document.querySelector("tbody tr td:last-child").textContent)`);
  if (!near(apart, page.second.apart, 0.051)) fault(page.name, `says the first ball is ${apart} mm from the other shot's, not ${page.second.apart}`);
  await choose("off");
  if (await drawn() === over) fault(page.name, "the second shot is not drawn over the first");
  if (await browser.value(`document.querySelectorAll(".table")[1].clientWidth`) !== 0) fault(page.name, "the second table is there without being asked for");
  await choose("beside");
  const [first, second] = await browser.value(`[...document.querySelectorAll(".table")].map((t) => { const b = t.getBoundingClientRect(); return [b.left, b.right, b.top, b.width]; })`);
  if (!(second[0] >= first[1] && second[2] === first[2] && second[3] === first[3] && first[3] > 300)) fault(page.name, `beside: ${first} and ${second}`);
  await browser.picture(`${page.name}_beside`);
}

async function checkPolicy(browser, page) {
  const broken = await browser.value(`new Promise((done) => { document.addEventListener("securitypolicyviolation", (e) => done(e.effectiveDirective));
    const s = document.createElement("script"); s.textContent = "document.body.dataset.harmed = 1"; document.body.append(s); setTimeout(() => done("nothing"), 2000); })`);
  if (broken !== "script-src-elem") fault(page.name, `a script from elsewhere is met by ${broken}`);
  if (await browser.value("document.body.dataset.harmed")) fault(page.name, "a script from elsewhere has run");
  const loaded = await browser.value(`fetch("https://example.com/").then(() => "loaded", () => "refused")`);
  if (loaded !== "refused") fault(page.name, "loads from elsewhere");
}

async function checkPage(browser, page) {
  const url = pathToFileURL(page.file).href, messages = [], requests = [];
  browser.listeners = [(message) => {
    const {method, params} = message;
    if (method === "Runtime.consoleAPICalled") messages.push(JSON.stringify(params.args.map((a) => a.value ?? a.description)));
    if (method === "Runtime.exceptionThrown") messages.push(params.exceptionDetails.exception?.description || params.exceptionDetails.text);
    if (method === "Log.entryAdded") messages.push(params.entry.text);
    if (method === "Network.requestWillBeSent" && params.request.url.split("#")[0] !== url) requests.push(params.request.url);
  }];
  await browser.size(1400, 1000);
  await browser.send("Page.navigate", {url: `${url}#t=${page.times[1]}`});
  await browser.until(`document.body && document.body.dataset.ready === "true" && document.querySelector(".table canvas").width > 0`);
  await browser.value(settled);
  if (await browser.value("carom.now()") !== page.times[1]) fault(page.name, `#t=${page.times[1]} opens at ${await browser.value("carom.now()")}`);
  const [end, events] = await browser.value("[carom.record.duration, carom.record.events.map((e) => e.time)]");
  await checkInstants(browser, page);
  await browser.picture(page.name);
  await checkKeys(browser, page, events, end);
  await checkScrubbing(browser, page, end);
  await checkLists(browser, page, events);
  await checkTexts(browser, page);
  if (page.second) await checkSecond(browser, page);
  await browser.size(390, 844, true);
  await browser.value(settled);
  await checkInstants(browser, {...page, times: page.times.slice(0, 1)});
  const wide = await browser.value("document.documentElement.scrollWidth - innerWidth");
  if (wide > 0) fault(page.name, `on a phone the page is ${wide} pixels too wide`);
  await browser.picture(`${page.name}_phone`);
  for (const text of messages) fault(page.name, `the console says ${text}`);
  for (const text of requests) fault(page.name, `asks for ${text}`);
  if (page === manifest.pages[0] || page === manifest.pages.at(-1)) await checkPolicy(browser, page);
}

async function checkCalm(browser, page) {
  await browser.media("dark", "reduce");
  await browser.size(1400, 1000);
  await browser.send("Page.navigate", {url: "about:blank"});
  await browser.send("Page.navigate", {url: `${pathToFileURL(page.file).href}`});
  await browser.until(`document.body && document.body.dataset.ready === "true" && document.querySelector(".table canvas").width > 0`);
  const dark = await browser.value("getComputedStyle(document.body).backgroundColor");
  if (dark !== "rgb(19, 18, 17)") fault(page.name, `is ${dark} where dark is preferred`);
  await browser.key(" ", "Space");
  await browser.value(settled);
  const seen = await browser.value(`new Promise((done) => { const seen = new Set(); const start = performance.now();
    const look = () => { seen.add(carom.now()); performance.now() - start < 2200 ? requestAnimationFrame(look) : done([...seen]); }; look(); })`);
  const events = new Set(await browser.value("[0, carom.record.duration, ...carom.record.events.map((e) => e.time)]"));
  if (seen.length < 2 || seen.length > 4 || !seen.every((t) => events.has(t))) fault(page.name, `with less motion it plays ${JSON.stringify(seen)}`);
  await browser.key(" ", "Space");
  await browser.picture(`${page.name}_dark`);
  await browser.media("light");
}

/** A report: the readouts follow pointer and keys, tables sort, nothing is said or asked for. */
async function checkReport(browser, report) {
  const url = pathToFileURL(report.file).href, messages = [];
  browser.listeners = [({method, params}) => {
    if (method === "Runtime.consoleAPICalled" || method === "Runtime.exceptionThrown" || method === "Log.entryAdded") messages.push(JSON.stringify(params));
    if (method === "Network.requestWillBeSent" && params.request.url !== url) messages.push(`asks for ${params.request.url}`);
  }];
  await browser.size(1300, 1000);
  await browser.send("Page.navigate", {url});
  await browser.until(`document.body && document.body.dataset.ready === "true" && document.querySelector(".plot svg path")`);
  await browser.value(settled);
  const [x, y, before] = await browser.value(`(() => { const p = document.querySelector(".plot"); p.scrollIntoView({block: "center"}); const b = p.getBoundingClientRect();
    return [b.left + b.width / 2, b.top + b.height / 2, document.querySelector(".readout").textContent]; })()`);
  await browser.send("Input.dispatchMouseEvent", {type: "mouseMoved", x, y});
  const hovered = await browser.value(`document.querySelector(".readout").textContent`);
  if (hovered === before || !/[0-9]/.test(hovered)) fault(report.name, `hovering reads ${hovered}`);
  await browser.value(`document.querySelector(".plot").focus()`);
  await browser.key("ArrowRight");
  await browser.key("ArrowRight");
  if (!/[0-9]/.test(await browser.value(`document.querySelector(".readout").textContent`))) fault(report.name, "arrow keys read nothing");
  const unmarked = await browser.value(`[...document.querySelectorAll(".plot svg")].filter((svg) => [...svg.querySelectorAll("text[text-anchor=middle]")].length < 3).length`);
  if (unmarked > 0) fault(report.name, "an axis has fewer than two values");
  const column = report.column, cells = `[...document.querySelectorAll("table")].at(-1).querySelectorAll("tbody tr td:nth-child(${column + 1})")`;
  const values = `[...${cells}].map((td) => Number(td.textContent)).filter(Number.isFinite)`;
  for (const direction of [1, -1]) {
    await browser.value(`[...document.querySelectorAll("table")].at(-1).querySelectorAll("th button")[${column}].click()`);
    const list = await browser.value(values);
    if (list.length < 3 || list.some((v, i) => i > 0 && direction * (v - list[i - 1]) < 0)) fault(report.name, `is not sorted: ${list.slice(0, 9)}`);
  }
  const made = await browser.value(`document.querySelector("footer").textContent`);
  if (!made.includes(report.command)) fault(report.name, `says it was made by ${made}`);
  await browser.picture(report.name);
  for (const text of messages) fault(report.name, text);
}

/** How long a frame of the page takes, for the report: nothing is asserted. */
async function frameTimes(browser, page) {
  await browser.size(1400, 1000);
  await browser.send("Page.navigate", {url: "about:blank"});
  await browser.send("Page.navigate", {url: pathToFileURL(page.file).href});
  await browser.until(`document.body && document.body.dataset.ready === "true" && document.querySelector(".table canvas").width > 0`);
  return browser.value(`new Promise((done) => { const gaps = [], works = []; let before = 0, k = 0; const frame = (time) => { if (before) gaps.push(time - before); before = time;
    const start = performance.now(); carom.show(carom.record.duration * 0.6 * k / 180); works.push(performance.now() - start);
    if (++k <= 180) requestAnimationFrame(frame); else { const middle = (list) => list.sort((a, b) => a - b)[list.length >> 1].toFixed(2); done(\`\${page_name}: a frame every \${middle(gaps)} ms, of it script \${middle(works)} ms (medians of 180)\`); } };
    const page_name = ${JSON.stringify(page.name)}; requestAnimationFrame(frame); })`);
}

const browser = new Browser();
try {
  await browser.open();
  await browser.media("light");
  for (const page of manifest.pages) await checkPage(browser, page).catch((error) => fault(page.name, error.message));
  if (manifest.pages.length > 0) await checkCalm(browser, manifest.pages[0]).catch((error) => fault("less motion", error.message));
  for (const report of manifest.reports) await checkReport(browser, report).catch((error) => fault(report.name, error.message));
  if (manifest.timed) console.log(await frameTimes(browser, manifest.pages.find((page) => page.name === manifest.timed)));
  console.log(`${manifest.pages.length + manifest.reports.length} pages, ${faults} faults`);
  await browser.send("Browser.close", {}, undefined).catch(() => {});
} finally {
  browser.process.kill();
}
process.exit(faults > 0 ? 1 : 0);
