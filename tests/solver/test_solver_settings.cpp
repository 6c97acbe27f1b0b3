// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The library's own solve: where it is used, its settings, and its reports.
#include "cloth.h"

namespace tetskin::test {
namespace {

using Vector = Eigen::Vector3d;

bool sameBits(const std::vector<btVector3>& a, const std::vector<btVector3>& b) {
  return a.size() == b.size() && std::equal(a.begin(), a.end(), b.begin(), [](const btVector3& p, const btVector3& q) {
           return p.x() == q.x() && p.y() == q.y() && p.z() == q.z();
         });
}

TEST(DeformableSolver, IsWhatBodiesAreSolvedByUnlessTheyAreBullets) {
  TetskinWorld world;
  const auto ours = added(world, smallCageAbove(5));
  SoftBodyOptions options;
  options.forceModel = ForceModel::NeoHookean;
  const auto bullets = added(world, smallCageAbove(10), options);
  EXPECT_EQ(ours->forceModel(), ForceModel::Corotated);
  EXPECT_EQ(ours->solverPath(), SolverPath::Solver);
  EXPECT_EQ(bullets->forceModel(), ForceModel::NeoHookean);
  EXPECT_EQ(bullets->solverPath(), SolverPath::Bullet);
}

/// A world's settings of Bullet's solve.
struct Settings {
  bool implicit, lineSearch, projection;
};

TEST(DeformableSolver, SolvesWhateverTheWorldsSettingsOfBulletsSolveAre) {
  const auto landed = [](const Settings& settings) {
    TetskinWorld world;
    world.deformable().setImplicit(settings.implicit);
    world.deformable().setLineSearch(settings.lineSearch);
    world.deformable().setUseProjection(settings.projection);
    SoftBodyOptions options;
    options.configureWorld = false;
    const auto body = added(world, cageAbove(0.3), options);
    step(world, 60);
    EXPECT_TRUE(world.bodySolver().ownSolveActive());
    EXPECT_LT(lowest(body->body()), 0.1);
    EXPECT_GT(lowest(body->body()), -0.03);
    return nodesOf(body->body());
  };
  const std::vector<btVector3> usual = landed({false, false, true});
  for (const Settings& settings : {Settings{true, false, true}, Settings{false, true, true},
                                   Settings{false, false, false}, Settings{true, true, false}}) {
    EXPECT_TRUE(sameBits(usual, landed(settings)))
        << settings.implicit << " " << settings.lineSearch << " " << settings.projection;
  }
}

TEST(DeformableSolver, LeavesAWorldOfBulletsForcesAloneToBulletsCode) {
  for (const Settings& settings :
       {Settings{true, false, true}, Settings{true, true, true}, Settings{false, false, false}}) {
    TetskinWorld ours;
    EmptyWorld bullets;
    std::vector<btVector3> positions[2];
    for (const int k : {0, 1}) {
      EmptyWorld& world = k == 0 ? static_cast<EmptyWorld&>(ours) : bullets;
      world.deformable().setImplicit(settings.implicit);
      world.deformable().setLineSearch(settings.lineSearch);
      world.deformable().setUseProjection(settings.projection);
      SoftBodyOptions options;
      options.forceModel = ForceModel::NeoHookean;
      options.configureWorld = false;
      const auto body = added(world, smallCageAbove(0.3), options);
      step(world, 30);
      positions[k] = nodesOf(body->body());
    }
    EXPECT_FALSE(ours.bodySolver().ownSolveActive());
    EXPECT_TRUE(sameBits(positions[0], positions[1])) << settings.implicit << settings.lineSearch;
  }
}

TEST(DeformableSolver, TellsTheEnergyAndAskingChangesNothing) {
  TetskinWorld asked, left;
  const auto a = added(asked, cageAbove(0.2)), b = added(left, cageAbove(0.2));
  double fallen = 0.0, maximum = 0.0;
  for (int f = 0; f < 40; ++f) {
    step(asked, 1);
    step(left, 1);
    maximum = std::max(maximum, test::elasticEnergyIn(asked));
    if (f == 5) fallen = maximum;
    ASSERT_TRUE(sameBits(nodesOf(a->body()), nodesOf(b->body()))) << f;
  }
  EXPECT_LT(fallen, 1e-3);  // a body in free fall is not deformed
  // A body of 1 kg that has fallen by 0.2 with 10 m/s2 has 2 J, some of which goes into the deformation.
  EXPECT_GT(maximum, 0.1);
  EXPECT_LT(maximum, 2.0 * 1.5);
}

TEST(DeformableSolver, DoesNotBoundTheDefaultStiffnessByTheStep) {
  TetskinWorld ours;
  EmptyWorld bullets;
  SoftBodyOptions options;
  options.relativeStiffness = 1e4;
  const TetMesh cage = cageAbove(5);
  const double wanted = 1e4 * (1.0 / totalVolume(cage)) * 10.0;  // a body of 1 kg, 1 unit long
  EXPECT_NEAR(added(ours, cage, options)->youngsModulus(), wanted, 1e-6 * wanted);
  options.forceModel = ForceModel::NeoHookean;
  EXPECT_LT(added(bullets, cage, options)->youngsModulus(), 0.5 * wanted);
}

TEST(DeformableSolver, TakesAStiffnessForEachTetAndAMassForEachNode) {
  TetskinWorld world;
  const TetMesh cage = cageAbove(5);
  SoftBodyOptions options;
  options.stiffnessScale.assign(cage.tetCount(), 1.0);
  // The lower half is a hundred times softer.
  for (std::size_t t = 0; t < cage.tetCount(); ++t) {
    double height = 0.0;
    for (const int n : cage.tets[t]) height += cage.nodes[static_cast<std::size_t>(n)].y() / 4.0;
    if (height < 5.4) options.stiffnessScale[t] = 0.01;
  }
  options.nodeMasses.assign(cage.nodeCount(), 0.02);
  options.pinned = pinnedIn(Box3(Vector(-1, 5.79, -1), Vector(2, 7, 2)));
  options.youngsModulus = 1e4;
  const auto body = added(world, cage, options);
  step(world, 120);
  double upper = 0.0, lower = 0.0;
  for (int n = 0; n < body->body().m_nodes.size(); ++n) {
    const Vector rest = cage.nodes[static_cast<std::size_t>(n)];
    const double moved = rest.y() - static_cast<double>(body->body().m_nodes[n].m_x.y());
    if (rest.y() < 5.01) lower = std::max(lower, moved);
    if (std::abs(rest.y() - 5.4) < 0.01) upper = std::max(upper, moved);
    const auto inverse = static_cast<double>(body->body().m_nodes[n].m_im);
    EXPECT_NEAR(inverse, rest.y() > 5.79 ? 0.0 : 50.0, 1e-3);
  }
  EXPECT_GT(lower, 10.0 * upper);
  EXPECT_GT(upper, 0.0);
}

TEST(DeformableSolver, FollowsChangesOfTheMaterial) {
  TetskinWorld world;
  SoftBodyOptions options;
  options.pinned = pinnedIn(Box3(Vector(-1, 5.79, -1), Vector(2, 7, 2)));
  options.youngsModulus = 1e3;
  const auto body = added(world, cageAbove(5), options);
  step(world, 120);
  const double soft = 5.0 - lowest(body->body());
  ASSERT_TRUE(body->setYoungsModulus(1e5).ok());
  step(world, 120);
  const double stiff = 5.0 - lowest(body->body());
  EXPECT_LT(stiff, 0.05 * soft);
  EXPECT_EQ(body->setPoissonRatio(0.5).code, StatusCode::InvalidOption);
  EXPECT_EQ(body->youngsModulus(), 1e5);
}

TEST(DeformableSolver, CountsTheIterationsOfTheLastStepAlone) {
  TetskinWorld world;
  Cloth cloth(world);
  EXPECT_EQ(world.bodySolver().iterations(), 0);
  step(world, 1);
  EXPECT_GT(world.bodySolver().iterations(), 0);
  // Only gravity is left.
  world.deformable().removeForce(cloth.body.get(), &cloth.springs);
  step(world, 1);
  EXPECT_EQ(world.bodySolver().iterations(), 0);

  world.deformable().addForce(cloth.body.get(), &cloth.springs);
  world.deformable().setLineSearch(true);
  step(world, 1);
  EXPECT_EQ(world.bodySolver().iterations(), 0) << "Bullet's own code has solved";

  const auto body = added(world, smallCageAbove(5));
  body->body().m_nodes[0].m_v += btVector3(1, 0, 0);
  step(world, 1);
  EXPECT_GT(world.bodySolver().iterations(), 0);
}

/// A stiff bar of 150 cubes that is anchored at one end takes many iterations to bend.
TEST(DeformableSolver, IteratesWithAnchorsAsOftenAsItIsAllowedTo) {
  TetMesh bar = test::latticeCage(150, 1, 1, 0.1);
  for (Vector& p : bar.nodes) p.y() += 5;
  const auto iterationsPerSolve = [&](int allowed) {
    TetskinWorld world;
    btBoxShape shape(btVector3(1, 1, 1));
    btRigidBody wall(0, nullptr, &shape);
    world.deformable().addRigidBody(&wall);
    SoftBodyOptions options;
    options.relativeStiffness = 1e6;
    options.solverTolerance = 1e-6;
    options.maxIterations = allowed;
    double most = 0;
    {
      const auto body = added(world, bar, options);
      for (int n = 0; n < body->body().m_nodes.size(); ++n) {
        if (body->body().m_nodes[n].m_x.x() < btScalar(0.05)) body->body().appendDeformableAnchor(n, &wall);
      }
      for (int s = 0; s < 3; ++s) {
        step(world, 1);
        most = std::max(most, double(world.bodySolver().iterations()) / std::max(world.bodySolver().linearSolves(), 1));
      }
    }
    world.deformable().removeRigidBody(&wall);
    return most;
  };
  EXPECT_LE(iterationsPerSolve(50), 51);
  EXPECT_GT(iterationsPerSolve(1000), 80);
}

}  // namespace
}  // namespace tetskin::test
