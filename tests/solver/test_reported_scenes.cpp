// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Scenes that users of other engines report as faults, each with the number that is right.
#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>
#include <tetskin/elastic/elastic_body.h>

#include "deformable_test.h"
#include "recorded_forces.h"
#include "rigid_bodies.h"
#include "support/bars.h"

namespace tetskin::test {
namespace {

using Vector3 = Eigen::Vector3d;

struct Weightless : TetskinWorld {
  Weightless() { deformable().setGravity(btVector3(0, 0, 0)); }
};

TetMesh raised(TetMesh cage, double height) {
  for (Vector3& p : cage.nodes) p.y() += height;
  return cage;
}

std::unique_ptr<DeformableBody> bodyIn(EmptyWorld& world, const TetMesh& cage, const SoftBodyOptions& options) {
  Result<std::unique_ptr<DeformableBody>> body = DeformableBody::add(world.deformable(), cage, options);
  EXPECT_TRUE(body.ok()) << body.status().message;
  return std::move(body).value();
}

/// E A times the strain; A is 2.1e-3 m^2.
TEST(ReportedScenes, AStripBetweenBoxesThatMoveApartPullsByItsStrain) {
  Weightless world;
  const auto forces = forcesIn(world);
  SoftBodyOptions options;
  options.youngsModulus = 1e6;
  options.poissonRatio = 0.0;
  options.density = 1000;
  const auto strip = bodyIn(world, raised(makeBox({20, 2, 1}, {1.4, 0.07, 0.03}), 5), options);
  btSoftBody& soft = strip->body();
  const auto box = [] {
    return std::make_unique<btBoxShape>(btVector3(btScalar(0.05), btScalar(0.05), btScalar(0.05)));
  };
  Rigid left(world, box(), 0, btVector3(btScalar(-0.05), btScalar(5.035), btScalar(0.015)));
  Rigid right(world, box(), 0, btVector3(btScalar(1.45), btScalar(5.035), btScalar(0.015)));
  right.body->setActivationState(DISABLE_DEACTIVATION);
  right.body->setCollisionFlags(btCollisionObject::CF_KINEMATIC_OBJECT);
  std::vector<std::pair<int, btVector3>> held;
  for (int n = 0; n < soft.m_nodes.size(); ++n) {
    const btVector3 at = soft.m_nodes[n].m_x;
    if (at.x() < btScalar(0.001)) soft.appendDeformableAnchor(n, left.body.get());
    if (at.x() < btScalar(1.399)) continue;
    soft.appendDeformableAnchor(n, right.body.get());
    held.emplace_back(n, at);
  }
  const auto moveBy = [&](double way, int frames) {
    for (int f = 0; f < frames; ++f) {
      btTransform next = right.body->getWorldTransform();
      next.getOrigin() += btVector3(static_cast<btScalar>(way / frames), 0, 0);
      right.body->setWorldTransform(next);
      step(world, 1);
      const btScalar moved = next.getOrigin().x() - btScalar(1.45);
      for (const auto& [n, at] : held) {
        EXPECT_LT((soft.m_nodes[n].m_x - at - btVector3(moved, 0, 0)).length(), 1e-4);
      }
    }
    step(world, 60);
  };
  const auto on = [&](const Rigid& of) { return static_cast<double>(forces->forcesOn(*of.body).total().force.x()); };
  moveBy(0.14, 60);
  EXPECT_NEAR(on(left), 210, 2.1);
  EXPECT_NEAR(on(right), -on(left), 0.5);
  moveBy(-0.14, 60);
  EXPECT_NEAR(on(left), 0, 0.05);
}

/// A tyre of rubber around a hub, anchored all around.
struct Wheel {
  static constexpr double kInner = 0.2, kOuter = 0.3;

