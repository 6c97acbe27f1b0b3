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
Eigen::Matrix<double, 6, 6> symmetricMatrix6(std::mt19937& random, int rank) {
  Eigen::Matrix<double, 6, 6> sum = Eigen::Matrix<double, 6, 6>::Zero();
  for (int k = 0; k < rank; ++k) {
    const Eigen::Matrix<double, 6, 1> v = randomMatrix<6>(random);
    sum += (k % 3 == 2 ? -1.0 : 1.0) * v * v.transpose();
  }
  return sum;
}

TEST(SmallMatrix, SolutionsHaveTheBitsOfEigensAlsoForSingularMatrices) {
  std::mt19937 random(3);
  for (int time = 0; time < kTimes; ++time) {
    const Eigen::Matrix<double, 6, 6> m = symmetricMatrix6(random, time % 8);
    const Eigen::Matrix<double, 6, 1> right = randomMatrix<6>(random);
    expectSameBits(SmallLdlt<6>(small(m)).solve(small(right)), Eigen::Matrix<double, 6, 1>(m.ldlt().solve(right)));
  }
}

TEST(SmallMatrix, SolutionsOfMatricesWithZerosHaveTheBitsOfEigens) {
  std::mt19937 random(4);
  for (int time = 0; time < kTimes; ++time) {
    Eigen::Matrix<double, 6, 6> m = symmetricMatrix6(random, 6);
    for (int k = 0; k < 6; ++k) {
      if (random() % 3 == 0) m.row(k).setZero(), m.col(k).setZero();
    }
    const Eigen::Matrix<double, 6, 1> right = randomMatrix<6>(random);
    expectSameBits(SmallLdlt<6>(small(m)).solve(small(right)), Eigen::Matrix<double, 6, 1>(m.ldlt().solve(right)));
  }
}

}  // namespace
}  // namespace tetskin
