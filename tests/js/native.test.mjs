// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// With `deterministic`, states equal those of a native program to the bit: live_native of tests/live, which uses only
// the library's C++. Its path is in TETSKIN_LIVE_NATIVE.
import assert from "node:assert/strict";
import {execFileSync} from "node:child_process";
import {mkdtempSync, rmSync, writeFileSync} from "node:fs";
import {tmpdir} from "node:os";
import {join} from "node:path";
import {test} from "node:test";

import {folder, repository} from "./module.mjs";
import {tube} from "./shapes.mjs";

const native = process.env.TETSKIN_LIVE_NATIVE;
const pose = (x, y, z) => `${x} ${y} ${z} 0 0 0 1`;
/** Mass, place, relative stiffness, damping, friction, contact among soft bodies. */
const body = (tets, place, contact) => `body tube ${tets} ${place} 5 60 0.02 0.5 ${contact}`;
const ground = `box 10 1 10 0 ${pose(0, -1, 0)} 0.5`;
const scenes = {
  "a body falls on a box and a ball": [
    ground, `sphere 0.4 0 ${pose(1, 0, 0.1)} 0.5`, body(1000, pose(0, 0.9, 0), "none")],
  "two bodies fall onto each other": [
    ground, body(300, pose(0, 0.5, 0), "soft"), body(300, pose(0.3, 1.3, 0.2), "soft")],
};

for (const [name, lines] of Object.entries(scenes)) {
  const skip = !native && "TETSKIN_LIVE_NATIVE is not set";
  test(`${name}: 120 frames have the states of a native run`, {skip}, () => {
    const place = mkdtempSync(join(tmpdir(), "tetskin-"));
    try {
      const {positions, triangles} = tube(), counts = Int32Array.of(positions.length / 3, triangles.length / 3);
      writeFileSync(join(place, "tube"), Buffer.concat([counts, positions, triangles].map(a => Buffer.from(a.buffer))));
      const scene = join(place, "scene");
      writeFileSync(scene, [`mesh tube ${join(place, "tube")}`, ...lines, ""].join("\n"));
      const said = (program, ...words) =>
        execFileSync(program, words, {encoding: "utf8"}).split("\n").filter(line => line.startsWith("hash"));
      const expected = said(native, scene, "120");
      assert.match(expected[3], /^hash 120 [0-9a-f]{16}$/);
      assert.deepEqual(
        said("node", join(repository, "tests/live/speed.mjs"), join(folder, "tetskin.js"), scene, "120"), expected);
    } finally {
      rmSync(place, {recursive: true});
    }
  });
}
