// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to SoftContacts: a tree of boxes, made once of a body at rest and fitted to it as it moves.
#pragma once

#include <LinearMath/btVector3.h>

#include <cstddef>
#include <utility>
#include <vector>

namespace tetskin::contact_detail {

/// Empty until extended.
struct ContactBox {
  btScalar low[3] = {BT_LARGE_FLOAT, BT_LARGE_FLOAT, BT_LARGE_FLOAT};
  btScalar high[3] = {-BT_LARGE_FLOAT, -BT_LARGE_FLOAT, -BT_LARGE_FLOAT};

  void extend(const btScalar* lower, const btScalar* upper) {
    for (int k = 0; k < 3; ++k) {
      low[k] = lower[k] < low[k] ? lower[k] : low[k];
      high[k] = upper[k] > high[k] ? upper[k] : high[k];
    }
  }
  void extend(const btVector3& p) { extend(p.m_floats, p.m_floats); }
  void extend(const ContactBox& b) { extend(b.low, b.high); }
  /// Without branches: most pairs are apart, on no axis in particular.
  bool meets(const ContactBox& b) const {
    return (low[0] <= b.high[0]) & (low[1] <= b.high[1]) & (low[2] <= b.high[2]) & (b.low[0] <= high[0]) &
           (b.low[1] <= high[1]) & (b.low[2] <= high[2]);
  }
  ContactBox grownBy(btScalar margin) const;
  ContactBox cutBy(const ContactBox& b) const;
  btScalar diagonal() const;
};

/// The shape of a tree: which items are near each other at rest.
class BoxTree {
 public:
  struct Node {
    int first = 0, last = 0;  ///< in `items`
    int right = 0;            ///< second child, 0 in a leaf; the first child is the next node
  };

  BoxTree() = default;
  /// items  numbers of boxes in `boxes`. Cost O(n log n)
  BoxTree(std::vector<int> items, const std::vector<ContactBox>& boxes);

  const std::vector<int>& items() const { return items_; }
  const std::vector<Node>& nodes() const { return nodes_; }

 private:
  void build(const std::vector<ContactBox>& boxes, int first, int last);

  std::vector<int> items_;
  std::vector<Node> nodes_;
};

/// Its boxes for one body, now.
class FittedTree {
 public:
  /// boxes  by item number. Cost O(n); allocates the first time alone
  void fit(const BoxTree& tree, const std::vector<ContactBox>& boxes);

  const BoxTree& tree() const { return *tree_; }
  bool empty() const { return !tree_ || tree_->nodes().empty(); }
  const ContactBox& box(int node) const { return boxes_[static_cast<std::size_t>(node)]; }
  /// Of the item in this place of `BoxTree::items`.
  const ContactBox& itemBox(int place) const { return itemBoxes_[static_cast<std::size_t>(place)]; }

 private:
  const BoxTree* tree_ = nullptr;
  std::vector<ContactBox> boxes_, itemBoxes_;
};

}  // namespace tetskin::contact_detail
