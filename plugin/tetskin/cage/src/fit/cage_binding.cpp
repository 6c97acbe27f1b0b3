// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/cage/src/fit/cage_binding.h>
#include <tetskin/cage/src/fit/cage_quality.h>
#include <tetskin/core/src/base/progress.h>

#include <cassert>
#include <cmath>

namespace tetskin::cage_detail {
namespace {

bool holds(const TetMesh& mesh, int tet, const Eigen::Vector3d& p) {
  return barycentricDistance(BarycentricMap(cornersOf(mesh, mesh.tets[tet]))(p)) <= 0.0;
}

}  // namespace

std::vector<int> bindPoints(const std::vector<Eigen::Vector3d>& points, const LatticeSet& set,
                            const LatticeFrame& frame, const LatticeMesh& lattice) {
  const auto indexOf = [&](const LatticeTet& tet) { return lattice.indexOf(set, tet); };
  std::vector<int> result(points.size(), -1);
  for (std::size_t p = 0; p < points.size(); ++p) {
    Progress::goOn(p);
    const LatticeTet home = locate(frame.toLattice(points[p]));
    const int tet = indexOf(home);
    if (tet >= 0 && holds(lattice.mesh, tet, points[p])) {
      result[p] = tet;
      continue;
    }
    // A point on or near a face, an edge or a node may be in any tet around a node of its lattice tet.
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
  assert(count <= points.size() && count <= tetOf.size());
  std::size_t outside = 0;
  for (std::size_t p = 0; p < count; ++p) outside += tetOf[p] >= 0 && holds(mesh, tetOf[p], points[p]) ? 0 : 1;
  return outside;
}

}  // namespace tetskin::cage_detail
