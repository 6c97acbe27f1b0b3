// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/src/base/bvh/bvh.h>
#include <tetskin/core/src/base/instantiate.h>

#include <algorithm>
#include <cassert>
#include <numeric>

namespace tetskin {
namespace {

/// The items during the splits: small, because they are moved often.
template <class Scalar>
struct PointItem {
  using Box = BvhBox<Scalar>;
  Eigen::Matrix<Scalar, 3, 1> centroid;
  int number;

  Scalar key(int axis) const { return centroid[axis]; }
  void extend(Box& box) const { box.extend(centroid.data()); }
};

template <class Scalar>
struct BoxItem {
  using Box = BvhBox<Scalar>;
  Box box;
  int number;

  Scalar key(int axis) const { return box.low[axis] + box.high[axis]; }
  void extend(Box& around) const { around.extend(box); }
};

template <class Item>
class Builder {
 public:
  Builder(std::vector<Item> items, int leafSize, std::vector<Bvh::Node>& nodes, std::vector<int>& numbers)
      : items_(std::move(items)), leafSize_(leafSize), nodes_(nodes) {
    if (!items_.empty()) build(0, static_cast<int>(items_.size()), -1);
    numbers.reserve(items_.size());
    for (const Item& item : items_) numbers.push_back(item.number);
  }

 private:
  void build(int first, int last, int parentAxis) {
    const std::size_t index = nodes_.size();
    nodes_.push_back({first, last, 0});
    if (last - first <= leafSize_) return sortLeaf(first, last, parentAxis);
    const int half = first + (last - first) / 2, axis = longestAxis(first, last);
    std::nth_element(at(first), at(half), at(last), Before{axis});
    build(first, half, axis);
    nodes_[index].right = static_cast<int>(nodes_.size());
    build(half, last, axis);
  }

  int longestAxis(int first, int last) const {
    typename Item::Box box;
    for (int i = first; i < last; ++i) items_[static_cast<std::size_t>(i)].extend(box);
    int axis = 0;
    for (int k = 1; k < 3; ++k) {
      if (box.high[k] - box.low[k] > box.high[axis] - box.low[axis]) axis = k;
    }
    return axis;
  }

  /// Sorts the items of a leaf: their order after `nth_element` depends on the standard library.
  void sortLeaf(int first, int last, int axis) {
    if (axis >= 0) std::sort(at(first), at(last), Before{axis});
  }

  /// Order along an axis; of two at the same coordinate, the lower number comes first.
  struct Before {
    int axis;
    bool operator()(const Item& a, const Item& b) const {
      const auto x = a.key(axis), y = b.key(axis);
      return x < y || (x == y && a.number < b.number);
    }
  };

  auto at(int index) { return items_.begin() + index; }

  std::vector<Item> items_;
  int leafSize_;
  std::vector<Bvh::Node>& nodes_;
};

std::vector<int> allItems(std::size_t count) {
  std::vector<int> all(count);
  std::iota(all.begin(), all.end(), 0);
  return all;
}

}  // namespace

template <class Scalar>
Bvh::Bvh(const Centroids<Scalar>& centroids, int leafSize) : Bvh(centroids, allItems(centroids.size()), leafSize) {}

template <class Scalar>
Bvh::Bvh(const Centroids<Scalar>& centroids, const std::vector<int>& items, int leafSize) {
  assert(leafSize > 0);
  using Item = PointItem<Scalar>;
  std::vector<Item> points;
  points.reserve(items.size());
  for (const int number : items) {
    assert(number >= 0 && static_cast<std::size_t>(number) < centroids.size());
    const auto& centroid = centroids[static_cast<std::size_t>(number)];
    points.push_back({centroid, number});
    // NaN cannot be sorted; any position is valid.
    if (!centroid.allFinite()) points.back().centroid.setZero();
  }
  Builder<Item>(std::move(points), leafSize, nodes_, items_);
}

template <class Scalar>
Bvh::Bvh(const std::vector<BvhBox<Scalar>>& boxes, const std::vector<int>& items, int leafSize) {
  assert(leafSize > 0);
  using Item = BoxItem<Scalar>;
  std::vector<Item> boxed;
  boxed.reserve(items.size());
  for (const int number : items) boxed.push_back({boxes[static_cast<std::size_t>(number)], number});
  Builder<Item>(std::move(boxed), leafSize, nodes_, items_);
}

#define TETSKIN_INSTANTIATE(Scalar)                                                           \
  template TETSKIN_CORE_API Bvh::Bvh(const Centroids<Scalar>&, int);                          \
  template TETSKIN_CORE_API Bvh::Bvh(const Centroids<Scalar>&, const std::vector<int>&, int); \
  template TETSKIN_CORE_API Bvh::Bvh(const std::vector<BvhBox<Scalar>>&, const std::vector<int>&, int);  // NOLINT
TETSKIN_FOR_SCALARS(TETSKIN_INSTANTIATE)
#undef TETSKIN_INSTANTIATE

}  // namespace tetskin
