// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Pure functions of one triangle, in double.
//
// This work is based on:
//   Christer Ericson, "Real-Time Collision Detection", 2005, section 5.1.5 (closest point on a triangle)
#pragma once

#include <tetskin/core/mesh.h>

#include <algorithm>
#include <array>
#include <cstddef>

namespace tetskin {

using TriangleCorners = std::array<Eigen::Vector3d, 3>;

inline TriangleCorners cornersOf(const TriangleMesh& mesh, const std::array<int, 3>& triangle) {
  const auto corner = [&](std::size_t k) -> const Eigen::Vector3d& {
    return mesh.positions[static_cast<std::size_t>(triangle[k])];
  };
  return {corner(0), corner(1), corner(2)};
}

/// Squared sine of a triangle's angle below which rounding leaves only its sides.
constexpr double kThinTriangle = 1e-14;

struct ClosestPoint {
  Eigen::Vector3d point;
  Eigen::Vector3d weights;  ///< of the corners: none below 0, sum 1 within rounding
};

/// The closest point of the side from one corner to another.
inline ClosestPoint closestPointOnSide(const Eigen::Vector3d& p, const TriangleCorners& t, int a, int b) {
  const Eigen::Vector3d side = t[b] - t[a];
  const double length = side.squaredNorm();
  const double at = length > 0.0 ? std::clamp((p - t[a]).dot(side) / length, 0.0, 1.0) : 0.0;
  ClosestPoint closest{t[a] + at * side, Eigen::Vector3d::Zero()};
  closest.weights[a] = 1.0 - at;
  closest.weights[b] = at;
  return closest;
}

/// The closest point of the three sides: for a triangle without area.
inline ClosestPoint closestPointOnSides(const Eigen::Vector3d& p, const TriangleCorners& t) {
  ClosestPoint best = closestPointOnSide(p, t, 0, 1);
  for (int a = 1; a < 3; ++a) {
    const ClosestPoint other = closestPointOnSide(p, t, a, (a + 1) % 3);
    if ((other.point - p).squaredNorm() < (best.point - p).squaredNorm()) best = other;
  }
  return best;
}

/// The point of a triangle, possibly without area, that is closest to p.
inline ClosestPoint closestPointOnTriangle(const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                           const Eigen::Vector3d& c) {
  const Eigen::Vector3d ab = b - a, ac = c - a, ap = p - a;
  const double d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0.0 && d2 <= 0.0) return {a, {1.0, 0.0, 0.0}};
  const Eigen::Vector3d bp = p - b;
  const double d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0.0 && d4 <= d3) return {b, {0.0, 1.0, 0.0}};
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 && d1 > d3) {
    const double w = d1 / (d1 - d3);
    return {a + ab * w, {1.0 - w, w, 0.0}};
  }
  const Eigen::Vector3d cp = p - c;
  const double d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0.0 && d5 <= d6) return {c, {0.0, 0.0, 1.0}};
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 && d2 > d6) {
    const double w = d2 / (d2 - d6);
    return {a + ac * w, {1.0 - w, 0.0, w}};
  }
  const double va = d3 * d6 - d5 * d4;
  const double fromB = d4 - d3, fromC = d5 - d6;
  if (va <= 0.0 && fromB >= 0.0 && fromC >= 0.0 && fromB + fromC > 0.0) {
    const double w = fromB / (fromB + fromC);
    return {b + (c - b) * w, {0.0, 1.0 - w, w}};
  }
  const double sum = va + vb + vc;
  const bool thin = !(sum > kThinTriangle * ab.squaredNorm() * ac.squaredNorm());
  if (thin || !(va >= 0.0 && vb >= 0.0 && vc >= 0.0)) return closestPointOnSides(p, {a, b, c});
  const double scale = 1.0 / sum, v = vb * scale, w = vc * scale;
  return {a + ab * v + ac * w, {1.0 - v - w, v, w}};
}

inline ClosestPoint closestPointOnTriangle(const Eigen::Vector3d& p, const TriangleCorners& t) {
  return closestPointOnTriangle(p, t[0], t[1], t[2]);
}

}  // namespace tetskin
