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
/// Of a tree: a triangle costs little more than a box.
constexpr int kLeafSize = 4;

}  // namespace

Eigen::Vector3d BodyWays::middleOf(const TetCell& cell) const {
  const LatticeTet& tet = links_.tets[cell.tet];
  return frame_.toRest(cubeOrigin(tet.cube) + cellTables().centroids[tet.local][cell.cell]);
}

Crossing BodyWays::crossingOf(std::size_t element, const Eigen::Vector3d& from, const Eigen::Vector3d& way) const {
  const auto& [a, b, c] = surface_.triangles[triangleOf(element)];
  return SeenTriangle(surface_.points[a] - from, surface_.points[b] - from, surface_.points[c] - from).crossing(way);
}

BodyWays::ElementTree BodyWays::makeTree(int tet) const {
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

const BodyWays::ElementTree& BodyWays::treeOf(int tet) const {
  int& tree = treeOf_[tet];
  if (tree < 0) {
    tree = static_cast<int>(trees_.size());
    trees_.push_back(makeTree(tet));
  }
  return trees_[tree];
}

template <class Visit>
void BodyWays::forElementsAlong(int tet, const Eigen::Vector3d& from, const Eigen::Vector3d& way, Visit&& visit) const {
  const std::size_t first = firstElement(tet), last = lastElement(tet);
  if (last - first > kFewElements) {
    const ElementTree& tree = treeOf(tet);
    return tree.bvh.visitAlong(tree.boxes, from, way, 1.0, [&](int index, double& end) {
      visit(first + static_cast<std::size_t>(tree.bvh.item(index)), end);
    });
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
