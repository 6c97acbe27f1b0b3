// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// A bounding-volume hierarchy: a balanced binary tree of items that have a centroid. This is only the tree; boxes and
// other data of its nodes are separate arrays, so that several bodies can share one tree and each fit it to itself.
//
// Visitors are called with the index of an item in `items`; owners may keep their data in this order.
#pragma once

#include <tetskin/core/src/base/bvh/bvh_box.h>
#include <tetskin/export.h>

#include <Eigen/Core>
#include <cassert>
#include <cstddef>
#include <functional>
#include <utility>
#include <vector>

namespace tetskin {

class TETSKIN_CORE_API Bvh {
 public:
  template <class Scalar>
  using Centroids = std::vector<Eigen::Matrix<Scalar, 3, 1>>;

  struct Node {
    int first = 0, last = 0;  ///< its items: indices of `items` in [first, last)
    int right = 0;            ///< second child, 0 in a leaf; the first child is the next node
    bool isLeaf() const { return right == 0; }
  };

  Bvh() = default;
  /// Halves the items at the median along the longest side of their centroids' box. Of two at the same coordinate, the
  /// lower number comes first, and the items of leaves are sorted: the tree is the same with every standard library.
  /// centroids  by item; those that are not finite count as 0
  /// leafSize   groups of up to this many items are not halved, at least 1
  /// Cost       O(n log n)
  template <class Scalar>
  Bvh(const Centroids<Scalar>& centroids, int leafSize);
  /// A tree of some of the items.
  /// items  numbers into `centroids`, each at most once
  template <class Scalar>
  Bvh(const Centroids<Scalar>& centroids, const std::vector<int>& items, int leafSize);
  /// A tree by boxes instead of centroids; it splits along the longest side of the box around them all.
  template <class Scalar>
  Bvh(const std::vector<BvhBox<Scalar>>& boxes, const std::vector<int>& items, int leafSize);

  bool empty() const { return nodes_.empty(); }
  /// The nodes: the root first, parents before children.
  const std::vector<Node>& nodes() const { return nodes_; }
  /// Numbers of items, leaf by leaf.
  const std::vector<int>& items() const { return items_; }
  int item(int index) const {
    assert(index >= 0 && static_cast<std::size_t>(index) < items_.size());
    return items_[static_cast<std::size_t>(index)];
  }

  /// Computes a value per node, for leaves by `fromItems(node)`, for others by `fromChildren(left, right)`. Cost O(n);
  /// allocates only if `values` is too small.
  template <class Value, class FromItems, class FromChildren>
  void fill(std::vector<Value>& values, FromItems&& fromItems, FromChildren&& fromChildren) const;

  /// Computes the nodes' boxes from the items' boxes, `boxOf(index)`. Cost as for `fill`
  template <class Box, class BoxOf>
  void fit(std::vector<Box>& boxes, BoxOf&& boxOf) const;

  /// Calls visit(index, squared) for the items in leaves whose box is nearer to a point than the root of `squared`,
  /// nearer leaves first. `visit` lowers `squared` to what it has found. Cost about O(log n)
  template <class Box, class Visit>
  void visitNear(const std::vector<Box>& boxes, const Eigen::Vector3d& point, double squared, Visit&& visit) const;

  /// Calls visit(index, end) for the items in leaves whose box the ray `start + t * direction` meets at some t between
  /// 0 and `end`, nearer leaves first. `visit` may lower `end`. Cost about O(log n) and what is visited
  template <class Box, class Visit>
  void visitAlong(const std::vector<Box>& boxes, const Eigen::Vector3d& start, const Eigen::Vector3d& direction,
                  double end, Visit&& visit) const;

 private:
  /// Most nodes waiting to be visited: one per level, and trees are balanced.
  static constexpr int kMaxWaiting = 64;
  struct PendingNode {
    int node;
    double distance;
  };
  const Node& node(int index) const { return nodes_[static_cast<std::size_t>(index)]; }

  template <class Distance, class Within, class Visit>
  void visitNearestFirst(const Distance& distance, double& bound, Within within, Visit& visit) const;

