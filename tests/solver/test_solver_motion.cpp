// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// A body solved by the library's own solver that moves freely.
#include "deformable_test.h"

namespace tetskin {
namespace {

using test::added;
using test::cageAbove;
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

}  // namespace
}  // namespace tetskin
