// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "support/allocation_count.h"
#include "support/odd_meshes.h"

#include <tetskin/core/mesh_skin.h>

#include <limits>

namespace tetskin {
namespace {

template <class Scalar>
class KeptStepsOf : public testing::Test {
 public:
  using Points = std::vector<Eigen::Matrix<Scalar, 3, 1>>;

  static Points points(unsigned seed) {
    Points all;
    for (const Eigen::Vector3d& p : test::randomPoints(50, {Eigen::Vector3d::Zero(), Eigen::Vector3d::Ones()}, seed)) {
      all.push_back(p.cast<Scalar>());
    }
    return all;
  }
  Points at(Scalar alpha) const {
    Points out(steps.size());
    steps.nodesAt(alpha, viewOf(out));
    return out;
  }

  StepHistory<Scalar> steps;
  const Points a = points(1), b = points(2), c = points(3);
};

using Precisions = testing::Types<float, double>;
TYPED_TEST_SUITE(KeptStepsOf, Precisions, );

TYPED_TEST(KeptStepsOf, TellOfASingleNodeWhatTheyTellOfAll) {
  (void)this->steps.record(viewOf(this->a));
  EXPECT_EQ(this->steps.nodeAt(7, TypeParam(0.5)), this->a[7]);
  (void)this->steps.record(viewOf(this->b));
  for (const double alpha : {-1.0, 0.0, 0.3, 1.0, 2.0}) {
    const auto all = this->at(TypeParam(alpha));
    for (const std::size_t n : {0u, 7u, 49u}) EXPECT_EQ(this->steps.nodeAt(n, TypeParam(alpha)), all[n]) << alpha;
  }
}

TYPED_TEST(KeptStepsOf, AreTheLastTwo) {
  EXPECT_TRUE(this->steps.empty());
  EXPECT_FALSE(this->steps.record(viewOf(this->a)));
  EXPECT_EQ(this->at(TypeParam(0.3)), this->a);
  EXPECT_TRUE(this->steps.record(viewOf(this->b)));
  EXPECT_EQ(this->at(0), this->a);
  EXPECT_EQ(this->at(1), this->b);
  EXPECT_TRUE(this->steps.record(viewOf(this->c)));
  EXPECT_EQ(this->at(0), this->b);
  EXPECT_EQ(this->at(1), this->c);
  const auto quarter = this->at(TypeParam(0.25));
  for (std::size_t i = 0; i < quarter.size(); ++i) {
    EXPECT_LT((quarter[i] - (3 * this->b[i] + this->c[i]) / 4).norm(), 4 * std::numeric_limits<TypeParam>::epsilon());
  }
}

TYPED_TEST(KeptStepsOf, TakeAnAlphaBeyondTheirEndsForThem) {
  (void)this->steps.record(viewOf(this->a));
  (void)this->steps.record(viewOf(this->b));
  using Limits = std::numeric_limits<TypeParam>;
  for (const TypeParam before : {TypeParam(-0.01), -Limits::max(), -Limits::infinity()}) {
    EXPECT_EQ(this->at(before), this->a);
  }
  for (const TypeParam after : {TypeParam(1.01), Limits::max(), Limits::infinity(), Limits::quiet_NaN()}) {
    EXPECT_EQ(this->at(after), this->b);
  }
}

TYPED_TEST(KeptStepsOf, BeginAnewAfterAGapABadNodeOrAnotherNumberOfNodes) {
  using Limits = std::numeric_limits<TypeParam>;
  (void)this->steps.record(viewOf(this->a));
  ASSERT_TRUE(this->steps.record(viewOf(this->b)));
  this->steps.clear();
  EXPECT_EQ(this->at(TypeParam(0.5)), this->b);
  EXPECT_FALSE(this->steps.record(viewOf(this->c)));
  EXPECT_EQ(this->at(TypeParam(0.5)), this->c);
  EXPECT_TRUE(this->steps.record(viewOf(this->a)));
  for (const TypeParam bad : {Limits::quiet_NaN(), Limits::infinity(), TypeParam(1.1e18)}) {
    auto broken = this->b;
    broken[7].y() = bad;
    EXPECT_FALSE(this->steps.record(viewOf(std::as_const(broken))));
    EXPECT_FALSE(this->steps.record(viewOf(this->c)));
    EXPECT_TRUE(this->steps.record(viewOf(this->a)));
  }
  auto fewer = this->b;
  fewer.pop_back();
  EXPECT_FALSE(this->steps.record(viewOf(std::as_const(fewer))));
  EXPECT_EQ(this->at(TypeParam(0.5)), fewer);
}

TYPED_TEST(KeptStepsOf, AreTwoCopiesMadeOnce) {
  const std::size_t before = test::allocatedBytes();
  (void)this->steps.record(viewOf(this->a));
  EXPECT_EQ(test::allocatedBytes() - before, 6 * sizeof(TypeParam) * this->a.size());
  const std::size_t count = test::allocationCount();
  (void)this->steps.record(viewOf(this->b));
  (void)this->steps.record(viewOf(this->c));
  EXPECT_EQ(test::allocationCount(), count);
}

/// A skin drawn between two steps, compared with a skin of nodes half way between them.
class SkinBetweenSteps : public testing::Test {
 protected:
  using Points = std::vector<Eigen::Vector3f>;

