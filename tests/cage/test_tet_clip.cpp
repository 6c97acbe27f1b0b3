// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/cage/src/split/tet_clip.h>

namespace tetskin::test {
namespace {

using Weights = Eigen::Vector4d;

constexpr int kClipped = 5000;
/// More than an edge may be outside of a tet that it touches.
constexpr double kOutsideOfTet = 2e-4;

/// The weights of points in the tet and around it.
class RandomWeights {
 public:
  Weights operator()() {
    const double a = weight_(random_), b = weight_(random_), c = weight_(random_);
    return {a, b, c, 1.0 - a - b - c};
  }

 private:
  std::mt19937 random_{5};
  std::uniform_real_distribution<double> weight_{-0.6, 0.9};
};

/// The largest value that the least weight has along a segment. There two weights are equal, or the segment ends.
double deepestAlong(const Weights& from, const Weights& to) {
  double deepest = std::max(from.minCoeff(), to.minCoeff());
  for (int a = 0; a < 4; ++a) {
    for (int b = 0; b < a; ++b) {
      const double first = from[a] - from[b], last = to[a] - to[b], fraction = first / (first - last);
      if (fraction > 0.0 && fraction < 1.0) deepest = std::max(deepest, (from + fraction * (to - from)).minCoeff());
    }
  }
  return deepest;
}

TEST(TetClip, ASegmentPassesThroughWhereAllWeightsArePositive) {
  RandomWeights random;
  int through = 0;
  for (int k = 0; k < kClipped; ++k) {
    const Weights from = random(), to = random();
    const double deepest = deepestAlong(from, to);
    if (deepest < 0.0 && deepest > -kOutsideOfTet) continue;
    ASSERT_EQ(cage_detail::passesThrough(from, to), deepest >= 0.0) << from.transpose() << " to " << to.transpose();
    through += deepest >= 0.0 ? 1 : 0;
  }
  EXPECT_GT(through, kClipped / 10);
  EXPECT_LT(through, kClipped - kClipped / 10);
}

TEST(TetClip, ASegmentInAFacePassesThroughBothTetsDespiteRounding) {
  const Weights from(-1e-5, 0.3, 0.3, 0.40001), to(-1e-5, 0.5, 0.3, 0.20001);
  EXPECT_TRUE(cage_detail::passesThrough(from, to));
}

/// Finds the corners of the part of a triangle in the tet among the crossings of the seven lines that bound it: they
/// are on the inner side of all lines. Returns their number, and their sum.
int cornersWithin(const std::array<Weights, 3>& triangle, Weights& sum) {
  Eigen::Matrix<double, 7, 3> lines;
  lines << Eigen::Matrix3d::Identity(), triangle[0], triangle[1], triangle[2];
  int count = 0;
  sum.setZero();
  for (int i = 0; i < 7; ++i) {
    for (int j = 0; j < i; ++j) {
      Eigen::Vector3d crossing = lines.row(i).transpose().cross(lines.row(j).transpose());
      crossing /= crossing.sum();
      if ((lines * crossing).minCoeff() < -1e-12) continue;
      sum += lines.bottomRows<4>() * crossing;
      ++count;
    }
  }
  return count;
}

TEST(TetClip, TheCentroidIsThatOfTheCornersOfWhatIsInTheTet) {
  RandomWeights random;
  int clipped = 0;
  for (int k = 0; k < kClipped; ++k) {
    const std::array<Weights, 3> triangle{random(), random(), random()};
    Weights sum;
    const int count = cornersWithin(triangle, sum);
    if (count == 0) continue;
    ASSERT_LT((cage_detail::centroidWithin(triangle) - sum / count).norm(), 1e-9);
    clipped += count > 3 ? 1 : 0;
  }
  EXPECT_GT(clipped, kClipped / 10);
}

}  // namespace
}  // namespace tetskin::test
