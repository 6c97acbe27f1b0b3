// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <charconv>
#include <limits>
#include <string_view>
#include <system_error>

namespace tetskin::io {

/// Reads a token that is one number and nothing else: decimal or scientific, with an optional sign, also "inf" and
/// "nan". Correctly rounded, whatever the locale. A number too large for double is infinite, one too small is 0.
/// Returns false, with `value` unspecified, if the token is not a number.
inline bool parseDouble(std::string_view token, double& value) {
  const char* first = token.data();
  const char* last = first + token.size();
  // std::from_chars takes no plus sign.
  if (token.size() > 1 && *first == '+' && first[1] != '-') ++first;
  const auto [end, error] = std::from_chars(first, last, value);
  if (end != last || error == std::errc::invalid_argument) return false;
  if (error == std::errc::result_out_of_range) {
    const bool tiny = token.find("e-") != token.npos || token.find("E-") != token.npos;
    value = tiny ? 0.0 : std::numeric_limits<double>::infinity();
  }
  return true;
}

/// Reads a token that is one whole number and nothing else, with an optional sign; false if it is not, or does not fit.
template <class Integer>
bool parseInteger(std::string_view token, Integer& value) {
  const char* first = token.data();
  const char* last = first + token.size();
  if (token.size() > 1 && *first == '+' && first[1] != '-') ++first;
  const auto [end, error] = std::from_chars(first, last, value);
  return error == std::errc() && end == last;
}

/// Room that `formatNumber` needs: the longest double is -2.2250738585072014e-308.
constexpr int kNumberRoom = 25;

/// Writes the shortest text that reads back as the same number, and returns its end. `out` has room for kNumberRoom.
template <class Number>
char* formatNumber(char* out, Number value) {
  return std::to_chars(out, out + kNumberRoom, value).ptr;
}

/// Appends the same to a text.
template <class Text, class Number>
void appendNumber(Text& text, Number value) {
  char digits[kNumberRoom];
  text.append(digits, formatNumber(digits, value));
}

}  // namespace tetskin::io
