// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

namespace tetskin::io {

/// A type of numbers in a binary file.
struct NumberType {
  std::size_t bytes = 0;  ///< 0: not a type of fixed size
  bool real = false;
  bool sign = true;
};

inline NumberType vtkNumberType(std::string_view name) {
  if (name == "float") return {4, true};
  if (name == "double") return {8, true};
  if (name == "char" || name == "signed_char" || name == "vtktypeint8") return {1};
  if (name == "unsigned_char" || name == "vtktypeuint8") return {1, false, false};
  if (name == "short" || name == "vtktypeint16") return {2};
  if (name == "unsigned_short" || name == "vtktypeuint16") return {2, false, false};
  // Legacy files store ids as int, whatever their width in memory.
  if (name == "int" || name == "vtktypeint32" || name == "vtkidtype") return {4};
  if (name == "unsigned_int" || name == "vtktypeuint32") return {4, false, false};
  if (name == "long" || name == "vtktypeint64" || name == "long_long") return {8};
  if (name == "unsigned_long" || name == "vtktypeuint64") return {8, false, false};
  return {};
}

inline NumberType plyNumberType(std::string_view name) {
  if (name == "float" || name == "float32") return {4, true};
  if (name == "double" || name == "float64") return {8, true};
  if (name == "char" || name == "int8") return {1};
  if (name == "uchar" || name == "uint8") return {1, false, false};
  if (name == "short" || name == "int16") return {2};
  if (name == "ushort" || name == "uint16") return {2, false, false};
  if (name == "int" || name == "int32") return {4};
  if (name == "uint" || name == "uint32") return {4, false, false};
  return {};
}

enum class ByteOrder { Big, Little };

/// The bits of a number in a file, on any machine.
inline std::uint64_t bitsAt(const char* data, std::size_t bytes, ByteOrder order) {
  assert(data && bytes > 0 && bytes <= 8);
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < bytes; ++i) {
    bits = bits << 8 | static_cast<unsigned char>(data[order == ByteOrder::Big ? i : bytes - 1 - i]);
  }
  return bits;
}

inline std::int64_t decodeInteger(const char* data, const NumberType& type, ByteOrder order = ByteOrder::Big) {
  const std::uint64_t bits = bitsAt(data, type.bytes, order);
  const unsigned unused = static_cast<unsigned>(64 - 8 * type.bytes);
  if (!type.sign) return static_cast<std::int64_t>(bits);
  return static_cast<std::int64_t>(bits << unused) >> unused;
}

inline double decodeNumber(const char* data, const NumberType& type, ByteOrder order = ByteOrder::Big) {
  assert(!type.real || type.bytes == sizeof(float) || type.bytes == sizeof(double));
  if (!type.real) return static_cast<double>(decodeInteger(data, type, order));
  const std::uint64_t bits = bitsAt(data, type.bytes, order);
  if (type.bytes == sizeof(float)) {
    const auto narrow = static_cast<std::uint32_t>(bits);
    float value = 0;
    std::memcpy(&value, &narrow, sizeof(value));
    return static_cast<double>(value);
  }
  double value = 0;
  std::memcpy(&value, &bits, sizeof(value));
  return value;
}

}  // namespace tetskin::io
