// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/contact/src/soft/box_tree.h>

#include <algorithm>
#include <cassert>

namespace tetskin::contact_detail {
namespace {

/// Few enough that a leaf's box is tight, many enough that fitting is cheap.
constexpr int kItemsInLeaf = 4;

btScalar middleOf(const ContactBox& box, int axis) {
  return box.low[axis] + box.high[axis];
}

int longestAxis(const ContactBox& box) {
  int axis = 0;
  for (int k = 1; k < 3; ++k) {
    if (box.high[k] - box.low[k] > box.high[axis] - box.low[axis]) axis = k;
  }
  return axis;
}

}  // namespace

ContactBox ContactBox::cutBy(const ContactBox& b) const {
  ContactBox cut;
  for (int k = 0; k < 3; ++k) {
    cut.low[k] = std::max(low[k], b.low[k]);
    cut.high[k] = std::min(high[k], b.high[k]);
  }
  return cut;
}

ContactBox ContactBox::grownBy(btScalar margin) const {
  ContactBox grown = *this;
  for (int k = 0; k < 3; ++k) {
    grown.low[k] -= margin;
    grown.high[k] += margin;
  }
  return grown;
}

btScalar ContactBox::diagonal() const {
  return btVector3(high[0] - low[0], high[1] - low[1], high[2] - low[2]).length();
}

BoxTree::BoxTree(std::vector<int> items, const std::vector<ContactBox>& boxes) : items_(std::move(items)) {
  if (!items_.empty()) build(boxes, 0, static_cast<int>(items_.size()));
}

void BoxTree::build(const std::vector<ContactBox>& boxes, int first, int last) {
  const std::size_t index = nodes_.size();
  nodes_.push_back({first, last, 0});
  if (last - first <= kItemsInLeaf) return;
  ContactBox box;
  for (int i = first; i < last; ++i) box.extend(boxes[static_cast<std::size_t>(items_[i])]);
  const int axis = longestAxis(box), middle = first + (last - first) / 2;
  std::nth_element(items_.begin() + first, items_.begin() + middle, items_.begin() + last, [&](int a, int b) {
    const btScalar x = middleOf(boxes[static_cast<std::size_t>(a)], axis);
    const btScalar y = middleOf(boxes[static_cast<std::size_t>(b)], axis);
    return x < y || (x == y && a < b);
  });
  build(boxes, first, middle);
  nodes_[index].right = static_cast<int>(nodes_.size());
  build(boxes, middle, last);
}

void FittedTree::fit(const BoxTree& tree, const std::vector<ContactBox>& boxes) {
  tree_ = &tree;
  const auto& nodes = tree.nodes();
  itemBoxes_.resize(tree.items().size());
  boxes_.resize(nodes.size());
  for (std::size_t i = 0; i < itemBoxes_.size(); ++i) itemBoxes_[i] = boxes[static_cast<std::size_t>(tree.items()[i])];
  for (std::size_t n = nodes.size(); n-- > 0;) {
    ContactBox box;
    if (nodes[n].right == 0) {
      for (int i = nodes[n].first; i < nodes[n].last; ++i) box.extend(itemBoxes_[static_cast<std::size_t>(i)]);
    } else {
      box = boxes_[n + 1];
      box.extend(boxes_[static_cast<std::size_t>(nodes[n].right)]);
    }
    boxes_[n] = box;
  }
}

}  // namespace tetskin::contact_detail
