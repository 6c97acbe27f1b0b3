// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/types.h>

#include <cmath>
#include <string>
#include <vector>

namespace tetskin {

/// Of values for each of something, or none: Ok, or that they are more or fewer, or which is not above 0, or it or its
/// inverse out of the range of Scalar.
/// name, of  the values, and one of what has them: "stiffnessScale", "tet"
/// times     what is made of the values; it must be in the range, too
template <class Scalar>
Status checkPositive(const std::vector<double>& values, std::size_t count, const char* name, const char* of,
                     double times = 1.0) {
  if (values.empty()) return {};
  if (values.size() != count) {
    return {StatusCode::SizeMismatch, std::string(name) + " has " + std::to_string(values.size()) + " values for " +
                                          std::to_string(count) + " " + of + "s; it takes one for each, or none"};
  }
  for (std::size_t k = 0; k < count; ++k) {
    const auto held = static_cast<Scalar>(values[k] * times);
    if (held > Scalar(0) && std::isfinite(held) && std::isfinite(1 / held)) continue;
    return {StatusCode::InvalidOption, std::string(name) + "[" + std::to_string(k) +
                                           "] must be above 0, and within the range of " +
                                           (sizeof(Scalar) == sizeof(float) ? "float" : "double")};
  }
  return {};
}

}  // namespace tetskin
