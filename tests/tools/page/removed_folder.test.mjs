// The npm package's program in a folder that no longer exists.
import assert from "node:assert/strict";
import {spawnSync} from "node:child_process";
import {mkdtempSync} from "node:fs";
import {tmpdir} from "node:os";
import {join} from "node:path";
import {test} from "node:test";
import {fileURLToPath} from "node:url";

const program = fileURLToPath(new URL("../../../web/npm/bin/carom.mjs", import.meta.url));

test("a removed folder is one sentence, not an error of node", {skip: process.platform === "win32"}, () => {
  const folder = mkdtempSync(join(tmpdir(), "carom-"));
  const words = `cd "${folder}" && rmdir "${folder}" && exec "${process.execPath}" "${program}" check x.toml`;
  const {status, stderr} = spawnSync("sh", ["-c", words], {encoding: "utf8"});
  assert.equal(stderr, "carom: the current folder no longer exists; change to another one\n");
  assert.equal(status, 2);
});
