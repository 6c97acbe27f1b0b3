// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/cage/src/split/segment_queries.h>

#include <algorithm>
#include <cassert>

namespace tetskin::cage_detail {
namespace {

/// Fraction of a segment below which a crossing counts as being at its start.
constexpr double kJustThere = 1e-6;
/// Up to this many elements are tested one by one: a tree would save nothing.
constexpr std::size_t kFewElements = 32;
/// The boxes of triangles are enlarged by this, in half cubes. Rounding errors stay far below it, see smallestSpacing:
/// a tree finds every crossing that a test of all triangles would find, except those that exist only by rounding, as
/// with a triangle without area.
constexpr double kBoxSlack = 1e-4;
/// Leaf size of a tree: testing a triangle costs little more than testing a box.
constexpr int kLeafSize = 4;

}  // namespace

Eigen::Vector3d SegmentQueries::centroidOf(const TetCell& cell) const {
  const LatticeTet& tet = links_.tets[cell.tet];
  return frame_.toRest(cubeOrigin(tet.cube) + cellTables().centroids[tet.local][cell.cell]);
}

Crossing SegmentQueries::crossingOf(std::size_t element, const Eigen::Vector3d& from,
                                    const Eigen::Vector3d& direction) const {
  assert(element < material_.triangles.values.size());
  const auto& [a, b, c] = surface_.triangles[triangleOf(element)];
  return SeenTriangle(surface_.points[a] - from, surface_.points[b] - from, surface_.points[c] - from)
      .crossing(direction);
}

SegmentQueries::ElementTree SegmentQueries::makeTree(int tet) const {
  const std::size_t first = firstElement(tet), last = lastElement(tet);
  std::vector<BvhBox<double>> boxes(last - first);
  Bvh::Centroids<double> centroids;
  for (std::size_t e = first; e < last; ++e) {
    BvhBox<double>& box = boxes[e - first];
    for (const int point : surface_.triangles[triangleOf(e)]) box.extend(surface_.points[point].data());
    centroids.emplace_back(box.low[0] + box.high[0], box.low[1] + box.high[1], box.low[2] + box.high[2]);
    box = box.grownBy(kBoxSlack * frame_.half);
  }
  ElementTree tree{Bvh(centroids, kLeafSize), {}};
  tree.bvh.fit(tree.boxes, [&](int index) { return boxes[static_cast<std::size_t>(tree.bvh.item(index))]; });
  return tree;
}

const SegmentQueries::ElementTree& SegmentQueries::treeOf(int tet) const {
  int& tree = treeOf_[tet];
  if (tree < 0) {
    tree = static_cast<int>(trees_.size());
    trees_.push_back(makeTree(tet));
  }
  return trees_[tree];
}

template <class Visit>
void SegmentQueries::forElementsAlong(int tet, const Eigen::Vector3d& from, const Eigen::Vector3d& direction,
                                      Visit&& visit) const {
  const std::size_t first = firstElement(tet), last = lastElement(tet);
  if (last - first > kFewElements) {
    const ElementTree& tree = treeOf(tet);
    return tree.bvh.visitAlong(tree.boxes, from, direction, 1.0, [&](int index, double& end) {
      visit(first + static_cast<std::size_t>(tree.bvh.item(index)), end);
    });
  }
  double maximum = 1.0;
  for (std::size_t e = first; e < last; ++e) visit(e, maximum);
}

int SegmentQueries::firstCrossing(int tet, const Eigen::Vector3d& from, const Eigen::Vector3d& direction,
                                  bool leaving) const {
  int first = -1;
  forElementsAlong(tet, from, direction, [&](std::size_t e, double& maximum) {
    const Crossing crossing = crossingOf(e, from, direction);
    if (crossing.leaves != leaving || !(crossing.fraction > kJustThere && crossing.fraction <= maximum)) return;
    // Of two crossings at the same position, the one of lower number counts, because elements come in any order. A
    // crossing at the end of the segment is too late.
    const int element = static_cast<int>(e);
    if (crossing.fraction == maximum && element > first) return;
    maximum = crossing.fraction;
    first = element;
  });
  return first;
}

bool SegmentQueries::isBlocked(const TetCell& from, const TetCell& to) const {
  assert(from.tet == to.tet || links_.cornerTowards(from.tet, to.tet) >= 0);
  const Eigen::Vector3d start = centroidOf(from), direction = centroidOf(to) - start;
  crossed_.clear();
  for (const int tet : {from.tet, to.tet}) {
    forElementsAlong(tet, start, direction, [&](std::size_t e, double&) {
      const Crossing crossing = crossingOf(e, start, direction);
      if (crossing.within()) crossed_.push_back({crossing.fraction, triangleOf(e), crossing.change()});
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
