// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/io/src/text/number_text.h>

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace tetskin::io {

/// Reads words and numbers, separated by white space, from a text in memory, and counts lines. It is cheap to copy, so
/// that a copy can look ahead. The text must outlive it.
class TextScanner {
 public:
  explicit TextScanner(std::string_view text, std::size_t firstLine = 1) : rest_(text), line_(firstLine) {}

  /// Line of the last word read, from 1.
  std::size_t line() const { return line_; }
  /// Bytes not yet read.
  std::size_t remaining() const { return rest_.size(); }

  /// Next word; empty at the end of the text.
  std::string_view word() {
    skipBlanks();
    std::size_t length = 0;
    while (length < rest_.size() && !isBlank(rest_[length])) ++length;
    return take(length);
  }

  /// Next word as a number; false if there is none or it is not a number.
  bool number(double& value) { return parseDouble(word(), value); }
  template <class Integer>
  bool integer(Integer& value) {
    return parseInteger(word(), value);
  }

  /// The rest of the current line, without its line break, which is skipped.
  std::string_view restOfLine() {
    const std::size_t length = rest_.find('\n');
    if (length == rest_.npos) return take(rest_.size());
    std::string_view line = take(length);
    take(1);
    ++line_;
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    return line;
  }

  /// The next bytes, whatever they contain; at most `remaining()`. Line breaks among them are not counted.
  std::string_view bytes(std::size_t count) {
    assert(count <= rest_.size());
    return take(count);
  }

  /// True if the rest of the text can contain this many numbers, with at least one digit and one blank each. Call it
  /// before reserving memory for a count that the file states.
  bool hasRoomFor(std::uint64_t numbers) const { return numbers <= rest_.size() / 2 + 1; }

  static bool isBlank(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

 private:
  void skipBlanks() {
    std::size_t length = 0;
    for (; length < rest_.size() && isBlank(rest_[length]); ++length) line_ += rest_[length] == '\n';
    take(length);
  }
  std::string_view take(std::size_t length) {
    assert(length <= rest_.size());
    const std::string_view taken = rest_.substr(0, length);
    rest_.remove_prefix(length);
    return taken;
  }

  std::string_view rest_;
  std::size_t line_;
};

}  // namespace tetskin::io
