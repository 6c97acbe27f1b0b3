// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to snapshots: one of Bullet's trees, node by node, because contacts come in its order.
#pragma once

#include <BulletCollision/BroadphaseCollision/btDbvt.h>
#include <tetskin/replay/src/state/bullet_members.h>

#include <new>
#include <vector>

namespace tetskin::bullet_detail {

struct SavedNode {
  int item = -1;  ///< of a leaf; -1: a node with two children, which follow it
  btVector3 low{0, 0, 0}, high{0, 0, 0};
};
using SavedTree = std::vector<SavedNode>;

/// Appends a node and its descendants. `itemOf` gives each leaf a number of 0 or more.
template <class ItemOf>
void readTree(const btDbvtNode* node, const ItemOf& itemOf, SavedTree& to) {
  if (!node) return;
  to.push_back({node->isleaf() ? itemOf(*node) : -1, node->volume.Mins(), node->volume.Maxs()});
  for (int k = 0; k < 2 && node->isinternal(); ++k) readTree(node->childs[k], itemOf, to);
}

inline void serializeTree(WorldStream& stream, SavedTree& tree) {
  stream.each(tree, [&](SavedNode& node) { serializeAll(stream, node.item, node.low, node.high); });
}

/// True if this is exactly one tree, and takes(item) is true for each leaf.
template <class Takes>
bool isTree(const SavedTree& tree, const Takes& takes) {
  std::size_t missing = tree.empty() ? 0 : 1;  // nodes whose parents have been seen
  for (const SavedNode& node : tree) {
    if (missing-- == 0 || (node.item >= 0 && !takes(node.item))) return false;
    missing += node.item < 0 ? 2 : 0;
  }
  return missing == 0;
}

template <class Place>
btDbvtNode* makeNodes(const SavedNode*& from, btDbvtNode* parent, const Place& place) {
  const SavedNode& saved = *from++;
  auto* node = new (btAlignedAlloc(sizeof(btDbvtNode), 16)) btDbvtNode();  // as btDbvt does, which frees it
  node->parent = parent;
  node->volume = btDbvtVolume::FromMM(saved.low, saved.high);
  node->childs[1] = nullptr;
  if (saved.item >= 0) {
    place(saved.item, *node);
  } else {
    for (btDbvtNode*& child : node->childs) child = makeNodes(from, node, place);
  }
  return node;
}

/// Replaces a tree by another one.
/// tree   see `isTree`
/// place  (item, leaf): sets the leaf's data, and the item's pointer to it
template <class Place>
void makeTree(const SavedTree& tree, btDbvt& in, const Place& place) {
  in.clear();
  const SavedNode* from = tree.data();
  if (!tree.empty()) in.m_root = makeNodes(from, nullptr, place);
  in.m_leaves = static_cast<int>((tree.size() + 1) / 2);
}

}  // namespace tetskin::bullet_detail
