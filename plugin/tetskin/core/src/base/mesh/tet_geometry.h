// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Pure functions of one tet, in double.
//
// This work is based on:
//   Matthias Müller, "100 x Simulation Speedup with Mesh Embedding", Ten Minute Physics 12, 2022 (barycentric distance)
#pragma once

#include <tetskin/core/mesh.h>
#include <tetskin/core/src/base/mesh/triangle_geometry.h>
#include <tetskin/core/types.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>

namespace tetskin {

/// A tet whose six-fold volume is below this fraction of the cube of its longest edge counts as flat: barycentric
/// weights, which divide by the volume, would then keep less than half of a double's digits. Dimensionless.
constexpr double kFlatTet = 1e-9;

using TetCorners = std::array<Eigen::Vector3d, 4>;

inline TetCorners cornersOf(const TetMesh& mesh, const Tet& tet) {
  return {mesh.nodes[tet[0]], mesh.nodes[tet[1]], mesh.nodes[tet[2]], mesh.nodes[tet[3]]};
}

inline bool shareNode(const Tet& a, const Tet& b) {
  return std::find_first_of(a.begin(), a.end(), b.begin(), b.end()) != a.end();
}

/// Signed volume; positive for a positively oriented tet.
inline double signedVolume(const TetCorners& p) {
  return (p[1] - p[0]).cross(p[2] - p[0]).dot(p[3] - p[0]) / 6.0;
}

/// Length of the longest edge: the size of a tet.
inline double tetSize(const TetCorners& p) {
  double squared = 0.0;
  for (int a = 0; a < 3; ++a) {
    for (int b = a + 1; b < 4; ++b) squared = std::max(squared, (p[a] - p[b]).squaredNorm());
  }
  return std::sqrt(squared);
}

inline double edgeSum(const TetCorners& p) {
  double sum = 0.0;
  for (int a = 0; a < 3; ++a) {
    for (int b = a + 1; b < 4; ++b) sum += (p[a] - p[b]).norm();
  }
  return sum;
}

/// True if the tet counts as flat, see kFlatTet.
inline bool isFlat(const TetCorners& p) {
  const double size = tetSize(p);
  return !(std::abs(6.0 * signedVolume(p)) > kFlatTet * size * size * size);
}

/// The map from a point to its barycentric weights in one tet: b_i = rows[i] . (v - p3) for i < 3, b_3 = 1 - b_0 - b_1
/// - b_2. The fourth is never an independent quotient, so the weights sum to 1.
struct BarycentricMap {
  Eigen::Vector3d origin;               ///< p3
  std::array<Eigen::Vector3d, 3> rows;  ///< gradients of b_0, b_1, b_2

  /// The tet must not be flat.
  explicit BarycentricMap(const TetCorners& p) : origin(p[3]) {
    const Eigen::Vector3d a = p[0] - p[3], b = p[1] - p[3], c = p[2] - p[3];
    const Eigen::Vector3d bc = b.cross(c);
    const double inverse = 1.0 / a.dot(bc);
    rows[0] = bc * inverse;
    rows[1] = c.cross(a) * inverse;
    rows[2] = a.cross(b) * inverse;
  }

  /// Weights of the four nodes at (x, y, z). The order of operations is written out, so that every caller decides on
  /// the same bits, whether or not its compiler vectorises the call.
  void weightsAt(double x, double y, double z, double& b0, double& b1, double& b2, double& b3) const {
    const double rx = x - origin.x(), ry = y - origin.y(), rz = z - origin.z();
    b0 = (rows[0].x() * rx + rows[0].y() * ry) + rows[0].z() * rz;
    b1 = (rows[1].x() * rx + rows[1].y() * ry) + rows[1].z() * rz;
    b2 = (rows[2].x() * rx + rows[2].y() * ry) + rows[2].z() * rz;
    b3 = ((1.0 - b0) - b1) - b2;
  }
  Eigen::Vector4d operator()(const Eigen::Vector3d& v) const {
    Eigen::Vector4d b;
    weightsAt(v.x(), v.y(), v.z(), b[0], b[1], b[2], b[3]);
    return b;
  }

  /// The gradients of all four weights.
  std::array<Eigen::Vector3d, 4> gradients() const {
    return {rows[0], rows[1], rows[2], -(rows[0] + rows[1] + rows[2])};
  }
  /// Length of the gradient of each weight: the inverse of the altitude over the opposite face.
  Eigen::Vector4d gradientLengths() const {
    return {rows[0].norm(), rows[1].norm(), rows[2].norm(), (rows[0] + rows[1] + rows[2]).norm()};
  }
};

/// Barycentric distance d = max(-b_i): at most 0 inside, then the distance over the altitude.
inline double barycentricDistance(const Eigen::Vector4d& weights) {
  return -weights.minCoeff();
}

/// How far weights extrapolate: the largest of their absolute values. Negative ones amplify a node's motion just as
/// much.
inline double largestWeight(const Eigen::Vector4d& weights) {
  return weights.cwiseAbs().maxCoeff();
}

/// Closest point of the tet to v; v itself if inside. `weights` are v's barycentric weights in the tet: only faces that
/// v lies beyond can contain the closest point.
inline Eigen::Vector3d closestPointInTet(const Eigen::Vector3d& v, const TetCorners& p,
                                         const Eigen::Vector4d& weights) {
  Eigen::Vector3d closest = v;
  double squared = std::numeric_limits<double>::infinity();
  const auto take = [&](const Eigen::Vector3d& q) {
    const double d = (v - q).squaredNorm();
    if (!(d < squared)) return;  // also skips NaN
    squared = d;
    closest = q;
  };
  bool inside = true;
  for (int i = 0; i < 4; ++i) {
    if (weights[i] >= 0.0) continue;
    inside = false;
    take(closestPointOnTriangle(v, p[(i + 1) % 4], p[(i + 2) % 4], p[(i + 3) % 4]).point);
  }
  if (inside || squared < std::numeric_limits<double>::infinity()) return closest;
  // From 1e20 sizes away, rounding may eliminate every point of a face; a corner is as near.
  for (const Eigen::Vector3d& corner : p) take(corner);
  return closest;
}

/// Distance from v to the tet, 0 inside; see `closestPointInTet`.
inline double distanceToTet(const Eigen::Vector3d& v, const TetCorners& p, const Eigen::Vector4d& weights) {
  return (v - closestPointInTet(v, p, weights)).norm();
}

/// Mean length of the edges of the tets that are not flat, of which there must be one; an edge that several tets share
/// counts once for each. The unit for how far from its nearest tet a vertex may be moved. Cost O(T).
inline double meanEdge(const TetMesh& mesh) {
  double sum = 0.0;
  std::size_t count = 0;
  for (const Tet& tet : mesh.tets) {
    const TetCorners p = cornersOf(mesh, tet);
    if (isFlat(p)) continue;
    sum += edgeSum(p);
    count += 6;
  }
  assert(count > 0);
  return sum / static_cast<double>(count);
}

}  // namespace tetskin
