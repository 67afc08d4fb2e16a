// The package's declarations, compiled by TypeScript if tools/web --test has installed it.
import assert from "node:assert/strict";
import {spawnSync} from "node:child_process";
import {existsSync, mkdtempSync, rmSync, writeFileSync} from "node:fs";
import {tmpdir} from "node:os";
import * as path from "node:path";
import {test} from "node:test";
import {PACKAGE, SOURCE} from "./support.mjs";

const tsc = process.env.CAROM_TSC || path.join(SOURCE, "build/npm/node_modules/.bin/tsc");
const skip = existsSync(tsc) ? false : `${tsc} is missing; tools/web --test installs it`;

test("the declarations suit a program that uses all of them", {skip}, () => {
  const folder = mkdtempSync(path.join(tmpdir(), "carom-types-"));
  try {
    const settings = {files: [path.join(SOURCE, "tests/web/types.ts")], compilerOptions: {strict: true,
      noEmit: true, target: "es2022", module: "esnext", moduleResolution: "bundler", types: [],
      lib: ["es2022", "dom"], paths: {carom: [path.join(PACKAGE, "index.d.ts")]}}};
    writeFileSync(path.join(folder, "tsconfig.json"), JSON.stringify(settings));
    const {status, stdout} = spawnSync(tsc, ["-p", folder], {encoding: "utf8"});
    assert.equal(stdout, "");
    assert.equal(status, 0);
  } finally {
    rmSync(folder, {recursive: true});
  }
});
