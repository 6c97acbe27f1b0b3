// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Checks arguments before they are used.

function numberOf(value, name) {
  if (typeof value !== "number" || Number.isNaN(value)) throw invalid(`${name}: must be a number`);
  return value;
}

function wholeNumberOf(value, name) {
  if (!Number.isInteger(value) || Math.abs(value) > 0x7fffffff) throw invalid(`${name}: must be a whole number`);
  return value;
}

function booleanOf(value, name) {
  if (typeof value !== "boolean") throw invalid(`${name}: must be true or false`);
  return value;
}

/** Refuses a detached view: its length is 0, and it would be taken for an empty array. */
function checkAttached(buffer, name) {
  try {
    new Uint8Array(buffer);
  } catch {
    throw invalid(`${name}: its memory has gone. Get a view anew after calls, which may have grown the module's memory; ` +
      "a buffer that was transferred is the other thread's");
  }
}

/** A list of numbers, whose length is a multiple of `columns`. */
function numbersOf(value, name, columns = 1) {
  const isTyped = ArrayBuffer.isView(value);
  if (value === null || typeof value !== "object" || !(value.length >= 0) || isTyped && typeof value[0] === "bigint") {
    throw invalid(`${name}: must be an array of numbers`);
  }
  if (isTyped && value.length === 0) checkAttached(value.buffer, name);
  for (let i = 0; !isTyped && i < value.length; ++i) {
    if (typeof value[i] !== "number") throw invalid(`${name}: must be numbers, but ${i} is a ${typeof value[i]}`);
  }
  if (value.length % columns !== 0) throw invalid(`${name}: ${value.length} numbers, no multiple of ${columns}`);
  return value;
}

/** `length` numbers, as an array. */
function vectorOf(value, name, length = 3) {
  if (numbersOf(value, name).length !== length) throw invalid(`${name}: must be ${length} numbers`);
  return Array.from(value, number => numberOf(number, name));
}

function bytesOf(value, name) {
  const isView = ArrayBuffer.isView(value), buffer = isView ? value.buffer : value;
  if (!isView && !(value instanceof ArrayBuffer)) throw invalid(`${name}: must be a Uint8Array or an ArrayBuffer`);
  checkAttached(buffer, name);
  return isView ? new Uint8Array(buffer, value.byteOffset, value.byteLength) : new Uint8Array(buffer);
}

/**
 * The given options, and defaults from `known` for the others. The defaults also define the types: NaN is a number
 * without default, and an array a vector.
 */
function optionsOf(given, known) {
  if (given === undefined) given = {};
  if (given === null || typeof given !== "object") throw invalid("options: must be an object");
  for (const name of Object.keys(given)) {
    if (!Object.hasOwn(known, name)) {
      throw invalid(`options: there is no ${name}; there are ${Object.keys(known).join(", ")}`);
    }
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
    } else if (typeof value !== typeof (fallback ?? Function)) {
      throw invalid(`${name}: must be a ${typeof (fallback ?? Function)}`);
    } else {
      options[name] = value;
    }
  }
  return options;
}
