#!/usr/bin/env node
// The program carom in node: program.js runs main() in a thread, so that signals arrive here.
import {readFileSync} from "node:fs";
import {createRequire} from "node:module";
import {isatty} from "node:tty";
import {brotliDecompressSync} from "node:zlib";

const SIGNALS = {SIGINT: 2, SIGTERM: 15};
try {
  process.cwd();
} catch {
  process.stderr.write("carom: the current folder no longer exists; change to another one\n");
  process.exit(2);
}

if (isatty(2)) process.env.COLUMNS = process.stderr.columns;
// Unless main() returns another status.
process.exitCode = 1;
const onWindows = process.platform === "win32";
const program = await createRequire(import.meta.url)("./program.js")({
  // Windows accepts "/" in a path, and no other argument has a "\".
  arguments: process.argv.slice(2).map((word) => onWindows ? word.replace(/\\/g, "/") : word),
  wasmBinary: brotliDecompressSync(readFileSync(new URL("program.wasm.br", import.meta.url))),
});
for (const [name, number] of Object.entries(SIGNALS)) {
  process.on(name, () => {
    program._raise(number);
    // Nothing else ends a thread that waits for input. It checks signals before waiting, so it may miss one.
    setInterval(() => {
      if (Atomics.load(program.HEAP32, program._carom_reads_input() >> 2) !== 1) return;
      process.removeAllListeners(name);
      process.kill(process.pid, name);
    }, 50);
  });
}
