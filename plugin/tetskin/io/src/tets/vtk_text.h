// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/io/src/text/binary_numbers.h>
#include <tetskin/io/src/text/file_text.h>
#include <tetskin/io/src/text/text_scanner.h>

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <type_traits>

namespace tetskin::io {

/// The header of an array: `components` numbers for each of `tuples`.
struct VtkArray {
  std::string name;
  std::uint64_t components = 0, tuples = 0;
  std::string type;  ///< in lower case

  std::uint64_t count() const { return components * tuples; }
};

/// The elements of every section of a legacy VTK file: words, counts, and arrays of numbers, as text or as bytes. The
/// path and the text must outlive it.
class VtkText {
 public:
  VtkText(const std::string& path, std::string_view text) : path_(path), in_(text) {}

  const std::string& path() const { return path_; }
  bool binary() const { return binary_; }
  void setBinary(bool binary) { binary_ = binary; }
  std::size_t line() const { return in_.line(); }

  /// The next word, unchanged or in lower case; empty at the end of the file.
  std::string_view name() { return in_.word(); }
  std::string word() { return lower(in_.word()); }
  /// Looks ahead at the next word, without reading it.
  std::string wordAhead() const { return lower(TextScanner(in_).word()); }
  std::string_view restOfLine() { return in_.restOfLine(); }
  /// The next word as an integer; false if it is not one.
  bool integer(std::int64_t& value) { return in_.integer(value); }
  /// Binary data begins on the next line; text may continue on the same one.
  void endHeader() {
    if (binary_) in_.restOfLine();
  }

  /// How many values memory may be reserved for: each takes at least a byte of the file.
  std::size_t room(std::uint64_t count) const { return std::min<std::uint64_t>(count, in_.remaining()); }

  Status readCount(const char* what, std::uint64_t& count);

  /// Passes the next `count` numbers of a type, one after the other, to take(number), which returns a Status.
  template <class Number, class Take>
  Status readNumbers(std::uint64_t count, const std::string& type, Take&& take);

  /// Reads the arrays of a FIELD, whose keyword has been read: calls read(array), which returns a Status, for each of
  /// them.
  template <class Read>
  Status readField(Read&& read);

  /// Ok unless the file has less than one byte for each number of an array.
  Status checkSize(const VtkArray& array) const;
  /// Skips the numbers, or strings, of an array of this size.
  Status skip(const VtkArray& array);
  /// Skips metadata, whose keyword has been read; it ends with an empty line.
  void skipMetadata();

  Status error(StatusCode code, const std::string& what) const { return fileError(code, path_, in_.line(), what); }

  static std::string lower(std::string_view word);

 private:
  Status checkRoom(std::uint64_t count, const std::string& type) const;
  Status notANumber() const;
  Status readArrayHeader(VtkArray& array);
  Status skipStrings(std::uint64_t count);

  template <class Number>
  static Number decode(const char* data, const NumberType& type) {
    if constexpr (std::is_floating_point_v<Number>) {
      return decodeNumber(data, type);
    } else {
      return static_cast<Number>(decodeInteger(data, type));
    }
  }
  template <class Number>
  bool next(Number& value) {
    if constexpr (std::is_floating_point_v<Number>) {
      return in_.number(value);
    } else {
      return in_.integer(value);
    }
  }

  const std::string& path_;
  TextScanner in_;
  bool binary_ = false;
};

template <class Number, class Take>
Status VtkText::readNumbers(std::uint64_t count, const std::string& type, Take&& take) {
  static_assert(std::is_same_v<Number, double> || std::is_same_v<Number, std::int64_t>);
  if (Status status = checkRoom(count, type); !status.ok()) return status;
  const NumberType numbers = vtkNumberType(type);
  if (binary_ && numbers.real && !std::is_floating_point_v<Number>) {
    return error(StatusCode::Malformed, "has indices of unsupported type " + excerpt(type) + "; save it again");
  }
  const char* data = binary_ ? in_.bytes(static_cast<std::size_t>(count) * numbers.bytes).data() : nullptr;
  assert(!binary_ || numbers.bytes > 0);
  for (std::uint64_t i = 0; i < count; ++i) {
    Number value = 0;
    if (binary_) {
      value = decode<Number>(data + i * numbers.bytes, numbers);
    } else if (!next(value)) {
      return notANumber();
    }
    if (Status status = take(value); !status.ok()) return status;
  }
  return {};
}

template <class Read>
Status VtkText::readField(Read&& read) {
  in_.word();  // its name
  std::uint64_t arrays = 0;
  Status status = readCount("field arrays", arrays);
  for (std::uint64_t i = 0; status.ok() && i < arrays; ++i) {
    VtkArray array;
    status = readArrayHeader(array);
    if (status.ok()) status = read(array);
    if (!status.ok() || wordAhead() != "metadata") continue;
    in_.word();
    skipMetadata();
  }
  return status;
}

}  // namespace tetskin::io