  /// anchored  or held by its contact with a hub that is too large for it
  explicit Wheel(double modulus = 5e6, bool anchored = true) {
    const TetMesh cage = ring();
    SoftBodyOptions options;
    options.youngsModulus = modulus;
    options.density = 1000;
    options.stiffnessDamping = 0.002;
    options.margin = 0.014;  // of contact, 4 mm beyond the hub's own radius
    options.friction = 1;
    tyre = bodyIn(world, cage, options);
    hub.body->setActivationState(DISABLE_DEACTIVATION);
    hub.body->setFriction(1);
    btSoftBody& soft = tyre->body();
    for (int n = 0; n < soft.m_nodes.size(); ++n) {
      radii.push_back((cage.nodes[static_cast<std::size_t>(n)] - Vector3(0, 5, 0)).head<2>().norm());
      if (anchored && radii.back() < kInner + 1e-6) soft.appendDeformableAnchor(n, hub.body.get());
    }
  }
  static TetMesh ring() {
    constexpr int kAround = 24;
    const TetMesh box = makeBox({kAround, 2, 1}, {1, 1, 1});
    TetMesh ring;
    std::vector<int> numbers;
    for (std::size_t n = 0; n < box.nodes.size(); ++n) {
      if (n % (kAround + 1) == kAround) {
        numbers.push_back(numbers[n - kAround]);
        continue;
      }
      const Vector3& p = box.nodes[n];
      const double angle = 2 * M_PI * p.x(), radius = kInner + (kOuter - kInner) * p.y();
      numbers.push_back(static_cast<int>(ring.nodes.size()));
      ring.nodes.emplace_back(radius * std::cos(angle), 5 + radius * std::sin(angle), 0.1 * (p.z() - 0.5));
    }
    for (Tet tet : box.tets) {
      for (int& n : tet) n = numbers[static_cast<std::size_t>(n)];
      ring.tets.push_back(tet);
    }
    (void)repairTetMesh(ring);
    return ring;
  }
  void spin(btScalar rate) {
    btSoftBody& soft = tyre->body();
    hub.body->setAngularVelocity(btVector3(0, 0, rate));
    for (int n = 0; n < soft.m_nodes.size(); ++n) {
      btSoftBody::Node& node = soft.m_nodes[n];
      node.m_v = node.m_vn = btVector3(0, 0, rate).cross(node.m_x - btVector3(0, 5, 0));
    }
  }
  double momentum() {
    const btSoftBody& soft = tyre->body();
    double sum = rate() / static_cast<double>(hub.body->getInvInertiaDiagLocal().z());
    for (int n = 0; n < soft.m_nodes.size(); ++n) {
      const btSoftBody::Node& node = soft.m_nodes[n];
      sum += static_cast<double>((node.m_x - btVector3(0, 5, 0)).cross(node.m_v).z() / node.m_im);
    }
    return sum;
  }
  double rate() { return static_cast<double>(hub.body->getAngularVelocity().z()); }
  /// By how much the rim has grown.
  double growth() {
    double sum = 0, count = 0;
    for (std::size_t n = 0; n < radii.size(); ++n) {
      if (radii[n] < kOuter - 1e-6) continue;
      sum += (toEigen(tyre->body().m_nodes[static_cast<int>(n)].m_x) - Vector3(0, 5, 0)).head<2>().norm() - radii[n];
      ++count;
    }
    return sum / count;
  }
  void frames(int count, int substeps) {
    const btScalar frame = btScalar(1) / 60;
    for (int f = 0; f < count; ++f) world.deformable().stepSimulation(frame, substeps, frame / btScalar(substeps));
  }

