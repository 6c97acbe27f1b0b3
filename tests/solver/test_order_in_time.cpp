// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// How the motion in a world depends on the length of its steps.
#include <tetskin/elastic/elastic_body.h>
#include <tetskin/solver/deformable_body.h>
#include <tetskin/solver/src/forces/elastic_force.h>

#include <utility>

#include "deformable_test.h"
#include "rigid_bodies.h"

namespace tetskin::test {
namespace {

using Path = std::vector<Eigen::Vector3d>;

constexpr double kModulus = 1e4, kLength = 1.5, kHeight = 8.0, kGravity = 10.0;

SoftBodyOptions beamOptions(double damping) {
  SoftBodyOptions options;
  options.youngsModulus = kModulus;
  options.stiffnessDamping = damping;
  options.solverTolerance = 1e-6;
  return options;
}

/// High above the floor.
TetMesh beamCage() {
  return lifted(latticeCage(6, 1, 1, kLength / 6), kHeight);
}

bool isAtTheWall(const TetMesh& cage, std::size_t node) {
  return cage.nodes[node].x() == 0.0;
}

enum class Hold { Pins, Anchors };

/// A beam that a wall holds, and the place of its free end's last node after each frame.
class HeldBeam {
 public:
  HeldBeam(double damping, Hold hold)
      : wall_(world_, std::make_unique<btBoxShape>(btVector3(btScalar(0.1), 1, 1)), 0,
              btVector3(-1, btScalar(kHeight), 0)) {
    const TetMesh cage = beamCage();
    beam = added(world_, cage, beamOptions(damping));
    for (std::size_t n = 0; n < cage.nodeCount(); ++n) {
      if (!isAtTheWall(cage, n)) continue;
      if (hold == Hold::Pins) {
        EXPECT_TRUE(beam->setPinned(static_cast<int>(n)).ok());
      } else {
        beam->body().appendDeformableAnchor(static_cast<int>(n), wall_.body.get());
      }
    }
  }
  Path swing(int frames, int substeps) {
    Path path;
    for (int f = 0; f < frames; ++f) {
      const btScalar dt = btScalar(1) / 60 / static_cast<btScalar>(substeps);
      for (int s = 0; s < substeps; ++s) world_.deformable().stepSimulation(dt, 0);
      path.push_back(tip());
    }
    return path;
  }
  Eigen::Vector3d tip() const {
    const btVector3& x = beam->body().m_nodes[beam->body().m_nodes.size() - 1].m_x;
    return {x.x(), x.y(), x.z()};
  }

 private:
  TetskinWorld world_;
  Rigid wall_;

