// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "deformable_test.h"
#include "support/odd_meshes.h"

#include <tetskin/bullet/soft_body_skin.h>
#include <tetskin/core/src/base/mesh/tet_geometry.h>

#include <limits>

namespace tetskin::test {
namespace {

TEST(DeformableBody, EveryBodyKeepsItsOwnStiffness) {
  // Bullet's addForce would give the second body the stiffness of the first.
  TetskinWorld world;
  const Box3 left(Eigen::Vector3d(-0.1, 0, -9), Eigen::Vector3d(0.1, 9, 9));
  SoftBodyOptions stiff, limp;
  stiff.pinned = limp.pinned = pinnedIn(left);
  stiff.youngsModulus = 20000;
  limp.youngsModulus = 600;
  TetMesh beam = lifted(test::latticeCage(8, 2, 2, 0.25), 5.0);
  TetMesh aside = beam;
  for (Eigen::Vector3d& p : aside.nodes) p.z() += 3.0;
  const auto stiffBody = added(world, beam, stiff);
  const auto limpBody = added(world, aside, limp);
  EXPECT_EQ(stiffBody->youngsModulus(), 20000);
  step(world, 60);
  EXPECT_LT(lowest(limpBody->body()), lowest(stiffBody->body()) - 0.3);
}

TEST(DeformableBody, LeavesTheWorldWithItsForces) {
  TetskinWorld world;
  {
    const auto first = added(world, cageAbove(0.5));
    const auto second = added(world, cageAbove(3.0));
    EXPECT_EQ(world.deformable().getSoftBodyArray().size(), 2);
    step(world, 2);
  }
  EXPECT_EQ(world.deformable().getSoftBodyArray().size(), 0);
  auto* solver = static_cast<btDeformableBodySolver*>(world.softSolver.get());
  EXPECT_EQ(solver->getLagrangianForceArray()->size(), 0);
  step(world, 2);  // no pointers dangle
}

TEST(DeformableBody, LeavesItsBodyToAnotherWorldThatItWasMovedTo) {
  TetskinWorld first, second;
  auto body = added(first, test::smallCageAbove(3));
  btSoftBody& moved = body->body();
  first.deformable().removeSoftBody(&moved);
  moved.m_worldInfo = &second.deformable().getWorldInfo();
  second.deformable().addSoftBody(&moved);
  EXPECT_EQ(body->solverPath(), SolverPath::None);
  body.reset();
  step(first, 1);
  step(second, 1);
  EXPECT_EQ(second.deformable().getSoftBodyArray().size(), 1);
  EXPECT_FALSE(std::isnan(lowest(moved)));
  second.deformable().removeSoftBody(&moved);
  delete &moved;
}

TEST(DeformableBody, SaysThatNoForceActsOnceItWasTakenOutOfItsWorld) {
  for (const ForceModel model : {ForceModel::NeoHookean, ForceModel::Corotated}) {
    const auto world = test::worldFor(model);
    SoftBodyOptions options;
    options.forceModel = model;
    const auto body = added(*world, test::smallCageAbove(3), options);
    EXPECT_NE(body->solverPath(), SolverPath::None);
    world->deformable().removeSoftBody(&body->body());
    EXPECT_EQ(body->solverPath(), SolverPath::None);
    world->deformable().addSoftBody(&body->body());
    EXPECT_EQ(body->solverPath(), SolverPath::None);
  }
}

/// As plugin/docs/troubleshooting.md says.
TEST(DeformableBody, ThatIsNoMoreFiniteIsReplacedByOneThatIsAddedAgain) {
  TetskinWorld world;
  const TetMesh cage = test::smallCageAbove(1);
  TetMesh aside = cage;
  for (Eigen::Vector3d& p : aside.nodes) p.x() += 5;
  const auto healthy = added(world, aside);
  auto body = added(world, cage);
  SoftBodySkin skin;
  ASSERT_TRUE(skin.bind(body->body(), cage, test::sphere(8, 0.2, Eigen::Vector3d(0.3, 1.3, 0.4))).ok());
  const auto binding = skin.binding();
  step(world, 1);
  body->body().m_nodes[3].m_v.setX(std::numeric_limits<btScalar>::quiet_NaN());
  step(world, 1);
  EXPECT_EQ(skin.update(), StatusCode::NonFinite);
  body.reset();
  body = added(world, cage);
  ASSERT_TRUE(skin.bind(body->body(), binding).ok());
  step(world, 60);
  EXPECT_EQ(skin.update(), StatusCode::Ok);
  for (const btSoftBody* solved : {&body->body(), &healthy->body()}) {
    EXPECT_GT(lowest(*solved), -0.05);
    EXPECT_LT(lowest(*solved), 0.5);
  }
}

TEST(DeformableBody, OfAnySizeWeighsWhatItsVolumeDoesAndIsAsStiffForItsSize) {
  TetskinWorld world;
  for (const double size : {0.1, 1.0, 10.0}) {
    const auto body = DeformableBody::add(world.deformable(), test::latticeCage(3, 3, 3, size / 3.0)).value();
    const double volume = size * size * size;
    EXPECT_NEAR(static_cast<double>(body->body().getTotalMass()), 100.0 * volume, volume);
    EXPECT_NEAR(body->youngsModulus(), 50.0 * 100.0 * 10.0 * size, size);
    EXPECT_NEAR(body->relativeStiffness(), 50.0, 0.01);
    ASSERT_TRUE(body->setYoungsModulus(500.0 * size).ok());
    EXPECT_NEAR(body->relativeStiffness(), 0.5, 1e-3);
  }
}

TEST(DeformableBody, DefaultStiffnessIsBoundedByTheTimeStepForFineCages) {
  EmptyWorld world;
  const auto stiffness = [&](int cells, double timeStep) {
    SoftBodyOptions options;
    options.timeStep = timeStep;
    options.forceModel = ForceModel::NeoHookean;
    return added(world, test::latticeCage(cells, cells, cells, 1.0 / cells), options)->youngsModulus();
  };
  const double wanted = 50.0 * 1.0 * 10.0 * 1.0;  // relative stiffness x density x gravity x size
  EXPECT_NEAR(stiffness(3, 1.0 / 240), wanted, 1e-3 * wanted);
  EXPECT_LT(stiffness(16, 1.0 / 240), 0.5 * wanted);
  EXPECT_NEAR(stiffness(16, 1.0 / 300) / stiffness(16, 1.0 / 240), 1.5625, 1e-6);
}

TEST(DeformableBody, FineCageOfThinPartsBearsItsLanding) {
  // This table on four thin legs is so fine that a stiffness chosen by size alone would explode on impact.
  TetMesh cage = test::latticeCage(16, 8, 16, 1.0 / 16);
  const auto kept = [](const Eigen::Vector3d& c) {
    const bool leg = (c.x() < 0.13 || c.x() > 0.87) && (c.z() < 0.13 || c.z() > 0.87);
    return leg || c.y() > 0.37;
  };
  TetMesh table;
  std::vector<int> index(cage.nodeCount(), -1);
  for (Tet tet : cage.tets) {
    const TetCorners p = cornersOf(cage, tet);
    if (!kept((p[0] + p[1] + p[2] + p[3]) / 4.0)) continue;
    for (int& n : tet) {
      if (index[n] < 0) {
        index[n] = static_cast<int>(table.nodeCount());
        table.nodes.push_back(cage.nodes[n] + Eigen::Vector3d(0, 0.4, 0));
      }
      n = index[n];
    }
    table.tets.push_back(tet);
  }
  EmptyWorld world;
  SoftBodyOptions options;
  options.forceModel = ForceModel::NeoHookean;
  const auto body = added(world, table, options);
  step(world, 60);
  EXPECT_LT(rmsSpeed(body->body()), 0.3) << "it fell at 2.8";
  EXPECT_GT(lowest(body->body()), -0.03);
}

TEST(DeformableBody, RefusesMassSpringAndBadOptions) {
  TetskinWorld world;
  const TetMesh cage = smallCageAbove(1);
  const auto refuse = [&](auto&& spoil, StatusCode code = StatusCode::InvalidOption) {
    SoftBodyOptions bad;
    spoil(bad);
    const Status status = DeformableBody::add(world.deformable(), cage, bad).status();
    EXPECT_EQ(status.code, code) << status.message;
    EXPECT_FALSE(status.message.empty());
  };
  refuse([](SoftBodyOptions& o) { o.forceModel = ForceModel::MassSpring; });
  refuse([](SoftBodyOptions& o) { o.poissonRatio = 0.5; });
  refuse([](SoftBodyOptions& o) { o.youngsModulus = 1e25; });
  for (const double bad : {std::nan(""), -0.1, 1.001, HUGE_VAL}) {
    refuse([&](SoftBodyOptions& o) { o.friction = bad; });
    refuse([&](SoftBodyOptions& o) { o.solverTolerance = bad; });
  }
  refuse([](SoftBodyOptions& o) { o.youngsModulus = HUGE_VAL; });
  refuse([](SoftBodyOptions& o) { o.stiffnessDamping = HUGE_VAL; });
  refuse([](SoftBodyOptions& o) { o.maxIterations = 0; });
  refuse([](SoftBodyOptions& o) { o.stiffnessScale = {1.0}; }, StatusCode::SizeMismatch);
  refuse([](SoftBodyOptions& o) { o.nodeMasses = {1.0}; }, StatusCode::SizeMismatch);
  for (const double bad : {std::nan(""), 0.0, -1.0, HUGE_VAL}) {
    refuse([&](SoftBodyOptions& o) { o.stiffnessScale.assign(cage.tetCount(), bad); });
    refuse([&](SoftBodyOptions& o) { o.nodeMasses.assign(cage.nodeCount(), bad); });
  }
  EXPECT_EQ(DeformableBody::add(world.deformable(), {}).status().code, StatusCode::Empty);
  world.deformable().setGravity(btVector3(0, std::numeric_limits<btScalar>::quiet_NaN(), 0));
  EXPECT_EQ(DeformableBody::add(world.deformable(), cage).status().code, StatusCode::InvalidOption);
  EXPECT_EQ(world.deformable().getSoftBodyArray().size(), 0);
}

}  // namespace
}  // namespace tetskin::test
