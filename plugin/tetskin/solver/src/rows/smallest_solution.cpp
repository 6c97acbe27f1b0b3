// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/src/base/arithmetic/small_matrix.h>
#include <tetskin/solver/src/rows/smallest_solution.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <utility>

namespace tetskin::bullet_detail {
namespace {

constexpr double kDigit = std::numeric_limits<double>::epsilon();

/// Strided access to a part of a column or a row: neighbours are `stride` apart.
template <class Number>
struct Numbers {
  Number& operator[](std::size_t k) const { return first[k * stride]; }
  Number* first;
  std::size_t stride, count;
};
using Changed = Numbers<double>;
using Read = Numbers<const double>;

/// The reflection 1 - factor (1, w) (1, w)^T that zeroes all numbers of v but the first; w replaces the others. Returns
/// the factor.
double makeReflection(Changed v) {
  double squared = 0.0;
  for (std::size_t k = 1; k < v.count; ++k) squared += v[k] * v[k];
  const double first = v[0];
  if (squared <= std::numeric_limits<double>::min()) {
    for (std::size_t k = 1; k < v.count; ++k) v[k] = 0.0;
    return 0.0;
  }
  double length = std::sqrt(first * first + squared);
  if (first >= 0.0) length = -length;
  for (std::size_t k = 1; k < v.count; ++k) v[k] /= first - length;
  v[0] = length;
  return (length - first) / length;
}

/// v = (1 - factor (1, w) (1, w)^T) v, where w is `by` without its first number.
/// isRow  multiplies in the order for a row
void reflect(Read by, double factor, Changed v, bool isRow = false) {
  assert(by.count == v.count && v.count > 1);
  if (factor == 0.0) return;
  double product = 0.0;
  for (std::size_t k = 1; k < v.count; ++k) product += by[k] * v[k];
  product += v[0];
  v[0] -= factor * product;
  for (std::size_t k = 1; k < v.count; ++k) {
    v[k] -= isRow ? (factor * product) * by[k] : (factor * by[k]) * product;
  }
}

}  // namespace

SmallestSolution::SmallestSolution(const Columns& columns, std::size_t count) : qr_(columns), count_(count) {
  assert(count > 0 && count <= kMaxColumns);
  for (std::size_t k = 0; k < count; ++k) {
    order_[k] = k;
    lengths_[k] = computed_[k] = norm(smallFrom<kRows>(from(0, k)));
  }
  const double longest = *std::max_element(lengths_.begin(), lengths_.begin() + static_cast<std::ptrdiff_t>(count));
  pivots_ = count;
  for (std::size_t k = 0; k < count; ++k) {
    exchangeWithLongest(k);
    const double left = lengths_[k] * lengths_[k], enough = (longest * kDigit) * (longest * kDigit) / kRows;
    if (pivots_ == count && left < enough * static_cast<double>(kRows - k)) pivots_ = k;
    factors_[k] = makeReflection({&at(k, k), 1, kRows - k});
    for (std::size_t j = k + 1; j < count; ++j) {
      reflect({from(k, k), 1, kRows - k}, factors_[k], {&at(k, j), 1, kRows - k});
    }
    shortenLengths(k);
  }
  findRank();
  if (rank_ < count) reduceRows();
}

void SmallestSolution::exchangeWithLongest(std::size_t k) {
  std::size_t with = k;
  for (std::size_t j = k + 1; j < count_; ++j) {
    if (lengths_[j] > lengths_[with]) with = j;
  }
  if (with == k) return;
  std::swap_ranges(&at(0, k), &at(0, k) + kRows, &at(0, with));
  std::swap(lengths_[k], lengths_[with]);
  std::swap(computed_[k], computed_[with]);
  std::swap(order_[k], order_[with]);
}

/// Updates the lengths of the columns behind k, now without row k. They are recomputed when digits are lost.
void SmallestSolution::shortenLengths(std::size_t k) {
  for (std::size_t j = k + 1; j < count_; ++j) {
    if (lengths_[j] == 0.0) continue;
    const double share = std::abs(at(k, j)) / lengths_[j], of = lengths_[j] / computed_[j];
    const double left = std::max((1.0 + share) * (1.0 - share), 0.0);
    if (left * (of * of) > std::sqrt(kDigit)) {
      lengths_[j] *= std::sqrt(left);
      continue;
    }
    double squared = 0.0;
    for (std::size_t i = k + 1; i < kRows; ++i) squared += at(i, j) * at(i, j);
    lengths_[j] = computed_[j] = std::sqrt(squared);
  }
}

void SmallestSolution::findRank() {
  double largest = 0.0;
  for (std::size_t k = 0; k < count_; ++k) largest = std::max(largest, std::abs(at(k, k)));
  const double least = largest * (kDigit * static_cast<double>(count_));
  for (std::size_t k = 0; k < pivots_; ++k) rank_ += std::abs(at(k, k)) > least ? 1 : 0;
}

/// R = (T 0) Z, where T has as many columns as the rank.
void SmallestSolution::reduceRows() {
  const std::size_t size = count_ - rank_ + 1, last = rank_ - 1;
  for (std::size_t k = rank_; k-- > 0;) {
    std::swap_ranges(&at(0, k), &at(0, k) + (k == last ? 0 : k + 1), &at(0, last));
    rowFactors_[k] = makeReflection({&at(k, last), kRows, size});
    for (std::size_t i = 0; i < k; ++i) {
      reflect({from(k, last), kRows, size}, rowFactors_[k], {&at(i, last), kRows, size}, true);
    }
    std::swap_ranges(&at(0, k), &at(0, k) + (k == last ? 0 : k + 1), &at(0, last));
  }
}

std::array<double, SmallestSolution::kMaxColumns> SmallestSolution::solve(std::array<double, kRows> b) const {
  for (std::size_t k = 0; k < rank_; ++k) {
    reflect({from(k, k), 1, kRows - k}, factors_[k], {&b[k], 1, kRows - k});
  }
  std::array<double, kMaxColumns> x{}, solution{};
  for (std::size_t k = rank_; k-- > 0;) {
    x[k] = b[k] / *from(k, k);
    for (std::size_t i = 0; i < k; ++i) b[i] -= x[k] * *from(i, k);
  }
  const std::size_t size = count_ - rank_ + 1, last = rank_ - 1;
  for (std::size_t k = 0; k < rank_ && rank_ < count_; ++k) {
    std::swap(x[k], x[last]);
    std::array<double, kMaxColumns> by{};
    for (std::size_t j = 1; j < size; ++j) by[j] = *from(k, last + j);
    reflect({by.data(), 1, size}, rowFactors_[k], {&x[last], 1, size});
    std::swap(x[k], x[last]);
  }
  for (std::size_t k = 0; k < count_; ++k) solution[order_[k]] = x[k];
  return solution;
}

}  // namespace tetskin::bullet_detail