 public:
  std::unique_ptr<DeformableBody> beam;
};

double difference(const Path& a, const Path& b) {
  double squared = 0.0, way = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    squared += (a[k] - b[k]).squaredNorm();
    way += (b[k] - beamCage().nodes.back()).squaredNorm();
  }
  return std::sqrt(squared / way);
}

/// The same by an ElasticBody.
Path swingAlone(const btSoftBody& body, double damping, int frames, int substeps) {
  const TetMesh cage = beamCage();
  ElasticOptions options;
  options.youngsModulus = kModulus;
  options.stiffnessDamping = damping;
  options.tolerance = 1e-6;
  for (int n = 0; n < body.m_nodes.size(); ++n) {
    const bool held = isAtTheWall(cage, static_cast<std::size_t>(n));
    options.nodeMasses.push_back(held ? 1.0 : 1.0 / static_cast<double>(body.m_nodes[n].m_im));
  }
  ElasticBody<double> alone = std::move(ElasticBody<double>::create(cage, options)).value();
  for (std::size_t n = 0; n < cage.nodeCount(); ++n) alone.setPinned(n, isAtTheWall(cage, n));
  Path path;
  for (int f = 0; f < frames; ++f) {
    for (int s = 0; s < substeps; ++s) alone.step(1.0 / 60.0 / substeps, {0, -kGravity, 0});
    const double* tip = alone.positions()[cage.nodeCount() - 1];
    path.emplace_back(tip[0], tip[1], tip[2]);
  }
  return path;
}

TEST(OrderInTimeOfAWorld, FourSubstepsAreEnoughHoweverABodyIsHeld) {
  for (const Hold hold : {Hold::Pins, Hold::Anchors}) {
    for (const double damping : {0.0, 0.003, 0.02}) {
      HeldBeam beam(damping, hold);
      const Path exact = swingAlone(beam.beam->body(), damping, 60, 64), path = beam.swing(60, 4);
      EXPECT_LT(difference(path, exact), hold == Hold::Pins ? 0.004 : 0.012)
          << damping << (hold == Hold::Pins ? " pins" : " anchors");
    }
  }
}

/// Half a step more or less of gravity would part them.
TEST(OrderInTimeOfAWorld, AFreeBodyFallsBesideARigidOne) {
  for (const int substeps : {1, 4}) {
    TetskinWorld world;
    const Rigid rigid(world, ball(), 1, btVector3(5, btScalar(kHeight), 0));
    const auto beam = added(world, beamCage(), beamOptions(0.02));
    for (int k = 0; k < 60 * substeps; ++k) {
      world.deformable().stepSimulation(btScalar(1) / 60 / static_cast<btScalar>(substeps), 0);
    }
    const btScalar fallen = static_cast<btScalar>(rigid.height() - kHeight);
    ASSERT_LT(fallen, -4.0);
    for (int n = 0; n < beam->body().m_nodes.size(); ++n) {
      const btScalar before = static_cast<btScalar>(beamCage().nodes[static_cast<std::size_t>(n)].y());
      EXPECT_NEAR(beam->body().m_nodes[n].m_x.y() - before, fallen, 2e-5);
    }
  }
}

/// Whether the last step of the world's only body was one of contact: see `carryingOn`.
bool wasOfContact(EmptyWorld& world, double damping) {
  const auto& forces = *static_cast<btDeformableBodySolver&>(*world.softSolver).getLagrangianForceArray();
  for (int f = 0; f < forces.size(); ++f) {
    if (auto* elastic = dynamic_cast<bullet_detail::ElasticForce*>(forces[f])) {
      return std::abs(elastic->body().dynamics->alpha() * 240.0 - (damping + 0.5 / 240.0)) < 1e-6;
    }
  }
  ADD_FAILURE() << "no elastic force";
  return false;
}

double speedRange(const btSoftBody& body) {
  btScalar low = BT_LARGE_FLOAT, high = -BT_LARGE_FLOAT;
  for (int n = 0; n < body.m_nodes.size(); ++n) {
    low = std::min(low, body.m_nodes[n].m_v.y());
    high = std::max(high, body.m_nodes[n].m_v.y());
  }
  return static_cast<double>(high - low);
}

TEST(OrderInTimeOfAWorld, AStepInWhichAContactBeginsCarriesOnAsDoSomeAfterItHasEnded) {
  constexpr double kDamping = 0.02;
  TetskinWorld world;
  const auto block = added(world, cageAbove(0.5), beamOptions(kDamping));
  const auto stepOnce = [&] {
    world.deformable().stepSimulation(btScalar(1) / 240, 0);
    return wasOfContact(world, kDamping);
  };
  std::vector<bool> steps = {stepOnce()};
  while (speedRange(block->body()) < 0.01 && steps.size() < 240) steps.push_back(stepOnce());
  ASSERT_LT(steps.size(), 240U);
  EXPECT_TRUE(steps.back()) << "it has landed in this step";
  // The floor may have been near before.
  EXPECT_EQ(std::find(steps.begin(), steps.end() - 3, true), steps.end() - 3);
  for (int k = 0; k < 60; ++k) stepOnce();
  EXPECT_TRUE(stepOnce()) << "at rest";
  block->body().setVelocity(btVector3(0, 5, 0));
  EXPECT_TRUE(stepOnce());
  for (int k = 0; k < 20; ++k) stepOnce();
  EXPECT_FALSE(stepOnce());
}

/// A free beam that trembles, for 30 steps.
std::unique_ptr<DeformableBody> trembling(EmptyWorld& world, double damping) {
  const TetMesh cage = beamCage();
  world.deformable().setGravity(btVector3(0, 0, 0));
  auto beam = added(world, cage, beamOptions(damping));
  for (int n = 0; n < beam->body().m_nodes.size(); ++n) {
    const double x = cage.nodes[static_cast<std::size_t>(n)].x() / kLength - 0.5;
    beam->body().m_nodes[n].m_v.setValue(0, static_cast<btScalar>(4.0 * x * x - 1.0 / 3.0), 0);
  }
  for (int k = 0; k < 30; ++k) world.deformable().stepSimulation(btScalar(1) / 240, 0);
  return beam;
}

/// Compares two bodies in the same state; one of them has reached it by moving.
TEST(OrderInTimeOfAWorld, ABodyThatIsStoppedTurnedStiffenedOrPutToSleepGoesOnAsOneThatHasNeverMoved) {
  enum class Change { Stopped, Turned, Stiffened, Asleep };
  const btTransform turn(btQuaternion(btVector3(0, 0, 1), SIMD_HALF_PI), btVector3(3, 0, 0));
  for (const double damping : {0.0, 0.02}) {
    for (const Change change : {Change::Stopped, Change::Turned, Change::Stiffened, Change::Asleep}) {
      TetskinWorld world, other;
      const auto beam = trembling(world, damping);
      SoftBodyOptions options = beamOptions(damping);
      if (change == Change::Stopped) beam->body().setVelocity(btVector3(0, 0, 0));
      if (change == Change::Turned) beam->body().transform(turn);
      if (change == Change::Stiffened) {
        options.youngsModulus = 20.0 * kModulus;
        ASSERT_TRUE(beam->setYoungsModulus(20.0 * kModulus).ok());
      }
      if (change == Change::Asleep) {
        beam->body().forceActivationState(ISLAND_SLEEPING);
        for (int k = 0; k < 3; ++k) world.deformable().stepSimulation(btScalar(1) / 240, 0);
        beam->body().forceActivationState(ACTIVE_TAG);
        for (int n = 0; n < beam->body().m_nodes.size(); ++n) beam->body().m_nodes[n].m_v.setZero();
      }
      const auto fresh = added(other, beamCage(), options);
      other.deformable().setGravity(btVector3(0, 0, 0));
      for (int n = 0; n < beam->body().m_nodes.size(); ++n) {
        fresh->body().m_nodes[n].m_x = fresh->body().m_nodes[n].m_q = beam->body().m_nodes[n].m_x;
        fresh->body().m_nodes[n].m_v = beam->body().m_nodes[n].m_v;
      }
      world.deformable().stepSimulation(btScalar(1) / 240, 0);
      other.deformable().stepSimulation(btScalar(1) / 240, 0);
      for (int n = 0; n < beam->body().m_nodes.size(); ++n) {
        const btScalar difference = (beam->body().m_nodes[n].m_v - fresh->body().m_nodes[n].m_v).length();
        EXPECT_LT(difference, 0.003) << damping << ' ' << static_cast<int>(change);
      }
    }
  }
}

}  // namespace
}  // namespace tetskin::test
