// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/types.h>

#include <cstddef>
#include <string>
#include <string_view>

namespace tetskin::io {

/// All bytes of a file. Errors: FileNotFound, also for a folder and for a file that cannot be read.
Result<std::string> readFile(const std::string& path);

/// The whole content of a text file. Single carriage returns, the line ends of old Macs, become line feeds. Errors:
/// those of `readFile`
Result<std::string> readText(const std::string& path);

/// The text with single carriage returns replaced by line feeds. Those before a line feed stay.
std::string withLineFeeds(std::string text);

/// A status whose message begins with the position: "path:line: what", or "path: what" if line is 0.
Status fileError(StatusCode code, const std::string& path, std::size_t line, const std::string& what);

/// Extension of a path in lower case, with its dot; or empty.
std::string lowerExtension(const std::string& path);

/// A piece of a file for use in a message: in quotes, without control characters, cut after `most` characters.
std::string excerpt(std::string_view text, std::size_t most = 40);

/// The operating system's message for the current errno.
std::string systemReason();

}  // namespace tetskin::io
