// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The programs of the pages run as written, with the package installed as by npm; and after the program, all pieces of
// the page.
import assert from "node:assert/strict";
import {execFileSync} from "node:child_process";
import {mkdirSync, mkdtempSync, readFileSync, rmSync, symlinkSync, writeFileSync} from "node:fs";
import {tmpdir} from "node:os";
import {join} from "node:path";
import {test} from "node:test";

import {folder, repository} from "./module.mjs";
import {files, tube} from "./shapes.mjs";

const blocksOf = page =>
  [...readFileSync(join(repository, page), "utf8").matchAll(/```js\n([\s\S]*?)```/g)].map(([, block]) => block);

/** What a program prints beside which dragon.obj is. */
function printed(program) {
  const place = mkdtempSync(join(tmpdir(), "tetskin-"));
  try {
    mkdirSync(join(place, "node_modules"));
    symlinkSync(folder, join(place, "node_modules/tetskin"));
    writeFileSync(join(place, "dragon.obj"), files.obj(tube({rings: 60, length: 3})));
    writeFileSync(join(place, "program.mjs"), program);
    return execFileSync("node", ["program.mjs"], {cwd: place, encoding: "utf8"});
  } finally {
    rmSync(place, {recursive: true});
  }
}

for (const page of ["plugin/docs/javascript.md", "plugin/js/README.md"]) {
  test(`the program of ${page} prints what the page says`, () => {
    const complete = blocksOf(page).filter(block => block.includes("import "));
    assert.equal(complete.length, 1);
    assert.match(printed(complete[0]), /^lowest y = -?0\.0\d+$/m);
  });
}

// Names of a browser's worker, and names that the page leaves to its reader.
const around = `
const posted = [], postMessage = message => posted.push(message);
const text = readFileSync("node_modules/tetskin/tetskin.js", "utf8"), workersOwnScript = "tetskin.load()";
class Worker { constructor(url) { this.url = url; } }
`;

test("the pieces of plugin/docs/javascript.md run after its program", () => {
  const [program, ...pieces] = blocksOf("plugin/docs/javascript.md"), end = "world.delete();\n";
  assert.ok(program.endsWith(end) && pieces.length >= 4);
  const said = printed(program.slice(0, -end.length) + around + pieces.map(piece => `{\n${piece}}\n`).join("") +
    "console.log('posted', posted.filter(({fraction}) => fraction !== undefined).length > 1, posted.length > 3);\n" + end);
  assert.match(said, /^posted true true$/m);
});
