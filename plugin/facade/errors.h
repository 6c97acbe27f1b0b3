// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// How bindings to other languages report errors of the library: they throw, and the language's own exception has the
// code and the message. A wrong argument without a matching status is a std::invalid_argument.
#pragma once

#include <tetskin/core/types.h>

#include <stdexcept>
#include <string>
#include <utility>

namespace tetskin::facade {

/// The library's error for programs in another language.
struct Failure : std::runtime_error {
  explicit Failure(const Status& status) : std::runtime_error(status.message), code(status.code) {}
  StatusCode code;
};

[[noreturn]] inline void fail(StatusCode code, const std::string& message) {
  throw Failure(Status{code, message});
}
inline void check(const Status& status) {
  if (!status.ok()) throw Failure(status);
}
inline void check(StatusCode code, const char* what) {
  if (code != StatusCode::Ok) fail(code, std::string(what) + ": " + toString(code));
}
template <class T>
T take(Result<T>&& result) {
  check(result.status());
  return std::move(result).value();
}

}  // namespace tetskin::facade
