// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The programs of the pages run as they are written, where the package is installed as npm installs it.
import assert from "node:assert/strict";
import {execFileSync} from "node:child_process";
import {mkdirSync, mkdtempSync, readFileSync, rmSync, symlinkSync, writeFileSync} from "node:fs";
import {tmpdir} from "node:os";
import {join} from "node:path";
import {test} from "node:test";

import {folder, repository} from "./module.mjs";
import {files, tube} from "./shapes.mjs";

for (const page of ["plugin/docs/javascript.md", "plugin/js/README.md"]) {
  test(`the program of ${page} prints what the page says`, () => {
    const text = readFileSync(join(repository, page), "utf8");
    const programs = [...text.matchAll(/```js\n([\s\S]*?)```/g)].map(([, program]) => program);
    const complete = programs.filter(program => program.includes("import "));
    assert.equal(complete.length, 1);
    const place = mkdtempSync(join(tmpdir(), "tetskin-"));
    try {
      mkdirSync(join(place, "node_modules"));
      symlinkSync(folder, join(place, "node_modules/tetskin"));
      writeFileSync(join(place, "dragon.obj"), files.obj(tube({rings: 60, length: 3})));
      writeFileSync(join(place, "program.mjs"), complete[0]);
      const said = execFileSync("node", ["program.mjs"], {cwd: place, encoding: "utf8"});
      assert.match(said, /^lowest y = -?0\.0\d+$/m);
    } finally {
      rmSync(place, {recursive: true});
    }
  });
}
