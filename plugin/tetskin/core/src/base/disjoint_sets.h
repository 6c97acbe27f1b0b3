// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <cassert>
#include <cstddef>
#include <numeric>
#include <utility>
#include <vector>

namespace tetskin {

/// Disjoint sets over 0 .. count-1 with path halving; the lowest member represents a set. Each member also has a parity
/// relative to its representative, for sets whose members agree or disagree in a yes-no property.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t count) : parent_(count), parity_(count, 0) {
    std::iota(parent_.begin(), parent_.end(), 0);
  }

  /// Up to `count` members; each new one is a set of its own.
  void grow(std::size_t count) {
    assert(count >= parent_.size());
    const std::size_t before = parent_.size();
    parent_.resize(count);
    std::iota(parent_.begin() + static_cast<std::ptrdiff_t>(before), parent_.end(), static_cast<int>(before));
    parity_.resize(count, 0);
  }

  int find(int i) {
    assert(i >= 0 && static_cast<std::size_t>(i) < parent_.size());
    while (parent_[i] != i) {
      const int up = parent_[i];
      parity_[i] = static_cast<char>(parity_[i] ^ parity_[up]);
      parent_[i] = parent_[up];
      i = parent_[i];
    }
    return i;
  }

  /// By member: the number of its set. Sets are numbered in the order of their lowest members.
  std::vector<int> numbers() {
    std::vector<int> numbers(parent_.size());
    int count = 0;
    for (int i = 0; i < static_cast<int>(numbers.size()); ++i) {
      const int root = find(i);
      numbers[static_cast<std::size_t>(i)] = root == i ? count++ : numbers[static_cast<std::size_t>(root)];
    }
    return numbers;
  }

  /// 1 if i differs from its representative.
  int parity(int i) {
    int odd = 0;
    for (; parent_[i] != i; i = parent_[i]) odd ^= parity_[i];
    return odd;
  }

  /// Joins the sets of a and b; `differ` is 1 if a and b differ. Nothing happens if they are already joined.
  void unite(int a, int b, int differ = 0) {
    const int odd = parity(a) ^ parity(b) ^ differ;
    int rootA = find(a), rootB = find(b);
    if (rootA == rootB) return;
    if (rootA > rootB) std::swap(rootA, rootB);
    parent_[rootB] = rootA;
    parity_[rootB] = static_cast<char>(odd);
  }

 private:
  std::vector<int> parent_;
  std::vector<char> parity_;  ///< relative to the parent
};

}  // namespace tetskin
