// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/contact/src/rigid/triangle_distance.h>

#include <algorithm>

namespace tetskin {
namespace {

btVector3 closestOnSegment(const btVector3& a, const btVector3& b, const btVector3& point) {
  const btVector3 along = b - a;
  const btScalar squared = along.length2();
  if (!(squared > 0)) return a;
  return a + std::clamp(along.dot(point - a) / squared, btScalar(0), btScalar(1)) * along;
}

}  // namespace

btVector3 closestOnTriangle(const TriangleCorners& corners, const btVector3& point) {
  const btVector3 ab = corners[1] - corners[0], ac = corners[2] - corners[0], ap = point - corners[0];
  const btVector3 normal = ab.cross(ac);
  const btScalar area = normal.length2();
  // Weights of the second and the third corner at the point's projection.
  const btScalar second = ap.cross(ac).dot(normal), third = ab.cross(ap).dot(normal);
  if (area > 0 && second >= 0 && third >= 0 && second + third <= area) {
    return corners[0] + (second / area) * ab + (third / area) * ac;
  }
  btVector3 best = closestOnSegment(corners[0], corners[1], point);
  for (std::size_t k = 1; k < 3; ++k) {
    const btVector3 other = closestOnSegment(corners[k], corners[(k + 1) % 3], point);
    if ((other - point).length2() < (best - point).length2()) best = other;
  }
  return best;
}

}  // namespace tetskin
