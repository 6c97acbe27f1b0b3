// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/types.h>

#include <cmath>
#include <string>
#include <vector>

namespace tetskin {

/// Checks one value per element, or none at all. Returns Ok, or reports a wrong number of values, or the first value
/// that is not above 0, or that is out of the range of Scalar itself or by its inverse.
/// name, label  of the values, and of one element: "stiffnessScale", "tet"
/// times        a factor of the values; the product must be in range, too
template <class Scalar>
Status checkPositive(const std::vector<double>& values, std::size_t count, const char* name, const char* label,
                     double times = 1.0) {
  if (values.empty()) return {};
  if (values.size() != count) {
    return {StatusCode::SizeMismatch, std::string(name) + " has " + std::to_string(values.size()) + " values for " +
                                          std::to_string(count) + " " + label + "s; pass one value per " + label +
                                          ", or none"};
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
