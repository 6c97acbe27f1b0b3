// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/io/src/mesh/obj_scanner.h>
#include <tetskin/io/src/text/file_text.h>

#include <algorithm>
#include <cassert>

namespace tetskin::io {

namespace {

bool isBlank(char c) {
  return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f';
}

/// Length of a backslash with the line break after it, or 0. A backslash at the very end of the file counts.
std::size_t continuation(std::string_view text) {
  if (text.empty() || text[0] != '\\') return 0;
  if (text.size() == 1) return 1;
  if (text[1] == '\n') return 2;
  return text[1] == '\r' && text.size() > 2 && text[2] == '\n' ? 3 : 0;
}

std::size_t blankLength(std::string_view text) {
  std::size_t length = 0;
  while (length < text.size()) {
    const std::size_t step = isBlank(text[length]) ? 1 : continuation(text.substr(length));
    if (step == 0) break;
    length += step;
  }
  return length;
}

std::size_t wordLength(std::string_view text) {
  std::size_t length = 0;
  while (length < text.size() && !isBlank(text[length]) && text[length] != '\n' &&
         (text[length] != '\\' || continuation(text.substr(length)) == 0)) {
    ++length;
  }
  return length;
}

/// Length up to the line break that ends the statement. A backslash at the end of a comment does not continue it: it
/// may end a Windows path.
std::size_t statementLength(std::string_view text, bool comment) {
  std::size_t end = text.find('\n');
  while (end != text.npos && !comment) {
    std::size_t last = end;
    if (last > 0 && text[last - 1] == '\r') --last;
    if (last == 0 || text[last - 1] != '\\') break;
    end = text.find('\n', end + 1);
  }
  return std::min(end, text.size());
}

}  // namespace

bool ObjScanner::next(ObjStatement& statement) {
  if (rest_.empty()) return false;
  std::size_t blanks = 0;
  while (blanks < rest_.size() && isBlank(rest_[blanks])) ++blanks;
  const std::string_view body = rest_.substr(blanks);
  const bool comment = !body.empty() && body[0] == '#';
  const std::size_t length = statementLength(body, comment);
  const std::size_t keyword = comment ? 0 : wordLength(body.substr(0, length));

  statement.line = line_;
  statement.text = rest_.substr(0, std::min(rest_.size(), blanks + length + 1));
  statement.keyword = body.substr(0, keyword);
  statement.rest = body.substr(keyword, length - keyword);
  // Only statements with a backslash span lines, so most need no counting.
  const bool oneLine = statement.rest.find('\\') == statement.rest.npos;
  line_ += oneLine ? 1 : static_cast<std::size_t>(std::count(statement.text.begin(), statement.text.end(), '\n'));
  assert(!statement.text.empty() && statement.text.size() <= rest_.size());
  rest_.remove_prefix(statement.text.size());
  return true;
}

std::string_view ObjWords::next() {
  rest_.remove_prefix(blankLength(rest_));
  if (!rest_.empty() && rest_[0] == '#') rest_ = rest_.substr(0, 0);
  const std::string_view word = rest_.substr(0, wordLength(rest_));
  rest_.remove_prefix(word.size());
  return word;
}

std::string_view ObjWords::name() {
  const std::string_view first = next();
  if (first.empty()) return {};
  const char* end = first.data() + first.size();
  for (std::string_view word = next(); !word.empty(); word = next()) end = word.data() + word.size();
  return {first.data(), static_cast<std::size_t>(end - first.data())};
}

std::string_view withoutMark(std::string_view text) {
  if (text.substr(0, 3) == "\xEF\xBB\xBF") text.remove_prefix(3);
  return text;
}

Result<std::string> readObjText(const std::string& path) {
  Result<std::string> text = readText(path);
  if (text.ok() && text.value().find('\0') != std::string::npos) {
    return fileError(StatusCode::Malformed, path, 0,
                     "is binary, not the text of a Wavefront OBJ model (a compiler's object file, or UTF-16?); save it "
                     "as plain text");
  }
  return text;
}

}  // namespace tetskin::io
