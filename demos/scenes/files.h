// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <charconv>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace tetskin::scenes {

/// Writes a whole file under the name `path.part` and renames it, so that a file called `path` is always complete.
/// Symbolic links are followed; anything but a regular file (/dev/stdout) is written directly. Throws InputError with
/// the path.
void writeFile(const std::string& path, std::string_view bytes);

/// The deepest existing component of a folder's path; the folder itself if it exists.
std::filesystem::path existingComponent(std::filesystem::path folder);

/// Throws InputError if this file cannot be written, so that this is known before the work begins. Does not change the
/// file.
void requireWritable(const std::string& path);

/// Throws InputError unless this is the name of a file with one of these extensions, which are in lower case and
/// include their dots; without extensions, any is permitted.
void requireExtension(const std::string& path, const std::vector<std::string>& extensions);

/// A size in words: "12 MB", "1.2 MB", "3 kB".
std::string sizeText(double bytes);

/// Appends the shortest text that reads back as the same number.
template <class Number>
void appendNumber(std::string& text, Number value) {
  char digits[32];
  text.append(digits, std::to_chars(digits, digits + sizeof digits, value).ptr);
}

/// FNV-1a of nothing.
constexpr std::uint64_t kNoHash = 14695981039346656037ull;

}  // namespace tetskin::scenes
