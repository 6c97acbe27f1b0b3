// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Which components have their rigid motion as an unknown, and its position. Its products with dense matrices are in
// test_system_solve.cpp.
#include <tetskin/solver/src/forces/node_vectors.h>
#include <tetskin/solver/src/rows/solver_bodies.h>
#include <tetskin/solver/src/system/component_unknown.h>

#include "deformable_test.h"

namespace tetskin::test {

using namespace bullet_detail;

namespace {

/// A body in the middle of a step: two copies of `cage`, by default of a block, that share no node.
class TwoBlocks {
 public:
  explicit TwoBlocks(double modulus, int pinned = -1, const TetMesh& cage = smallCageAbove(0)) {
    SoftBodyOptions options;
    options.youngsModulus = modulus;
    body = added(world, twoComponents(cage), options);
    if (pinned >= 0) (void)body->setPinned(pinned);
    btAlignedObjectArray<btSoftBody*> all, awake;
    all.push_back(&body->body());
    bodies.collect(all, false, awake);
    bodies.assign(*world.bodySolver().getLagrangianForceArray());
    readNodes(body->body(), dynamics());
    dynamics().predict({1.0 / 240.0}, nullptr);
    dynamics().matrix().free();
    dynamics().findResidual(nullptr);
  }
  Dynamics& dynamics() { return *bodies.bodies()[0].dynamics; }
  int last() const { return body->body().m_nodes.size() - 1; }
  std::vector<ComponentUnknown> unknowns(std::size_t most = 99) {
    return ComponentUnknown::makeAll(dynamics(), most, nullptr);
  }
  static CarriedPoint at(int node) {
    CarriedPoint point;
    point.add(node, 1);
    return point;
  }

  TetskinWorld world;
  std::unique_ptr<DeformableBody> body;
  SolverBodies bodies;
};

TEST(ComponentUnknown, IsOneForEachComponentAndMovesItsOwnNodesAlone) {
  TwoBlocks blocks(1e4);
  const std::vector<ComponentUnknown> unknowns = blocks.unknowns();
  ASSERT_EQ(unknowns.size(), 2u);
  for (const int node : {0, blocks.last()}) {
    for (const ComponentUnknown& unknown : unknowns) {
      const bool own = blocks.dynamics().componentOf(static_cast<std::size_t>(node)) == unknown.component;
      const RowMotions motions = unknown.motionsAt(blocks.dynamics(), TwoBlocks::at(node));
      EXPECT_NE(isZero(motions), own) << node;
      const Small3x3 translations = smallFrom<3, 3>(motions.values);
      for (int k = 0; k < 3; ++k) {
        Small3 expected;
        if (own) expected[k] = 1.0;
        EXPECT_LT(norm(translations.column(k) - expected), 1e-6);
      }
    }
  }
  double masses = 0.0;
  for (const ComponentUnknown& unknown : unknowns) masses += unknown.mass(0, 0);
  EXPECT_NEAR(masses, 1.0, 1e-4) << "the body has one kilogram";
}

TEST(ComponentUnknown, IsNoneOfAComponentThatIsPinnedOrBeyondTheMost) {
  EXPECT_EQ(TwoBlocks(1e4).unknowns(1).size(), 1u);
  TwoBlocks pinned(1e4, 3);
  const std::vector<ComponentUnknown> unknowns = pinned.unknowns();
  ASSERT_EQ(unknowns.size(), 1u);
  EXPECT_NE(unknowns[0].component, pinned.dynamics().componentOf(3));
}

/// Nodes of many components share chunks of the wide layout.
TEST(ComponentUnknown, ReadsItsOwnPartOfTheBodyAlone) {
  TwoBlocks blocks(1e4, -1, twoComponents(twoComponents(twoComponents(smallCageAbove(0)))));
  const auto& matrix = blocks.dynamics().matrix();
  const std::vector<ComponentUnknown> unknowns = blocks.unknowns();
  ASSERT_EQ(unknowns.size(), 16u);
  AlignedVector<btScalar> wide(matrix.wideSize());
  for (std::size_t i = 0; i < wide.size(); ++i) wide[i] = static_cast<btScalar>(i % 7);
  std::size_t read = 0;
  for (const ComponentUnknown& unknown : unknowns) {
    for (const ComponentUnknown::Span& span : unknown.spans()) read += std::max<std::size_t>(span.last - span.first, 3);
    Small6 expected;
    AlignedVector<btScalar> added(wide.size(), btScalar(0)), moved(wide.size(), btScalar(0));
    for (std::size_t n = 0; n < blocks.dynamics().nodeCount(); ++n) {
      if (blocks.dynamics().componentOf(n) != unknown.component) continue;
      const std::size_t at = matrix.wideOf(n);
      for (std::size_t k = 0; k < 6; ++k) {
        const btVector3 image = fromWide(&unknown.fields().images[k][at]);
        expected[static_cast<int>(k)] += static_cast<double>(image.dot(fromWide(&wide[at])));
        toWide(fromWide(&added[at]) + image, &added[at]);
      }
    }
    EXPECT_LT(norm(unknown.imageProducts(wide.data()) - expected), 1e-5 * norm(expected));
    unknown.addImages({{1, 1, 1, 1, 1, 1}}, moved.data());
    for (std::size_t i = 0; i < wide.size(); ++i) ASSERT_NEAR(moved[i], added[i], 1e-6) << i;
  }
  EXPECT_LE(read, matrix.wideSize()) << "sixteen components take as long as one";
}

/// In float, rounding of the stiffness would hide the masses: the images of motions are then these alone.
TEST(ComponentUnknown, OfAVeryStiffBodyHasTheMassesOfItsNodes) {
  for (const double modulus : {1e4, 1e10}) {
    TwoBlocks blocks(modulus);
    const ComponentUnknown unknown = blocks.unknowns().front();
    const auto& matrix = blocks.dynamics().matrix();
    double off = 0.0, all = 0.0;
    for (std::size_t n = 0; n < blocks.dynamics().nodeCount(); ++n) {
      if (blocks.dynamics().componentOf(n) != unknown.component) continue;
      const std::size_t at = matrix.wideOf(n);
      const btVector3 image = fromWide(&unknown.fields().images[0][at]),
                      exact = matrix.mass(n) * fromWide(&unknown.fields().motions[0][at]);
      off += static_cast<double>((image - exact).length2());
      all += static_cast<double>(exact.length2());
    }
    EXPECT_LE(off, 1e-4 * all) << modulus;
    EXPECT_NEAR(unknown.mass(0, 0), 0.5, 0.01) << modulus;
  }
}

}  // namespace
}  // namespace tetskin::test
