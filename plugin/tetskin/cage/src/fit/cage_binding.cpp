// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/cage/src/fit/cage_binding.h>
#include <tetskin/cage/src/fit/cage_quality.h>

#include <cmath>

namespace tetskin::cage_detail {
namespace {

using Corners = std::array<Eigen::Vector3d, 3>;

/// Adds rows of points parallel to the longest edge, rows and points at most a step apart; none if that edge is
/// shorter.
void addRows(const Corners& t, double step, std::vector<Eigen::Vector3d>& points) {
  int longest = 0;
  double length = 0.0;
  for (int i = 0; i < 3; ++i) {
    const double edge = (t[(i + 1) % 3] - t[i]).norm();
    if (edge <= length) continue;
    length = edge;
    longest = i;
  }
  if (length <= step) return;
  const Eigen::Vector3d &a = t[longest], &b = t[(longest + 1) % 3], &c = t[(longest + 2) % 3];
  const double height = (b - a).cross(c - a).norm() / length;
  const int rows = static_cast<int>(std::ceil(height / step));
  for (int r = 0; r <= rows; ++r) {
    const double s = rows > 0 ? static_cast<double>(r) / rows : 0.0;
    const Eigen::Vector3d left = a + s * (c - a), right = b + s * (c - b);
    const int columns = static_cast<int>(std::ceil((right - left).norm() / step));
    for (int k = 0; k <= columns; ++k) {
      points.push_back(left + (columns > 0 ? static_cast<double>(k) / columns : 0.0) * (right - left));
    }
  }
}

bool holds(const TetMesh& mesh, int tet, const Eigen::Vector3d& p) {
  return barycentricDistance(BarycentricMap(cornersOf(mesh, mesh.tets[tet]))(p)) <= 0.0;
}

}  // namespace

std::vector<Eigen::Vector3d> pointsToHold(const Surface& surface, double step) {
  std::vector<Eigen::Vector3d> points = surface.points;
  for (const auto& t : surface.triangles) {
    addRows({surface.points[t[0]], surface.points[t[1]], surface.points[t[2]]}, step, points);
  }
  return points;
}

std::vector<int> bindPoints(const std::vector<Eigen::Vector3d>& points, const LatticeSet& set,
                            const LatticeFrame& frame, const LatticeMesh& lattice) {
  const auto indexOf = [&](const LatticeTet& tet) {
    const int cube = set.find(tet.cube);
    return cube < 0
               ? -1
               : lattice.tetOf[kTetsPerCube * static_cast<std::size_t>(cube) + static_cast<std::size_t>(tet.local)];
  };
  std::vector<int> result(points.size(), -1);
  for (std::size_t p = 0; p < points.size(); ++p) {
    const LatticeTet home = locate(frame.toLattice(points[p]));
    const int tet = indexOf(home);
    if (tet >= 0 && holds(lattice.mesh, tet, points[p])) {
      result[p] = tet;
      continue;
    }
    // On or near a face, an edge or a node: any tet around a node of the home tet may be the one.
    for (const LatticeNode& node : nodesOf(home)) {
      for (const LatticeStep& step : latticeTables().star[node.kind]) {
        const int other = indexOf(node.cube + step);
        if (result[p] < 0 && other >= 0 && holds(lattice.mesh, other, points[p])) result[p] = other;
      }
    }
  }
  return result;
}

std::size_t countOutside(const std::vector<Eigen::Vector3d>& points, std::size_t count, const TetMesh& mesh,
                         const std::vector<int>& tetOf) {
  std::size_t outside = 0;
  for (std::size_t p = 0; p < count; ++p) outside += tetOf[p] >= 0 && holds(mesh, tetOf[p], points[p]) ? 0 : 1;
  return outside;
}

}  // namespace tetskin::cage_detail
