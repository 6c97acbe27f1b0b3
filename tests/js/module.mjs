// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The module that is tested: that of the folder TETSKIN_JS_PACKAGE, which tests/js/run sets, or of build/js/package.
import {dirname, join, resolve} from "node:path";
import {fileURLToPath, pathToFileURL} from "node:url";

export const repository = join(dirname(fileURLToPath(import.meta.url)), "../..");
export const folder = resolve(process.env.TETSKIN_JS_PACKAGE ?? join(repository, "build/js/package"));
const module = await import(pathToFileURL(join(folder, "tetskin.js")));
export const {load, version, TetskinError} = module;

/** For assert.throws: an error of this code, whose message has these words. */
export function failure(code, words = /./) {
  return error => error instanceof TetskinError && error.name === "TetskinError" && error.code === code &&
    words.test(error.message);
}
