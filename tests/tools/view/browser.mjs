// node browser.mjs MANIFEST.json [PICTURES]: opens pages in headless Chromium, drives them by its DevTools
// protocol, and prints a line for everything that differs from the manifest; the exit status is then 1.
// The manifest: {chromium, profile, pages: [{name, file, bounds, times, states, second: {time, apart} for two
// shots}], reports: [{name, file, column, command}]}, where states[k] is the list of {id, x, y, z, state,
// radius} at times[k]. With PICTURES, screenshots go to that folder.
import {readFileSync} from "node:fs";
import {pathToFileURL} from "node:url";
import {Browser} from "./chromium.mjs";

const manifest = JSON.parse(readFileSync(process.argv[2], "utf8")), pictures = process.argv[3];
let faults = 0;
const fault = (page, text) => { ++faults; console.log(`${page}: ${text}`); };

const near = (a, b, by = 1e-9) => Math.abs(a - b) <= by;
const settled = "new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() => done(true))))";

/** Statements that read the upper canvas into `canvas` and its bytes into `data`. */
const copied = `const canvas = document.querySelectorAll(".table canvas")[1];
    const copy = new OffscreenCanvas(canvas.width, canvas.height)
      .getContext("2d", {willReadFrequently: true});
    copy.drawImage(canvas, 0, 0);
    const data = copy.getImageData(0, 0, canvas.width, canvas.height).data;`;

/** The upper canvas at these discs: number of pixels, number of opaque ones, and mean colour. */
function pixels(places) {
  return `(() => { ${copied}
    return ${JSON.stringify(places)}.map(([x, y, r]) => {
      x *= canvas.width; y *= canvas.height; r *= Math.hypot(canvas.width, canvas.height);
      let n = 0, opaque = 0, sum = [0, 0, 0];
      for (let j = -r; j <= r; ++j) for (let i = -r; i <= r; ++i) {
        if (Math.hypot(i, j) > 0.8 * r) continue;
        const at = 4 * (Math.floor(y + j) * canvas.width + Math.floor(x + i));
        ++n; opaque += data[at + 3] === 255;
        for (let k = 0; k < 3; ++k) sum[k] += data[at + k];
      }
      return {n, opaque, mean: sum.map((s) => s / n / 255)}; }); })()`;
}

const rectangle = (selector) => `(() => {
    const b = document.querySelector("${selector}").getBoundingClientRect();
    return [b.left, b.top, b.width, b.height]; })()`;
const ready = (what) =>
  `document.body && document.body.dataset.ready === "true" && document.querySelector(${what})`;
const painted = `${ready('".table canvas"')}.width > 0`;

/** A table place on the canvas, in fractions of its width and height. */
function share({low, high}, lying, x, y) {
  const [u, v] = [(x - low[0]) / (high[0] - low[0]), (y - low[1]) / (high[1] - low[1])];
  return lying ? [v, u] : [u, 1 - v];
}

