// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// This work is based on:
//   Gavin Barill, Neil G. Dickson, Ryan Schmidt, David I. W. Levin, Alec Jacobson, "Fast Winding Numbers for Soups and
//   Clouds", SIGGRAPH 2018 (the tree of dipoles)
//   A. Van Oosterom, J. Strackee, "The Solid Angle of a Plane Triangle", IEEE Transactions on Biomedical Engineering,
//   1983, eq. 8
#include <tetskin/contact/src/soft/triangle_tree.h>
#include <tetskin/core/src/mesh/tet_geometry.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace tetskin::contact_detail {
namespace {

constexpr double kFullAngle = 4.0 * 3.14159265358979323846;
constexpr int kTrianglesInLeaf = 6;
/// From so many radii away a group counts as one dipole.
constexpr double kDipoleRadii = 2.3;

/// Eq. 8 of Van Oosterom and Strackee.
double solidAngle(const std::array<Eigen::Vector3d, 3>& t, const Eigen::Vector3d& p) {
  const Eigen::Vector3d a = t[0] - p, b = t[1] - p, c = t[2] - p;
  const double la = a.norm(), lb = b.norm(), lc = c.norm();
  const double numerator = a.dot(b.cross(c));
  const double denominator = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
  return numerator == 0.0 ? 0.0 : 2.0 * std::atan2(numerator, denominator);
}

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
  if (last - first <= kTrianglesInLeaf) {
    for (int i = first; i < last; ++i) {
      const auto& [a, b, c] = mesh.triangles[static_cast<std::size_t>(order_[i])];
      triangles_.push_back({mesh.positions[a], mesh.positions[b], mesh.positions[c]});
    }
    return measure(nodes_[index]);
  }
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
  measure(nodes_[index]);
}

/// From its triangles, which are all in place by then.
void TriangleTree::measure(Node& node) const {
  for (int t = node.first; t < node.last; ++t) {
    const Corners& c = triangles_[t];
    const Eigen::Vector3d normal = 0.5 * (c[1] - c[0]).cross(c[2] - c[0]);
    const double area = normal.norm();
    for (const Eigen::Vector3d& p : c) node.box.extend(p);
    node.dipole += normal;
    node.area += area;
    node.centre += area * (c[0] + c[1] + c[2]) / 3.0;
  }
  node.centre = node.area > 0.0 ? Eigen::Vector3d(node.centre / node.area) : node.box.center();
  const Eigen::Vector3d reach = (node.box.max() - node.centre).cwiseMax(node.centre - node.box.min());
  node.radius = reach.norm();
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

double TriangleTree::wind(int index, const Eigen::Vector3d& p) const {
  const Node& node = nodes_[index];
  const Eigen::Vector3d offset = node.centre - p;
  const double squared = offset.squaredNorm();
  const double far = kDipoleRadii * node.radius;
  if (squared > far * far) return node.dipole.dot(offset) / (kFullAngle * squared * std::sqrt(squared));
  if (node.right > 0) return wind(index + 1, p) + wind(node.right, p);
  double sum = 0.0;
  for (int t = node.first; t < node.last; ++t) sum += solidAngle(triangles_[t], p);
  return sum / kFullAngle;
}

double TriangleTree::windingNumber(const Eigen::Vector3d& p) const {
  return nodes_.empty() ? 0.0 : wind(0, p);
}

}  // namespace tetskin::contact_detail
