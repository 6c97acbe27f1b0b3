// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// This work is based on:
//   Ivan Sutherland, Gary Hodgman, "Reentrant Polygon Clipping", Communications of the ACM 17, 1974
#include <tetskin/cage/src/split/tet_clip.h>

#include <algorithm>
#include <cassert>

namespace tetskin::cage_detail {
namespace {

/// Barycentric distance within which an edge touches a tet: about as large as for triangles, see kTouch.
constexpr double kTouches = 1e-4;
/// A triangle has three corners, and each of four cuts adds at most one.
constexpr std::size_t kMaxCorners = 7;

struct Polygon {
  std::array<Eigen::Vector4d, kMaxCorners> corners;
  std::size_t count = 0;

  void add(const Eigen::Vector4d& corner) {
    assert(count < kMaxCorners);
    corners[count++] = corner;
  }
};

/// The part of the polygon where one weight is not negative.
Polygon cut(const Polygon& polygon, int weight) {
  Polygon kept;
  for (std::size_t k = 0; k < polygon.count; ++k) {
    const Eigen::Vector4d &a = polygon.corners[k], &b = polygon.corners[(k + 1) % polygon.count];
    const double from = a[weight], to = b[weight];
    if (from >= 0.0) kept.add(a);
    if ((from >= 0.0) != (to >= 0.0)) kept.add(a + (from / (from - to)) * (b - a));
  }
  return kept;
}

}  // namespace

bool passesThrough(const Eigen::Vector4d& from, const Eigen::Vector4d& to) {
  double first = 0.0, last = 1.0;
  for (int c = 0; c < 4; ++c) {
    const double a = from[c] + kTouches, b = to[c] + kTouches;
    if (a < 0.0 && b < 0.0) return false;
    if (a < 0.0) first = std::max(first, a / (a - b));
    if (b < 0.0) last = std::min(last, a / (a - b));
  }
  return first <= last;
}

Eigen::Vector4d centroidWithin(const std::array<Eigen::Vector4d, 3>& triangle) {
  Polygon polygon;
  for (const Eigen::Vector4d& corner : triangle) polygon.add(corner);
  for (int weight = 0; weight < 4; ++weight) {
    const Polygon kept = cut(polygon, weight);
    if (kept.count == 0) break;
    polygon = kept;
  }
  Eigen::Vector4d sum = Eigen::Vector4d::Zero();
  for (std::size_t k = 0; k < polygon.count; ++k) sum += polygon.corners[k];
  return sum / static_cast<double>(polygon.count);
}

}  // namespace tetskin::cage_detail
