// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/contact/src/soft/triangle_tree.h>
#include <tetskin/core/src/mesh/tet_geometry.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace tetskin::contact_detail {
namespace {

constexpr int kTrianglesInLeaf = 6;

Eigen::Vector3d middleOf(const TriangleMesh& mesh, int triangle) {
  const auto& [a, b, c] = mesh.triangles[static_cast<std::size_t>(triangle)];
  return (mesh.positions[a] + mesh.positions[b] + mesh.positions[c]) / 3.0;
}

std::vector<int> allTriangles(const TriangleMesh& mesh) {
  std::vector<int> all(mesh.triangleCount());
  std::iota(all.begin(), all.end(), 0);
  return all;
}

}  // namespace

TriangleTree::TriangleTree(const TriangleMesh& mesh) : TriangleTree(mesh, allTriangles(mesh)) {}

TriangleTree::TriangleTree(const TriangleMesh& mesh, const std::vector<int>& triangles) : order_(triangles) {
  if (!order_.empty()) build(mesh, 0, static_cast<int>(order_.size()));
}

void TriangleTree::build(const TriangleMesh& mesh, int first, int last) {
  const std::size_t index = nodes_.size();
  nodes_.emplace_back();
  nodes_[index].first = first;
  nodes_[index].last = last;
  if (last - first <= kTrianglesInLeaf) return fillLeaf(mesh, nodes_[index]);
  Box3 middles;
  for (int i = first; i < last; ++i) middles.extend(middleOf(mesh, order_[i]));
  int axis = 0;
  middles.sizes().maxCoeff(&axis);
  const int middle = first + (last - first) / 2;
  std::nth_element(order_.begin() + first, order_.begin() + middle, order_.begin() + last, [&](int a, int b) {
    const double x = middleOf(mesh, a)[axis], y = middleOf(mesh, b)[axis];
    return x < y || (x == y && a < b);
  });
  build(mesh, first, middle);
  nodes_[index].right = static_cast<int>(nodes_.size());
  build(mesh, middle, last);
  nodes_[index].box = nodes_[index + 1].box.merged(nodes_[nodes_[index].right].box);
}

void TriangleTree::fillLeaf(const TriangleMesh& mesh, Node& node) {
  for (int i = node.first; i < node.last; ++i) {
    const auto& [a, b, c] = mesh.triangles[static_cast<std::size_t>(order_[i])];
    triangles_.push_back({mesh.positions[a], mesh.positions[b], mesh.positions[c]});
    for (const Eigen::Vector3d& p : triangles_.back()) node.box.extend(p);
  }
}

void TriangleTree::search(int index, const Eigen::Vector3d& p, NearestPoint& best) const {
  const Node& node = nodes_[index];
  if (node.right == 0) {
    for (int t = node.first; t < node.last; ++t) {
      const Corners& c = triangles_[t];
      const Eigen::Vector3d point = closestPointOnTriangle(p, c[0], c[1], c[2]);
      const double squared = (p - point).squaredNorm();
      if (squared < best.squaredDistance) best = {point, order_[t], squared};
    }
    return;
  }
  int near = index + 1, far = node.right;
  double toNear = nodes_[near].box.squaredExteriorDistance(p), toFar = nodes_[far].box.squaredExteriorDistance(p);
  if (toFar < toNear) {
    std::swap(near, far);
    std::swap(toNear, toFar);
  }
  if (toNear < best.squaredDistance) search(near, p, best);
  if (toFar < best.squaredDistance) search(far, p, best);
}

NearestPoint TriangleTree::nearest(const Eigen::Vector3d& p, double squaredBound) const {
  NearestPoint best;
  best.squaredDistance = squaredBound;
  if (!nodes_.empty()) search(0, p, best);
  return best;
}

}  // namespace tetskin::contact_detail
