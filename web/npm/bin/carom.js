#!/usr/bin/env node
// The program carom in node: program.js runs main() in a thread, so that signals arrive here.
"use strict";
const {readFileSync} = require("fs"), path = require("path"), {brotliDecompressSync} = require("zlib");

const SIGNALS = {SIGINT: 2, SIGTERM: 15};

async function run() {
  const {isatty} = require("tty"), onWindows = process.platform === "win32";
  if (isatty(2)) process.env.COLUMNS = process.stderr.columns;
  const program = await require("./program.js")({
    // Windows accepts "/" in a path, and no other argument has a "\".
    arguments: process.argv.slice(2).map((word) => onWindows ? word.replace(/\\/g, "/") : word),
    wasmBinary: brotliDecompressSync(readFileSync(path.join(__dirname, "program.wasm.br"))),
  });
  for (const [name, number] of Object.entries(SIGNALS)) {
    process.on(name, () => {
      program._raise(number);
      if (Atomics.load(program.HEAP32, program._carom_reads_input() >> 2) === 1) process.exit(128 + number);
    });
  }
}

run();
