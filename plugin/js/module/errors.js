// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors

class TetskinError extends Error {
  constructor(code, message) {
    super(message);
    this.name = "TetskinError";
    this.code = code;
  }
}

const kOutOfMemory = "there is not enough memory for this: take a smaller mesh or fewer tets, or delete what is not " +
  "needed any more";

/** The error for an exception of the library, whose messages name options as in C++ and Python. */
function errorOf(code, message) {
  if (code === "OutOfMemory") return new TetskinError(code, kOutOfMemory);
  const inCamelCase = name => name.replace(/_([a-z])/g, (_, letter) => letter.toUpperCase());
  return new TetskinError(code, message.replace(/^\w+(?=:)/, inCamelCase).replaceAll("/file.", "file."));
}

function invalid(message) {
  return new TetskinError("InvalidArgument", message);
}
