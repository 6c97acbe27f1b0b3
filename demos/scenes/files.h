// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <charconv>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tetskin::scenes {

/// Writes a whole file under the name `path.part` and renames it, so that a file called `path` is always complete.
/// Through symbolic links, and straight into what is no regular file (/dev/stdout). Throws InputError with the path.
void writeFile(const std::string& path, std::string_view bytes);

/// What is there already on the way to a folder; the folder itself if it is.
std::filesystem::path existingPart(std::filesystem::path folder);

/// All bytes of a file; nothing if it cannot be read.
std::optional<std::string> contentsOf(const std::string& path);

/// Throws InputError if this file cannot be written, so that it is known before the work. Does not change it.
void requireWritable(const std::string& path);

/// Throws InputError if this is not the name of a file with one of these extensions, which are in small letters with
/// their dots; of none: any.
void requireExtension(const std::string& path, const std::vector<std::string>& extensions);

/// "12 MB", "1.2 MB", "3 kB".
std::string sizeText(double bytes);

/// Appends the shortest text that reads back as the same number.
template <class Number>
void appendNumber(std::string& text, Number value) {
  char digits[32];
  text.append(digits, std::to_chars(digits, digits + sizeof digits, value).ptr);
}

/// 64 bits of FNV-1a over bytes, seeded with those of what came before.
constexpr std::uint64_t kNoHash = 14695981039346656037ull;
std::uint64_t hashOf(const void* bytes, std::size_t count, std::uint64_t seed = kNoHash);

}  // namespace tetskin::scenes
