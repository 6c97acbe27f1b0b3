// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

namespace tetskin::scenes {

/// Median of some numbers, the upper one if their number is even; 0 if there are none.
inline double median(std::vector<double> values) {
  if (values.empty()) return 0.0;
  const auto centroid = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), centroid, values.end());
  return *centroid;
}

/// Root mean square of at least one number.
inline double rms(const std::vector<double>& values) {
  double squared = 0.0;
  for (const double value : values) squared += value * value;
  return std::sqrt(squared / static_cast<double>(values.size()));
}

}  // namespace tetskin::scenes
