// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/types.h>

#include <string>

namespace tetskin::io {

/// The bytes that a uri in a file names: those of a `data:` uri, or of a regular file in the folder of `path` or below;
/// links must also end there. No other file is opened, and nothing is fetched.
/// Errors: FileNotFound, UnsupportedFormat for any other place, Malformed; the message names `path`
Result<std::string> readUri(const std::string& path, const std::string& uri);

}  // namespace tetskin::io
