// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The contents of the npm package, and that it loads from any place.
import assert from "node:assert/strict";
import {execFileSync} from "node:child_process";
import {existsSync, mkdtempSync, readFileSync, readdirSync, rmSync, writeFileSync} from "node:fs";
import {tmpdir} from "node:os";
import {join} from "node:path";
import {test} from "node:test";
import {Worker} from "node:worker_threads";

import {folder, load, repository, TetskinError, version} from "./module.mjs";

const read = name => readFileSync(join(folder, name), "utf8");

test("npm packs the module, its types, its licences, and nothing else", () => {
  const [{files}] = JSON.parse(execFileSync("npm", ["pack", "--dry-run", "--json"], {cwd: folder, encoding: "utf8"}));
  assert.deepEqual(files.map(({path}) => path).sort(), [
    "LICENSE", "README.md", "licences/bullet.txt", "licences/eigen.txt", "licences/emscripten.txt",
    "licences/json.txt", "licences/llvm.txt", "licences/musl.txt", "licences/tinygltf.txt", "package.json",
    "tetskin.d.ts", "tetskin.js"]);
});

test("licences of all that is inside are in the package", () => {
  for (const [name, words] of Object.entries({
    "LICENSE": "2026 the tetskin authors", "licences/bullet.txt": "bulletphysics.org",
    "licences/eigen.txt": "Mozilla Public License Version 2.0", "licences/tinygltf.txt": "Syoyo Fujita",
    "licences/json.txt": "Niels Lohmann", "licences/emscripten.txt": "Emscripten authors",
    "licences/musl.txt": "Rich Felker", "licences/llvm.txt": "LLVM Exceptions to the Apache 2.0 License",
  })) assert.ok(read(name).includes(words), name);
});

const rulesOfBuild = join(folder, "../build.ninja");

test("nothing else is linked", {skip: !existsSync(rulesOfBuild) && "the package is not where it was built"}, () => {
  // Every compiled source belongs to the library, to Bullet, or to software with a licence in the package.
  const rules = readFileSync(rulesOfBuild, "utf8");
  const sources = [...rules.matchAll(/^build \S+[.]o: \S+ (\S+)/gm)].map(([, source]) => source);
  assert.ok(sources.length > 20);
  const known = [/\/(bullet[^/]*\/src|plugin\/(tetskin|facade|js))\//, /(^|\/)(CMakeFiles|library)\/.*\/Unity\//,
    /\/tinygltf[.]cpp$/];
  assert.deepEqual(sources.filter(source => !known.some(place => place.test(source))), []);
});

