// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "skin_test.h"

#include <limits>

namespace tetskin::test {
namespace {

class SkinState : public test::SkinTest {};

TEST_F(SkinState, HiddenSkinIsLeftAloneAndRightAtOnceWhenShown) {
  ASSERT_TRUE(skin.bind(*body, cage, mesh).ok());
  EXPECT_TRUE(skin.visible());
  const Eigen::Vector3d before = at(skin, 17);
  skin.setVisible(false);
  EXPECT_FALSE(skin.visible());
  body->translate(btVector3(2, 0, 0));
  EXPECT_EQ(skin.update(), StatusCode::Hidden);
  EXPECT_EQ(at(skin, 17), before);
  skin.setVisible(true);  // the caller does not call update
  EXPECT_LT((at(skin, 17) - before - Eigen::Vector3d(2, 0, 0)).norm(), 4 * kRounding);
  body->translate(btVector3(0, 3, 0));
  EXPECT_EQ(skin.update(), StatusCode::Ok);
  EXPECT_LT((at(skin, 17) - before - Eigen::Vector3d(2, 3, 0)).norm(), 8 * kRounding);
}

TEST_F(SkinState, SleepingBodyOfNoWorldIsSkippedUntilAnyOfItsNodesMoves) {
  ASSERT_TRUE(skin.bind(*body, cage, mesh).ok());
  body->setActivationState(ISLAND_SLEEPING);
  EXPECT_EQ(skin.update(), StatusCode::Asleep);
  body->translate(btVector3(1, 0, 0));
  EXPECT_EQ(skin.update(), StatusCode::Ok);
  EXPECT_EQ(skin.update(), StatusCode::Asleep);
  for (int n = 0; n < body->m_nodes.size(); ++n) {
    body->m_nodes[n].m_x.setZ(std::nextafter(body->m_nodes[n].m_x.z(), btScalar(100)));
    EXPECT_EQ(skin.update(), StatusCode::Ok) << n;
    EXPECT_EQ(skin.update(), StatusCode::Asleep);
  }
  skin.markMoved();
  EXPECT_EQ(skin.update(), StatusCode::Ok);
}

TEST_F(SkinState, KeepsTheLastGoodSurfaceWhenTheSimulationExplodes) {
  ASSERT_TRUE(skin.bind(*body, cage, mesh).ok());
  const Eigen::Vector3d good = at(skin, 17);
  body->m_nodes[20].m_x.setX(std::numeric_limits<btScalar>::quiet_NaN());
  body->m_nodes[31].m_x.setZ(-std::numeric_limits<btScalar>::infinity());
  EXPECT_EQ(skin.update(), StatusCode::NonFinite);
  EXPECT_EQ(skin.firstNonFiniteNode(), 20u);
  EXPECT_EQ(at(skin, 17), good);
  body->m_nodes[20].m_x = toBullet(cage.nodes[20]);
  EXPECT_EQ(skin.update(), StatusCode::NonFinite);
  EXPECT_EQ(skin.firstNonFiniteNode(), 31u);
  body->m_nodes[31].m_x = toBullet(cage.nodes[31]);
  EXPECT_EQ(skin.update(), StatusCode::Ok);
  EXPECT_EQ(at(skin, 17), good);
}

TEST_F(SkinState, RecoversFromAnExplosionEvenIfTheBodySleepsSince) {
  ASSERT_TRUE(skin.bind(*body, cage, mesh).ok());
  for (int n = 0; n < body->m_nodes.size(); ++n) body->m_nodes[n].m_x.setY(std::numeric_limits<btScalar>::quiet_NaN());
  EXPECT_EQ(skin.update(), StatusCode::NonFinite);
  body->setActivationState(ISLAND_SLEEPING);
  EXPECT_EQ(skin.update(), StatusCode::NonFinite);
  for (int n = 0; n < body->m_nodes.size(); ++n) {
    body->m_nodes[n].m_x = toBullet(cage.nodes[n] + Eigen::Vector3d(0, 5, 0));
  }
  EXPECT_EQ(skin.update(), StatusCode::Ok);
  EXPECT_LT((at(skin, 17) - mesh.positions[17] - Eigen::Vector3d(0, 5, 0)).norm(), 4 * kRounding);
  EXPECT_EQ(skin.update(), StatusCode::Asleep);
}

TEST_F(SkinState, RecoversFromASingleBadNodeOfASleepingBodyAboutTheOrigin) {
  // Every node but one is where it was, and their mean is 0.
  for (Eigen::Vector3d& p : cage.nodes) p -= Eigen::Vector3d::Constant(0.5);
  for (Eigen::Vector3d& p : mesh.positions) p -= Eigen::Vector3d::Constant(0.5);
  body = createSoftBody(cage, info).value();
  ASSERT_TRUE(skin.bind(*body, cage, mesh).ok());
  body->m_nodes[31].m_x.setX(std::numeric_limits<btScalar>::quiet_NaN());
  EXPECT_EQ(skin.update(), StatusCode::NonFinite);
  body->setActivationState(ISLAND_SLEEPING);
  body->m_nodes[31].m_x = toBullet(cage.nodes[31]);
  EXPECT_EQ(skin.update(), StatusCode::Ok);
  EXPECT_EQ(skin.update(), StatusCode::Asleep);
}

TEST_F(SkinState, NoticesAppendedNodesAndTets) {
  ASSERT_TRUE(skin.bind(*body, cage, mesh).ok());
  const Eigen::Vector3d good = at(skin, 17);
  body->appendNode(btVector3(0, 0, 0), 1);
  EXPECT_EQ(skin.update(), StatusCode::TopologyChanged);
  EXPECT_EQ(at(skin, 17), good);
  const std::unique_ptr<btSoftBody> other(createSoftBody(cage, info).value());
  ASSERT_TRUE(skin.bind(*other, cage, mesh).ok());
  other->appendTetra(0, 1, 5, 25);
  EXPECT_EQ(skin.update(), StatusCode::TopologyChanged);
  other->setActivationState(ISLAND_SLEEPING);  // added or removed tets are noticed when the body wakes
  EXPECT_EQ(skin.update(), StatusCode::Asleep);
  other->forceActivationState(ACTIVE_TAG);
  EXPECT_EQ(skin.update(), StatusCode::TopologyChanged);
  other->setActivationState(ISLAND_SLEEPING);
  other->appendNode(btVector3(0, 0, 0), 1);
  EXPECT_EQ(skin.update(), StatusCode::TopologyChanged);
}

TEST_F(SkinState, UnboundSkinSaysSo) {
  EXPECT_EQ(skin.update(), StatusCode::Unbound);
  EXPECT_TRUE(skin.positions().empty());
  EXPECT_EQ(skin.binding(), nullptr);
}

TEST_F(SkinState, PreviousPositionsAreThoseOfTheUpdateBefore) {
  SkinOptions options;
  options.previousPositions = true;
  ASSERT_TRUE(skin.bind(*body, cage, mesh, options).ok());
  const auto still = [&] { return skin.previousPositions().data() == skin.positions().data(); };
  const auto motion = [&](std::size_t v) -> double { return skin.positions()[v][1] - skin.previousPositions()[v][1]; };
  EXPECT_TRUE(still());
  body->translate(btVector3(0, 1, 0));
  ASSERT_EQ(skin.update(), StatusCode::Ok);
  EXPECT_NEAR(motion(9), 1.0, 8 * kRounding);
  body->translate(btVector3(0, 2, 0));
  ASSERT_EQ(skin.update(), StatusCode::Ok);
  EXPECT_NEAR(motion(9), 2.0, 8 * kRounding);

  body->setActivationState(ISLAND_SLEEPING);
  ASSERT_EQ(skin.update(), StatusCode::Ok);
  EXPECT_EQ(motion(9), 0.0);
  ASSERT_EQ(skin.update(), StatusCode::Asleep);
  EXPECT_TRUE(still());
  body->setActivationState(ACTIVE_TAG);
  body->translate(btVector3(0, 3, 0));
  ASSERT_EQ(skin.update(), StatusCode::Ok);
  EXPECT_NEAR(motion(9), 3.0, 16 * kRounding);

  skin.setVisible(false);
  body->translate(btVector3(0, 4, 0));
  ASSERT_EQ(skin.update(), StatusCode::Hidden);
  EXPECT_TRUE(still());
  skin.setVisible(true);
  EXPECT_TRUE(still());
  EXPECT_NEAR(static_cast<double>(skin.positions()[9][1]), mesh.positions[9].y() + 10.0, 16 * kRounding);

  const btScalar good = body->m_nodes[20].m_x.x();
  body->translate(btVector3(0, 1, 0));
  ASSERT_EQ(skin.update(), StatusCode::Ok);
  body->m_nodes[20].m_x.setX(std::numeric_limits<btScalar>::quiet_NaN());
  ASSERT_EQ(skin.update(), StatusCode::NonFinite);
  EXPECT_TRUE(still());
  body->m_nodes[20].m_x.setX(good);
  ASSERT_EQ(skin.update(), StatusCode::Ok);
  EXPECT_NEAR(motion(9), 0.0, 16 * kRounding);
}

}  // namespace
}  // namespace tetskin::test
