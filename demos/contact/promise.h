// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// What is promised of contact by the surface, figure by figure.
#pragma once

#include <algorithm>
#include <limits>
#include <string>
#include <vector>

namespace tetskin::contact_demo {

/// A figure of all scenes whose names begin so lies between these.
struct Promise {
  const char* scene;
  const char* figure;
  double least = -std::numeric_limits<double>::infinity();
  double most = std::numeric_limits<double>::infinity();

  bool holds(double value) const { return value >= least && value <= most; }
  /// How far the value may still go; below 0: it is out by that.
  double slack(double value) const { return std::min(value - least, most - value); }
};

const std::vector<Promise>& promises();

/// Of several that fit, the one that names more of the scene; null where nothing is promised.
const Promise* promiseFor(const std::string& scene, const std::string& figure);

/// "<= 0.001", "0.9 .. 1.1".
std::string text(const Promise& promise);

}  // namespace tetskin::contact_demo
