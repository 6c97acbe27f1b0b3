// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/src/base/mesh/triangle_bvh.h>

#include <cassert>
#include <numeric>

namespace tetskin {
namespace {

/// Few enough that few are tested in vain, many enough that the tree is small.
constexpr int kTrianglesInLeaf = 6;

std::vector<int> allTriangles(const TriangleMesh& mesh) {
  std::vector<int> all(mesh.triangleCount());
  std::iota(all.begin(), all.end(), 0);
  return all;
}

}  // namespace

TriangleBvh::TriangleBvh(const TriangleMesh& mesh) : TriangleBvh(mesh, allTriangles(mesh)) {}

TriangleBvh::TriangleBvh(const TriangleMesh& mesh, const std::vector<int>& triangles) {
  Bvh::Centroids<double> centroids;
  centroids.reserve(mesh.triangleCount());
  for (const auto& triangle : mesh.triangles) {
    const TriangleCorners t = cornersOf(mesh, triangle);
    centroids.emplace_back((t[0] + t[1] + t[2]) / 3.0);
  }
  bvh_ = Bvh(centroids, triangles, kTrianglesInLeaf);
  triangles_.reserve(triangles.size());
  for (const int t : bvh_.items()) triangles_.push_back(cornersOf(mesh, mesh.triangles[static_cast<std::size_t>(t)]));
  bvh_.fit(boxes_, [this](int index) {
    BvhBox<double> box;
    for (const Eigen::Vector3d& p : triangles_[static_cast<std::size_t>(index)]) box.extend(p.data());
    return box;
  });
}

NearestPoint TriangleBvh::nearest(const Eigen::Vector3d& p, double squaredBound) const {
  NearestPoint best;
  best.squaredDistance = squaredBound;
  search(p, best);
  return best;
}

NearestPoint TriangleBvh::nearest(const Eigen::Vector3d& p, const NearestPoint& guess) const {
  NearestPoint best;
  if (guess.index >= 0) test(guess.index, p, best);
  search(p, best);
  return best;
}

void TriangleBvh::search(const Eigen::Vector3d& p, NearestPoint& best) const {
  bvh_.visitNear(boxes_, p, best.squaredDistance, [&](int index, double& squared) {
    test(index, p, best);
    squared = best.squaredDistance;
  });
}

void TriangleBvh::test(int index, const Eigen::Vector3d& p, NearestPoint& best) const {
  assert(index >= 0 && static_cast<std::size_t>(index) < triangles_.size());
  const Eigen::Vector3d point = closestPointOnTriangle(p, triangles_[static_cast<std::size_t>(index)]).point;
  const double squared = (p - point).squaredNorm();
  if (squared < best.squaredDistance) best = {point, bvh_.item(index), squared, index};
}

}  // namespace tetskin
