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
#include <tetskin/core/src/base/mesh/winding_tree.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace tetskin {
namespace {

/// The solid angle of a sphere is 4 pi.
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
  Bvh::Centroids<float> centroids(count);
  const Box3 box = boundingBox(points);
  const Eigen::Vector3d centre = box.center();
  const double scale = 1.0 / box.sizes().maxCoeff();
  for (std::size_t t = 0; t < count; ++t) {
    const auto& [a, b, c] = triangles[t];
    const Eigen::Vector3d centroid = (points[a] + points[b] + points[c]) / 3.0;
    centroids[t] = ((centroid - centre) * scale).cast<float>();
  }
  bvh_ = Bvh(centroids, kLeafSize);
  triangles_.reserve(count);
  for (const int t : bvh_.items()) {
    const auto& [a, b, c] = triangles[t];
    triangles_.push_back({points[a], points[b], points[c]});
  }
  bvh_.fill(
      dipoles_, [this](const Bvh::Node& leaf) { return ofLeaf(leaf); }, ofChildren);
}

WindingTree::Dipole WindingTree::ofLeaf(const Bvh::Node& leaf) const {
  Dipole dipole;
  for (int t = leaf.first; t < leaf.last; ++t) {
    const Corners& c = triangles_[t];
    const Eigen::Vector3d normal = 0.5 * (c[1] - c[0]).cross(c[2] - c[0]);
    const double area = normal.norm();
    dipole.moment += normal;
    dipole.area += area;
    dipole.centroid += area * (c[0] + c[1] + c[2]) / 3.0;
  }
  assert(dipole.area > 0.0);
  dipole.centroid /= dipole.area;
  for (int t = leaf.first; t < leaf.last; ++t) {
    for (const Eigen::Vector3d& p : triangles_[t]) {
      dipole.radius = std::max(dipole.radius, (p - dipole.centroid).norm());
    }
  }
  return dipole;
}

WindingTree::Dipole WindingTree::ofChildren(const Dipole& a, const Dipole& b) {
  Dipole both;
  both.moment = a.moment + b.moment;
  both.area = a.area + b.area;
  both.centroid = (a.area * a.centroid + b.area * b.centroid) / both.area;
  both.radius =
      std::max((a.centroid - both.centroid).norm() + a.radius, (b.centroid - both.centroid).norm() + b.radius);
  return both;
}

double WindingTree::walk(int index, const Eigen::Vector3d& p) const {
  assert(index >= 0 && static_cast<std::size_t>(index) < dipoles_.size());
  const Dipole& dipole = dipoles_[static_cast<std::size_t>(index)];
  const Eigen::Vector3d offset = dipole.centroid - p;
  const double squared = offset.squaredNorm();
  const double far = kFarRadii * dipole.radius;
  if (squared > far * far) return dipole.moment.dot(offset) / (4.0 * kPi * squared * std::sqrt(squared));
  const Bvh::Node& node = bvh_.nodes()[static_cast<std::size_t>(index)];
  if (!node.isLeaf()) return walk(index + 1, p) + walk(node.right, p);
  double sum = 0.0;
  for (int t = node.first; t < node.last; ++t) sum += halfSolidAngle(triangles_[t], p);
  return sum / (2.0 * kPi);
}

double WindingTree::windingNumber(const Eigen::Vector3d& p) const {
  return bvh_.empty() ? 0.0 : walk(0, p);
}

}  // namespace tetskin
