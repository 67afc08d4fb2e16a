// WebAssembly has the native program's hashes: for every scene of scenes/, and for 2000 variations of them
// with other models, marches and numbers.
import assert from "node:assert/strict";
import {execFileSync} from "node:child_process";
import {mkdtempSync, readFileSync, rmSync, writeFileSync} from "node:fs";
import {tmpdir} from "node:os";
import * as path from "node:path";
import {before, test} from "node:test";
import {PROGRAM, SOURCE, carom, native, sceneText, scenes, withoutProgram} from "./support.mjs";

const VARIATIONS = Number(process.env.CAROM_WEB_VARIATIONS || 2000);

before(() => carom.init());

for (const name of scenes) {
  test(`the hash of ${name}`, {skip: withoutProgram}, () => {
    const shot = carom.simulate(carom.Scene.parse(sceneText(name), name));
    assert.equal(shot.hash, native(["simulate", path.join(SOURCE, "scenes", name), "--hash"]).trim());
    shot.free();
  });
}

/** Numbers from 0 to 1, the same in every run (mulberry32). */
function randomNumbers(seed) {
  return () => {
    seed = (seed + 0x6d2b79f5) | 0;
    let t = Math.imul(seed ^ (seed >>> 15), 1 | seed);
    t = (t + Math.imul(t ^ (t >>> 7), 61 | t)) ^ t;
    return ((t ^ (t >>> 14)) >>> 0) / 4294967296;
  };
}

/** Changes of a scene: always the stroke, and sometimes each of the models and numbers. */
function changes(random) {
  const one = (list) => list[Math.floor(random() * list.length)];
  const between = (low, high) => low + (high - low) * random();
  const out = {"cue.speed": between(0.3, 9), "cue.aim_deg": between(-180, 180),
    "cue.offset": [between(-0.35, 0.35), between(-0.35, 0.35)]};
  const sometimes = (share, key, value) => { if (random() < share) out[key] = value(); };
  sometimes(0.3, "cue.elevation_deg", () => between(0, 60));
  sometimes(0.5, "physics.cushion",
    () => one(["han_2005", "mathavan_2010", "stronge", "impulse", "smooth"]));
  sometimes(0.3, "physics.ball_ball", () => one(["mathavan", "elastic", "inelastic", "two_step"]));
  sometimes(0.5, "physics.clusters", () => one(["compliant", "sequential", "rigid"]));
  if (random() < 0.4) {
    out["physics.substeps"] = Math.floor(between(1, 2000));
    out["physics.march"] = one(["summed", "published"]);
  } else {
    sometimes(0.4, "physics.tolerance", () => 10 ** between(-12, -2));
  }
  sometimes(0.3, "physics.cloth_slip", () => one(["consistent", "as_published"]));
  sometimes(0.3, "physics.cushion_touch", () => one(["radius", "nose"]));
  sometimes(0.3, "physics.pocket", () => one(["fall", "at_once"]));
  sometimes(0.2, "physics.vertical", () => one(["keep", "drop"]));
  sometimes(0.4, "balls.mu_b", () => between(0, 0.2));
  sometimes(0.4, "balls.e_b", () => between(0.7, 1));
  sometimes(0.2, "balls.mu_s", () => between(0.05, 0.4));
  sometimes(0.2, "balls.e_h", () => between(0, 0.4));
  return out;
}

test(`the hashes of ${VARIATIONS} variations`, {skip: withoutProgram}, (t) => {
  const folder = mkdtempSync(path.join(tmpdir(), "carom-web-")), random = randomNumbers(20261125);
  const bases = scenes.map((name) => carom.Scene.parse(sceneText(name), name)).filter((scene) => scene.cue);
  const here = new Map();
  let tried = 0;
  try {
    while (here.size < VARIATIONS) {
      assert.ok(++tried < 3 * VARIATIONS, `only ${here.size} of ${tried} variations are valid scenes`);
      const name = `v${String(tried).padStart(5, "0")}.toml`;
      let scene;
      try {
        scene = bases[tried % bases.length].with(changes(random));
      } catch (error) {
        assert.equal(error.kind, "scene", error.stack);
        continue;
      }
      let hash;
      try {
        const shot = carom.simulate(scene);
        hash = shot.hash;
        shot.free();
      } catch (error) {
        // The native program must also fail.
        assert.ok(["simulation", "scene"].includes(error.kind), error.stack);
        hash = "";
      }
      writeFileSync(path.join(folder, name), scene.toml);
      scene.free();
      here.set(name, hash);
    }
    const script = 'for f in "$@"; do echo "$f $("$CAROM" simulate "$f" --hash 2>/dev/null || true)"; done';
    const names = [...here.keys()], there = execFileSync("bash", ["-c", script, "bash", ...names],
      {cwd: folder, encoding: "utf8", env: {...process.env, CAROM: PROGRAM}, maxBuffer: 1 << 26});
    const different = [];
    for (const line of there.trim().split("\n")) {
      const [name, hash = ""] = line.split(" ");
      if (here.get(name) === hash) continue;
      different.push(`${name}: ${here.get(name) || "failed"} in WebAssembly, ${hash || "failed"} natively`);
      t.diagnostic(readFileSync(path.join(folder, name), "utf8"));
    }
    const failed = [...here.values()].filter((hash) => hash === "").length;
    t.diagnostic(`${here.size} variations, ${failed} of them fail in both, ${different.length} differ`);
    assert.deepEqual(different, []);
  } finally {
    rmSync(folder, {recursive: true});
  }
});
