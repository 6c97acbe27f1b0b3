// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Frames that are drawn between two steps.
#include "skin_test.h"
#include "support/allocation_count.h"

#include <limits>

namespace tetskin::test {
namespace {

/// Largest deviation of a surface from the one that is the fraction `alpha` of the way between two others.
double distance(const Surface& surface, const Surface& before, const Surface& after, double alpha) {
  double largest = surface.size() == before.size() ? 0.0 : 1e9;
  for (std::size_t i = 0; i < surface.size() && i < before.size(); ++i) {
    const double expected = (1.0 - alpha) * double(before[i]) + alpha * double(after[i]);
    largest = std::max(largest, std::abs(double(surface[i]) - expected));
  }
  return largest;
}

class FramesBetweenSteps : public test::SkinTest {
 protected:
  /// Records the body at rest and then bent, each as after a step.
  void bindAndKeepTwo(const SkinOptions& options = {}) {
    ASSERT_TRUE(skin.bind(*body, cage, mesh, options).ok());
    rest = surfaceOf(skin);
    skin.recordStep();
    bend();
    ASSERT_EQ(skin.update(), StatusCode::Ok);
    bent = surfaceOf(skin);
    skin.recordStep();
  }
  void moveUp() { body->translate(btVector3(0, 1, 0)); }
  Surface at(btScalar alpha) {
    EXPECT_EQ(skin.update(alpha), StatusCode::Ok);
    return surfaceOf(skin);
  }
  /// Checks that every update shows the body's current state.
  void expectNothingBetween() {
    SoftBodySkin now;
    ASSERT_TRUE(now.bind(*body, skin.binding()).ok());
    for (const btScalar alpha : {btScalar(0.0), btScalar(0.5)}) {
      (void)skin.update(alpha);
      EXPECT_EQ(surfaceOf(skin), surfaceOf(now));
    }
  }

