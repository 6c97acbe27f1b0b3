// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/types.h>

#include <cstddef>
#include <string>
#include <string_view>

namespace tetskin::io {

/// One statement of an OBJ file: a line, continued by a backslash at its end. All views are into the text.
struct ObjStatement {
  std::string_view text;     ///< everything, from leading blanks to the line break
  std::string_view keyword;  ///< "v", "f", ...; empty for a blank line or a comment
  std::string_view rest;     ///< after the keyword
  std::size_t line = 0;      ///< number of its first line, from 1
};

/// Splits the text of an OBJ file into statements, which together make up the whole text. The text must outlive it.
class ObjScanner {
 public:
  explicit ObjScanner(std::string_view text) : rest_(text) {}
  /// False at the end of the text.
  bool next(ObjStatement& statement);

 private:
  std::string_view rest_;
  std::size_t line_ = 1;
};

/// Splits the part after the keyword (`ObjStatement::rest`) into words, up to a comment.
class ObjWords {
 public:
  explicit ObjWords(std::string_view rest) : rest_(rest) {}
  /// Empty at the end.
  std::string_view next();
  /// The rest of the statement as one name, which may contain blanks, without a comment and without surrounding blanks.
  std::string_view name();

 private:
  std::string_view rest_;
};

/// Drops a byte order mark.
std::string_view withoutMark(std::string_view text);

/// Reads an OBJ file's bytes. Errors: FileNotFound; Malformed if it is binary, such as a compiler's object file.
Result<std::string> readObjText(const std::string& path);

}  // namespace tetskin::io
