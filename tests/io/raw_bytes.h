// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <initializer_list>
#include <string>

namespace tetskin::test {

/// The bytes of numbers, on machines with the lowest byte first.
template <class Number>
std::string raw(std::initializer_list<Number> values) {
  std::string bytes(values.size() * sizeof(Number), '\0');
  std::memcpy(&bytes[0], values.begin(), bytes.size());
  return bytes;
}

/// The bytes of a number, the highest first or the lowest first, on any machine.
template <class Number>
std::string bytesOf(Number value, bool highestFirst) {
  std::string bytes(sizeof(value), '\0');
  std::memcpy(&bytes[0], &value, sizeof(value));
  const std::uint16_t one = 1;
  unsigned char first = 0;
  std::memcpy(&first, &one, 1);
  const bool isHighestFirst = first == 0;
  return isHighestFirst == highestFirst ? bytes : std::string(bytes.rbegin(), bytes.rend());
}

/// The bytes of numbers of one type, one after another.
template <class Number>
std::string bytesOfAll(std::initializer_list<double> values, bool highestFirst) {
  std::string bytes;
  for (const double value : values) bytes += bytesOf(static_cast<Number>(value), highestFirst);
  return bytes;
}

/// The bytes of a number, the highest first.
template <class Number>
std::string big(Number value) {
  return bytesOf(value, true);
}
template <class Number>
std::string bigAll(std::initializer_list<double> values) {
  return bytesOfAll<Number>(values, true);
}

inline std::string base64(const std::string& bytes) {
  const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    unsigned bits = 0;
    for (std::size_t k = 0; k < 3; ++k)
      bits = bits << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0);
    for (std::size_t k = 0; k < 4; ++k) text += i + k > bytes.size() ? '=' : digits[bits >> (18 - 6 * k) & 63];
  }
  return text;
}

}  // namespace tetskin::test
