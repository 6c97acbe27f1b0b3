// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/src/base/arithmetic/small_matrix.h>

#include <Eigen/Cholesky>
#include <cstring>

namespace tetskin {
namespace {

/// Random numbers of several magnitudes.
template <int Rows, int Columns = 1>
Eigen::Matrix<double, Rows, Columns> randomMatrix(std::mt19937& random) {
  std::uniform_real_distribution<double> mantissa(-1.0, 1.0);
  std::uniform_int_distribution<int> exponent(-8, 8);
  Eigen::Matrix<double, Rows, Columns> m;
  for (int k = 0; k < Rows * Columns; ++k) m.data()[k] = std::ldexp(mantissa(random), exponent(random));
  return m;
}

template <int Rows, int Columns>
SmallMatrix<Rows, Columns> small(const Eigen::Matrix<double, Rows, Columns>& m) {
  return smallFrom<Rows, Columns>(m.data());
}

template <int Rows, int Columns>
void expectSameBits(const SmallMatrix<Rows, Columns>& a, const Eigen::Matrix<double, Rows, Columns>& b) {
  EXPECT_EQ(std::memcmp(a.values, b.data(), sizeof a.values), 0);
}

constexpr int kTimes = 300;

TEST(SmallMatrix, ProductsHaveTheBitsOfEigens) {
  std::mt19937 random(1);
  for (int time = 0; time < kTimes; ++time) {
    const Eigen::Matrix<double, 3, 6> a = randomMatrix<3, 6>(random), b = randomMatrix<3, 6>(random);
    const Eigen::Matrix3d h = randomMatrix<3, 3>(random);
    const Eigen::Matrix<double, 6, 6> m = randomMatrix<6, 6>(random);
    const Eigen::Matrix<double, 6, 1> q = randomMatrix<6>(random);
    const Eigen::Vector3d v = randomMatrix<3>(random);
    expectSameBits(transposeTimes(small(a), small(h)) * small(b), Eigen::Matrix<double, 6, 6>(a.transpose() * h * b));
    expectSameBits(small(a) * small(q), Eigen::Vector3d(a * q));
    expectSameBits(transposeTimes(small(a), small(v)), Eigen::Matrix<double, 6, 1>(a.transpose() * v));
    expectSameBits(small(q) + small(m) * small(q), Eigen::Matrix<double, 6, 1>(q + m * q));
    expectSameBits(small(h) * small(v) - 0.3 * small(v), Eigen::Vector3d(h * v - 0.3 * v));
  }
}

TEST(SmallMatrix, NormsAndDotAndCrossProductsHaveTheBitsOfEigens) {
  std::mt19937 random(2);
  for (int time = 0; time < kTimes; ++time) {
    const Eigen::Vector3d a = randomMatrix<3>(random), b = randomMatrix<3>(random);
    const Eigen::Matrix<double, 6, 1> p = randomMatrix<6>(random), q = randomMatrix<6>(random);
    EXPECT_EQ(dot(small(a), small(b)), a.dot(b));
    EXPECT_EQ(dot(small(p), small(q)), p.dot(q));
    EXPECT_EQ(norm(small(a)), a.norm());
    EXPECT_EQ(squaredNorm(small(p)), p.squaredNorm());
    expectSameBits(cross(small(a), small(b)), Eigen::Vector3d(a.cross(b)));
    EXPECT_TRUE(isZero(cross(small(a), small(b)) - smallCrossMatrix(small(a)) * small(b)));
  }
}

/// Symmetric, of the given rank.
template <int Size>
Eigen::Matrix<double, Size, Size> symmetricMatrix(std::mt19937& random, int rank) {
  Eigen::Matrix<double, Size, Size> sum = Eigen::Matrix<double, Size, Size>::Zero();
  for (int k = 0; k < rank; ++k) {
    const Eigen::Matrix<double, Size, 1> v = randomMatrix<Size>(random);
    sum += (k % 3 == 2 ? -1.0 : 1.0) * v * v.transpose();
  }
  return sum;
}

template <int Size>
void expectBitsOfEigensSolutions(const Eigen::Matrix<double, Size, Size>& m, std::mt19937& random) {
  const Eigen::Matrix<double, Size, 1> right = randomMatrix<Size>(random);
  Eigen::Matrix<double, Size, Size> lower = m;  // the rest is not read
  lower.template triangularView<Eigen::StrictlyUpper>().setConstant(NAN);
  expectSameBits(SmallLdlt<Size>(small(lower)).solve(small(right)),
                 Eigen::Matrix<double, Size, 1>(m.ldlt().solve(right)));
}

TEST(SmallMatrix, SymmetricSolutionsHaveTheBitsOfEigensAlsoForSingularMatrices) {
  std::mt19937 random(3);
  for (int time = 0; time < kTimes; ++time) {
    expectBitsOfEigensSolutions<6>(symmetricMatrix<6>(random, time % 8), random);
    expectBitsOfEigensSolutions<3>(symmetricMatrix<3>(random, time % 5), random);
  }
}

TEST(SmallMatrix, SymmetricSolutionsOfMatricesWithZerosHaveTheBitsOfEigens) {
  std::mt19937 random(4);
  for (int time = 0; time < kTimes; ++time) {
    Eigen::Matrix<double, 6, 6> m = symmetricMatrix<6>(random, 6);
    for (int k = 0; k < 6; ++k) {
      if (random() % 3 == 0) m.row(k).setZero(), m.col(k).setZero();
    }
    expectBitsOfEigensSolutions<6>(m, random);
    expectBitsOfEigensSolutions<3>(m.topLeftCorner<3, 3>(), random);
  }
}

template <int Size>
void expectBitsOfEigensFactors(std::mt19937& random) {
  const Eigen::Matrix<double, Size, Size> m = randomMatrix<Size, Size>(random);
  const Eigen::Matrix<double, Size, 1> right = randomMatrix<Size>(random);
  expectSameBits(solved(small(m), small(right)), Eigen::Matrix<double, Size, 1>(m.partialPivLu().solve(right)));
}

TEST(SmallMatrix, SolutionsHaveTheBitsOfEigens) {
  std::mt19937 random(5);
  for (int time = 0; time < kTimes; ++time) {
    expectBitsOfEigensFactors<3>(random);
    expectBitsOfEigensFactors<6>(random);
  }
}

TEST(SmallMatrix, SolutionsDivideByNoSmallPivot) {
  const SmallMatrix<2> x = solved<2>({{1e-20, 1.0, 1.0, 1.0}}, {{1.0, 2.0}});
  EXPECT_DOUBLE_EQ(x[0], 1.0);
  EXPECT_DOUBLE_EQ(x[1], 1.0);
}

TEST(SmallMatrix, SolutionsOfASingularMatrixAreNotFinite) {
  const SmallMatrix<2> x = solved<2>({{1.0, 2.0, 2.0, 4.0}}, {{1.0, 1.0}});
  EXPECT_FALSE(std::isfinite(x[0]) && std::isfinite(x[1]));
}

}  // namespace
}  // namespace tetskin
