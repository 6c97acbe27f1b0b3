// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// A DeformableBody that is changed while it exists, and which settings of its world it changes.
#include "deformable_test.h"

namespace tetskin::test {
namespace {

/// A beam in the air, pinned at one end.
std::unique_ptr<DeformableBody> pinnedBeam(EmptyWorld& world, ForceModel model, double youngsModulus) {
  TetMesh beam = lifted(test::latticeCage(8, 2, 2, 0.25), 20);
  SoftBodyOptions options;
  options.pinned = [](const Eigen::Vector3d& p) { return p.x() < 0.1; };
  options.forceModel = model;
  options.youngsModulus = youngsModulus;
  options.stiffnessDamping = 0.05;
  return added(world, beam, options);
}

class Models : public testing::TestWithParam<ForceModel> {};
INSTANTIATE_TEST_SUITE_P(DeformableBody, Models, testing::Values(ForceModel::NeoHookean, ForceModel::LinearElasticity));

TEST_P(Models, ANewStiffnessBendsAsIfItHadBeenThereFromTheStart) {
  EmptyWorld world, other;
  const auto changed = pinnedBeam(world, GetParam(), 900);
  const auto stiff = pinnedBeam(other, GetParam(), 6000);
  step(world, 60);
  step(other, 240);
  ASSERT_LT(lowest(changed->body()), lowest(stiff->body()) - 0.2);
  ASSERT_TRUE(changed->setYoungsModulus(6000).ok());
  EXPECT_EQ(changed->youngsModulus(), 6000);
  step(world, 240);
  EXPECT_NEAR(lowest(changed->body()), lowest(stiff->body()), 0.05);
}

TEST_P(Models, MoreDampingStopsASwingSooner) {
  const auto speedAfterASecond = [](double damping) {
    EmptyWorld world;
    const auto body = pinnedBeam(world, GetParam(), 6000);
    EXPECT_TRUE(body->setStiffnessDamping(damping).ok());
    step(world, 60);
    return rmsSpeed(body->body());
  };
  EXPECT_LT(speedAfterASecond(0.3), 0.3 * speedAfterASecond(0.005));
}

TEST_P(Models, PoissonsRatioDecidesHowMuchVolumeACompressionTakes) {
  const auto relativeVolume = [](double ratio) {
    EmptyWorld world;
    SoftBodyOptions options;
    options.forceModel = GetParam();
    options.youngsModulus = 60;
    const auto body = added(world, test::smallCageAbove(0.05), options);
    const btScalar before = body->body().getVolume();
    EXPECT_TRUE(body->setPoissonRatio(ratio).ok());
    EXPECT_EQ(body->poissonRatio(), ratio);
    step(world, 180);
    return static_cast<double>(body->body().getVolume() / before);
  };
  EXPECT_LT(relativeVolume(0.05), relativeVolume(0.45) - 0.01);
}

TEST(DeformableBody, RefusesAMaterialThatMakesNoSenseAndKeepsItsOwn) {
  TetskinWorld world;
  const auto body = added(world, cageAbove(1));
  const double stiffness = body->youngsModulus();
  for (const double bad : {0.0, -1.0, 1e18, 1e30, HUGE_VAL, std::nan("")}) {
    const Status status = body->setYoungsModulus(bad);
    EXPECT_EQ(status.code, StatusCode::InvalidOption) << bad;
    EXPECT_FALSE(status.message.empty()) << bad;
  }
  EXPECT_NE(body->setYoungsModulus(1e30).message.find("1e+30"), std::string::npos) << "it names the number";
  for (const double bad : {-0.1, 0.5, std::nan("")}) {
    EXPECT_EQ(body->setPoissonRatio(bad).code, StatusCode::InvalidOption) << bad;
  }
  for (const double bad : {-0.1, 1e12, HUGE_VAL, std::nan("")}) {
    EXPECT_EQ(body->setStiffnessDamping(bad).code, StatusCode::InvalidOption) << bad;
  }
  if (sizeof(btScalar) == sizeof(float)) {
    EXPECT_EQ(body->setYoungsModulus(1e39).code, StatusCode::InvalidOption);  // infinite as a float
  }
  for (const btVector3& bad : {btVector3(0, btScalar(1e30), 0), btVector3(btScalar(std::nan("")), 0, 0)}) {
    EXPECT_EQ(body->setGravity(bad).code, StatusCode::InvalidOption);
  }
  EXPECT_EQ(body->youngsModulus(), stiffness);
  EXPECT_EQ(body->poissonRatio(), 0.3);
  EXPECT_EQ(body->stiffnessDamping(), 0.02);
}

/// Gravity for Bullet's forces in Bullet's solver, and for the library's forces in its own solver.
class Gravity : public testing::TestWithParam<ForceModel> {};
INSTANTIATE_TEST_SUITE_P(DeformableBody, Gravity, testing::Values(ForceModel::NeoHookean, ForceModel::Corotated));

TEST_P(Gravity, FollowsTheWorldsUnlessSet) {
  const auto made = test::worldFor(GetParam());
  EmptyWorld& world = *made;
  SoftBodyOptions options;
  options.forceModel = GetParam();
  const auto body = added(world, cageAbove(20), options);
  const auto acceleration = [&] {
    const btScalar before = body->body().m_nodes[0].m_v.y();
    step(world, 6);
    return static_cast<double>(body->body().m_nodes[0].m_v.y() - before) * 10.0;
  };
  EXPECT_NEAR(acceleration(), -10.0, 0.1);
  world.world->setGravity(btVector3(0, -2, 0));
  EXPECT_NEAR(acceleration(), -2.0, 0.1);
  EXPECT_TRUE(body->setGravity(btVector3(0, 5, 0)).ok());
  EXPECT_NEAR(acceleration(), 5.0, 0.1);
  world.world->setGravity(btVector3(0, -9, 0));
  EXPECT_NEAR(acceleration(), 5.0, 0.1);
  body->followWorldGravity();
  EXPECT_NEAR(acceleration(), -9.0, 0.1);
}

TEST(DeformableBody, NodesArePinnedAndLetGoWhileItMoves) {
  TetskinWorld world;
  const auto body = added(world, test::smallCageAbove(2));
  step(world, 10);
  const btVector3 where = body->body().m_nodes[0].m_x;
  const btScalar mass = body->body().getMass(0);
  ASSERT_TRUE(body->setPinned(0).ok());
  ASSERT_TRUE(body->setPinned(0).ok());
  EXPECT_TRUE(body->isPinned(0));
  step(world, 60);
  EXPECT_LT((body->body().m_nodes[0].m_x - where).length(), 1e-5);
  EXPECT_GT(lowest(body->body()), 0.3);  // the body hangs from the pinned node
  ASSERT_TRUE(body->setPinned(0, false).ok());
  EXPECT_FALSE(body->isPinned(0));
  EXPECT_EQ(body->body().getMass(0), mass);
  step(world, 180);
  EXPECT_LT(lowest(body->body()), 0.1);
  EXPECT_EQ(body->setPinned(-1).code, StatusCode::IndexOutOfRange);
  EXPECT_EQ(body->setPinned(body->body().m_nodes.size(), false).code, StatusCode::IndexOutOfRange);
}

TEST(DeformableBody, LetsGoOfNodesThatWerePinnedFromTheStart) {
  TetskinWorld world;
  SoftBodyOptions options;
  options.pinned = [](const Eigen::Vector3d&) { return true; };
  options.mass = 3.0;
  const auto body = added(world, test::twoComponents(cageAbove(0.3)), options);
  step(world, 10);
  for (int n = 0; n < body->body().m_nodes.size(); ++n) ASSERT_TRUE(body->setPinned(n, false).ok());
  EXPECT_NEAR(body->body().getTotalMass(), 3.0, 1e-4);
  step(world, 60);
  EXPECT_LT(lowest(body->body()), 0.15);
}

TEST(DeformableBody, LeadsOnlyPinnedNodesToFinitePositions) {
  TetskinWorld world;
  const auto body = added(world, test::smallCageAbove(2));
  const btVector3 start = body->body().m_nodes[0].m_x, target = start + btVector3(btScalar(0.25), 0, 0);
  EXPECT_EQ(body->setPinnedPosition(0, target).code, StatusCode::InvalidOption) << "it is free";
  ASSERT_TRUE(body->setPinned(0).ok());
  EXPECT_EQ(body->setPinnedPosition(0, btVector3(0, NAN, 0)).code, StatusCode::NonFinite);
  EXPECT_EQ(body->setPinnedPosition(-1, target).code, StatusCode::IndexOutOfRange);
  EXPECT_EQ(body->body().m_nodes[0].m_x, start);
  body->body().setActivationState(ISLAND_SLEEPING);
  ASSERT_TRUE(body->setPinnedPosition(0, target).ok());
  EXPECT_TRUE(body->body().isActive());
  step(world, 30);
  EXPECT_LT((body->body().m_nodes[0].m_x - target).length(), 1e-6);
}

TEST(DeformableBody, TakesTheMassesThatTheFreeFunctionsSet) {
  TetskinWorld world;
  const auto body = added(world, test::smallCageAbove(2));
  step(world, 2);
  setTotalMass(body->body(), 6);
  setMass(body->body(), 3, btScalar(0.5));
  ASSERT_TRUE(body->setPinned(3).ok());
  step(world, 2);
  ASSERT_TRUE(body->setPinned(3, false).ok());
  EXPECT_NEAR(body->body().getMass(3), 0.5, 1e-6);
  setMass(body->body(), 0, 0);
  body->body().m_nodes[0].m_v.setZero();
  const btVector3 where = body->body().m_nodes[0].m_x;
  step(world, 30);
  EXPECT_LT((body->body().m_nodes[0].m_x - where).length(), 1e-5) << "pinned by its mass";
  EXPECT_LT(lowest(body->body()), where.y());
}

/// Options of a body with Bullet's neo-Hookean force.
SoftBodyOptions neoHookean() {
  SoftBodyOptions options;
  options.forceModel = ForceModel::NeoHookean;
  return options;
}

/// The settings of the world's solver in the last substep.
struct Told : btDeformableBodySolver {
  static bool implicit(const btSoftBodySolver& solver) {
    return static_cast<const btDeformableBodySolver&>(solver).*(&Told::m_implicit);
  }
  static bool lineSearch(const btSoftBodySolver& solver) {
    return static_cast<const btDeformableBodySolver&>(solver).*(&Told::m_lineSearch);
  }
  static bool projection(const btSoftBodySolver& solver) {
    return static_cast<const btDeformableBodySolver&>(solver).m_useProjection;
  }
};

TEST(DeformableBody, LeavesAnImplicitWorldImplicit) {
  EmptyWorld world;
  world.deformable().setImplicit(true);
  world.deformable().setLineSearch(true);
  world.deformable().setUseProjection(false);
  const auto body = added(world, cageAbove(5), neoHookean());
  step(world, 1);
  EXPECT_TRUE(Told::implicit(*world.softSolver));
  EXPECT_TRUE(Told::lineSearch(*world.softSolver));
  EXPECT_TRUE(Told::projection(*world.softSolver));  // without projection, bodies do not land
}

TEST(DeformableBody, MakesTheWorldWhatIsAskedFor) {
  EmptyWorld world;
  world.deformable().setLineSearch(true);
  for (const bool implicit : {true, false}) {
    SoftBodyOptions options = neoHookean();
    options.implicit = implicit;
    const auto body = added(world, cageAbove(5), options);
    step(world, 1);
    EXPECT_EQ(Told::implicit(*world.softSolver), implicit);
    EXPECT_FALSE(Told::lineSearch(*world.softSolver));
  }
}

TEST(DeformableBody, SetsNothingOfAWorldThatItMustNotConfigure) {
  EmptyWorld world;
  world.deformable().setUseProjection(false);
  world.deformable().setImplicit(true);
  world.deformable().setLineSearch(true);
  world.deformable().getWorldInfo().m_gravity.setValue(1, 2, 3);
  SoftBodyOptions options = neoHookean();
  options.configureWorld = false;
  options.implicit = false;
  const auto body = added(world, cageAbove(5), options);
  step(world, 1);
  EXPECT_FALSE(Told::projection(*world.softSolver));
  EXPECT_TRUE(Told::implicit(*world.softSolver));
  EXPECT_TRUE(Told::lineSearch(*world.softSolver));
  EXPECT_EQ(world.deformable().getWorldInfo().m_gravity, btVector3(1, 2, 3));
}

}  // namespace
}  // namespace tetskin::test
