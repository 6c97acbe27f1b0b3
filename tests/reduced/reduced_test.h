// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// A bar of fine tets, its vibration modes, and a cage around it.
#pragma once

#include <BulletSoftBody/BulletReducedDeformableBody/btReducedDeformableBodySolver.h>
#include <BulletSoftBody/btDeformableMultiBodyConstraintSolver.h>
#include <BulletSoftBody/btDeformableMultiBodyDynamicsWorld.h>
#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>
#include <btBulletDynamicsCommon.h>
#include <gtest/gtest.h>
#include <support/bars.h>
#include <support/rigids.h>
#include <tetskin/reduced/reduced_body.h>

#include <cmath>
#include <memory>

namespace tetskin::test {

/// A bar of 2 x 0.5 x 0.5, centred at the origin.
inline TetMesh fineBar() {
  TetMesh bar = makeBox({16, 4, 4}, Eigen::Vector3d(2, 0.5, 0.5));
  for (Eigen::Vector3d& node : bar.nodes) node -= Eigen::Vector3d(1, 0.25, 0.25);
  return bar;
}

/// A cage a few hundredths larger than the bar.
inline Cage barCage() {
  TetMesh cage = makeBox({12, 3, 3}, Eigen::Vector3d(2.04, 0.54, 0.54));
  for (Eigen::Vector3d& node : cage.nodes) node -= Eigen::Vector3d(1.02, 0.27, 0.27);
  return cage;
}

inline std::vector<int> leftEnd(const TetMesh& bar) {
  std::vector<int> nodes;
  for (std::size_t n = 0; n < bar.nodeCount(); ++n) {
    if (bar.nodes[n].x() < -1 + 1e-9) nodes.push_back(static_cast<int>(n));
  }
  return nodes;
}

/// The bar's 20 softest modes, free or with its left end pinned.
inline const VibrationModes& barModes(bool pinnedNodes = false) {
  const auto make = [](bool pinned) {
    VibrationOptions options;
    if (pinned) options.pinned = leftEnd(fineBar());
    return computeVibrationModes(fineBar(), options).value();
  };
  static const VibrationModes free = make(false), pinned = make(true);
  return pinnedNodes ? pinned : free;
}

/// A world with Bullet's reduced solver, or with another one.
class World {
 public:
  explicit World(const btVector3& gravity = btVector3(0, -10, 0),
                 std::unique_ptr<btDeformableBodySolver> solver = std::make_unique<btReducedDeformableBodySolver>())
      : bodySolver_(std::move(solver)) {
    constraintSolver_.setDeformableSolver(bodySolver_.get());
    world = std::make_unique<btDeformableMultiBodyDynamicsWorld>(&dispatcher_, &broadphase_, &constraintSolver_,
                                                                 &configuration_, bodySolver_.get());
    world->setGravity(gravity);
    world->getWorldInfo().m_gravity = gravity;
  }
  /// Adds a floor whose top is at y = 0.
  void addFloor() {
    floor_ = std::make_unique<Rigid>(*world, std::make_unique<btBoxShape>(btVector3(20, 1, 20)), btScalar(0),
                                     btVector3(0, -1, 0));
  }
  void step(int substeps, double seconds = 1.0 / 240.0) {
    for (int k = 0; k < substeps; ++k) world->stepSimulation(static_cast<btScalar>(seconds), 0);
  }

 private:
  btSoftBodyRigidBodyCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  btDbvtBroadphase broadphase_;
  btDeformableMultiBodyConstraintSolver constraintSolver_;
  std::unique_ptr<btDeformableBodySolver> bodySolver_;

 public:
  std::unique_ptr<btDeformableMultiBodyDynamicsWorld> world;

 private:
  std::unique_ptr<Rigid> floor_;  ///< removes itself from `world`: release it before that
};

inline btTransform at(double x, double y, double z) {
  return btTransform(btQuaternion::getIdentity(),
                     btVector3(static_cast<btScalar>(x), static_cast<btScalar>(y), static_cast<btScalar>(z)));
}

/// Options for the bar, which is soft enough for 20 modes in steps of 1/240 s.
inline ReducedBodyOptions barOptions(const btTransform& placement = btTransform::getIdentity()) {
  ReducedBodyOptions options;
  options.density = 2.0;
  options.youngsModulus = 2000.0;
  options.placement = placement;
  return options;
}

/// Options with so few modes that steps are quick.
inline ReducedBodyOptions fewModes(const btTransform& placement) {
  ReducedBodyOptions options = barOptions(placement);
  options.modeCount = 6;
  return options;
}

inline std::unique_ptr<ReducedBody> added(World& world, const VibrationModes& modes,
                                          const ReducedBodyOptions& options = barOptions()) {
  Result<std::unique_ptr<ReducedBody>> body = ReducedBody::add(*world.world, modes, barCage(), options);
  EXPECT_TRUE(body.ok()) << body.status().message;
  return std::move(body).value();
}

inline Eigen::Vector3d nodeOf(const btSoftBody& body, int n) {
  const btVector3& p = body.m_nodes[n].m_x;
  return {p.x(), p.y(), p.z()};
}

inline double lowest(const btSoftBody& body) {
  double y = HUGE_VAL;
  for (int n = 0; n < body.m_nodes.size(); ++n) y = std::min<double>(y, body.m_nodes[n].m_x.y());
  return y;
}

inline bool allFinite(const btSoftBody& body) {
  for (int n = 0; n < body.m_nodes.size(); ++n) {
    if (!nodeOf(body, n).allFinite() || nodeOf(body, n).norm() > 1e3) return false;
  }
  return true;
}

}  // namespace tetskin::test
