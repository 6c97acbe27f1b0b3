// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Arguments are checked before anything is done with them.

function numberOf(value, name) {
  if (typeof value !== "number" || Number.isNaN(value)) throw invalid(`${name}: must be a number`);
  return value;
}

function wholeNumberOf(value, name) {
  if (!Number.isInteger(value) || Math.abs(value) > 0x7fffffff) throw invalid(`${name}: must be a whole number`);
  return value;
}

/** A list of numbers, whose length is a multiple of `columns`. */
function numbersOf(value, name, columns = 1) {
  if (value === null || typeof value !== "object" || !(value.length >= 0)) {
    throw invalid(`${name}: must be an array of numbers`);
  }
  if (value.length % columns !== 0) throw invalid(`${name}: ${value.length} numbers, no multiple of ${columns}`);
  return value;
}

/** So many numbers, as an array. */
function vectorOf(value, name, length = 3) {
  if (numbersOf(value, name).length !== length) throw invalid(`${name}: must be ${length} numbers`);
  return Array.from(value, number => numberOf(number, name));
}

function bytesOf(value, name) {
  if (value instanceof ArrayBuffer) return new Uint8Array(value);
  if (ArrayBuffer.isView(value)) return new Uint8Array(value.buffer, value.byteOffset, value.byteLength);
  throw invalid(`${name}: must be a Uint8Array or an ArrayBuffer`);
}

/**
 * The given options, and the others of `known`, whose values tell the types, too. NaN is that of a number without a
 * default, and an array that of a vector.
 */
function optionsOf(given, known) {
  if (given === undefined) given = {};
  if (given === null || typeof given !== "object") throw invalid("options: must be an object");
  for (const name of Object.keys(given)) {
    if (!(name in known)) throw invalid(`options: there is no ${name}; there are ${Object.keys(known).join(", ")}`);
  }
  const options = {};
  for (const [name, fallback] of Object.entries(known)) {
    const value = given[name];
    if (value === undefined) {
      options[name] = fallback;
    } else if (Array.isArray(fallback)) {
      options[name] = fallback.length > 0 ? vectorOf(value, name, fallback.length) : numbersOf(value, name);
    } else if (typeof fallback === "number") {
      options[name] = numberOf(value, name);
    } else if (fallback !== undefined && typeof value !== typeof fallback) {
      throw invalid(`${name}: must be a ${typeof fallback}`);
    } else {
      options[name] = value;
    }
  }
  return options;
}
