// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/cage/src/split/triangle_tree.h>

#include <cassert>
#include <numeric>

namespace tetskin::cage_detail {
namespace {

/// A triangle costs little more than a box.
constexpr int kTrianglesInLeaf = 4;

Box3 boxOf(const Surface& surface, std::uint32_t triangle) {
  Box3 box;
  for (const int point : surface.triangles[triangle]) box.extend(surface.points[point]);
  return box;
}

}  // namespace

TriangleTree::TriangleTree(const Surface& surface, const std::uint32_t* triangles, std::size_t count, double slack)
    : order_(count) {
  assert(count > 0 && slack >= 0.0);
  std::vector<Box3> boxes(count);
  std::transform(triangles, triangles + count, boxes.begin(), [&](std::uint32_t t) { return boxOf(surface, t); });
  std::iota(order_.begin(), order_.end(), 0);
  build(boxes, slack, 0, static_cast<int>(count));
}

void TriangleTree::build(const std::vector<Box3>& boxes, double slack, int first, int last) {
  const std::size_t index = nodes_.size();
  nodes_.emplace_back();
  Box3 box, middles;
  for (int k = first; k < last; ++k) {
    box.extend(boxes[order_[k]]);
    middles.extend(boxes[order_[k]].center());
  }
  nodes_[index].box = Box3(box.min().array() - slack, box.max().array() + slack);
  nodes_[index].first = first;
  nodes_[index].last = last;
  if (last - first <= kTrianglesInLeaf) return;
  Eigen::Index axis = 0;
  middles.sizes().maxCoeff(&axis);
  const int middle = first + (last - first) / 2;
  const auto twice = [&](int k) { return boxes[k].min()[axis] + boxes[k].max()[axis]; };
  std::nth_element(order_.begin() + first, order_.begin() + middle, order_.begin() + last,
                   [&](int a, int b) { return twice(a) < twice(b); });
  build(boxes, slack, first, middle);
  nodes_[index].right = static_cast<int>(nodes_.size());
  build(boxes, slack, middle, last);
}

}  // namespace tetskin::cage_detail
