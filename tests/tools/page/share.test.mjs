// Addresses that contain a scene read back unchanged, and damaged ones are refused with a sentence.
import assert from "node:assert/strict";
import {readFileSync} from "node:fs";
import * as path from "node:path";
import {test} from "node:test";
import {fileURLToPath} from "node:url";
import {fragmentOf, sceneInFragment} from "../../../tools/carom/commands/play/share.js";

const SCENES = fileURLToPath(new URL("../../../scenes", import.meta.url));
const sceneText = (name) => readFileSync(path.join(SCENES, name), "utf8");
const HASH = "0123456789abcdef";
/** Why these tests are skipped, or false. */
const skip = (() => {
  try {
    return !new CompressionStream("deflate-raw");
  } catch {
    return "node 18 has no deflate-raw";
  }
})();

test("a scene reads back unchanged", {skip}, async () => {
  const toml = sceneText("three_cushion.toml") + "# an umlaut: ä\n";
  const fragment = await fragmentOf(toml, HASH);
  assert.match(fragment, /^#[\w=&-]+$/);
  assert.deepEqual(await sceneInFragment(fragment), {hash: HASH, toml});
});

test("an address without a scene yields none", async () => {
  for (const fragment of ["", "#", "#t=1.5"]) assert.equal(await sceneInFragment(fragment), null);
});

test("a scene that would fill the memory is refused", {skip}, async () => {
  await assert.rejects(sceneInFragment(await fragmentOf("#".repeat(50e6), HASH)), /address/);
});

test("a thousand damaged addresses are refused or yield a text", {skip}, async () => {
  const whole = await fragmentOf(sceneText("draw.toml"), HASH);
  let seed = 3, refused = 0;
  const random = (n) => { seed = (Math.imul(seed, 1103515245) + 12345) & 0x7fffffff; return seed % n; };
  for (let i = 0; i < 1000; ++i) {
    const at = random(whole.length), put = ["", "<script>", "%00", "A", "&s=", "\u{1f3b1}"][random(6)];
    const damaged = i % 3 === 0 ? whole.slice(0, at) : whole.slice(0, at) + put + whole.slice(at + random(5));
    try {
      const found = await sceneInFragment(damaged);
      assert.ok(found === null || typeof found.toml === "string");
    } catch (error) {
      assert.match(error.message, /^The address .*\.$/);
      ++refused;
    }
  }
  assert.ok(refused > 500, `${refused} of 1000 were refused`);
});
