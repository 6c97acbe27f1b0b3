// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <algorithm>
#include <cassert>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string_view>
#include <system_error>
#ifndef __cpp_lib_to_chars  // libc++ has long lacked these functions for floating-point numbers
#include <stdio.h>
#include <stdlib.h>
#include <string>
#include <type_traits>
#if __has_include(<xlocale.h>)
#include <xlocale.h>  // macOS
#else
#include <locale.h>
#endif
#endif

namespace tetskin::io {

/// Reads a token that is exactly one integer, with an optional sign; false if it is not, or does not fit.
template <class Integer>
bool parseInteger(std::string_view token, Integer& value) {
  const char* first = token.data();
  const char* last = first + token.size();
  if (token.size() > 1 && *first == '+' && first[1] != '-') ++first;
  const auto [end, error] = std::from_chars(first, last, value);
  return error == std::errc() && end == last;
}

/// True if a number is 1 or more, false if it is less, judged by its text: it may be far outside the range of double.
inline bool isLarge(std::string_view token) {
  assert(!token.empty());
  const std::size_t mark = std::min(token.find_first_of("eE"), token.size());
  const std::string_view digits = token.substr(0, mark);
  const std::size_t first = std::min(digits.find_first_of("123456789"), digits.size());
  const std::size_t point = std::min(digits.find('.'), digits.size());
  // The exponent in 0.d1 d2 d3 ... times 10^places, without the stated exponent; a point before the first digit is
  // included.
  const std::int64_t indices =
      static_cast<std::int64_t>(point) - static_cast<std::int64_t>(first) + (point < first ? 1 : 0);
  if (mark == token.size()) return indices > 0;
  std::int32_t exponent = 0;
  if (parseInteger(token.substr(mark + 1), exponent)) return indices + exponent > 0;
  return token[mark + 1] != '-';  // no text is as long as that exponent
}

/// Reads a token that is exactly one number: decimal or scientific, with an optional sign, also "inf" and "nan".
/// Correctly rounded, in any locale. A number too large for double becomes infinite, with its sign; one too small
/// becomes 0. Returns false, with `value` unspecified, if the token is not a number.
inline bool parseDouble(std::string_view token, double& value) {
#ifdef __cpp_lib_to_chars
  const char* first = token.data();
  const char* last = first + token.size();
  // std::from_chars does not accept a plus sign.
  if (token.size() > 1 && *first == '+' && first[1] != '-') ++first;
  const auto [end, error] = std::from_chars(first, last, value);
  if (end != last || error == std::errc::invalid_argument) return false;
  if (error == std::errc::result_out_of_range) {
    const double huge = std::numeric_limits<double>::infinity();
    value = !isLarge(token) ? 0.0 : *first == '-' ? -huge : huge;
  }
  return true;
#else
  // strtod accepts more than std::from_chars: numbers after blanks, and hexadecimal ones.
  if (token.empty() || token.find_first_of(" \t\n\v\f\rxX") != token.npos || token.find('\0') != token.npos)
    return false;
  static const locale_t kPlain = newlocale(LC_ALL_MASK, "C", nullptr);
  const std::string text(token);
  char* end = nullptr;
  value = strtod_l(text.c_str(), &end, kPlain);
  return end == text.c_str() + text.size();
#endif
}

/// Memory that `formatNumber` needs: the longest double is -2.2250738585072014e-308.
constexpr int kNumberRoom = 25;

#ifndef __cpp_lib_to_chars
/// With as many digits as necessary, in the plain locale.
template <class Real>
char* formatByTrying(char* out, Real value) {
  double same = 0;
  int length = 0;
  for (int digits = 1; digits <= std::numeric_limits<Real>::max_digits10; ++digits) {
    length = snprintf(out, kNumberRoom, "%.*g", digits, static_cast<double>(value));
    std::replace(out, out + length, ',', '.');
    if (parseDouble({out, static_cast<std::size_t>(length)}, same) && static_cast<Real>(same) == value) break;
  }
  return out + length;
}
#endif

/// Writes the shortest text that reads back as the same number, and returns its end. `out` has room for kNumberRoom
/// characters.
template <class Number>
char* formatNumber(char* out, Number value) {
#ifndef __cpp_lib_to_chars
  if constexpr (std::is_floating_point_v<Number>)
    return formatByTrying(out, value);
  else
#endif
    return std::to_chars(out, out + kNumberRoom, value).ptr;
}

/// Appends the shortest text that reads back as the same number.
template <class Text, class Number>
void appendNumber(Text& text, Number value) {
  char digits[kNumberRoom];
  text.append(digits, formatNumber(digits, value));
}

}  // namespace tetskin::io
