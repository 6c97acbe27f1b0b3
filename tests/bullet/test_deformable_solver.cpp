// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Bodies under the library's own solve, alone in a world.
#include "deformable_test.h"

#include <tetskin/threads/thread_pool.h>

#include <cmath>

namespace tetskin {
namespace {

using test::added;
using test::cageAbove;
using test::EmptyWorld;
using test::lowest;
using test::rmsSpeed;
using test::smallCageAbove;
using test::step;
using test::TetskinWorld;
using test::twoParts;

using Vector = Eigen::Vector3d;

/// Kilograms, and the moments of motion about the centre of mass.
struct Motion {
  double mass = 0.0, kinetic = 0.0, size = 0.0;
  Vector momentum = Vector::Zero(), spin = Vector::Zero();
};

Motion motionOf(const btSoftBody& body) {
  Motion motion;
  Vector centre = Vector::Zero();
  for (int n = 0; n < body.m_nodes.size(); ++n) {
    const double mass = 1.0 / static_cast<double>(body.m_nodes[n].m_im);
    motion.mass += mass;
    centre += mass * toEigen(body.m_nodes[n].m_x);
  }
  centre /= motion.mass;
  for (int n = 0; n < body.m_nodes.size(); ++n) {
    const double mass = 1.0 / static_cast<double>(body.m_nodes[n].m_im);
    const Vector arm = toEigen(body.m_nodes[n].m_x) - centre, v = toEigen(body.m_nodes[n].m_v);
    motion.momentum += mass * v;
    motion.spin += mass * arm.cross(v);
    motion.kinetic += 0.5 * mass * v.squaredNorm();
    motion.size = std::max(motion.size, arm.norm());
  }
  return motion;
}

/// Radians a second about an axis through the centre, and a push.
void spin(btSoftBody& body, const Vector& rate, const Vector& push) {
  Vector centre = Vector::Zero();
  for (int n = 0; n < body.m_nodes.size(); ++n) centre += toEigen(body.m_nodes[n].m_x) / body.m_nodes.size();
  for (int n = 0; n < body.m_nodes.size(); ++n) {
    btSoftBody::Node& node = body.m_nodes[n];
    node.m_v = node.m_vn = toBullet(push + rate.cross(toEigen(node.m_x) - centre));
  }
}

std::vector<btVector3> positionsOf(const btSoftBody& body) {
  std::vector<btVector3> all;
  for (int n = 0; n < body.m_nodes.size(); ++n) all.push_back(body.m_nodes[n].m_x);
  return all;
}

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
  world.deformable().setLineSearch(true);
  step(world, 1);
  EXPECT_EQ(ours->solverPath(), SolverPath::ForceOnly);
  world.deformable().setLineSearch(false);
  step(world, 1);
  EXPECT_EQ(ours->solverPath(), SolverPath::Solver);
  world.deformable().setUseProjection(false);
  step(world, 1);
  EXPECT_EQ(ours->solverPath(), SolverPath::ForceOnly);

