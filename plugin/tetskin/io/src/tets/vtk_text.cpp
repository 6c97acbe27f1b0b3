// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/io/src/tets/vtk_text.h>

#include <algorithm>

namespace tetskin::io {

std::string VtkText::lower(std::string_view word) {
  std::string result(word);
  std::transform(result.begin(), result.end(), result.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return result;
}

Status VtkText::readCount(const char* what, std::uint64_t& count) {
  const std::string_view word = in_.word();
  if (parseInteger(word, count)) return {};
  return error(StatusCode::Malformed, "has " + excerpt(word) + " as the number of " + what + "; correct the file");
}

Status VtkText::checkRoom(std::uint64_t count, const std::string& type) const {
  const NumberType numbers = vtkNumberType(type);
  if (binary_ && numbers.bytes == 0) {
    return error(StatusCode::UnsupportedFormat,
                 "has binary data of type " + excerpt(type) + ", which is not supported; save it as ASCII");
  }
  if (binary_ ? count <= in_.remaining() / numbers.bytes : in_.hasRoomFor(count)) return {};
  return error(StatusCode::Malformed, "states " + std::to_string(count) +
                                          " numbers, for which the file is too short; is it complete? Save it again");
}

Status VtkText::notANumber() const {
  return error(StatusCode::Malformed,
               "has something other than a number, or ends, within the data; is it complete? Save it again");
}

Status VtkText::readArrayHeader(VtkArray& array) {
  array.name = in_.word();
  if (array.name.empty()) return error(StatusCode::Malformed, "ends within FIELD; is it complete? Save it again");
  Status status = readCount("components", array.components);
  if (status.ok()) status = readCount("tuples", array.tuples);
  if (!status.ok()) return status;
  array.type = word();
  if (binary_ || array.type == "string") in_.restOfLine();
  return checkSize(array);
}

Status VtkText::checkSize(const VtkArray& array) const {
  if (array.components == 0 || array.tuples <= in_.remaining() / array.components) return {};
  return error(StatusCode::Malformed, "states an array larger than the file; is it complete? Save it again");
}

/// A binary string is its length, in 1, 2, 4 or 8 bytes depending on the two top bits, and its bytes.
Status VtkText::skipStrings(std::uint64_t count) {
  for (std::uint64_t i = 0; i < count; ++i) {
    if (in_.remaining() == 0) return notANumber();
    const auto first = static_cast<unsigned char>(TextScanner(in_).bytes(1)[0]);
    const std::size_t bytes = std::size_t(8) >> (first >> 6);
    if (in_.remaining() < bytes) return notANumber();
    const std::uint64_t bits = bitsAt(in_.bytes(bytes).data(), bytes, ByteOrder::Big);
    const std::uint64_t length = bits & ~(std::uint64_t{3} << (8 * bytes - 2));
    if (length > in_.remaining()) return notANumber();
    in_.bytes(static_cast<std::size_t>(length));
  }
  return {};
}

Status VtkText::skip(const VtkArray& array) {
  if (binary_ && (array.type == "string" || array.type == "utf8_string")) return skipStrings(array.count());
  if (binary_) {
    Status status = checkRoom(array.count(), array.type);
    if (status.ok()) in_.bytes(static_cast<std::size_t>(array.count()) * vtkNumberType(array.type).bytes);
    return status;
  }
  // A string has its own line, with its blanks encoded, and may be empty.
  for (std::uint64_t i = 0; i < array.count(); ++i) array.type == "string" ? in_.restOfLine() : in_.word();
  return {};
}

void VtkText::skipMetadata() {
  in_.restOfLine();
  while (in_.remaining() > 0 && !in_.restOfLine().empty()) continue;
}

}  // namespace tetskin::io
