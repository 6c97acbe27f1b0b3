// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// This work is based on:
//   G. H. Meisters, "Polygons Have Ears", The American Mathematical Monthly 82, 1975
//   Martin Newell's area vector, as in Sutherland, Sproull, Schumacker, "A Characterization of Ten Hidden-Surface
//   Algorithms", 1974
#include <tetskin/io/src/mesh/polygon.h>

#include <cassert>

namespace tetskin::io {

namespace {

using Point = Eigen::Vector2d;

/// Number of failed searches for an ear, each of quadratic time, after which the rest is cut off corner by corner.
/// Polygons that touch themselves need a few; those that cross themselves, nearly one per corner.
constexpr std::size_t kMaxFailures = 4;

/// The polygon projected along the axis nearest to its area vector, so that it is counter-clockwise.
std::vector<Point> flattened(const std::vector<Eigen::Vector3d>& positions, const std::vector<int>& corners) {
  const auto at = [&](std::size_t i) { return positions[static_cast<std::size_t>(corners[i % corners.size()])]; };
  Eigen::Vector3d area(0, 0, 0);
  for (std::size_t i = 1; i + 1 < corners.size(); ++i) area += (at(i) - at(0)).cross(at(i + 1) - at(0));
  Eigen::Index axis = 0;
  area.cwiseAbs().maxCoeff(&axis);
  const Eigen::Index u = (axis + 1) % 3, v = (axis + 2) % 3;
  const double side = area[axis] < 0.0 ? -1.0 : 1.0;
  std::vector<Point> points;
  for (std::size_t i = 0; i < corners.size(); ++i) points.emplace_back(at(i)[u] * side, at(i)[v]);
  return points;
}

/// Twice the area of a triangle; positive if it is counter-clockwise.
double turn(const Point& a, const Point& b, const Point& c) {
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

bool isConvex(const std::vector<Point>& points) {
  const std::size_t count = points.size();
  for (std::size_t i = 0; i < count; ++i) {
    if (turn(points[i], points[(i + 1) % count], points[(i + 2) % count]) < 0.0) return false;
  }
  return true;
}

/// True if the middle one of three corners is convex, and none of the polygon's corners lies in their triangle.
bool isEar(const std::vector<Point>& points, const std::vector<std::size_t>& left, std::size_t centroid) {
  assert(centroid < left.size() && left.size() >= 3);
  const std::size_t count = left.size();
  const Point& a = points[left[(centroid + count - 1) % count]];
  const Point& b = points[left[centroid]];
  const Point& c = points[left[(centroid + 1) % count]];
  if (!(turn(a, b, c) > 0.0)) return false;
  for (const std::size_t other : left) {
    const Point& p = points[other];
    if (p == a || p == b || p == c) continue;
    if (turn(a, b, p) >= 0.0 && turn(b, c, p) >= 0.0 && turn(c, a, p) >= 0.0) return false;
  }
  return true;
}

void clipEars(const std::vector<Point>& points, const std::vector<int>& corners,
              std::vector<std::array<int, 3>>& triangles) {
  assert(points.size() == corners.size());
  std::vector<std::size_t> left(points.size());
  for (std::size_t i = 0; i < left.size(); ++i) left[i] = i;
  std::size_t mayFail = kMaxFailures;
  for (std::size_t count = left.size(); count > 2; --count) {
    std::size_t ear = 0;
    while (mayFail > 0 && ear < count && !isEar(points, left, ear)) ++ear;
    if (ear == count) {
      ear = 0;
      --mayFail;
    }
    triangles.push_back(
        {corners[left[(ear + count - 1) % count]], corners[left[ear]], corners[left[(ear + 1) % count]]});
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(ear));
  }
}

}  // namespace

void appendPolygon(const std::vector<Eigen::Vector3d>& positions, const std::vector<int>& corners,
                   std::vector<std::array<int, 3>>& triangles) {
  assert(corners.size() >= 3);
  if (corners.size() > 3 && corners.size() <= kMaxConcaveCorners) {
    const std::vector<Point> points = flattened(positions, corners);
    if (!isConvex(points)) return clipEars(points, corners, triangles);
  }
  for (std::size_t i = 1; i + 1 < corners.size(); ++i) triangles.push_back({corners[0], corners[i], corners[i + 1]});
}

}  // namespace tetskin::io