  EmptyWorld other;
  EXPECT_EQ(added(other, smallCageAbove(5))->solverPath(), SolverPath::ForceOnly);
}

TEST(DeformableSolver, LetsBodiesFallLikeStones) {
  TetskinWorld world;
  const auto body = added(world, smallCageAbove(100));
  step(world, 60);
  const Motion motion = motionOf(body->body());
  EXPECT_NEAR(motion.momentum.y() / motion.mass, -10.0, 1e-4);
  for (int n = 0; n < body->body().m_nodes.size(); ++n) {
    EXPECT_NEAR(static_cast<double>(body->body().m_nodes[n].m_v.y()), -10.0, 1e-3);
  }
}

class Landing : public testing::TestWithParam<double> {};

/// Steps of 1/240 s, of a stiffness in density x gravity x size.
TEST_P(Landing, BouncesAndRests) {
  TetskinWorld world;
  SoftBodyOptions options;
  options.relativeStiffness = GetParam();
  const auto body = added(world, cageAbove(0.5), options);
  step(world, 240);
  EXPECT_LT(rmsSpeed(body->body()), 0.05);
  EXPECT_GT(lowest(body->body()), -0.005);
  EXPECT_LT(lowest(body->body()), 0.03);  // the margin is 0.02
}

/// One step a frame.
TEST_P(Landing, HoldsInLongSteps) {
  TetskinWorld world;
  SoftBodyOptions options;
  options.relativeStiffness = GetParam();
  const auto body = added(world, cageAbove(0.5), options);
  for (int f = 0; f < 240; ++f) world.deformable().stepSimulation(btScalar(1) / 60, 1, btScalar(1) / 60);
  EXPECT_LT(rmsSpeed(body->body()), 0.05);
  EXPECT_GT(lowest(body->body()), -0.005);
}

/// Beside each other, one of them held at a side.
TEST_P(Landing, HoldsForSeveralBodiesAndWithPins) {
  for (const int substeps : {4, 1}) {
    TetskinWorld world;
    std::vector<std::unique_ptr<DeformableBody>> bodies;
    for (int b = 0; b < 3; ++b) {
      TetMesh cage = cageAbove(0.3);
      for (Vector& p : cage.nodes) p.x() += 2.0 * b;
      SoftBodyOptions options;
      options.relativeStiffness = GetParam();
      if (b == 1) options.pinned = pinnedIn(Box3(Vector(1.9, 0.0, -1.0), Vector(2.01, 2.0, 2.0)));
      bodies.push_back(added(world, cage, options));
    }
    const auto steps = static_cast<btScalar>(substeps);
    for (int f = 0; f < 240; ++f) {
      world.deformable().stepSimulation(btScalar(1) / 60, substeps, btScalar(1) / 60 / steps);
    }
    for (const auto& body : bodies) {
      EXPECT_LT(rmsSpeed(body->body()), 0.05) << substeps;
      EXPECT_GT(lowest(body->body()), -0.005) << substeps;
    }
    EXPECT_GT(lowest(bodies[1]->body()) - lowest(bodies[0]->body()), -1e-3);
  }
}

INSTANTIATE_TEST_SUITE_P(DeformableSolver, Landing, testing::Values(50.0, 300.0, 1e4));

TEST(DeformableSolver, DoesNotBoundTheDefaultStiffnessByTheStep) {
  TetskinWorld ours;
  EmptyWorld bullets;
  SoftBodyOptions options;
  options.relativeStiffness = 1e4;
  const TetMesh cage = cageAbove(5);
  const double wanted = 1e4 * (1.0 / totalVolume(cage)) * 10.0;  // of 1 kg, 1 unit long
  EXPECT_NEAR(added(ours, cage, options)->youngsModulus(), wanted, 1e-6 * wanted);
  EXPECT_LT(added(bullets, cage, options)->youngsModulus(), 0.5 * wanted);
}

/// A turn a second, stiff and soft.
TEST(DeformableSolver, KeepsSpinAndGainsNoEnergy) {
  for (const double stiffness : {50.0, 1e4}) {
    TetskinWorld world;
    SoftBodyOptions options;
    options.relativeStiffness = stiffness;
    const auto body = added(world, cageAbove(50), options);
    body->setGravity(btVector3(0, 0, 0));
    const Vector rate = 2.0 * M_PI * Vector(1, 2, 3).normalized();
    spin(body->body(), rate, Vector(0.3, -0.2, 0.1));
    const Motion before = motionOf(body->body());
    const double tip = rate.norm() * before.size;
    for (int f = 0; f < 600; ++f) {
      step(world, 1);
      ASSERT_LT(motionOf(body->body()).kinetic, 1.0001 * before.kinetic) << "frame " << f;
    }
    const Motion after = motionOf(body->body());
    EXPECT_LT((after.momentum - before.momentum).norm(), 1e-5 * before.mass * tip);
    EXPECT_LT((after.spin - before.spin).norm(), 1e-5 * before.mass * tip * before.size);
  }
}

TEST(DeformableSolver, GivesTheSameBitsAgainAndWithThreads) {
  const auto run = [](ParallelFor* threads, int bodies) {
    TetskinWorld world;
    world.bodySolver().setThreads(threads);
    std::vector<std::unique_ptr<DeformableBody>> all;
    for (int b = 0; b < bodies; ++b) all.push_back(added(world, cageAbove(0.3 + 1.5 * b)));
    step(world, 40);
    std::vector<btVector3> positions;
    for (const auto& body : all) {
      for (const btVector3& p : positionsOf(body->body())) positions.push_back(p);
    }
    return positions;
  };
  ThreadPool pool(3);
  for (const int bodies : {1, 3}) {
    const std::vector<btVector3> alone = run(nullptr, bodies);
    EXPECT_TRUE(sameBits(alone, run(nullptr, bodies))) << bodies;
    EXPECT_TRUE(sameBits(alone, run(&pool, bodies))) << bodies;
  }
}

/// Pinned by its upper layer; stretched by its weight as a bar is: rho g L^2 / 2 E.
TEST(DeformableSolver, HangsFromItsPinsAsLongAsItShould) {
  TetskinWorld world;
  TetMesh cage = test::latticeCage(2, 10, 2, 0.1);
  for (Vector& p : cage.nodes) p.y() += 5.0;
  SoftBodyOptions options;
  options.density = 10.0;
  options.youngsModulus = 5000.0;
  options.poissonRatio = 0.0;
  options.damping = 0.1;
  options.pinned = pinnedIn(Box3(Vector(-1, 5.999, -1), Vector(1, 7, 1)));
  const auto body = added(world, cage, options);
  step(world, 300);
  const double sag = 5.0 - lowest(body->body());
  EXPECT_NEAR(sag, 10.0 * 10.0 * 1.0 / (2.0 * 5000.0), 0.05 * sag);
  for (int n = 0; n < body->body().m_nodes.size(); ++n) {
    if (cage.nodes[static_cast<std::size_t>(n)].y() < 5.999) continue;
    EXPECT_LT((toEigen(body->body().m_nodes[n].m_x) - cage.nodes[static_cast<std::size_t>(n)]).norm(), 1e-6);
  }
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

TEST(DeformableSolver, RefusesValuesThatMakeNoSense) {
  TetskinWorld world;
  const TetMesh cage = smallCageAbove(5);
  const auto refused = [&](auto&& change) {
    SoftBodyOptions options;
    change(options);
    const auto result = DeformableBody::add(world.deformable(), cage, options);
    EXPECT_FALSE(result.ok());
    EXPECT_FALSE(result.status().message.empty());
    return result.status().code;
  };
  const double nan = std::nan("");
  const auto scale = [&](std::vector<double> values) {
    return refused([&](SoftBodyOptions& o) { o.stiffnessScale = values; });
  };
  const auto masses = [&](std::vector<double> values) {
    return refused([&](SoftBodyOptions& o) { o.nodeMasses = values; });
  };
  EXPECT_EQ(scale({1.0}), StatusCode::SizeMismatch);
  EXPECT_EQ(masses({1.0}), StatusCode::SizeMismatch);
  for (const double bad : {nan, 0.0, -1.0, HUGE_VAL}) {
    EXPECT_EQ(scale(std::vector<double>(cage.tetCount(), bad)), StatusCode::InvalidOption) << bad;
    EXPECT_EQ(masses(std::vector<double>(cage.nodeCount(), bad)), StatusCode::InvalidOption) << bad;
  }
  EXPECT_EQ(refused([](SoftBodyOptions& o) { o.poissonRatio = 0.5; }), StatusCode::InvalidOption);
  EXPECT_EQ(refused([](SoftBodyOptions& o) { o.solverTolerance = 1.0; }), StatusCode::InvalidOption);
  EXPECT_EQ(refused([&](SoftBodyOptions& o) { o.solverTolerance = nan; }), StatusCode::InvalidOption);
  EXPECT_EQ(refused([](SoftBodyOptions& o) { o.maxIterations = 0; }), StatusCode::InvalidOption);
  EXPECT_EQ(refused([&](SoftBodyOptions& o) {
              o.forceModel = ForceModel::NeoHookean;
              o.stiffnessScale.assign(cage.tetCount(), 1.0);
            }),
            StatusCode::InvalidOption);
  EXPECT_EQ(world.deformable().getSoftBodyArray().size(), 0);
}

TEST(DeformableSolver, RefusesAWorldOfReducedBodies) {
  EmptyWorld world(std::make_unique<btReducedDeformableBodySolver>());
  const auto result = DeformableBody::add(world.deformable(), smallCageAbove(5));
  EXPECT_EQ(result.status().code, StatusCode::InvalidOption);
  EXPECT_EQ(world.deformable().getSoftBodyArray().size(), 0);
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

TEST(DeformableSolver, CarriesPartsThatShareNoNode) {
  TetskinWorld world;
  const auto body = added(world, twoParts(cageAbove(0.5)));
  step(world, 180);
  EXPECT_LT(rmsSpeed(body->body()), 0.05);
  EXPECT_GT(lowest(body->body()), -0.005);
}

/// Nodes are put on a plane, mirrored, or all to one place.
TEST(DeformableSolver, BringsBackWhatIsFlatOrInsideOut) {
  using Place = std::function<btVector3(const btVector3&)>;
  const Place places[] = {[](const btVector3& x) { return btVector3(x.x(), 5, x.z()); },
                          [](const btVector3& x) { return btVector3(x.x(), 10 - x.y(), x.z()); },
                          [](const btVector3&) { return btVector3(0, 5, 0); }};
  for (const Place& place : places) {
    TetskinWorld world;
    const auto body = added(world, cageAbove(5));
    body->setGravity(btVector3(0, 0, 0));
    btSoftBody& soft = body->body();
    for (int n = 0; n < soft.m_nodes.size(); ++n)
      soft.m_nodes[n].m_x = soft.m_nodes[n].m_q = place(soft.m_nodes[n].m_x);
    step(world, 240);
    btScalar volume = 0;
    for (int t = 0; t < soft.m_tetras.size(); ++t) {
      const auto& tet = soft.m_tetras[t];
      const btVector3 &a = tet.m_n[0]->m_x, &b = tet.m_n[1]->m_x, &c = tet.m_n[2]->m_x, &d = tet.m_n[3]->m_x;
      volume += (b - a).cross(c - a).dot(d - a) / 6;
      ASSERT_TRUE(std::isfinite(volume));
    }
    ASSERT_LT(rmsSpeed(soft), 100.0);
    RecordProperty("volume", std::to_string(volume));
  }
}

/// Rays find a body wherever it has gone, though its trees are not fitted in each step.
TEST(DeformableSolver, LeavesBodiesToBeFoundByRays) {
  TetskinWorld world;
  const auto body = added(world, cageAbove(6));
  for (int f = 0; f < 90; ++f) {
    step(world, 1);
    btVector3 low, high;
    body->body().getAabb(low, high);
    const btSoftBody::Face& face = body->body().m_faces[(37 * f) % body->body().m_faces.size()];
    const btVector3 centre = (face.m_n[0]->m_x + face.m_n[1]->m_x + face.m_n[2]->m_x) / 3;
    const btVector3 normal =
        (face.m_n[1]->m_x - face.m_n[0]->m_x).cross(face.m_n[2]->m_x - face.m_n[0]->m_x).normalized();
    const btVector3 from = centre + btScalar(0.001) * normal, to = centre - btScalar(0.001) * normal;
    btCollisionWorld::ClosestRayResultCallback hit(from, to);
    world.deformable().rayTest(from, to, hit);
    EXPECT_TRUE(hit.hasHit()) << "frame " << f;
  }
}

TEST(DeformableSolver, LetsBodiesSlideDownASlipperySlopeAndNotAStickyOne) {
  const auto slid = [](double friction) {
    TetskinWorld world;
    btBoxShape shape(btVector3(10, 1, 10));
    btRigidBody slope(0, nullptr, &shape);
    btTransform tilted(btQuaternion(btVector3(0, 0, 1), btScalar(-0.3)), btVector3(0, 3, 0));
    slope.setWorldTransform(tilted);
    slope.setInterpolationWorldTransform(tilted);
    slope.setFriction(1);
    world.deformable().addRigidBody(&slope);
    SoftBodyOptions options;
    options.friction = friction;
    options.relativeStiffness = 300.0;
    TetMesh cage = test::latticeCage(3, 2, 3, 0.2);
    for (Vector& p : cage.nodes) {
      p = toEigen(tilted * toBullet(p + Vector(0, 1.03, 0)));
    }
    const auto body = added(world, cage, options);
    const btVector3 before = body->body().m_nodes[0].m_x;
    step(world, 60);
    const double way = static_cast<double>((body->body().m_nodes[0].m_x - before).length());
    world.deformable().removeRigidBody(&slope);
    return way;
  };
  // a = g (sin - mu cos): 2.9 without friction, 1.0 with 0.2; held above tan(0.3) = 0.31
  EXPECT_NEAR(slid(0.0), 0.5 * 10.0 * std::sin(0.3), 0.15);
  EXPECT_NEAR(slid(0.2), 0.5 * 10.0 * (std::sin(0.3) - 0.2 * std::cos(0.3)), 0.25);
  EXPECT_LT(slid(0.6), 0.1);
}

TEST(DeformableSolver, LetsAHeavyBoxRestOnALightBody) {
  TetskinWorld world;
  SoftBodyOptions options;
  options.youngsModulus = 2e5;
  const auto body = added(world, cageAbove(0.02), options);
  btBoxShape shape(btVector3(btScalar(0.5), btScalar(0.5), btScalar(0.5)));
  btVector3 inertia;
  shape.calculateLocalInertia(100, inertia);
  btRigidBody box(100, nullptr, &shape, inertia);
  btTransform above(btQuaternion::getIdentity(), btVector3(btScalar(0.5), btScalar(1.4), btScalar(0.5)));
  box.setWorldTransform(above);
  box.setInterpolationWorldTransform(above);
  world.deformable().addRigidBody(&box);
  step(world, 240);
  EXPECT_LT(box.getLinearVelocity().length(), 0.1);
  EXPECT_GT(box.getWorldTransform().getOrigin().y(), 1.1);
  EXPECT_LT(box.getWorldTransform().getOrigin().y(), 1.4);
  world.deformable().removeRigidBody(&box);
}

}  // namespace
}  // namespace tetskin
