// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/cage/src/split/body_ways.h>

#include <algorithm>

namespace tetskin::cage_detail {
namespace {

/// Share of a way under which what it crosses is where it begins.
constexpr double kJustThere = 1e-6;
/// So many elements are tested one by one: fewer than a tree would save.
constexpr std::size_t kFewElements = 32;
/// What the boxes of triangles are widened by, in half cubes. Spacings are such that rounding errors stay far below,
/// see smallestSpacing: a tree finds what a test of all triangles would, but for what only rounding makes a crossing,
/// as with a triangle without area.
constexpr double kBoxSlack = 1e-4;

}  // namespace

Eigen::Vector3d BodyWays::middleOf(const TetCell& cell) const {
  const LatticeTet& tet = links_.tets[cell.tet];
  return frame_.toRest(cubeOrigin(tet.cube) + cellTables().centroids[tet.local][cell.cell]);
}

Crossing BodyWays::crossingOf(std::size_t element, const Eigen::Vector3d& from, const Eigen::Vector3d& way) const {
  const auto& [a, b, c] = surface_.triangles[triangleOf(element)];
  return SeenTriangle(surface_.points[a] - from, surface_.points[b] - from, surface_.points[c] - from).crossing(way);
}

const TriangleTree& BodyWays::treeOf(int tet) const {
  int& tree = treeOf_[tet];
  if (tree < 0) {
    const std::size_t first = firstElement(tet), count = lastElement(tet) - first;
    tree = static_cast<int>(trees_.size());
    trees_.emplace_back(surface_, material_.triangles.values.data() + first, count, kBoxSlack * frame_.half);
  }
  return trees_[tree];
}

template <class Visit>
void BodyWays::forElementsAlong(int tet, const Eigen::Vector3d& from, const Eigen::Vector3d& way, Visit&& visit) const {
  const std::size_t first = firstElement(tet), last = lastElement(tet);
  if (last - first > kFewElements) {
    treeOf(tet).along(from, way, [&](std::size_t k, double& most) { visit(first + k, most); });
    return;
  }
  double most = 1.0;
  for (std::size_t e = first; e < last; ++e) visit(e, most);
}

int BodyWays::firstCrossing(int tet, const Eigen::Vector3d& from, const Eigen::Vector3d& way, bool leaving) const {
  int first = -1;
  forElementsAlong(tet, from, way, [&](std::size_t e, double& most) {
    const Crossing crossing = crossingOf(e, from, way);
    if (crossing.leaves != leaving || !(crossing.share > kJustThere && crossing.share <= most)) return;
    // Of two at one place, the one of lower number: elements come in any order. At the end of the way it is too late.
    const int element = static_cast<int>(e);
    if (crossing.share == most && element > first) return;
    most = crossing.share;
    first = element;
  });
  return first;
}

bool BodyWays::isBlocked(const TetCell& from, const TetCell& to) const {
  const Eigen::Vector3d start = middleOf(from), way = middleOf(to) - start;
  crossed_.clear();
  for (const int tet : {from.tet, to.tet}) {
    forElementsAlong(tet, start, way, [&](std::size_t e, double&) {
      const Crossing crossing = crossingOf(e, start, way);
      if (crossing.within()) crossed_.push_back({crossing.share, triangleOf(e), crossing.change()});
    });
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