  Surface rest, bent;
};

TEST_F(FramesBetweenSteps, AreSkinsOfTheNodesBetweenThem) {
  bindAndKeepTwo();
  for (const btScalar alpha : {btScalar(0.5), btScalar(0.125), btScalar(0.9), btScalar(0.0)}) {
    EXPECT_LT(distance(at(alpha), rest, bent, double(alpha)), kRounding);
  }
  EXPECT_EQ(at(0), rest);
  skin.recordStep();  // a step in which nothing moved
  for (const btScalar alpha : {btScalar(0.0), btScalar(0.5)}) EXPECT_EQ(at(alpha), bent);
}

TEST_F(FramesBetweenSteps, AreToldNodeByNode) {
  EXPECT_EQ(skin.body(), nullptr);
  EXPECT_EQ(skin.interpolation(), Interpolation::Linear);
  SkinOptions quadratic;
  quadratic.interpolation = Interpolation::Quadratic;
  const btVector3 before = body->m_nodes[3].m_x;
  bindAndKeepTwo(quadratic);
  EXPECT_EQ(skin.body(), body.get());
  EXPECT_EQ(skin.interpolation(), Interpolation::Quadratic);
  const btVector3 now = body->m_nodes[3].m_x;
  EXPECT_EQ(skin.nodeAt(3, 0), before);
  EXPECT_LT((skin.nodeAt(3, btScalar(0.5)) - (before + now) / 2).length(), kRounding);
  EXPECT_EQ(skin.nodeAt(3), now);
  InstanceOptions plain;
  plain.disableQuadratic = true;
  ASSERT_TRUE(skin.bind(*body, skin.binding(), plain).ok());
  EXPECT_EQ(skin.interpolation(), Interpolation::Linear);
  EXPECT_EQ(skin.nodeAt(3, 0), now);
}

TEST_F(FramesBetweenSteps, CostTwoCopiesOfTheNodesAndOnlyIfStepsAreKept) {
  const std::size_t bound = test::allocatedBytes();
  ASSERT_TRUE(skin.bind(*body, cage, mesh).ok());
  const std::size_t count = test::allocationCount();
  bend();
  skin.markTeleported();
  (void)skin.update(btScalar(0.5));
  EXPECT_EQ(test::allocationCount(), count) << "no step is kept";
  const std::size_t before = test::allocatedBytes();
  skin.recordStep();
  EXPECT_EQ(test::allocatedBytes() - before, 6 * sizeof(btScalar) * cage.nodeCount());
  const std::size_t kept = test::allocationCount();
  moveUp();
  skin.recordStep();
  (void)skin.update(btScalar(0.5));
  skin.markTeleported();
  EXPECT_EQ(test::allocationCount(), kept);
  skin = SoftBodySkin();
  EXPECT_EQ(test::allocatedBytes(), bound);
}

TEST_F(FramesBetweenSteps, WithoutAStepKeptOrWithOneShowTheBodyAsItIs) {
  skin.recordStep();
  skin.markTeleported();  // there is nothing to do while unbound
  ASSERT_TRUE(skin.bind(*body, cage, mesh).ok());
  bend();
  expectNothingBetween();
  skin.recordStep();
  expectNothingBetween();
}

TEST_F(FramesBetweenSteps, DoNotShowATeleportedBodyOnItsWay) {
  bindAndKeepTwo();
  body->translate(btVector3(0, 100, 0));
  skin.markTeleported();
  expectNothingBetween();
  const Surface there = at(1);
  moveUp();
  skin.recordStep();
  const Surface next = at(1);
  EXPECT_LT(distance(at(btScalar(0.5)), there, next, 0.5), 100 * kRounding);  // and it continues from there
  body->translate(btVector3(0, 100, 0));
  skin.recordStep();
  skin.markTeleported();  // called after the step
  expectNothingBetween();
  body->setActivationState(ISLAND_SLEEPING);
  skin.recordStep();
  skin.recordStep();
  EXPECT_EQ(skin.update(btScalar(0.5)), StatusCode::Ok);
  EXPECT_EQ(skin.update(btScalar(0.5)), StatusCode::Asleep);
  body->translate(btVector3(0, 100, 0));
  skin.markTeleported();
  EXPECT_EQ(skin.update(btScalar(0.5)), StatusCode::Ok);
  EXPECT_EQ(skin.update(btScalar(0.5)), StatusCode::Asleep);
}

TEST_F(FramesBetweenSteps, ReachTheLastStepOfABodyThatFallsAsleepAndThenCostNothing) {
  bindAndKeepTwo();
  const Surface before = at(1);
  moveUp();
  body->setActivationState(ISLAND_SLEEPING);  // the body falls asleep in this step
  skin.recordStep();
  bent = at(1);
  for (const btScalar alpha : {btScalar(0.75), btScalar(0.25), btScalar(0.25)}) {
    EXPECT_LT(distance(at(alpha), before, bent, double(alpha)), kRounding);
  }
  skin.recordStep();
  EXPECT_EQ(at(btScalar(0.1)), bent);
  for (const btScalar alpha : {btScalar(0.1), btScalar(0.9), btScalar(1)}) {
    EXPECT_EQ(skin.update(alpha), StatusCode::Asleep);
    skin.recordStep();
  }
  EXPECT_EQ(surfaceOf(skin), bent);
}

TEST_F(FramesBetweenSteps, DoNotComeFromWhereABodyFellAsleepWhenItWakes) {
  bindAndKeepTwo();
  body->setActivationState(ISLAND_SLEEPING);
  skin.recordStep();
  skin.recordStep();
  body->forceActivationState(ACTIVE_TAG);
  moveUp();
  skin.recordStep();
  expectNothingBetween();
  const Surface awake = at(1);
  moveUp();
  skin.recordStep();
  const Surface next = at(1);
  EXPECT_LT(distance(at(btScalar(0.5)), awake, next, 0.5), 4 * kRounding);
}

TEST_F(FramesBetweenSteps, BeginAnewWithAnotherBindingAndForAnotherNumberOfNodes) {
  bindAndKeepTwo();
  const TetMesh small = test::latticeCage(2, 2, 2, 0.5);
  const std::unique_ptr<btSoftBody> other(createSoftBody(small, info).value());
  ASSERT_TRUE(skin.bind(*other, small, mesh).ok());
  other->translate(btVector3(0, 1, 0));
  const btScalar height = surfaceOf(skin)[1];
  EXPECT_NEAR(double(at(btScalar(0.5))[1] - height), 1.0, 4 * kRounding);
  skin.recordStep();
  EXPECT_NEAR(double(at(btScalar(0.5))[1] - height), 1.0, 4 * kRounding);
  other->translate(btVector3(0, 1, 0));
  skin.recordStep();
  EXPECT_NEAR(double(at(btScalar(0.5))[1] - height), 1.5, 4 * kRounding);
  other->appendNode(btVector3(0, 0, 0), 1);
  const Surface good = surfaceOf(skin);
  EXPECT_EQ(skin.update(btScalar(0.2)), StatusCode::TopologyChanged);
  skin.recordStep();
  skin.markTeleported();
  EXPECT_EQ(skin.update(btScalar(0.2)), StatusCode::TopologyChanged);
  EXPECT_EQ(surfaceOf(skin), good);
  other->m_nodes.pop_back();
  EXPECT_NEAR(double(at(btScalar(0.5))[1] - height), 2.0, 4 * kRounding);
  skin.recordStep();
  EXPECT_NEAR(double(at(btScalar(0.5))[1] - height), 2.0, 4 * kRounding);
}

TEST_F(FramesBetweenSteps, KeepTheLastGoodSurfaceWhileNodesAreNotFinite) {
  bindAndKeepTwo();
  const Surface good = at(btScalar(0.5));
  const btScalar x = body->m_nodes[20].m_x.x();
  body->m_nodes[20].m_x.setX(std::numeric_limits<btScalar>::quiet_NaN());
  skin.recordStep();
  for (const btScalar alpha : {btScalar(0), btScalar(0.5), btScalar(1)}) {
    EXPECT_EQ(skin.update(alpha), StatusCode::NonFinite);
    EXPECT_EQ(skin.firstNonFiniteNode(), 20u);
    EXPECT_EQ(surfaceOf(skin), good);
  }
  body->m_nodes[20].m_x.setX(x);
  skin.recordStep();
  expectNothingBetween();
  moveUp();
  skin.recordStep();
  EXPECT_LT(distance(at(0), bent, bent, 0.0), kRounding);
}

TEST_F(FramesBetweenSteps, OfAHiddenSkinAreNotKeptAndBeginWhereItIsShown) {
  bindAndKeepTwo();
  skin.setVisible(false);
  moveUp();
  skin.recordStep();
  EXPECT_EQ(skin.update(btScalar(0.5)), StatusCode::Hidden);
  moveUp();
  skin.setVisible(true);
  const Surface shown = surfaceOf(skin);
  expectNothingBetween();
  moveUp();
  skin.recordStep();
  const Surface next = at(1);
  EXPECT_LT(distance(at(btScalar(0.5)), shown, next, 0.5), 4 * kRounding);
}

TEST_F(FramesBetweenSteps, HaveTheMotionSinceTheFrameBefore) {
  SkinOptions options;
  options.previousPositions = true;
  ASSERT_TRUE(skin.bind(*body, cage, mesh, options).ok());
  const auto motion = [&] { return double(skin.positions()[9][1] - skin.previousPositions()[9][1]); };
  skin.recordStep();
  moveUp();
  skin.recordStep();
  (void)at(btScalar(0.25));
  EXPECT_NEAR(motion(), 0.25, 8 * kRounding);
  (void)at(btScalar(0.75));
  EXPECT_NEAR(motion(), 0.5, 8 * kRounding);
  moveUp();
  skin.recordStep();
  (void)at(btScalar(0.5));
  EXPECT_NEAR(motion(), 0.75, 8 * kRounding);
  body->translate(btVector3(0, 100, 0));
  skin.markTeleported();
  (void)at(btScalar(0.75));
  EXPECT_EQ(motion(), 0.0);
  moveUp();
  skin.recordStep();
  (void)at(btScalar(0.25));
  EXPECT_NEAR(motion(), 0.25, 100 * kRounding);
}

TEST_F(FramesBetweenSteps, AreAMovedSkinsStill) {
  bindAndKeepTwo();
  const Surface half = at(btScalar(0.5));
  SoftBodySkin other = std::move(skin);
  EXPECT_EQ(other.update(btScalar(0.25)), StatusCode::Ok);
  EXPECT_EQ(other.update(btScalar(0.5)), StatusCode::Ok);
  EXPECT_EQ(surfaceOf(other), half);
  skin = SoftBodySkin();
  skin.recordStep();
  EXPECT_EQ(skin.update(btScalar(0.5)), StatusCode::Unbound);
}

TEST_F(FramesBetweenSteps, OfManySkinsAreThoseOfEach) {
  bindAndKeepTwo();
  SoftBodySkin plain;
  ASSERT_TRUE(plain.bind(*body, skin.binding()).ok());
  const Surface half = at(btScalar(0.5));
  (void)at(btScalar(0.75));
  SoftBodySkin* const both[] = {&skin, &plain};
  EXPECT_EQ(SoftBodySkin::updateAll(both, 2, nullptr, btScalar(0.5)), 2u);
  EXPECT_EQ(surfaceOf(skin), half);
  EXPECT_EQ(surfaceOf(plain), bent);
  EXPECT_EQ(SoftBodySkin::updateAll(both, 2), 2u);
  EXPECT_EQ(surfaceOf(skin), bent);
}

}  // namespace
}  // namespace tetskin::test
