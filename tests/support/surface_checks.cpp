// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "surface_checks.h"

#include <algorithm>
#include <limits>
#include <map>
#include <utility>

namespace tetskin::test {

bool isClosedAndOriented(const TriangleMesh& mesh) {
  std::map<std::pair<int, int>, int> uses;
  for (const std::array<int, 3>& t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) ++uses[{t[k], t[(k + 1) % 3]}];
  }
  return std::all_of(uses.begin(), uses.end(), [&](const auto& edge) {
    return edge.second == 1 && uses.count({edge.first.second, edge.first.first}) == 1;
  });
}

double enclosedVolume(const TriangleMesh& mesh) {
  double volume = 0.0;
  for (const auto& [a, b, c] : mesh.triangles) {
    volume += mesh.positions[a].dot(mesh.positions[b].cross(mesh.positions[c])) / 6.0;
  }
  return volume;
}

double flattestTriangle(const TriangleMesh& mesh) {
  double flattest = std::numeric_limits<double>::infinity();
  for (const auto& [a, b, c] : mesh.triangles) {
    const Eigen::Vector3d u = mesh.positions[b] - mesh.positions[a], v = mesh.positions[c] - mesh.positions[a];
    const double longest = std::max({u.squaredNorm(), v.squaredNorm(), (u - v).squaredNorm()});
    flattest = std::min(flattest, u.cross(v).norm() / longest);
  }
  return flattest;
}

}  // namespace tetskin::test
