// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// This work is based on:
//   Alec Jacobson, Ladislav Kavan, Olga Sorkine-Hornung, "Robust Inside-Outside Segmentation using Generalized Winding
//   Numbers", SIGGRAPH 2013
//   Gavin Barill, Neil G. Dickson, Ryan Schmidt, David I. W. Levin, Alec Jacobson, "Fast Winding Numbers for Soups and
//   Clouds", SIGGRAPH 2018 (the tree of dipoles)
//   A. Van Oosterom, J. Strackee, "The Solid Angle of a Plane Triangle", IEEE Transactions on Biomedical Engineering,
//   1983, eq. 8
#include <tetskin/core/src/mesh/winding_tree.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace tetskin {
namespace {

constexpr double kPi = 3.14159265358979323846;
/// Triangles in a leaf: few enough to sum exactly, many enough to keep the tree small.
constexpr int kLeafSize = 8;
/// A group counts as one dipole from this many radii away. Barill et al. use 2 with higher terms; the
/// error, below 0.03, only matters where the winding number is near 1/2.
constexpr double kFarRadii = 2.3;

/// Solid angle over 2: eq. 8 of Van Oosterom and Strackee.
double halfSolidAngle(const std::array<Eigen::Vector3d, 3>& t, const Eigen::Vector3d& p) {
  const Eigen::Vector3d a = t[0] - p, b = t[1] - p, c = t[2] - p;
  const double la = a.norm(), lb = b.norm(), lc = c.norm();
  const double numerator = a.dot(b.cross(c));
  const double denominator = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
  return numerator == 0.0 ? 0.0 : std::atan2(numerator, denominator);
}

WindingTree::Triangles trianglesWithArea(const TriangleMesh& mesh) {
  WindingTree::Triangles solid;
  for (const auto& t : mesh.triangles) {
    const Eigen::Vector3d& a = mesh.positions[t[0]];
    if ((mesh.positions[t[1]] - a).cross(mesh.positions[t[2]] - a).squaredNorm() > 0.0) solid.push_back(t);
  }
  return solid;
}

}  // namespace

WindingTree::WindingTree(const TriangleMesh& mesh) {
  const Triangles solid = trianglesWithArea(mesh);
  *this = WindingTree(mesh.positions, solid, solid.size());
}

WindingTree::WindingTree(const std::vector<Eigen::Vector3d>& points, const Triangles& triangles, std::size_t count) {
  assert(count <= triangles.size());
  std::vector<Item> items(count);
  const Box3 box = boundingBox(points);
  const Eigen::Vector3d centre = box.center();
  const double scale = 1.0 / box.sizes().maxCoeff();
  for (std::size_t t = 0; t < count; ++t) {
    const auto& [a, b, c] = triangles[t];
    const Eigen::Vector3d middle = (points[a] + points[b] + points[c]) / 3.0;
    items[t] = {((middle - centre) * scale).cast<float>(), static_cast<int>(t)};
  }
  triangles_.reserve(count);
  if (count > 0) build(points, triangles, items, 0, static_cast<int>(count));
}

void WindingTree::build(const std::vector<Eigen::Vector3d>& points, const Triangles& triangles,
                        std::vector<Item>& items, int first, int last) {
  const std::size_t index = nodes_.size();
  nodes_.emplace_back();
  nodes_[index].first = first;
  nodes_[index].last = last;
  if (last - first <= kLeafSize) {
    for (int i = first; i < last; ++i) {
      const auto& [a, b, c] = triangles[items[i].triangle];
      triangles_.push_back({points[a], points[b], points[c]});
    }
    fillLeaf(nodes_[index]);
    return;
  }
  Eigen::AlignedBox3f box;
  for (int i = first; i < last; ++i) box.extend(items[i].middle);
  int axis = 0;
  box.sizes().maxCoeff(&axis);
  const int middle = first + (last - first) / 2;
  std::nth_element(items.begin() + first, items.begin() + middle, items.begin() + last,
                   [axis](const Item& a, const Item& b) { return a.middle[axis] < b.middle[axis]; });
  build(points, triangles, items, first, middle);
  nodes_[index].right = static_cast<int>(nodes_.size());
  build(points, triangles, items, middle, last);
  fillFromChildren(index);
}

void WindingTree::fillLeaf(Node& node) {
  for (int t = node.first; t < node.last; ++t) {
    const Corners& c = triangles_[t];
    const Eigen::Vector3d normal = 0.5 * (c[1] - c[0]).cross(c[2] - c[0]);
    const double area = normal.norm();
    node.dipole += normal;
    node.area += area;
    node.centre += area * (c[0] + c[1] + c[2]) / 3.0;
  }
  node.centre /= node.area;
  for (int t = node.first; t < node.last; ++t) {
    for (const Eigen::Vector3d& p : triangles_[t]) node.radius = std::max(node.radius, (p - node.centre).norm());
  }
}

void WindingTree::fillFromChildren(std::size_t index) {
  Node& node = nodes_[index];
  const Node &a = nodes_[index + 1], &b = nodes_[node.right];
  node.dipole = a.dipole + b.dipole;
  node.area = a.area + b.area;
  node.centre = (a.area * a.centre + b.area * b.centre) / node.area;
  node.radius = std::max((a.centre - node.centre).norm() + a.radius, (b.centre - node.centre).norm() + b.radius);
}

double WindingTree::walk(int index, const Eigen::Vector3d& p) const {
  const Node& node = nodes_[index];
  const Eigen::Vector3d offset = node.centre - p;
  const double squared = offset.squaredNorm();
  const double far = kFarRadii * node.radius;
  if (squared > far * far) return node.dipole.dot(offset) / (4.0 * kPi * squared * std::sqrt(squared));
  if (node.right > 0) return walk(index + 1, p) + walk(node.right, p);
  double sum = 0.0;
  for (int t = node.first; t < node.last; ++t) sum += halfSolidAngle(triangles_[t], p);
  return sum / (2.0 * kPi);
}

double WindingTree::windingNumber(const Eigen::Vector3d& p) const {
  return nodes_.empty() ? 0.0 : walk(0, p);
}

}  // namespace tetskin
