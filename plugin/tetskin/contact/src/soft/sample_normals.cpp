// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/bullet/soft_body.h>
#include <tetskin/contact/src/soft/sample_normals.h>
#include <tetskin/core/src/base/mesh/weld.h>

#include <algorithm>

namespace tetskin::contact_detail {
namespace {

/// Cosine between a sample's normal and those of the triangles around it: below this, the sample is on a tip. At the
/// corner of a box it is 0.58.
constexpr btScalar kAround = btScalar(0.5);

/// 0 where the grid has none.
btVector3 gradientAt(const DistanceGrid& grid, const Eigen::Vector3d& point) {
  GridDistance at;
  const bool known = grid.at(toBullet(point), at) && at.gradient.length() > kNoDirection;
  return known ? at.gradient : btVector3(0, 0, 0);
}

btVector3 normalOf(const TriangleMesh& mesh, const std::array<int, 3>& t) {
  const Eigen::Vector3d& a = mesh.positions[t[0]];
  return toBullet((mesh.positions[t[1]] - a).cross(mesh.positions[t[2]] - a).normalized());
}

/// By vertex: the smallest dot product of the grid's gradient with a normal of the triangles around it.
std::vector<btScalar> leastAround(const TriangleMesh& mesh, const std::vector<int>& triangles,
                                  const DistanceGrid& grid) {
  // At seams and tips, several vertices share a position.
  const std::vector<std::uint32_t> first = weldCoincident(viewOf(mesh.positions));
  std::vector<btScalar> least(mesh.vertexCount(), 1);
  for (const int t : triangles) {
    const btVector3 normal = normalOf(mesh, mesh.triangles[t]);
    for (const int v : mesh.triangles[t]) {
      btScalar& value = least[first[v]];
      value = std::min(value, normal.dot(gradientAt(grid, mesh.positions[v])));
    }
  }
  for (std::size_t v = 0; v < least.size(); ++v) least[v] = least[first[v]];
  return least;
}

}  // namespace

std::vector<btVector3> sampleNormals(const TriangleMesh& mesh, const std::vector<int>& triangles,
                                     const std::vector<SurfaceSample>& samples, const DistanceGrid& grid) {
  const std::vector<btScalar> least = leastAround(mesh, triangles, grid);
  std::vector<btVector3> normals;
  normals.reserve(samples.size());
  for (const SurfaceSample& s : samples) {
    const btVector3 normal = gradientAt(grid, s.point);
    const btScalar length = normal.length();
    const btScalar around = s.vertex >= 0 ? least[s.vertex] : normal.dot(normalOf(mesh, s.corners));
    const bool tip = length < kOnFace && around < kAround * length;
    normals.push_back(tip ? btVector3(0, 0, 0) : normal);
  }
  return normals;
}

}  // namespace tetskin::contact_detail
