// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/io/src/text/text_scanner.h>

namespace tetskin::io {

/// Iterates over the lines of a text that are neither blank nor a comment (beginning with #). The text must outlive it.
class TextRecords {
 public:
  explicit TextRecords(std::string_view text) : in_(text) {}
  /// A scanner of the next line, without its comment. At the end of the file it finds no words.
  TextScanner next() {
    while (in_.remaining() > 0) {
      const std::size_t line = in_.line();
      const std::string_view text = in_.restOfLine();
      const TextScanner record(text.substr(0, text.find('#')), line);
      TextScanner ahead = record;
      if (!ahead.word().empty()) return record;
    }
    return TextScanner({}, in_.line());
  }
  bool hasRoomFor(std::uint64_t numbers) const { return in_.hasRoomFor(numbers); }

 private:
  TextScanner in_;
};

}  // namespace tetskin::io
