// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Bodies solved by the library's own solver that move freely or hang.
#include "deformable_test.h"

#include <cmath>

namespace tetskin {
namespace {

using test::added;
using test::cageAbove;
using test::lowest;
using test::rmsSpeed;
using test::smallCageAbove;
using test::step;
using test::TetskinWorld;

using Vector = Eigen::Vector3d;

/// A body's mass in kilograms, kinetic energy, size, momentum and angular momentum about the centre of mass.
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

/// Sets a rotation in radians per second about an axis through the centre, and a velocity.
void spin(btSoftBody& body, const Vector& rate, const Vector& push) {
  Vector centre = Vector::Zero();
  for (int n = 0; n < body.m_nodes.size(); ++n) centre += toEigen(body.m_nodes[n].m_x) / body.m_nodes.size();
  for (int n = 0; n < body.m_nodes.size(); ++n) {
    btSoftBody::Node& node = body.m_nodes[n];
    node.m_v = node.m_vn = toBullet(push + rate.cross(toEigen(node.m_x) - centre));
  }
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

/// One turn per second, with a soft and a stiff body.
TEST(DeformableSolver, KeepsSpinAndGainsNoEnergy) {
  for (const double stiffness : {50.0, 1e4}) {
    TetskinWorld world;
    SoftBodyOptions options;
    options.relativeStiffness = stiffness;
    const auto body = added(world, cageAbove(50), options);
    EXPECT_TRUE(body->setGravity(btVector3(0, 0, 0)).ok());
    const Vector rate = 2.0 * 3.14159265358979323846 * Vector(1, 2, 3).normalized();
    spin(body->body(), rate, Vector(0.3, -0.2, 0.1));
    const Motion before = motionOf(body->body());
    const double tip = rate.norm() * before.size;
    // Velocities are chords of the arc that a step turns through.
    const double chord = 1.0 / std::pow(std::cos(0.5 * rate.norm() / 240.0), 2);
    for (int f = 0; f < 600; ++f) {
      step(world, 1);
      ASSERT_LT(motionOf(body->body()).kinetic, 1.0001 * chord * before.kinetic) << "frame " << f;
    }
    const Motion after = motionOf(body->body());
    EXPECT_LT((after.momentum - before.momentum).norm(), 1e-5 * before.mass * tip);
    EXPECT_LT((after.spin - before.spin).norm(), 1e-5 * before.mass * tip * before.size);
  }
}

/// A case that once failed: the rotations of the step before tell nothing of the new ones.
TEST(DeformableSolver, LeavesABodyThatIsRotatedByAnyAngleAtRest) {
  TetMesh cage = test::latticeCage(3, 3, 3, 1.0 / 3.0);
  for (Vector& p : cage.nodes) p += Vector(-0.5, 20.0, -0.5);
  for (const bool started : {false, true}) {
    for (const btVector3& axis : {btVector3(1, 0, 0), btVector3(0, 1, 0), btVector3(0, 0, 1), btVector3(1, 2, 3)}) {
      for (const double degrees : {90.0, 179.0, 179.9, 180.0}) {
        TetskinWorld world;
        const auto body = added(world, cage);
        ASSERT_TRUE(body->setGravity(btVector3(0, 0, 0)).ok());
        if (started) step(world, 3);
        btSoftBody& soft = body->body();
        const btVector3 centroid(0, btScalar(20.5), 0);
        soft.translate(-centroid);
        soft.rotate(btQuaternion(axis.normalized(), static_cast<btScalar>(degrees * SIMD_PI / 180.0)));
        soft.translate(centroid);
        step(world, 10);
        for (int n = 0; n < soft.m_nodes.size(); ++n)
          EXPECT_LT(soft.m_nodes[n].m_v.length(), btScalar(0.02)) << degrees;
      }
    }
  }
}

/// The body is pinned by its upper layer and stretches under its weight as a bar does: rho g L^2 / 2 E.
TEST(DeformableSolver, HangsFromItsPinsAsLongAsItShould) {
  TetskinWorld world;
  TetMesh cage = test::latticeCage(2, 10, 2, 0.1);
  for (Vector& p : cage.nodes) p.y() += 5.0;
  SoftBodyOptions options;
  options.density = 10.0;
  options.youngsModulus = 5000.0;
  options.poissonRatio = 0.0;
  options.stiffnessDamping = 0.1;
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

double volumeOf(const btSoftBody& body) {
  btScalar sum = 0;
  for (int t = 0; t < body.m_tetras.size(); ++t) {
    btSoftBody::Node* const* n = body.m_tetras[t].m_n;
    const btVector3& origin = n[0]->m_x;
    sum += (n[1]->m_x - origin).cross(n[2]->m_x - origin).dot(n[3]->m_x - origin) / 6;
  }
  return static_cast<double>(sum);
}

/// Nodes are put on a plane, mirrored, or all put at one position.
TEST(DeformableSolver, BringsBackWhatIsFlatOrInsideOut) {
  using Position = std::function<btVector3(const btVector3&)>;
  const Position places[] = {[](const btVector3& x) { return btVector3(x.x(), 5, x.z()); },
                             [](const btVector3& x) { return btVector3(x.x(), 10 - x.y(), x.z()); },
                             [](const btVector3&) { return btVector3(0, 5, 0); }};
  const TetMesh cage = cageAbove(5);
  for (const Position& toPosition : places) {
    TetskinWorld world;
    const auto body = added(world, cage);
    EXPECT_TRUE(body->setGravity(btVector3(0, 0, 0)).ok());
    btSoftBody& soft = body->body();
    for (int n = 0; n < soft.m_nodes.size(); ++n)
      soft.m_nodes[n].m_x = soft.m_nodes[n].m_q = toPosition(soft.m_nodes[n].m_x);
    step(world, 240);
    EXPECT_LT(rmsSpeed(soft), 100.0);
    EXPECT_NEAR(volumeOf(soft), totalVolume(cage), 1e-3);
  }
}

}  // namespace
}  // namespace tetskin
