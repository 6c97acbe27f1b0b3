// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/cage/src/split/body_ways.h>

#include <algorithm>

namespace tetskin::cage_detail {
namespace {

/// Share of a way under which what it crosses is where it begins.
constexpr double kJustThere = 1e-6;

}  // namespace

Eigen::Vector3d BodyWays::middleOf(const TetCell& cell) const {
  const LatticeTet& tet = links_.tets[cell.tet];
  return frame_.toRest(cubeOrigin(tet.cube) + cellTables().centroids[tet.local][cell.cell]);
}

Crossing BodyWays::crossingOf(std::size_t element, const Eigen::Vector3d& from, const Eigen::Vector3d& way) const {
  const auto& [a, b, c] = surface_.triangles[triangleOf(element)];
  return SeenTriangle(surface_.points[a] - from, surface_.points[b] - from, surface_.points[c] - from).crossing(way);
}

int BodyWays::firstCrossing(int tet, const Eigen::Vector3d& from, const Eigen::Vector3d& way, bool leaving) const {
  int first = -1;
  double nearest = 1.0;
  for (std::size_t e = firstElement(tet); e < lastElement(tet); ++e) {
    const Crossing crossing = crossingOf(e, from, way);
    if (crossing.leaves != leaving || !(crossing.share > kJustThere && crossing.share < nearest)) continue;
    nearest = crossing.share;
    first = static_cast<int>(e);
  }
  return first;
}

bool BodyWays::isBlocked(const TetCell& from, const TetCell& to) const {
  const Eigen::Vector3d start = middleOf(from), way = middleOf(to) - start;
  crossed_.clear();
  for (const int tet : {from.tet, to.tet}) {
    for (std::size_t e = firstElement(tet); e < lastElement(tet); ++e) {
      const Crossing crossing = crossingOf(e, start, way);
      if (crossing.within()) crossed_.push_back({crossing.share, triangleOf(e), crossing.change()});
    }
    if (from.tet == to.tet) break;
  }
  if (crossed_.empty()) return false;
  std::sort(crossed_.begin(), crossed_.end());
  crossed_.erase(std::unique(crossed_.begin(), crossed_.end()), crossed_.end());
  int winding = material_.windingOf(from.tet, from.cell);
  return std::any_of(crossed_.begin(), crossed_.end(),
                     [&](const auto& crossing) { return (winding += std::get<2>(crossing)) == 0; });
}

}  // namespace tetskin::cage_detail
