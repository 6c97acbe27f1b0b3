// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Makes the npm package from Emscripten's output: the module in one file, its types, licences and pages.
//   node pack.mjs core.js core.wasm FOLDER   the folder is replaced
// The variable TETSKIN_REPOSITORY is the address of the public repository, which package.json then contains.
//
// In that file WebAssembly is deflated and in base64: less than half of the size otherwise. Everything is in one
// function, whose names are invisible outside; only the last line has ES module syntax, so that a page may replace it.
import {cpSync, mkdirSync, readFileSync, rmSync, writeFileSync} from "node:fs";
import {dirname, join} from "node:path";
import {fileURLToPath} from "node:url";
import {deflateSync} from "node:zlib";

const here = dirname(fileURLToPath(import.meta.url));
const repository = join(here, "../..");
const [script, binary, folder] = process.argv.slice(2);
const read = path => readFileSync(path, "utf8");
const address = (process.env.TETSKIN_REPOSITORY ?? "").replace(/(\.git|\/)$/, "");

const header = read(join(repository, "plugin/tetskin/tetskin.h"));
const version = ["MAJOR", "MINOR", "PATCH"].map(part => new RegExp(`VERSION_${part} (\\d+)`).exec(header)[1]).join(".");
const parts = ["errors", "arguments", "instance", "models", "world", "load"];
// The sources' own headers and comments stay out.
const sources = parts.map(part => read(join(here, "module", `${part}.js`)).replace(/^\/\/.*\n/gm, ""));
const packed = deflateSync(readFileSync(binary), {level: 9}).toString("base64");

const module = `// tetskin ${version}, zlib licence. Contains Bullet, Eigen, tinygltf, JSON for Modern C++, and what
// it uses of the libraries of Emscripten, musl and LLVM: their licences are in the folder licences of the npm package.
const tetskin = (() => {
"use strict";
${read(script).trim()}
const kWebAssembly = "${packed}";
${sources.join("\n")}
return {version: "${version}", load, TetskinError};
})();
export const {version, load, TetskinError} = tetskin;
`;

rmSync(folder, {recursive: true, force: true});
mkdirSync(join(folder, "licences"), {recursive: true});
writeFileSync(join(folder, "tetskin.js"), module);
const description = JSON.parse(read(join(here, "package.json")));
const places = address && {homepage: address, repository: {type: "git", url: `git+${address}.git`},
  bugs: `${address}/issues`};
writeFileSync(join(folder, "package.json"), JSON.stringify({...description, version, ...places}, null, 2) + "\n");
cpSync(join(here, "tetskin.d.ts"), join(folder, "tetskin.d.ts"));
cpSync(join(here, "README.md"), join(folder, "README.md"));
cpSync(join(repository, "LICENSE"), join(folder, "LICENSE"));
// The licences of software that the Python package also contains are there.
for (const name of ["bullet", "eigen", "tinygltf", "json"]) {
  cpSync(join(repository, "plugin/python/licences", `${name}.txt`), join(folder, "licences", `${name}.txt`));
}
cpSync(join(here, "licences"), join(folder, "licences"), {recursive: true});
