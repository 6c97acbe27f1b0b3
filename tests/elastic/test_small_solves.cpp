// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/elastic/src/base/small_solves.h>

namespace tetskin::elastic_detail {
namespace {

using Numbers = std::vector<double>;

Numbers numbers(int count, std::mt19937& random) {
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  Numbers values(static_cast<std::size_t>(count));
  for (double& value : values) value = any(random);
  return values;
}

/// The largest entry of A x - b, relative to that of x; A by columns.
double residual(const Numbers& a, const Numbers& x, const Numbers& b) {
  double most = 0.0, size = 1.0;
  for (std::size_t row = 0; row < b.size(); ++row) {
    double sum = -b[row];
    for (std::size_t column = 0; column < b.size(); ++column) sum += a[row + b.size() * column] * x[column];
    most = std::max(most, std::abs(sum));
    size = std::max(size, std::abs(x[row]));
  }
  return most / size;
}

TEST(SmallSolves, FindWhatTheMatrixTakesToTheRightSide) {
  std::mt19937 random(1);
  for (int k = 0; k < 1000; ++k) {
    const int size = 1 + k % kMostUnknowns;
    const Numbers a = numbers(size * size, random), b = numbers(size, random);
    Numbers left = a, x = b;
    solveSmall(size, left.data(), x.data());
    EXPECT_LT(residual(a, x, b), 1e-14) << size;
  }
}

TEST(SmallSolves, DivideByNoSmallPivot) {
  Numbers a = {1e-20, 1.0, 1.0, 1.0}, x = {1.0, 2.0};
  solveSmall(2, a.data(), x.data());
  EXPECT_DOUBLE_EQ(x[0], 1.0);
  EXPECT_DOUBLE_EQ(x[1], 1.0);
}

TEST(SmallSolves, OfASingularMatrixAreNotFinite) {
  Numbers a = {1.0, 2.0, 2.0, 4.0}, x = {1.0, 1.0};
  solveSmall(2, a.data(), x.data());
  EXPECT_FALSE(std::isfinite(x[0]) && std::isfinite(x[1]));
}

TEST(SymmetricFactors, SolveForAnyOrderOfTheDiagonal) {
  std::mt19937 random(2);
  for (int k = 0; k < 1000; ++k) {
    const Numbers root = numbers(9, random), b = numbers(3, random);
    Numbers a(9, 0.0);  // positive
    for (std::size_t i = 0; i < 9; ++i) {
      for (std::size_t j = 0; j < 3; ++j) a[i] += root[i % 3 + 3 * j] * root[i / 3 + 3 * j];
    }
    for (std::size_t i = 0; i < 9; i += 4) a[i] += 0.1;
    Numbers x = b;
    SymmetricFactors(a.data()).solve(x.data());
    EXPECT_LT(residual(a, x, b), 1e-13);
  }
}

TEST(SymmetricFactors, ReadTheLowerTriangleAlone) {
  const Numbers a = {2.0, 1.0, 0.5, NAN, 3.0, 0.25, NAN, NAN, 4.0};
  const Numbers whole = {2.0, 1.0, 0.5, 1.0, 3.0, 0.25, 0.5, 0.25, 4.0}, b = {1.0, -2.0, 3.0};
  Numbers x = b;
  SymmetricFactors(a.data()).solve(x.data());
  EXPECT_LT(residual(whole, x, b), 1e-14);
}

TEST(SymmetricFactors, OfWhatHasNoInverseGiveNoPart) {
  Numbers x = {1.0, 2.0, 3.0};
  SymmetricFactors(Numbers(9, 0.0).data()).solve(x.data());
  EXPECT_EQ(x, Numbers(3, 0.0));
  x = {1.0, 2.0, 3.0};
  SymmetricFactors(Numbers{0.0, 0.0, 0.0, 0.0, 4.0, 0.0, 0.0, 0.0, 0.0}.data()).solve(x.data());
  EXPECT_EQ(x, (Numbers{0.0, 0.5, 0.0}));
}

}  // namespace
}  // namespace tetskin::elastic_detail
