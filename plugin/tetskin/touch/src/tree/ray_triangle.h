// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to SurfaceTree: where a ray meets a triangle.
//
// This work is based on:
//   Tomas Möller and Ben Trumbore, "Fast, Minimum Storage Ray/Triangle Intersection", Journal of Graphics Tools 2,
//   1997, doi 10.1080/10867651.1997.10487468
#pragma once

#include <tetskin/core/src/base/mesh/triangle_geometry.h>

namespace tetskin::touch_detail {

/// A segment of a line: from `start` to `start` plus `end` times `direction`.
struct Ray {
  Eigen::Vector3d start, direction;
  double end = 1.0;
};

struct RayHit {
  int triangle = -1;                 ///< of the mesh; -1: none
  int index = -1;                    ///< index of the triangle in the hierarchy
  double at = 0.0;                   ///< in units of the ray's direction
  double second = 0.0, third = 0.0;  ///< weights of the second and third corner
};

/// Finds where a ray meets a triangle, from either side. Does not set the triangle's numbers. Returns false, and writes
/// nothing, if the ray misses or the triangle has no area.
inline bool collides(const Ray& ray, const TriangleCorners& triangle, RayHit& hit) {
  // A tolerance, so that a ray that rounding would let pass between two triangles hits both.
  constexpr double kEdge = 1e-12;
  const Eigen::Vector3d &a = triangle[0], &b = triangle[1], &c = triangle[2];
  const Eigen::Vector3d first = b - a, second = c - a, across = ray.direction.cross(second), from = ray.start - a;
  const double volume = first.dot(across);
  if (!(volume * volume > 0.0)) return false;
  const double u = from.dot(across) / volume;
  if (!(u >= -kEdge && u <= 1.0 + kEdge)) return false;
  const Eigen::Vector3d turned = from.cross(first);
  const double v = ray.direction.dot(turned) / volume;
  if (!(v >= -kEdge && u + v <= 1.0 + kEdge)) return false;
  const double at = second.dot(turned) / volume;
  if (!(at >= 0.0 && at <= ray.end)) return false;
  hit.at = at;
  hit.second = u;
  hit.third = v;
  return true;
}

}  // namespace tetskin::touch_detail
