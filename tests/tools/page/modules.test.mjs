// The pages' modules, as tools/carom/page/embed.cmake embeds them: each finds its imports.
import assert from "node:assert/strict";
import {readFileSync, readdirSync} from "node:fs";
import * as path from "node:path";
import {test} from "node:test";
import {fileURLToPath} from "node:url";

const SOURCE = fileURLToPath(new URL("../../..", import.meta.url));
const FOLDERS = ["tools/carom/page", "tools/carom/commands/play", "lab/carom/page"];
const files = FOLDERS.flatMap((folder) => readdirSync(path.join(SOURCE, folder))
  .filter((name) => name.endsWith(".js")).map((name) => path.join(SOURCE, folder, name)));
const text = (file) => readFileSync(file, "utf8");
const importsOf = (file) => [...text(file).matchAll(/^import ([^"]+) from "([^"]+)";$/gm)]
  .map(([, names, from]) => ({names: names.match(/\w+/g), from: path.resolve(path.dirname(file), from)}));

test("every imported name is exported on a line of its own", () => {
  assert.ok(files.length > 20);
  for (const file of files)
    for (const {names, from} of importsOf(file)) {
      if (from.endsWith("look.h") || names[0] === "as") continue;
      const exports = text(from).matchAll(/^export (?:async )?(?:function|class|const) (\w+)/gm);
      const exported = [...exports].map(([, name]) => name);
      for (const name of names) assert.ok(exported.includes(name), `${file}: ${from} exports no ${name}`);
    }
});

test("no text spans lines, because pages omit indentation", () => {
  for (const file of files)
    for (const line of text(file).split("\n"))
      assert.equal(line.split("`").length % 2, 1, `${file}: ${line}`);
});

test("modules have different names, and none needs itself", () => {
  const names = files.map((file) => path.basename(file));
  assert.equal(new Set(names).size, names.length);
  const reach = (file, above) => {
    assert.ok(!above.includes(file), [...above, file].join(" -> "));
    for (const {from} of importsOf(file)) if (from.endsWith(".js")) reach(from, [...above, file]);
  };
  for (const file of files) reach(file, []);
});