  Weightless world;
  Rigid hub{world, std::make_unique<btCylinderShapeZ>(btVector3(btScalar(0.19), btScalar(0.19), btScalar(0.05))), 10,
            btVector3(0, 5, 0)};
  std::unique_ptr<DeformableBody> tyre;
  std::vector<double> radii;
};

/// Between plane strain and plane stress; a quarter of a radian per step.
TEST(ReportedScenes, ASoftWheelOnAMotorGrowsByElasticityAlone) {
  Wheel wheel;
  btHingeConstraint hinge(*wheel.hub.body, btVector3(0, 0, 0), btVector3(0, 0, 1));
  hinge.enableAngularMotor(true, 60, 1000);
  wheel.world.deformable().addConstraint(&hinge);
  wheel.frames(30, 4);
  EXPECT_NEAR(wheel.rate(), 60, 0.06);
  EXPECT_GT(wheel.growth(), 0.66e-3);
  EXPECT_LT(wheel.growth(), 0.85e-3);
  wheel.world.deformable().removeConstraint(&hinge);
}

/// With anchors all around, their impulses cancel out. Soft and stiff tyres, in steps of a quarter and half a radian.
TEST(ReportedScenes, AWheelKeepsItsSpin) {
  struct Case {
    double modulus;
    btScalar rate;
    int substeps;
  };
  for (const Case& of : {Case{5e6, 60, 4}, Case{5e8, 60, 4}, Case{5e6, 30, 1}}) {
    Wheel wheel(of.modulus);
    wheel.spin(of.rate);
    const double before = wheel.momentum();
    wheel.frames(60, of.substeps);
    EXPECT_NEAR(wheel.momentum(), before, 1e-4 * before) << of.modulus << " Pa, " << of.rate;
    EXPECT_NEAR(wheel.rate(), of.rate, 0.05 * of.rate) << of.modulus << " Pa, " << of.rate;
    EXPECT_LT(std::abs(wheel.growth()), 1e-3);
  }
}

/// The hub is a multibody's link, whose points also move on arcs.
TEST(ReportedScenes, AWheelAroundALinkOfAMultibodyDoesNotSwell) {
  Weightless world;
  btCylinderShapeZ shape(btVector3(btScalar(0.19), btScalar(0.19), btScalar(0.05)));
  btVector3 inertia;
  shape.calculateLocalInertia(10, inertia);
  btMultiBody axle(1, 0, btVector3(0, 0, 0), true, false);
  axle.setBasePos(btVector3(0, 5, 0));
  axle.setupRevolute(0, 10, inertia, -1, btQuaternion::getIdentity(), btVector3(0, 0, 1), btVector3(0, 0, 0),
                     btVector3(0, 0, 0), true);
  axle.setLinearDamping(0);
  axle.setAngularDamping(0);
  axle.finalizeMultiDof();
  axle.setJointVel(0, 60);
  btMultiBodyLinkCollider hub(&axle, 0);
  hub.setCollisionShape(&shape);
  hub.setWorldTransform(btTransform(btQuaternion::getIdentity(), btVector3(0, 5, 0)));
  axle.getLink(0).m_collider = &hub;
  world.deformable().addMultiBody(&axle);
  world.deformable().addCollisionObject(&hub);
  SoftBodyOptions options;
  options.youngsModulus = 5e6;
  options.density = 1000;
  options.stiffnessDamping = 0.002;
  const TetMesh cage = Wheel::ring();
  const auto tyre = bodyIn(world, cage, options);
  btSoftBody& soft = tyre->body();
  const btVector3 centre(0, 5, 0);
  for (int n = 0; n < soft.m_nodes.size(); ++n) {
    btSoftBody::Node& node = soft.m_nodes[n];
    node.m_v = node.m_vn = btVector3(0, 0, 60).cross(node.m_x - centre);
    if ((cage.nodes[static_cast<std::size_t>(n)] - toEigen(centre)).head<2>().norm() < Wheel::kInner + 1e-6) {
      soft.appendDeformableAnchor(n, &hub);
    }
  }
  step(world, 30);
  double grown = 0;
  for (int n = 0; n < soft.m_nodes.size(); ++n) {
    const double before = (cage.nodes[static_cast<std::size_t>(n)] - toEigen(centre)).head<2>().norm();
    grown = std::max(grown, (toEigen(soft.m_nodes[n].m_x - centre)).head<2>().norm() - before);
  }
  EXPECT_GT(grown, 0.66e-3);
  EXPECT_LT(grown, 0.95e-3);
  EXPECT_NEAR(axle.getJointVel(0), 60, 1);
  world.deformable().removeCollisionObject(&hub);
  world.deformable().removeMultiBody(&axle);
}

/// A ring that is stretched around a hub, and held by friction alone.
TEST(ReportedScenes, ARingSqueezedOnAHubKeepsTheSpinOfBoth) {
  Wheel ring(5e6, false);
  ring.frames(60, 4);
  ring.spin(30);
  const double before = ring.momentum();
  ring.frames(30, 4);
  EXPECT_NEAR(ring.momentum(), before, 1e-4 * before);
  EXPECT_NEAR(ring.rate(), 30, 1.5);
}

/// A ball of flesh on a core that is led: 0.2 m of 5 kPa, damped by 0.01 s.
struct Flesh {
  static constexpr double kSize = 0.2;

