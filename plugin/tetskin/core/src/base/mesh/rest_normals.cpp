// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/mesh.h>
#include <tetskin/core/src/base/mesh/area_vectors.h>
#include <tetskin/core/src/base/mesh/weld.h>

#include <cassert>
#include <cmath>
#include <limits>

namespace tetskin {
namespace {

/// How far an authored normal's length may be from 1.
constexpr float kUnitTolerance = 0.1f;

/// Normalises a sum of face vectors; returns false if it is 0.
bool normalise(Eigen::Vector3d& sum) {
  double squared = sum.squaredNorm();
  if (!(squared > std::numeric_limits<double>::min() && std::isfinite(squared))) {
    // Sums over tiny or huge triangles are scaled first, unless they are 0 or not finite.
    const double size = sum.cwiseAbs().maxCoeff();
    if (!(size > 0.0 && std::isfinite(size))) return false;
    sum /= size;
    squared = sum.squaredNorm();
    if (!std::isfinite(squared)) return false;  // the largest coordinate may hide another one that is NaN
  }
  sum /= std::sqrt(squared);
  return true;
}

}  // namespace

std::vector<Eigen::Vector3d> restNormals(const TriangleMesh& mesh) {
  std::vector<Eigen::Vector3d> normals(mesh.vertexCount(), Eigen::Vector3d::Zero());
  const std::vector<std::uint32_t> first = weldCoincident(viewOf(mesh.positions));
  assert(first.size() == mesh.vertexCount());
  sumAreaVectors(mesh, 0, [&](std::size_t v) -> Eigen::Vector3d& { return normals[first[v]]; });
  for (std::size_t v = 0; v < normals.size(); ++v) {
    if (first[v] < v) {
      normals[v] = normals[first[v]];  // already a unit vector
    } else if (!normalise(normals[v])) {
      normals[v] = Eigen::Vector3d::UnitY();
    }
  }
  if (mesh.normals.size() != mesh.vertexCount()) return normals;
  for (std::size_t v = 0; v < normals.size(); ++v) {
    const Eigen::Vector3f& n = mesh.normals[v];
    if (std::abs(n.norm() - 1.0f) < kUnitTolerance) normals[v] = n.cast<double>().normalized();
  }
  return normals;
}

}  // namespace tetskin
