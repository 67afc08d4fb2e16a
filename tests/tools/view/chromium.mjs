// Headless Chromium for tests, driven by its DevTools protocol.
import {spawn} from "node:child_process";
import {writeFileSync} from "node:fs";

/** Waits until the page has drawn. */
export const TWO_FRAMES =
  "new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() => done(1))))";

/** A browser with two pipes, file descriptors 3 and 4; messages are JSON, each followed by a 0. */
export class Browser {
  /** `pictures`: a folder for screenshots. `server`: the address of a test's own server; all else is
   * unreachable. */
  constructor({chromium = "chromium", profile, pictures = "", server = ""}) {
    this.pictures = pictures;
    const hosts = `MAP * ~NOTFOUND${server ? `, EXCLUDE ${server}` : ""}`;
    this.process = spawn(chromium, ["--headless=new", "--no-sandbox", "--disable-gpu",
      "--enable-unsafe-swiftshader", "--hide-scrollbars", "--remote-debugging-pipe",
        `--host-resolver-rules=${hosts}`, "--no-proxy-server",
      "--no-first-run", "--disable-background-networking", `--user-data-dir=${profile}`,
      "about:blank"],
    {stdio: ["ignore", "ignore", "ignore", "pipe", "pipe"]});
    this.waiting = new Map();
    this.listeners = [];
    this.next = 0;
    let text = "";
    this.process.stdio[4].setEncoding("utf8").on("data", (data) => {
      text += data;
      for (let end; (end = text.indexOf("\0")) >= 0; text = text.slice(end + 1))
        this.receive(JSON.parse(text.slice(0, end)));
    });
    this.process.on("exit", () => {
      for (const {reject} of this.waiting.values()) reject(new Error("the browser ended"));
    });
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
    const {result, exceptionDetails} =
      await this.send("Runtime.evaluate", {expression, returnByValue: true, awaitPromise: true});
    if (exceptionDetails) throw new Error(exceptionDetails.exception?.description || exceptionDetails.text);
    return result.value;
  }
  async go(url) {
    await this.send("Page.navigate", {url: "about:blank"});
    await this.send("Page.navigate", {url});
  }
  async until(expression, tries = 400) {
    for (let i = 0; i < tries; ++i) {
      if (await this.value(expression)) return;
      await new Promise((resolve) => setTimeout(resolve, 25));
    }
    throw new Error(`never true: ${expression}`);
  }
  async size(width, height, mobile = false) {
    const deviceScaleFactor = mobile ? 2 : 1;
    await this.send("Emulation.setDeviceMetricsOverride", {width, height, deviceScaleFactor, mobile});
  }
  async media(scheme, motion = "no-preference") {
    const features =
      [{name: "prefers-color-scheme", value: scheme}, {name: "prefers-reduced-motion", value: motion}];
    await this.send("Emulation.setEmulatedMedia", {features});
  }
  async key(key, code = key) {
    const text = key.length === 1 ? key : key === "Enter" ? "\r" : undefined;
    const windowsVirtualKeyCode = {Enter: 13, Tab: 9}[key];
    await this.send("Input.dispatchKeyEvent", {type: "keyDown", key, code, text, windowsVirtualKeyCode});
    await this.send("Input.dispatchKeyEvent", {type: "keyUp", key, code, windowsVirtualKeyCode});
  }
  async mouse(type, x, y) {
    const buttons = type === "mouseReleased" ? 0 : 1;
    await this.send("Input.dispatchMouseEvent", {type, x, y, button: "left", buttons, clickCount: 1});
  }
  /** Presses at the first place, moves to the others and releases; `type`: "mouse" or "touch". */
  async drag(places, type = "mouse") {
    const finger = ([x, y]) => ({x, y, id: 1, radiusX: 5, radiusY: 5, force: 1});
    const touch = (name, at) => this.send("Input.dispatchTouchEvent",
      {type: name, touchPoints: at ? [finger(at)] : []});
    if (type === "touch")
      await this.send("Emulation.setTouchEmulationEnabled", {enabled: true, maxTouchPoints: 5});
    const [from, ...more] = places, last = places.at(-1), steps = [];
    let [x, y] = from;
    for (const to of more) {
      for (const share of [0.25, 0.5, 0.75, 1])
        steps.push([x + share * (to[0] - x), y + share * (to[1] - y)]);
      [x, y] = to;
    }
    await (type === "touch" ? touch("touchStart", from) : this.mouse("mousePressed", ...from));
    for (const at of steps)
      await (type === "touch" ? touch("touchMove", at) : this.mouse("mouseMoved", ...at));
    await this.value(TWO_FRAMES);
    await (type === "touch" ? touch("touchEnd") : this.mouse("mouseReleased", ...last));
    // A touch right after a swipe would only stop the swipe without a click.
    if (type === "touch" && more.length > 0) await new Promise((resolve) => setTimeout(resolve, 400));
  }
  async picture(name) {
    if (!this.pictures) return;
    const {data} = await this.send("Page.captureScreenshot", {format: "png"});
    writeFileSync(`${this.pictures}/${name}.png`, Buffer.from(data, "base64"));
  }
}
