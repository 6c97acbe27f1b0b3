// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/bullet/src/search/node_paths.h>

#include <algorithm>
#include <cassert>

namespace tetskin::bullet_detail {
namespace {

/// Nodes in a leaf: fitting a leaf costs more than testing a few nodes in vain.
constexpr int kNodesPerLeaf = 16;

}  // namespace

std::vector<NodeTravel>& NodePaths::begin(std::size_t nodeCount) {
  if (travels_.size() != nodeCount) tree_ = {};
  travels_.resize(nodeCount);
  fitted_ = false;
  return travels_;
}

BvhBox<btScalar> NodePaths::boxOf(int node) const {
  BvhBox<btScalar> box;
  box.extend((*this)[node].now);
  box.extend((*this)[node].predicted);
  return box;
}

void NodePaths::fit() {
  if (tree_.empty()) {
    Bvh::Centroids<btScalar> centroids;
    for (const NodeTravel& travel : travels_) centroids.emplace_back(travel.now.x(), travel.now.y(), travel.now.z());
    tree_ = Bvh(centroids, kNodesPerLeaf);
  }
  tree_.fit(boxes_, [&](int index) { return boxOf(tree_.item(index)); });
  fitted_ = true;
}

const std::vector<int>& NodePaths::near(const BvhBox<btScalar>& box) {
  near_.clear();
  if (travels_.empty()) return near_;
  if (!fitted_) fit();
  listNear(box, 0);
  std::sort(near_.begin(), near_.end());
  return near_;
}

void NodePaths::listNear(const BvhBox<btScalar>& box, std::size_t node) {
  assert(node < tree_.nodes().size() && boxes_.size() == tree_.nodes().size());
  if (!boxes_[node].collides(box)) return;
  const Bvh::Node& at = tree_.nodes()[node];
  if (at.isLeaf()) {
    for (int k = at.first; k < at.last; ++k) near_.push_back(tree_.item(k));
    return;
  }
  listNear(box, node + 1);
  listNear(box, static_cast<std::size_t>(at.right));
}

}  // namespace tetskin::bullet_detail
