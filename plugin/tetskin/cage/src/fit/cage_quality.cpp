// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/cage/src/fit/cage_quality.h>
#include <tetskin/core/src/base/disjoint_sets.h>
#include <tetskin/core/src/base/progress.h>

#include <algorithm>
#include <cmath>

namespace tetskin {
namespace cage_detail {

std::array<double, 6> dihedralCosines(const TetCorners& p) {
  const Eigen::Vector3d a = p[1] - p[0], b = p[2] - p[0], c = p[3] - p[0];
  // Normals of the faces opposite to corners 0 to 3, all pointing inwards for a positive tet.
  std::array<Eigen::Vector3d, 4> n = {Eigen::Vector3d::Zero(), b.cross(c), c.cross(a), a.cross(b)};
  n[0] = -(n[1] + n[2] + n[3]);
  std::array<double, 4> inverse{};
  for (int i = 0; i < 4; ++i) inverse[i] = 1.0 / n[i].norm();
  const auto cosine = [&](int i, int j) { return -n[i].dot(n[j]) * inverse[i] * inverse[j]; };
  return {cosine(0, 1), cosine(0, 2), cosine(0, 3), cosine(1, 2), cosine(1, 3), cosine(2, 3)};
}

std::vector<int> componentNumbers(const TetMesh& mesh) {
  Progress::goOnWithRound();
  DisjointSets sets(mesh.nodeCount());
  for (const Tet& tet : mesh.tets) {
    for (int k = 1; k < 4; ++k) sets.unite(tet[0], tet[k]);
  }
  std::vector<int> number(mesh.nodeCount(), -1), components;
  int count = 0;
  for (const Tet& tet : mesh.tets) {
    int& component = number[sets.find(tet[0])];
    if (component < 0) component = count++;
    components.push_back(component);
  }
  return components;
}

}  // namespace cage_detail

DihedralRange dihedralRange(const TetMesh& mesh) {
  Progress::goOnWithRound();
  // Degrees per radian.
  constexpr double kDegrees = 180.0 / 3.14159265358979323846;
  double smallest = 1.0, largest = -1.0;  // cosines of the angles
  for (const Tet& tet : mesh.tets) {
    for (const double c : cage_detail::dihedralCosines(cornersOf(mesh, tet))) {
      smallest = std::min(smallest, c);
      largest = std::max(largest, c);
    }
  }
  if (mesh.tets.empty()) return {};
  return {std::acos(std::clamp(largest, -1.0, 1.0)) * kDegrees, std::acos(std::clamp(smallest, -1.0, 1.0)) * kDegrees};
}

}  // namespace tetskin
