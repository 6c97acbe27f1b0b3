// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The promise for each figure; in scenes of contact, for contact at the surface.
#pragma once

#include <limits>
#include <string>
#include <vector>

namespace tetskin::measure {

/// This figure lies between two bounds in all scenes whose names begin with a given text.
struct Promise {
  const char* scene;
  const char* figure;
  double minimum = -std::numeric_limits<double>::infinity();
  double maximum = std::numeric_limits<double>::infinity();

  bool holds(double value) const { return value >= minimum && value <= maximum; }
};

const std::vector<Promise>& promises();

/// The promise for a figure of a scene. If several fit, the one that matches more of the scene's name; null where
/// nothing is promised.
const Promise* promiseFor(const std::string& scene, const std::string& figure);

/// "<= 0.001", "0.9 .. 1.1".
std::string text(const Promise& promise);

}  // namespace tetskin::measure