  /// Bends the cage; one half of it stays where it is.
  Points bent(double amount) const {
    Points nodes;
    for (const Eigen::Vector3d& p : cage.nodes) {
      const double x = std::max(p.x() - 0.5, 0.0);
      nodes.push_back((p + amount * Eigen::Vector3d(0.0, x * x, x)).cast<float>());
    }
    return nodes;
  }
  void keep(const Points& nodes) { steps.record(viewOf(nodes)); }
  static void expectNear(PointView<const float> points, PointView<const float> expected, float tolerance) {
    ASSERT_EQ(points.size(), expected.size());
    for (std::size_t v = 0; v < points.size(); ++v) {
      const Eigen::Map<const Eigen::Vector3f> p(points[v]), q(expected[v]);
      EXPECT_LT((p - q).norm(), tolerance) << v;
    }
  }

  TetMesh cage = test::latticeCage(8, 2, 2, 0.125);
  TriangleMesh mesh = test::sphere(20, 0.4, Eigen::Vector3d(0.5, 0.125, 0.125));
  StepHistory<float> steps;
};

TEST_F(SkinBetweenSteps, IsThatOfTheNodesBetweenThem) {
  for (const Interpolation interpolation : {Interpolation::Linear, Interpolation::Quadratic}) {
    for (const Normals normals : {Normals::Transformed, Normals::Recomputed}) {
      SkinOptions options;
      options.interpolation = interpolation;
      options.normals = normals;
      MeshSkin<float> skin, expected;
      ASSERT_TRUE(skin.bind(cage, mesh, options).ok());
      ASSERT_TRUE(expected.bind(cage, mesh, options).ok());
      keep(bent(1.0));
      keep(bent(2.0));
      for (const double alpha : {0.5, 0.5, 0.25, 0.0, 1.0, 0.75}) {
        const Points between = bent(1.0 + alpha);
        ASSERT_EQ(skin.update(steps, static_cast<float>(alpha)), StatusCode::Ok);
        ASSERT_EQ(expected.update(viewOf(between)), StatusCode::Ok);
        expectNear(skin.positions(), expected.positions(), 2e-6f);
        expectNear(skin.normals(), expected.normals(), 1e-4f);
      }
    }
  }
}

TEST_F(SkinBetweenSteps, IsAtTheirEndsThatOfTheirNodesToTheBit) {
  MeshSkin<float> skin, expected;
  ASSERT_TRUE(skin.bind(cage, mesh).ok());
  ASSERT_TRUE(expected.bind(cage, mesh).ok());
  keep(bent(0.3));
  keep(bent(0.7));
  for (const auto& [alpha, amount] : {std::pair{0.0f, 0.3}, std::pair{1.0f, 0.7}}) {
    const Points nodes = bent(amount);
    ASSERT_EQ(skin.update(steps, alpha), StatusCode::Ok);
    ASSERT_EQ(expected.update(viewOf(nodes)), StatusCode::Ok);
    expectNear(skin.positions(), expected.positions(), std::numeric_limits<float>::min());
  }
}

TEST_F(SkinBetweenSteps, AllocatesNothing) {
  MeshSkin<float> skin;
  ASSERT_TRUE(skin.bind(cage, mesh).ok());
  keep(bent(0.3));
  keep(bent(0.7));
  const std::size_t before = test::allocationCount();
  ASSERT_EQ(skin.update(steps, 0.5f), StatusCode::Ok);
  EXPECT_EQ(test::allocationCount(), before);
}

}  // namespace
}  // namespace tetskin