test("the package tells the library's version, and its own", () => {
  const description = JSON.parse(read("package.json"));
  assert.equal(description.version, version);
  const header = readFileSync(join(repository, "plugin/tetskin/tetskin.h"), "utf8");
  assert.deepEqual(version.split("."), [...header.matchAll(/#define TETSKIN_VERSION_[A-Z]+ (\d+)/g)].map(([, n]) => n));
  assert.equal(description.type, "module");
  for (const file of [description.main, description.types, description.exports["."].types]) assert.ok(read(file));
});

test("where the repository is public, the package tells its address", () => {
  const copy = mkdtempSync(join(tmpdir(), "tetskin-")), pack = join(repository, "plugin/js/pack.mjs");
  try {
    for (const name of ["core.js", "core.wasm"]) writeFileSync(join(copy, name), "");
    const described = TETSKIN_REPOSITORY => {
      execFileSync("node", [pack, join(copy, "core.js"), join(copy, "core.wasm"), join(copy, "package")],
        {env: {...process.env, TETSKIN_REPOSITORY}});
      return JSON.parse(readFileSync(join(copy, "package/package.json"), "utf8"));
    };
    const {homepage, repository: {url}, bugs, author} = described("https://host.example/people/tetskin.git");
    assert.deepEqual([homepage, url, bugs, author], ["https://host.example/people/tetskin",
      "git+https://host.example/people/tetskin.git", "https://host.example/people/tetskin/issues",
      "the tetskin authors"]);
    assert.equal(described("").homepage, undefined);
  } finally {
    rmSync(copy, {recursive: true});
  }
});

test("codes of errors that only the module has are in the types", () => {
  const source = readFileSync(join(repository, "plugin/js/src/guarded.cpp"), "utf8");
  const [, types] = /export type ErrorCode =([\s\S]*?);\n/.exec(read("tetskin.d.ts"));
  const typed = types.match(/"\w+"/g).map(word => word.slice(1, -1));
  for (const [, code] of source.matchAll(/return \{"(\w+)"/g)) assert.ok(typed.includes(code), code);
});

test("all that the types tell of is there", async () => {
  const tetskin = await load();
  const mesh = tetskin.createMesh([0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1], [0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3]);
  const cage = tetskin.createCage(mesh, {targetTets: 20}), world = tetskin.createWorld();
  const rigid = world.addSphere(1), body = world.addBody(cage, mesh, {position: [0, 3, 0]});
  const hit = world.raycast([0.2, 9, 0.2], [0.2, -9, 0.2]);
  const things = {Tetskin: tetskin, Mesh: mesh, Cage: cage, World: world, RigidBody: rigid, Body: body, Hit: hit,
    Spring: world.addSpring(hit), Palette: tetskin.createPalette(cage, mesh), StageTimes: world.times};
  const types = read("tetskin.d.ts").replace(/\/\*[\s\S]*?\*\//g, "");
  for (const [name, thing] of Object.entries(things)) {
    const [, members] = new RegExp(`export interface ${name}(?: extends \\w+)? \\{([\\s\\S]*?)\\n\\}`).exec(types);
    const names = [...members.matchAll(/^ {2}(?:readonly |get |set )?(\w+)/gm)].map(([, member]) => member);
    assert.ok(names.length > 2, name);
    assert.deepEqual(names.filter(member => !(member in thing)), [], name);
  }
});

test("it runs in a worker that was made from its text", async () => {
  const text = `${read("tetskin.js")}
    const {parentPort} = await import("node:worker_threads");
    const loaded = await load();
    const mesh = loaded.createMesh([0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1], [0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3]);
    const bytes = loaded.createCage(mesh, {targetTets: 50}).toBytes();
    parentPort.postMessage(bytes, [bytes.buffer]);`;
  const worker = new Worker(new URL(`data:text/javascript;base64,${Buffer.from(text).toString("base64")}`));
  const bytes = await new Promise((resolve, reject) => {
    worker.on("message", resolve);
    worker.on("error", reject);
  });
  await worker.terminate();
  assert.ok((await load()).cageFromBytes(bytes).tetCount > 10);
});

test("a page may take its last line off", () => {
  const lines = read("tetskin.js").trimEnd().split("\n");
  assert.equal(lines.pop(), "export const {version, load, TetskinError} = tetskin;");
  assert.doesNotMatch(lines.join("\n").replace(/kWebAssembly = ".*"/, ""), /^\s*(export|import)\b|import\.meta/m);
});

test("where WebAssembly cannot be compiled, load says what is needed", async () => {
  const copy = mkdtempSync(join(tmpdir(), "tetskin-"));
  try {
    writeFileSync(join(copy, "old.mjs"), read("tetskin.js"));
    const old = await import(join(copy, "old.mjs"));
    const {compile} = WebAssembly;
    WebAssembly.compile = async () => { throw new WebAssembly.CompileError("no SIMD"); };
    try {
      await assert.rejects(old.load(), error => error.code === "Unsupported" && /Safari 16/.test(error.message));
    } finally {
      WebAssembly.compile = compile;
    }
    assert.ok((await old.load()).memoryBytes > 0);
  } finally {
    rmSync(copy, {recursive: true});
  }
});

test("an error is one of JavaScript's, too", () => {
  const error = new TetskinError("Empty", "nothing");
  assert.ok(error instanceof Error && error.code === "Empty" && /TetskinError: nothing/.test(String(error)));
  assert.ok(readdirSync(folder).length > 4);
});
