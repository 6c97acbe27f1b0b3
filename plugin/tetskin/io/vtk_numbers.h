// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>

namespace tetskin::io {

/// A type of numbers in a binary VTK file.
struct VtkNumberType {
  std::size_t bytes = 0;  ///< 0: not a type of fixed size
  bool real = false;
  bool sign = true;
};

inline VtkNumberType vtkNumberType(const std::string& name) {
  if (name == "float") return {4, true};
  if (name == "double") return {8, true};
  if (name == "char" || name == "signed_char" || name == "vtktypeint8") return {1};
  if (name == "unsigned_char" || name == "vtktypeuint8") return {1, false, false};
  if (name == "short" || name == "vtktypeint16") return {2};
  if (name == "unsigned_short" || name == "vtktypeuint16") return {2, false, false};
  // Legacy files hold ids as int, however wide they are in memory.
  if (name == "int" || name == "vtktypeint32" || name == "vtkidtype") return {4};
  if (name == "unsigned_int" || name == "vtktypeuint32") return {4, false, false};
  if (name == "long" || name == "vtktypeint64" || name == "long_long") return {8};
  if (name == "unsigned_long" || name == "vtktypeuint64") return {8, false, false};
  return {};
}

/// A number of a binary file, which is big-endian on every machine.
inline std::uint64_t bigEndian(const char* data, std::size_t bytes) {
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < bytes; ++i) bits = bits << 8 | static_cast<unsigned char>(data[i]);
  return bits;
}

inline double decodeReal(const char* data, std::size_t bytes) {
  const std::uint64_t bits = bigEndian(data, bytes);
  if (bytes == sizeof(float)) {
    const auto narrow = static_cast<std::uint32_t>(bits);
    float value = 0;
    std::memcpy(&value, &narrow, sizeof(value));
    return value;
  }
  double value = 0;
  std::memcpy(&value, &bits, sizeof(value));
  return value;
}

inline std::int64_t decodeInteger(const char* data, const VtkNumberType& type) {
  const std::uint64_t bits = bigEndian(data, type.bytes);
  const unsigned unused = static_cast<unsigned>(64 - 8 * type.bytes);
  if (!type.sign) return static_cast<std::int64_t>(bits);
  return static_cast<std::int64_t>(bits << unused) >> unused;
}

}  // namespace tetskin::io