  Flesh() {
    cage = makeBox({6, 6, 6}, {2, 2, 2});
    for (Vector3& p : cage.nodes) {
      p -= Vector3(1, 1, 1);
      if (p.norm() > 0) p *= 0.5 * kSize * p.cwiseAbs().maxCoeff() / p.norm();
      p.y() += 5;
    }
    SoftBodyOptions options;
    options.youngsModulus = 5e3;
    options.density = 1000;
    options.stiffnessDamping = 0.01;
    options.pinned = [](const Vector3& rest) { return (rest - Vector3(0, 5, 0)).norm() < 0.04; };
    body = bodyIn(world, cage, options);
  }
  btSoftBody& soft() { return body->body(); }
  void lead(double way) {
    for (int n = 0; n < soft().m_nodes.size(); ++n) {
      if (!body->isPinned(n)) continue;
      const btVector3 place = soft().m_nodes[n].m_x + btVector3(static_cast<btScalar>(way), 0, 0);
      EXPECT_TRUE(body->setPinnedPosition(n, place).ok());
    }
  }
  Vector3 core() {
    for (int n = 0;; ++n) {
      if (body->isPinned(n)) return toEigen(soft().m_nodes[n].m_x) - cage.nodes[static_cast<std::size_t>(n)];
    }
  }
  /// Of the flesh from the core, along x; and the farthest of any node.
  double offset(double* farthest = nullptr) {
    const Vector3 at = core();
    double sum = 0, mass = 0;
    for (int n = 0; n < soft().m_nodes.size(); ++n) {
      const Vector3 away = toEigen(soft().m_nodes[n].m_x) - at - cage.nodes[static_cast<std::size_t>(n)];
      if (farthest) *farthest = std::max(*farthest, away.norm());
      if (soft().m_nodes[n].m_im == 0) continue;
      sum += away.x() / static_cast<double>(soft().m_nodes[n].m_im);
      mass += 1 / static_cast<double>(soft().m_nodes[n].m_im);
    }
    return sum / mass;
  }
  double deformation() {
    double farthest = 0;
    offset(&farthest);
    return farthest / kSize;
  }
  bool rests(int frames) {
    for (int f = 0; f < frames && soft().isActive(); ++f) step(world, 1);
    return !soft().isActive();
  }

  Weightless world;
  TetMesh cage;
  std::unique_ptr<DeformableBody> body;
};

TEST(ReportedScenes, FleshOnALedCoreSwingsOutAsItsDampingSays) {
  Flesh flesh;
  for (int f = 0; f < 30; ++f) {
    flesh.lead(2.0 / 60);
    step(flesh.world, 1);
  }
  std::vector<std::pair<double, double>> peaks;  // seconds, and size
  double before = 0, last = 0;
  for (int k = 0; k < 360; ++k) {
    flesh.world.deformable().stepSimulation(btScalar(1) / 240, 1, btScalar(1) / 240);
    const double now = flesh.offset();
    if (k > 1 && (last - before) * (now - last) <= 0) peaks.emplace_back(k / 240.0, std::abs(last));
    before = last;
    last = now;
  }
  ASSERT_GT(peaks.size(), 6u);
  const double seconds = peaks[6].first - peaks[1].first, frequency = 5 * SIMD_PI / seconds;
  const double decay = std::log(peaks[1].second / peaks[6].second) / seconds;
  EXPECT_NEAR(decay, 0.5 * frequency * frequency * 0.01, 0.1 * decay);
  EXPECT_TRUE(flesh.rests(900));
  EXPECT_LT(flesh.deformation(), 1e-3);
}

TEST(ReportedScenes, FleshRecoversFromAHitchAndIsTeleportedWithItsCore) {
  Flesh flesh, beside;
  for (Flesh* of : {&flesh, &beside}) {
    const auto walk = [&] {
      for (int f = 0; f < 10; ++f) {
        of->lead(2.0 / 60);
        step(of->world, 1);
      }
    };
    walk();
    of->lead(0.4);
    of->world.deformable().stepSimulation(btScalar(0.2), 4, btScalar(0.05));
    EXPECT_TRUE(of->rests(1200));
    EXPECT_LT(of->deformation(), 1e-3);
    walk();
    if (of == &flesh) {
      ASSERT_TRUE(of->body->teleport(btTransform(btQuaternion::getIdentity(), btVector3(10, 0, 0))).ok());
    }
    walk();
  }
  EXPECT_NEAR(flesh.core().x(), beside.core().x() + 10, 1e-5);
  EXPECT_NEAR(flesh.deformation(), beside.deformation(), 1e-4);
}

}  // namespace
}  // namespace tetskin::test
