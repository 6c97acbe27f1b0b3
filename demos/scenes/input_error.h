// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/types.h>

#include <stdexcept>

namespace tetskin::scenes {

/// Bad arguments or unreadable input: caught by `CommandLine::run`, printed as one line, exit status 2.
struct InputError : std::runtime_error {
  using std::runtime_error::runtime_error;
};
/// Throws an InputError unless the status is Ok.
inline void require(const Status& status) {
  if (!status.ok()) throw InputError(status.message);
}

}  // namespace tetskin::scenes
