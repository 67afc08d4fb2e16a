// Headless Firefox for tests, driven by its own protocol Marionette: "length:JSON" on a socket.
import {spawn} from "node:child_process";
import {mkdirSync, writeFileSync} from "node:fs";
import {connect} from "node:net";

/** Like Browser of chromium.mjs, with fewer functions. */
export class Firefox {
  constructor({firefox = "firefox-esr", profile, pictures = "", port = 20000 + process.pid % 20000}) {
    Object.assign(this, {pictures, port, waiting: new Map(), next: 0, actions: 0});
    mkdirSync(profile, {recursive: true});
    writeFileSync(`${profile}/user.js`, [["marionette.port", port], ["network.dns.disabled", true],
      ["browser.shell.checkDefaultBrowser", false], ["datareporting.policy.dataSubmissionEnabled", false],
      ["dom.w3c_touch_events.enabled", 1]]
      .map(([key, value]) => `user_pref("${key}", ${value});\n`).join(""));
    this.process = spawn(firefox, ["--headless", "--marionette", "--no-remote", "--profile", profile,
      "about:blank"], {stdio: "ignore", env: {...process.env, MOZ_HEADLESS_WIDTH: "1400",
      MOZ_HEADLESS_HEIGHT: "1000"}});
  }
  async open() {
    for (let i = 0; ; ++i) {
      try {
        await new Promise((resolve, reject) => {
          this.socket = connect(this.port, "127.0.0.1", resolve).on("error", reject);
        });
        break;
      } catch (error) {
        if (i > 400) throw error;
        await new Promise((resolve) => setTimeout(resolve, 100));
      }
    }
    let bytes = Buffer.alloc(0);
    this.socket.on("data", (data) => {
      bytes = Buffer.concat([bytes, data]);
      for (let colon; (colon = bytes.indexOf(":")) >= 0;) {
        const size = Number(bytes.subarray(0, colon));
        if (bytes.length < colon + 1 + size) return;
        this.receive(JSON.parse(bytes.subarray(colon + 1, colon + 1 + size)));
        bytes = bytes.subarray(colon + 1 + size);
      }
    });
    await this.send("WebDriver:NewSession", {});
    await this.send("WebDriver:SetTimeouts", {script: 120000});
  }
  receive(message) {
    if (!Array.isArray(message)) return;
    const [, id, error, result] = message, call = this.waiting.get(id);
    if (error) call.reject(new Error(error.message));
    else call.resolve(result);
  }
  send(name, parameters) {
    const id = ++this.next, text = Buffer.from(JSON.stringify([0, id, name, parameters]));
    this.socket.write(Buffer.concat([Buffer.from(`${text.length}:`), text]));
    return new Promise((resolve, reject) => this.waiting.set(id, {resolve, reject}));
  }
  async go(url) {
    await this.send("WebDriver:Navigate", {url: "about:blank"});
    await this.send("WebDriver:Navigate", {url});
  }
  async value(expression) {
    const script = "const done = arguments[arguments.length - 1];" +
      `Promise.resolve((() => ${expression})())` +
      ".then((value) => done({value}), (e) => done({bad: String(e)}));";
    const {value: {value, bad}} = await this.send("WebDriver:ExecuteAsyncScript", {script, args: []});
    if (bad) throw new Error(bad);
    return value;
  }
  async until(expression, tries = 400) {
    for (let i = 0; i < tries; ++i) {
      if (await this.value(expression)) return;
      await new Promise((resolve) => setTimeout(resolve, 25));
    }
    throw new Error(`never true: ${expression}`);
  }
  async size(width, height) { await this.send("WebDriver:SetWindowRect", {width, height: height + 85}); }
  perform(actions) {
    return this.send("WebDriver:PerformActions", {actions: [{id: `a${++this.actions}`, ...actions}]});
  }
  async key(key) {
    const value = {ArrowLeft: "\ue012", ArrowUp: "\ue013", ArrowRight: "\ue014", ArrowDown: "\ue015",
      Escape: "\ue00c", Enter: "\ue007", Tab: "\ue004"}[key] ?? key;
    await this.perform({type: "key", actions: [{type: "keyDown", value}, {type: "keyUp", value}]});
  }
  /** Presses at the first place, moves to the others and releases; `type`: "mouse" or "touch". */
  async drag(places, type = "mouse") {
    const [from, ...more] = places.map(([x, y]) => ({type: "pointerMove", x: Math.round(x), y: Math.round(y),
      duration: 20}));
    const [down, up] = ["pointerDown", "pointerUp"].map((name) => ({type: name, button: 0}));
    await this.perform({type: "pointer", parameters: {pointerType: type},
      actions: [{...from, duration: 0}, down, ...more, {type: "pause", duration: 60}, up]});
  }
  async picture(name) {
    if (!this.pictures) return;
    const {value} = await this.send("WebDriver:TakeScreenshot", {full: false});
    writeFileSync(`${this.pictures}/${name}.png`, Buffer.from(value, "base64"));
  }
}
