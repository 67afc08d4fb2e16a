// node validate.mjs MODULES FILE.glb ...: prints the findings of the Khronos glTF validator, installed in the
// folder MODULES, for each file. Exit status 1: there are findings.
import {readFileSync} from "node:fs";
import {createRequire} from "node:module";
import {resolve} from "node:path";

const [, , modules, ...files] = process.argv;
const validator = createRequire(resolve(modules, "index.js"))("gltf-validator");
let said = 0;
for (const file of files) {
  const {issues} = await validator.validateBytes(new Uint8Array(readFileSync(file)), {maxIssues: 20});
  for (const issue of issues.messages) {
    ++said;
    console.log(`${file}: ${issue.code} at ${issue.pointer ?? issue.offset}: ${issue.message}`);
  }
}
console.log(`${files.length} files by validator ${validator.version()}, ${said} issues`);
process.exit(said > 0 ? 1 : 0);