  std::vector<Node> nodes_;
  std::vector<int> items_;
};

template <class Value, class FromItems, class FromChildren>
void Bvh::fill(std::vector<Value>& values, FromItems&& fromItems, FromChildren&& fromChildren) const {
  values.resize(nodes_.size());
  for (std::size_t n = nodes_.size(); n-- > 0;) {
    const Node& node = nodes_[n];
    values[n] =
        node.isLeaf() ? fromItems(node) : fromChildren(values[n + 1], values[static_cast<std::size_t>(node.right)]);
  }
}

template <class Box, class BoxOf>
void Bvh::fit(std::vector<Box>& boxes, BoxOf&& boxOf) const {
  const auto aroundItems = [&](const Node& leaf) {
    Box box;
    for (int k = leaf.first; k < leaf.last; ++k) box.extend(boxOf(k));
    return box;
  };
  const auto aroundBoth = [](Box box, const Box& other) {
    box.extend(other);
    return box;
  };
  fill(boxes, aroundItems, aroundBoth);
}

/// distance  of a node; if not within `bound`, the node is skipped
template <class Distance, class Within, class Visit>
void Bvh::visitNearestFirst(const Distance& distance, double& bound, Within within, Visit& visit) const {
  if (empty()) return;
  PendingNode stack[kMaxWaiting];
  int count = 0;
  stack[count++] = {0, distance(0)};
  while (count > 0) {
    PendingNode next = stack[--count];
    while (within(next.distance, bound) && !node(next.node).isLeaf()) {
      PendingNode near{next.node + 1, distance(next.node + 1)};
      PendingNode far{node(next.node).right, distance(node(next.node).right)};
      if (far.distance < near.distance) std::swap(near, far);
      assert(count < kMaxWaiting);
      if (within(far.distance, bound)) stack[count++] = far;
      next = near;
    }
    if (!within(next.distance, bound)) continue;
    for (int k = node(next.node).first; k < node(next.node).last; ++k) visit(k, bound);
  }
}

template <class Box, class Visit>
void Bvh::visitNear(const std::vector<Box>& boxes, const Eigen::Vector3d& point, double squared, Visit&& visit) const {
  assert(boxes.size() == nodes_.size());
  const auto distance = [&](int n) { return boxes[static_cast<std::size_t>(n)].squaredDistance(point.data()); };
  visitNearestFirst(distance, squared, std::less<>(), visit);
}

template <class Box, class Visit>
void Bvh::visitAlong(const std::vector<Box>& boxes, const Eigen::Vector3d& start, const Eigen::Vector3d& direction,
                     double end, Visit&& visit) const {
  assert(boxes.size() == nodes_.size());
  const Eigen::Vector3d inverse = direction.cwiseInverse();
  const auto distance = [&](int n) {
    return boxes[static_cast<std::size_t>(n)].entry(start.data(), inverse.data(), end);
  };
  visitNearestFirst(distance, end, std::less_equal<>(), visit);
}

/// Calls visit(leafA, leafB) for those pairs of leaves of two trees for which meet(nodeA, nodeB), called with numbers
/// of nodes, is true, as it must be for all their ancestors, too.
template <class Meet, class Visit>
void visitPairs(const Bvh& a, const Bvh& b, const Meet& meet, Visit&& visit, int nodeA = 0, int nodeB = 0) {
  if (a.empty() || b.empty() || !meet(nodeA, nodeB)) return;
  const Bvh::Node& first = a.nodes()[static_cast<std::size_t>(nodeA)];
  const Bvh::Node& second = b.nodes()[static_cast<std::size_t>(nodeB)];
  if (first.isLeaf() && second.isLeaf()) return visit(first, second);
  // Splits the one with more items.
  if (second.isLeaf() || (!first.isLeaf() && first.last - first.first > second.last - second.first)) {
    visitPairs(a, b, meet, visit, nodeA + 1, nodeB);
    visitPairs(a, b, meet, visit, first.right, nodeB);
  } else {
    visitPairs(a, b, meet, visit, nodeA, nodeB + 1);
    visitPairs(a, b, meet, visit, nodeA, second.right);
  }
}

}  // namespace tetskin
