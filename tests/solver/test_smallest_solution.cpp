// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/solver/src/rows/smallest_solution.h>

namespace tetskin::test {
namespace {

using bullet_detail::SmallestSolution;

constexpr std::size_t kSmallestRows = SmallestSolution::kRows;

/// The same numbers from -1 to 1 each time; columns from `independent` on are sums of those before.
SmallestSolution::Columns dependentColumns(std::size_t independent) {
  SmallestSolution::Columns columns{};
  for (std::size_t k = 0; k < SmallestSolution::kMaxColumns; ++k) {
    for (std::size_t i = 0; i < kSmallestRows; ++i) {
      double& to = columns[kSmallestRows * k + i];
      to = std::sin(1.0 + 2.3 * static_cast<double>(i) + 0.7 * static_cast<double>(k * i * i));
      if (k < independent) continue;
      to = 0.0;
      for (std::size_t j = 0; j < independent; ++j) {
        to += columns[kSmallestRows * j + i] * std::cos(static_cast<double>(j + 3 * k));
      }
    }
  }
  return columns;
}

TEST(SmallestSolution, LeavesAnErrorAcrossAllColumnsAndLiesInTheirRows) {
  for (std::size_t rank = 1; rank <= SmallestSolution::kMaxColumns; ++rank) {
    SCOPED_TRACE(rank);
    const SmallestSolution::Columns a = dependentColumns(rank);
    std::array<double, kSmallestRows> b{};
    for (std::size_t i = 0; i < kSmallestRows; ++i) b[i] = std::cos(0.4 + 1.9 * static_cast<double>(i));
    const auto x = SmallestSolution(a, SmallestSolution::kMaxColumns).solve(b);
    std::array<double, kSmallestRows> left = b;
    for (std::size_t k = 0; k < x.size(); ++k) {
      for (std::size_t i = 0; i < kSmallestRows; ++i) left[i] -= a[kSmallestRows * k + i] * x[k];
    }
    for (std::size_t k = 0; k < x.size(); ++k) {
      double product = 0.0;
      for (std::size_t i = 0; i < kSmallestRows; ++i) product += a[kSmallestRows * k + i] * left[i];
      EXPECT_NEAR(product, 0.0, 1e-13);
    }
    // With dependent columns, x is a sum of rows: it has no share along what changes nothing.
    for (std::size_t k = rank; k < x.size(); ++k) {
      double along = -x[k];
      for (std::size_t j = 0; j < rank; ++j) along += std::cos(static_cast<double>(j + 3 * k)) * x[j];
      EXPECT_NEAR(along, 0.0, 1e-12);
    }
  }
}

TEST(SmallestSolution, OfColumnsOfZerosIsZero) {
  for (const double x : SmallestSolution({}, 3).solve({1, 2, 3})) EXPECT_EQ(x, 0.0);
}

}  // namespace
}  // namespace tetskin::test
