// Shared by the tests of the package.
import {execFileSync} from "node:child_process";
import {existsSync, readFileSync, readdirSync} from "node:fs";
import {fileURLToPath} from "node:url";
import * as path from "node:path";

export const SOURCE = path.resolve(fileURLToPath(new URL("../..", import.meta.url)));
export const PACKAGE = process.env.CAROM_NPM || path.join(SOURCE, "build/wasm/npm");
export const carom = await import(path.join(PACKAGE, "index.js"));

/** The native program; tests that compare with it are skipped without it. */
export const PROGRAM = process.env.CAROM_PROGRAM || path.join(SOURCE, "build/release/carom");
export const withoutProgram = existsSync(PROGRAM) ? false
  : `${PROGRAM} is missing; build it, or set CAROM_PROGRAM`;

export const scenes =
  readdirSync(path.join(SOURCE, "scenes")).filter((name) => name.endsWith(".toml")).sort();
export const sceneText = (name) => readFileSync(path.join(SOURCE, "scenes", name), "utf8");

/** Runs the native program. @returns its output, or "" if it fails */
export function native(args, options = {}) {
  try {
    return execFileSync(PROGRAM, args, {encoding: "utf8", stdio: ["ignore", "pipe", "ignore"],
      maxBuffer: 1 << 28, ...options});
  } catch {
    return "";
  }
}