async function checkInstants(browser, page) {
  const [width, height] =
    await browser.value(`(({width, height}) => [width, height])(document.querySelector(".table canvas"))`);
  const {bounds} = page, sides = [bounds.high[0] - bounds.low[0], bounds.high[1] - bounds.low[1]];
  const aspect = Math.max(...sides) / Math.min(...sides);
  const exact = near(Math.max(width, height) / Math.min(width, height), aspect, 0.02);
  for (const [k, t] of page.times.entries()) {
    await browser.value(`location.hash = "#t=${t}"`);
    await browser.until(`carom.now() === ${t}`);
    await browser.value(settled);
    const here = JSON.parse(await browser.value("document.body.dataset.state")), expected = page.states[k];
    for (const [i, ball] of expected.entries())
      for (const key of ["id", "state", "x", "y", "z"])
        if (here[i][key] !== ball[key])
          fault(page.name, `at ${t} s ${ball.id} has ${key} ${here[i][key]} instead of ${ball[key]}`);
    if (!exact) continue;  // a very narrow outline does not reach the edges of the canvas
    const gone = ["pocketed", "out", "falling", "airborne"];
    const inPlay = expected.filter((ball) => !gone.includes(ball.state));
    const diagonal = Math.hypot(...sides), lying = width > height;
    const discs = inPlay.map((ball) => [...share(bounds, lying, ball.x, ball.y), ball.radius / diagonal]);
    const found = await browser.value(pixels(discs));
    for (const [j, {n, opaque, mean}] of found.entries()) {
      const ball = inPlay[j];
      if (n === 0 || opaque < n)
        fault(page.name, `at ${t} s ${ball.id} covers ${opaque} of ${n} pixels of its place`);
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
  if (await now() !== first)
    fault(page.name, `arrow down goes to ${await now()} instead of the event at ${first}`);
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
  const box = await browser.value(rectangle(".scrub"));
  await browser.mouse("mousePressed", box[0] + 0.25 * box[2], box[1] + box[3] / 2);
  await browser.mouse("mouseMoved", box[0] + 0.5 * box[2], box[1] + box[3] / 2);
  await browser.mouse("mouseReleased", box[0] + 0.5 * box[2], box[1] + box[3] / 2);
  const t = await browser.value("carom.now()");
  if (!near(t, 0.5 * end, 0.01 * end)) fault(page.name, `scrubbing to the middle goes to ${t} of ${end}`);
}

async function checkLists(browser, page, events) {
  const last = events.length - 1;
  await browser.value(`document.querySelectorAll(".events button")[${last}].click()`);
  if (await browser.value("carom.now()") !== events[last])
    fault(page.name, "a click on an event does not go there");
  const marked = await browser.value(
    `[...document.querySelectorAll(".events button")].findIndex((b) => b.getAttribute("aria-current"))`);
  if (marked !== last) fault(page.name, `event ${marked} is marked instead of ${last}`);
  const unnamed = await browser.value(
    `[...document.querySelectorAll("button, input, select, canvas[role], .plot")]
      .filter((e) => !(e.getAttribute("aria-label") || e.textContent.trim())).length`);
  if (unnamed > 0) fault(page.name, `${unnamed} controls have no name for a screen reader`);
  const wide =
    await browser.value("document.documentElement.scrollWidth - document.documentElement.clientWidth");
  if (wide > 0) fault(page.name, `the page is ${wide} pixels too wide`);
}

/** The page of a hostile file shows its texts as plain text. */
async function checkTexts(browser, page) {
  const shown = await browser.value(`[...document.querySelectorAll("tbody th")].map((th) => th.textContent)`);
  const [here, ids] = [shown, page.states[0].map((ball) => ball.id)].map((list) => JSON.stringify(list));
  if (here !== ids) fault(page.name, `shows the balls ${here} instead of ${ids}`);
  const policy = `document.querySelector("meta[http-equiv]").content.split("script-src")[1].match(/sha256/g)`;
  const scripts = `document.querySelectorAll("body > script:not([type])")`;
  if (await browser.value(`${scripts}.length !== ${policy}.length`))
    fault(page.name, "has scripts that it should not have");
}

/** Two shots: overlaid, side by side and off, and their balls' distance in the list. */
async function checkSecond(browser, page) {
  const drawn = () => browser.value(`(() => { ${copied}
    let sum = 0; for (const x of data) sum = (31 * sum + x) % 1000000007; return sum; })()`);
  const choose = async (mode) => {
    await browser.value(`(() => { const s = document.querySelector("select[aria-label='Second shot']");
      s.value = "${mode}"; s.onchange(); })()`);
    await browser.value(settled);
  };
  await browser.size(1400, 1000);
  await browser.value(settled);
  await browser.value(`carom.show(${page.second.time})`);
  await choose("over");
  const over = await drawn();
  const apart = await browser.value(`Number(document.querySelector("tbody tr td:last-child").textContent)`);
  const says = `says the first ball is ${apart} mm from the other shot's, not ${page.second.apart}`;
  if (!near(apart, page.second.apart, 0.051)) fault(page.name, says);
  await choose("off");
  if (await drawn() === over) fault(page.name, "the second shot is not drawn over the first");
  if (await browser.value(`document.querySelectorAll(".table")[1].clientWidth`) !== 0)
    fault(page.name, "shows the second table when it is off");
  await choose("beside");
  const [first, second] = await browser.value(`[...document.querySelectorAll(".table")].map((t) => {
    const b = t.getBoundingClientRect(); return [b.left, b.right, b.top, b.width]; })`);
  const aligned = second[0] >= first[1] && second[2] === first[2] && second[3] === first[3] && first[3] > 300;
  if (!aligned) fault(page.name, `beside: ${first} and ${second}`);
  await browser.picture(`${page.name}_beside`);
}

async function checkPolicy(browser, page) {
  const broken = await browser.value(`new Promise((done) => {
    document.addEventListener("securitypolicyviolation", (e) => done(e.effectiveDirective));
    const s = document.createElement("script"); s.textContent = "document.body.dataset.harmed = 1";
    document.body.append(s); setTimeout(() => done("nothing"), 2000); })`);
  if (broken !== "script-src-elem") fault(page.name, `a foreign script is stopped by ${broken}`);
  if (await browser.value("document.body.dataset.harmed")) fault(page.name, "a foreign script has run");
  const loaded =
    await browser.value(`fetch("https://example.com/").then(() => "loaded", () => "refused")`);
  if (loaded !== "refused") fault(page.name, "loads from elsewhere");
}

async function checkPage(browser, page) {
  const url = pathToFileURL(page.file).href, messages = [], requests = [];
  browser.listeners = [(message) => {
    const {method, params} = message;
    const {args, exceptionDetails: thrown, entry, request} = params;
    if (method === "Runtime.consoleAPICalled")
      messages.push(JSON.stringify(args.map((a) => a.value ?? a.description)));
    if (method === "Runtime.exceptionThrown") messages.push(thrown.exception?.description || thrown.text);
    if (method === "Log.entryAdded") messages.push(entry.text);
    if (method === "Network.requestWillBeSent" && request.url.split("#")[0] !== url)
      requests.push(request.url);
  }];
  await browser.size(1400, 1000);
  await browser.send("Page.navigate", {url: `${url}#t=${page.times[1]}`});
  await browser.until(painted);
  await browser.value(settled);
  const opened = await browser.value("carom.now()");
  if (opened !== page.times[1]) fault(page.name, `#t=${page.times[1]} opens at ${opened}`);
  const [end, events] =
    await browser.value("[carom.record.duration, carom.record.events.map((e) => e.time)]");
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
  for (const text of requests) fault(page.name, `requests ${text}`);
  if (page === manifest.pages[0] || page === manifest.pages.at(-1)) await checkPolicy(browser, page);
}

async function checkCalm(browser, page) {
  await browser.media("dark", "reduce");
  await browser.size(1400, 1000);
  await browser.send("Page.navigate", {url: "about:blank"});
  await browser.send("Page.navigate", {url: `${pathToFileURL(page.file).href}`});
  await browser.until(painted);
  const dark = await browser.value("getComputedStyle(document.body).backgroundColor");
  if (dark !== "rgb(19, 18, 17)") fault(page.name, `is ${dark} if dark is preferred`);
  await browser.key(" ", "Space");
  await browser.value(settled);
  const seen = await browser.value(`new Promise((done) => {
    const seen = new Set(), start = performance.now();
    const look = () => { seen.add(carom.now());
      performance.now() - start < 2200 ? requestAnimationFrame(look) : done([...seen]); }; look(); })`);
  const times = "[0, carom.record.duration, ...carom.record.events.map((e) => e.time)]";
  const events = new Set(await browser.value(times));
  if (seen.length < 2 || seen.length > 4 || !seen.every((t) => events.has(t)))
    fault(page.name, `with less motion it plays ${JSON.stringify(seen)}`);
  await browser.key(" ", "Space");
  await browser.picture(`${page.name}_dark`);
  await browser.media("light");
}

/** A report: readouts follow pointer and keys, tables sort, no messages, no requests. */
async function checkReport(browser, report) {
  const url = pathToFileURL(report.file).href, messages = [];
  browser.listeners = [({method, params}) => {
    const said = ["Runtime.consoleAPICalled", "Runtime.exceptionThrown", "Log.entryAdded"].includes(method);
    if (said) messages.push(JSON.stringify(params));
    if (method === "Network.requestWillBeSent" && params.request.url !== url)
      messages.push(`requests ${params.request.url}`);
  }];
  await browser.size(1300, 1000);
  await browser.send("Page.navigate", {url});
  await browser.until(ready('".plot svg path"'));
  await browser.value(settled);
  await browser.value(`document.querySelector(".plot").scrollIntoView({block: "center"})`);
  const readout = `document.querySelector(".readout").textContent`;
  const [left, top, width, height] = await browser.value(rectangle(".plot"));
  const x = left + width / 2, y = top + height / 2, before = await browser.value(readout);
  await browser.send("Input.dispatchMouseEvent", {type: "mouseMoved", x, y});
  const hovered = await browser.value(readout);
  if (hovered === before || !/[0-9]/.test(hovered)) fault(report.name, `hovering reads ${hovered}`);
  await browser.value(`document.querySelector(".plot").focus()`);
  await browser.key("ArrowRight");
  await browser.key("ArrowRight");
  if (!/[0-9]/.test(await browser.value(readout))) fault(report.name, "arrow keys read nothing");
  const unmarked = await browser.value(`[...document.querySelectorAll(".plot svg")]
    .filter((svg) => [...svg.querySelectorAll("text[text-anchor=middle]")].length < 3).length`);
  if (unmarked > 0) fault(report.name, "an axis has fewer than two values");
  const column = report.column, table = `[...document.querySelectorAll("table")].at(-1)`;
  const cells = `${table}.querySelectorAll("tbody tr td:nth-child(${column + 1})")`;
  const values = `[...${cells}].map((td) => Number(td.textContent)).filter(Number.isFinite)`;
  for (const direction of [1, -1]) {
    await browser.value(`${table}.querySelectorAll("th button")[${column}].click()`);
    const list = await browser.value(values);
    if (list.length < 3 || list.some((v, i) => i > 0 && direction * (v - list[i - 1]) < 0))
      fault(report.name, `is not sorted: ${list.slice(0, 9)}`);
  }
  const made = await browser.value(`document.querySelector("footer").textContent`);
  if (!made.includes(report.command)) fault(report.name, `says it was made by ${made}`);
  await browser.picture(report.name);
  for (const text of messages) fault(report.name, text);
}

/** The time of one frame of the page, reported without an assertion. */
async function frameTimes(browser, page) {
  await browser.size(1400, 1000);
  await browser.send("Page.navigate", {url: "about:blank"});
  await browser.send("Page.navigate", {url: pathToFileURL(page.file).href});
  await browser.until(painted);
  return browser.value(`new Promise((done) => {
    const gaps = [], works = [], middle = (list) => list.sort((a, b) => a - b)[list.length >> 1].toFixed(2);
    let before = 0, k = 0;
    const frame = (time) => {
      if (before) gaps.push(time - before);
      before = time;
      const start = performance.now();
      carom.show(carom.record.duration * 0.6 * k / 180);
      works.push(performance.now() - start);
      if (++k <= 180) requestAnimationFrame(frame);
      else done(${JSON.stringify(page.name)} + \`: a frame every \${middle(gaps)} ms, of which script \` +
        \`\${middle(works)} ms (medians of 180)\`);
    };
    requestAnimationFrame(frame); })`);
}

const {chromium, profile} = manifest, browser = new Browser({chromium, profile, pictures});
try {
  await browser.open();
  await browser.media("light");
  for (const page of manifest.pages)
    await checkPage(browser, page).catch((error) => fault(page.name, error.message));
  if (manifest.pages.length > 0)
    await checkCalm(browser, manifest.pages[0]).catch((error) => fault("less motion", error.message));
  for (const report of manifest.reports)
    await checkReport(browser, report).catch((error) => fault(report.name, error.message));
  const timed = manifest.pages.find((page) => page.name === manifest.timed);
  if (manifest.timed) console.log(await frameTimes(browser, timed));
  console.log(`${manifest.pages.length + manifest.reports.length} pages, ${faults} faults`);
  await browser.send("Browser.close", {}, undefined).catch(() => {});
} finally {
  browser.process.kill();
}
process.exit(faults > 0 ? 1 : 0);
